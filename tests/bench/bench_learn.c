// Times training with the paper's preset on the planar drive: transitions per second end to end, of playing (simulation
// and inference) alone, where the time goes, and the bare matrix products as the bound of the learning part.
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "learn/blas.h"
#include "vsss/clock.h"
#include "vsss/learn.h"
#include "vsss/rng.h"

enum { UPDATES = 3 };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *values, int count) {
  qsort(values, (size_t)count, sizeof *values, by_value);
  return values[count / 2];
}

static float *random_floats(size_t count) {
  float *out = aligned_alloc(64, (count * sizeof *out + 63) / 64 * 64);
  vs_rng rng = vs_rng_make(1, 0);
  for (size_t i = 0; out && i < count; i++) out[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  return out;
}

// The products of one minibatch of 1,070 rows, forward and backward, both networks; GFLOP/s of one core.
static double bare_products(const vs_blas *blas) {
  enum { ROWS = 1070, IN = 464, H = 256 };
  float *x = random_floats(ROWS * IN), *w = random_floats(IN * 2 * H), *h = random_floats(ROWS * 2 * H),
        *g = random_floats(ROWS * 2 * H), *out = random_floats(IN * 2 * H);
  double best = 0.0;
  for (int run = 0; run < 15; run++) {
    int64_t start = vs_clock_monotonic_us();
    vs_blas_multiply(blas, false, false, ROWS, 2 * H, IN, x, IN, w, 2 * H, false, h, 2 * H);
    vs_blas_multiply(blas, true, false, IN, 2 * H, ROWS, x, IN, g, 2 * H, false, out, 2 * H);
    for (int n = 0; n < 2; n++) {
      vs_blas_multiply(blas, false, false, ROWS, H, H, h + n * H, 2 * H, w, H, false, g + n * H, 2 * H);
      vs_blas_multiply(blas, true, false, H, H, ROWS, h + n * H, 2 * H, g + n * H, 2 * H, false, out, H);
      vs_blas_multiply(blas, false, true, ROWS, H, H, g + n * H, 2 * H, w, H, false, h + n * H, 2 * H);
    }
    double flop = 2.0 * ROWS * (2.0 * IN * 2 * H + 3.0 * 2 * H * H);
    double rate = flop / (1e3 * (double)(vs_clock_monotonic_us() - start));
    if (rate > best) best = rate;
  }
  free(x), free(w), free(h), free(g), free(out);
  return best;
}

int main(void) {
  vs_error err = {0};
  vs_train_def def;
  vs_train *train = NULL;
  vs_train_report report;
  double rate[UPDATES], play[UPDATES], learn[UPDATES], part[3] = {0};
  if (vs_train_def_preset("paper", &def, &err) != VS_OK || vs_train_new(&def, &train, &err) != VS_OK) goto failed;
  double rows = 3.0 * def.envs * def.steps;
  for (int i = 0; i < UPDATES; i++) {
    if (vs_train_update(train, &report, &err) != VS_OK) goto failed;
    rate[i] = report.transitions_per_s;
    play[i] = rows / (report.simulate_s + report.infer_s);
    learn[i] = rows / report.learn_s;
    double total = report.simulate_s + report.infer_s + report.learn_s;
    part[0] += 100.0 * report.simulate_s / total / UPDATES;
    part[1] += 100.0 * report.infer_s / total / UPDATES;
    part[2] += 100.0 * report.learn_s / total / UPDATES;
  }
  vs_train_free(train);
  vs_blas blas;
  if (vs_blas_open(&blas, &err) != VS_OK) goto failed;
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  printf("bench train_paper %.0f transitions/s\n", median(rate, UPDATES));
  printf("bench train_paper_play %.0f transitions/s\n", median(play, UPDATES));
  printf("bench train_paper_learn %.0f transitions/s\n", median(learn, UPDATES));
  printf("bench train_paper_simulate_part %.1f percent\n", part[0]);
  printf("bench train_paper_infer_part %.1f percent\n", part[1]);
  printf("bench train_paper_learn_part %.1f percent\n", part[2]);
  printf("bench train_paper_memory %.0f MB\n", (double)usage.ru_maxrss / 1024.0);
  printf("bench matrix_products_%s %.1f GFLOP/s\n", blas.kernels, bare_products(&blas));
  return 0;
failed:
  fprintf(stderr, "bench_learn: %s\n", err.text);
  return 1;
}
