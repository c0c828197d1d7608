// Times training with the paper's preset on the planar drive: transitions per second end to end and of playing alone,
// where the time goes, the memory, the learner by itself on one core, and the bare matrix products as its bound. Rates
// "1_core" are per second of processor time.
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include "learn/learner.h"
#include "vsss/learn.h"

enum { UPDATES = 3, LEARNER_ROWS = 4280 * 3 };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *values, int count) {
  qsort(values, (size_t)count, sizeof *values, by_value);
  return values[count / 2];
}

static double processor_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static float *random_floats(size_t count, double low, double high) {
  float *out = aligned_alloc(64, (count * sizeof *out + 63) / 64 * 64);
  vs_rng rng = vs_rng_make(1, 0);
  for (size_t i = 0; out && i < count; i++) out[i] = (float)vs_rng_range(&rng, low, high);
  return out;
}

// The products of one piece of a minibatch, forward and backward, both networks; GFLOP/s of one core.
static double bare_products(const vs_blas *blas) {
  enum { ROWS = 1070, IN = 464, H = 256, RUNS = 15 };
  float *x = random_floats(ROWS * IN, -1, 1), *w = random_floats(IN * 2 * H, -1, 1);
  float *h = random_floats(ROWS * 2 * H, -1, 1), *g = random_floats(ROWS * 2 * H, -1, 1);
  float *out = random_floats(IN * 2 * H, -1, 1);
  double rate[RUNS];
  for (int run = 0; run < RUNS; run++) {
    double start = processor_s();
    vs_blas_multiply(blas, false, false, ROWS, 2 * H, IN, x, IN, w, 2 * H, false, h, 2 * H);
    vs_blas_multiply(blas, true, false, IN, 2 * H, ROWS, x, IN, g, 2 * H, false, out, 2 * H);
    for (int n = 0; n < 2; n++) {
      vs_blas_multiply(blas, false, false, ROWS, H, H, h + n * H, 2 * H, w, H, false, g + n * H, 2 * H);
      vs_blas_multiply(blas, true, false, H, H, ROWS, h + n * H, 2 * H, g + n * H, 2 * H, false, out, H);
      vs_blas_multiply(blas, false, true, ROWS, H, H, g + n * H, 2 * H, w, H, false, h + n * H, 2 * H);
    }
    rate[run] = 2e-9 * ROWS * (2.0 * IN * 2 * H + 3.0 * 2 * H * H) / (processor_s() - start);
  }
  free(x), free(w), free(h), free(g), free(out);
  return median(rate, RUNS);
}

// The learner alone, one thread: transitions per second at five epochs.
static vs_status bench_learner(vs_precision precision, const char *name, vs_error *err) {
  const vs_learner_def def = {.shape = {VS_OBS_SIZE, 2, {256, 256}, VS_ACTION_SIZE, true},
                              .ppo = {.clip = 0.2, .clip_value = true, .entropy = 0.01, .value_weight = 0.5},
                              .learning_rate = 4e-4,
                              .adam_beta1 = 0.9,
                              .adam_beta2 = 0.999,
                              .adam_epsilon = 1e-5,
                              .max_gradient_norm = 0.5,
                              .initial_concentration = 4.0,
                              .epochs = 5,
                              .minibatch = 4280,
                              .microbatches = 4,
                              .precision = precision};
  vs_pool *pool;
  vs_learner learner;
  vs_status s = vs_pool_new(1, &pool, err);
  if (s == VS_OK) s = vs_learner_init(&learner, &def, pool, 1, err);
  if (s != VS_OK) return s;
  float *x = random_floats((size_t)LEARNER_ROWS * VS_OBS_SIZE, -1, 1),
        *logs = random_floats(2 * LEARNER_ROWS, -1, -0.5);
  float *zeros = random_floats(LEARNER_ROWS, 0, 0), *noise = random_floats(LEARNER_ROWS, -1, 1);
  const vs_ppo_batch batch = {LEARNER_ROWS, x, logs, logs, zeros, noise, noise, zeros};
  double rate[UPDATES];
  for (int i = 0; s == VS_OK && i < UPDATES; i++) {
    vs_learner_stats stats;
    double start = processor_s();
    s = vs_learner_update(&learner, &batch, (uint64_t)i, &stats, err);
    rate[i] = LEARNER_ROWS / (processor_s() - start);
  }
  printf("bench %s_transitions_per_s_1_core %.0f transitions/s\n", name, median(rate, UPDATES));
  vs_learner_free(&learner);
  vs_pool_free(pool);
  free(x), free(logs), free(zeros), free(noise);
  return s;
}

// The bare products by the library that the learner uses, and by OpenBLAS as the baseline, by turns.
static vs_status bench_products(vs_error *err) {
  enum { TURNS = 5 };
  vs_blas used, baseline;
  double rate[TURNS], rate_baseline[TURNS];
  vs_error missing = {0};
  vs_status s = vs_blas_open(&used, VS_BLAS_ANY, err);
  if (s != VS_OK) return s;
  bool compare = vs_blas_open(&baseline, VS_BLAS_OPENBLAS, &missing) == VS_OK;
  for (int i = 0; i < TURNS; i++) {
    rate[i] = bare_products(&used);
    rate_baseline[i] = compare ? bare_products(&baseline) : 1.0;
  }
  double products = median(rate, TURNS);
  printf("bench matrix_products_%s %.1f GFLOP/s\n", used.name, products);
  if (compare)
    printf("bench matrix_products_over_OpenBLAS %.2f ratio\n", products / median(rate_baseline, TURNS));
  else
    fprintf(stderr, "bench_learn: no baseline: %s\n", missing.text);
  return VS_OK;
}

static vs_status bench_training(vs_error *err) {
  vs_train_def def;
  vs_train *train = NULL;
  vs_train_report report;
  double rate[UPDATES], play[UPDATES], learn[UPDATES], core[UPDATES], part[3] = {0};
  vs_status s = vs_train_def_preset("paper", &def, err);
  if (s == VS_OK) s = vs_train_new(&def, NULL, &train, err);
  double rows = 3.0 * def.envs * def.steps;
  for (int i = 0; s == VS_OK && i < UPDATES; i++) {
    double start = processor_s();
    s = vs_train_update(train, &report, err);
    core[i] = rows / (processor_s() - start);
    rate[i] = report.transitions_per_s;
    play[i] = rows / (report.simulate_s + report.infer_s);
    learn[i] = rows / report.learn_s;
    double total = report.simulate_s + report.infer_s + report.learn_s;
    part[0] += 100.0 * report.simulate_s / total / UPDATES;
    part[1] += 100.0 * report.infer_s / total / UPDATES;
    part[2] += 100.0 * report.learn_s / total / UPDATES;
  }
  vs_train_free(train);
  if (s != VS_OK) return s;
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  printf("bench train_transitions_per_s %.0f transitions/s\n", median(rate, UPDATES));
  printf("bench train_transitions_per_s_1_core %.0f transitions/s\n", median(core, UPDATES));
  printf("bench train_play_per_s %.0f transitions/s\n", median(play, UPDATES));
  printf("bench train_learn_per_s %.0f transitions/s\n", median(learn, UPDATES));
  printf("bench train_simulate_part %.1f percent\n", part[0]);
  printf("bench train_infer_part %.1f percent\n", part[1]);
  printf("bench train_learn_part %.1f percent\n", part[2]);
  printf("bench train_memory %.0f MB\n", (double)usage.ru_maxrss / 1024.0);
  return VS_OK;
}

int main(void) {
  vs_error err = {0};
  vs_learn_environment();
  vs_status s = bench_training(&err);
  if (s == VS_OK) s = bench_learner(VS_PRECISION_AUTO, "learner", &err); // bf16 where the processor has it
  if (s == VS_OK) s = bench_learner(VS_PRECISION_FP32, "learner_fp32", &err);
  if (s == VS_OK) s = bench_products(&err);
  if (s == VS_OK) return 0;
  fprintf(stderr, "bench_learn: %s\n", err.text);
  return 1;
}
