// Tests src/learn/learner.c
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "learn/beta.h"
#include "learn/learner.h"

enum { ROWS = 240, INPUTS = 12 };

static vs_learner_def small_def(void) {
  return (vs_learner_def){.shape = {INPUTS, 2, {16, 8}, 2, true},
                          .ppo = {.clip = 0.2, .clip_value = true, .entropy = 0.01, .value_weight = 0.5},
                          .learning_rate = 1e-3,
                          .adam_beta1 = 0.9,
                          .adam_beta2 = 0.999,
                          .adam_epsilon = 1e-5,
                          .max_gradient_norm = 0.5,
                          .initial_concentration = 2.0,
                          .epochs = 3,
                          .minibatch = 60,
                          .microbatches = 4};
}

typedef struct data {
  float x[ROWS * INPUTS], log_u[ROWS * 2], log_1_u[ROWS * 2], old_log_p[ROWS], advantage[ROWS], target[ROWS],
      old_value[ROWS];
} data;

// Samples of the uniform distribution, advantages that favour a high first action where x[0] > 0.
static void make_data(data *d) {
  vs_rng rng = vs_rng_make(4, 0);
  for (int i = 0; i < ROWS; i++) {
    for (int k = 0; k < INPUTS; k++) d->x[i * INPUTS + k] = (float)vs_rng_range(&rng, -1.0, 1.0);
    double u = vs_rng_range(&rng, 0.01, 0.99), v = vs_rng_range(&rng, 0.01, 0.99);
    d->log_u[2 * i] = (float)log(u), d->log_1_u[2 * i] = (float)log1p(-u);
    d->log_u[2 * i + 1] = (float)log(v), d->log_1_u[2 * i + 1] = (float)log1p(-v);
    d->old_log_p[i] = 0.0f;
    d->advantage[i] = (float)((u - 0.5) * d->x[i * INPUTS]);
    d->target[i] = d->x[i * INPUTS + 1];
    d->old_value[i] = 0.0f;
  }
}

static vs_ppo_batch batch_of(const data *d, int from, int rows) {
  return (vs_ppo_batch){rows,
                        d->x + from * INPUTS,
                        d->log_u + 2 * from,
                        d->log_1_u + 2 * from,
                        d->old_log_p + from,
                        d->advantage + from,
                        d->target + from,
                        d->old_value + from};
}

static void updated(const vs_learner_def *def, int threads, const data *d, vs_learner *learner,
                    vs_learner_stats *stats) {
  vs_pool *pool;
  assert_ok(vs_pool_new(threads, &pool, err));
  assert_ok(vs_learner_init(learner, def, pool, 9, err));
  const vs_ppo_batch batch = batch_of(d, 0, ROWS);
  for (int i = 0; i < 4; i++) assert_ok(vs_learner_update(learner, &batch, (uint64_t)i, stats, err));
  vs_pool_free(pool);
}

static void the_number_of_threads_changes_no_bit(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  vs_learner_def def = small_def();
  def.precision = VS_PRECISION_AUTO;
  vs_learner one, three;
  vs_learner_stats stats;
  updated(&def, 1, &d, &one, &stats);
  updated(&def, 3, &d, &three, &stats);
  assert_memory_equal(one.parameters, three.parameters, one.net.size * sizeof(float));
  vs_learner_free(&one);
  vs_learner_free(&three);
}

// The gradient of the whole batch by a learner of this definition, with these parameters.
static float *gradient_of(const vs_learner_def *def, const data *d, const float *parameters) {
  vs_pool *pool;
  vs_learner learner;
  vs_ppo_stats stats = {0};
  const vs_ppo_batch batch = batch_of(d, 0, ROWS);
  int rows[ROWS];
  const vs_minibatch minibatch = {rows, ROWS, ROWS, 0.0, 1.0};
  for (int i = 0; i < ROWS; i++) rows[i] = i;
  assert_ok(vs_pool_new(2, &pool, err));
  assert_ok(vs_learner_init(&learner, def, pool, 9, err));
  // Once with its own parameters: nothing of them may be left in the second gradient.
  assert_ok(vs_learner_gradient(&learner, &batch, &minibatch, &stats, err));
  memcpy(learner.parameters, parameters, learner.net.size * sizeof(float));
  assert_ok(vs_learner_gradient(&learner, &batch, &minibatch, &stats, err));
  assert_near(stats.rows, 2.0 * ROWS, 0.0);
  float *out = malloc(learner.net.size * sizeof *out);
  memcpy(out, learner.gradient, learner.net.size * sizeof *out);
  vs_learner_free(&learner);
  vs_pool_free(pool);
  return out;
}

// Distance of two gradients in units of the first's length.
static double distance(const float *a, const float *b, size_t count) {
  double off = 0.0, length = 0.0;
  for (size_t i = 0; i < count; i++) {
    off += pow((double)a[i] - b[i], 2.0);
    length += pow(a[i], 2.0);
  }
  return sqrt(off / length);
}

static void microbatches_blocks_and_bfloat16_give_one_gradient(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  vs_learner_def def = small_def();
  def.minibatch = ROWS;
  vs_learner moved; // parameters that are no learner's first
  vs_learner_stats stats;
  updated(&def, 1, &d, &moved, &stats);
  def.microbatches = 1;
  float *whole = gradient_of(&def, &d, moved.parameters);
  def.microbatches = 7; // of 34 or 35 rows
  def.block = 8;        // the last of 2 or 3
  float *parts = gradient_of(&def, &d, moved.parameters);
  assert_true(distance(whole, parts, moved.net.size) < 1e-5);
  if (vs_blas_has_bf16(&moved.blas)) {
    def.precision = VS_PRECISION_BF16;
    float *rounded = gradient_of(&def, &d, moved.parameters);
    double off = distance(whole, rounded, moved.net.size);
    assert_true(off < 0.01 && off > 1e-5);
    free(rounded);
  } else {
    print_message("note: 1 check not run: no bfloat16 here\n");
  }
  free(parts);
  free(whole);
  vs_learner_free(&moved);
}

static void updates_reduce_the_loss_of_policy_and_value(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  vs_learner_def def = small_def();
  def.ppo.clip_value = false;
  vs_learner learner;
  vs_learner_stats first = {0}, last = {0};
  def.epochs = 1;
  updated(&def, 1, &d, &learner, &first);
  vs_learner_free(&learner);
  def.epochs = 40;
  def.learning_rate = 3e-3;
  updated(&def, 1, &d, &learner, &last);
  assert_true(last.last.policy_loss / last.last.rows < first.last.policy_loss / first.last.rows - 0.02);
  assert_true(last.last.value_loss < 0.5 * first.last.value_loss);
  assert_true(last.last.kl > first.last.kl);
  vs_learner_free(&learner);
}

// Target 1, 0, old value 0: variance 1/4. Old value = target: all of it explained.
static void explained_variance_is_0_for_a_constant_and_1_for_the_truth(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  vs_learner_def def = small_def();
  vs_learner learner;
  vs_learner_stats stats;
  updated(&def, 1, &d, &learner, &stats);
  assert_near(stats.explained_variance, 0.0, 1e-9);
  vs_learner_free(&learner);
  memcpy(d.old_value, d.target, sizeof d.target);
  updated(&def, 1, &d, &learner, &stats);
  assert_near(stats.explained_variance, 1.0, 1e-9);
  vs_learner_free(&learner);
}

// Two ranks in two threads of this process: sums through shared memory.
typedef struct meeting {
  pthread_barrier_t barrier;
  double sum[1024];
  pthread_mutex_t lock;
} meeting;
static meeting meet;

static vs_status sum_doubles(void *self, double *values, size_t count, vs_error *err) {
  (void)err;
  int rank = *(int *)self;
  if (rank == 0) memset(meet.sum, 0, sizeof meet.sum);
  pthread_barrier_wait(&meet.barrier);
  pthread_mutex_lock(&meet.lock);
  for (size_t i = 0; i < count; i++) meet.sum[i] += values[i];
  pthread_mutex_unlock(&meet.lock);
  pthread_barrier_wait(&meet.barrier);
  for (size_t i = 0; i < count; i++) values[i] = meet.sum[i];
  pthread_barrier_wait(&meet.barrier);
  return VS_OK;
}

static vs_status sum_floats(void *self, float *values, size_t count, vs_error *err) {
  double part[1024];
  for (size_t from = 0; from < count; from += 1024) {
    size_t n = count - from < 1024 ? count - from : 1024;
    for (size_t i = 0; i < n; i++) part[i] = values[from + i];
    sum_doubles(self, part, n, err);
    for (size_t i = 0; i < n; i++) values[from + i] = (float)part[i];
  }
  return VS_OK;
}

typedef struct rank_run {
  int rank;
  const data *d;
  vs_learner learner;
} rank_run;

static void *run_rank(void *argument) {
  rank_run *r = argument;
  vs_group group = {.rank = r->rank, .size = 2, .self = &r->rank, .sum_floats = sum_floats, .sum_doubles = sum_doubles};
  vs_learner_def def = small_def();
  vs_pool *pool;
  vs_learner_stats stats;
  if (vs_pool_new(1, &pool, NULL) != VS_OK || vs_learner_init(&r->learner, &def, pool, 9, NULL) != VS_OK) return NULL;
  r->learner.group = &group;
  const vs_ppo_batch batch = batch_of(r->d, r->rank * ROWS / 2, ROWS / 2);
  for (int i = 0; i < 4; i++) vs_learner_update(&r->learner, &batch, (uint64_t)i, &stats, NULL);
  vs_pool_free(pool);
  return NULL;
}

static void two_ranks_with_half_the_rows_each_make_the_update_of_one(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  vs_learner_def def = small_def();
  vs_learner one;
  vs_learner_stats stats;
  updated(&def, 1, &d, &one, &stats);
  pthread_barrier_init(&meet.barrier, NULL, 2);
  pthread_mutex_init(&meet.lock, NULL);
  rank_run rank[2] = {{.rank = 0, .d = &d}, {.rank = 1, .d = &d}};
  pthread_t thread[2];
  for (int i = 0; i < 2; i++) assert_int_equal(pthread_create(&thread[i], NULL, run_rank, &rank[i]), 0);
  for (int i = 0; i < 2; i++) pthread_join(thread[i], NULL);
  pthread_barrier_destroy(&meet.barrier);
  pthread_mutex_destroy(&meet.lock);
  double moved = 0.0;
  vs_learner fresh;
  vs_pool *pool;
  assert_ok(vs_pool_new(1, &pool, err));
  assert_ok(vs_learner_init(&fresh, &def, pool, 9, err));
  for (size_t i = 0; i < one.net.size; i++) {
    assert_near(rank[0].learner.parameters[i], one.parameters[i], 2e-5);
    moved = fmax(moved, fabs((double)one.parameters[i] - fresh.parameters[i]));
  }
  assert_memory_equal(rank[0].learner.parameters, rank[1].learner.parameters, one.net.size * sizeof(float));
  assert_true(moved > 1e-2); // far more than the tolerance
  for (int i = 0; i < 2; i++) vs_learner_free(&rank[i].learner);
  vs_learner_free(&fresh);
  vs_learner_free(&one);
  vs_pool_free(pool);
}

static void a_gradient_that_is_not_finite_ends_the_update_with_an_error(void **state) {
  (void)state;
  static data d;
  make_data(&d);
  d.advantage[17] = NAN;
  vs_learner_def def = small_def();
  vs_learner learner;
  vs_pool *pool;
  vs_learner_stats stats;
  vs_error err = {0};
  assert_ok(vs_pool_new(1, &pool, err));
  assert_ok(vs_learner_init(&learner, &def, pool, 9, err));
  const vs_ppo_batch batch = batch_of(&d, 0, ROWS);
  assert_int_equal(vs_learner_update(&learner, &batch, 0, &stats, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "learning_rate"));
  vs_learner_free(&learner);
  vs_pool_free(pool);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_number_of_threads_changes_no_bit),
      cmocka_unit_test(microbatches_blocks_and_bfloat16_give_one_gradient),
      cmocka_unit_test(updates_reduce_the_loss_of_policy_and_value),
      cmocka_unit_test(explained_variance_is_0_for_a_constant_and_1_for_the_truth),
      cmocka_unit_test(two_ranks_with_half_the_rows_each_make_the_update_of_one),
      cmocka_unit_test(a_gradient_that_is_not_finite_ends_the_update_with_an_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
