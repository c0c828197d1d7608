#include "precision.h"

#include <math.h>
#include <stdlib.h>

#include "vsss/clock.h"

enum { TRIES = 12, ROWS_MAX = 2048 };

// A minibatch of plausible numbers: what they are changes no product's speed.
typedef struct sample {
  vs_ppo_batch batch;
  float *numbers; // owns the batch's arrays
  int *rows;
} sample;

static bool make_sample(const vs_learner_def *def, sample *s) {
  int rows = def->minibatch < ROWS_MAX ? def->minibatch : ROWS_MAX;
  size_t n = (size_t)rows, inputs = (size_t)def->shape.inputs, actions = (size_t)def->shape.actions;
  s->numbers = malloc(n * (inputs + 2 * actions + 4) * sizeof *s->numbers);
  s->rows = malloc(n * sizeof *s->rows);
  if (!s->numbers || !s->rows) return false;
  vs_rng rng = vs_rng_make(1, 0);
  float *x = s->numbers, *log_u = x + n * inputs, *log_1_u = log_u + n * actions, *rest = log_1_u + n * actions;
  for (size_t i = 0; i < n * inputs; i++) x[i] = (float)vs_rng_range(&rng, -1, 1);
  for (size_t i = 0; i < n * actions; i++) {
    double u = vs_rng_range(&rng, 0.1, 0.9);
    log_u[i] = (float)log(u);
    log_1_u[i] = (float)log1p(-u);
  }
  for (size_t i = 0; i < 4 * n; i++) rest[i] = (float)vs_rng_range(&rng, -1, 1);
  for (int i = 0; i < rows; i++) s->rows[i] = i;
  s->batch = (vs_ppo_batch){rows, x, log_u, log_1_u, rest, rest + n, rest + 2 * n, rest + 3 * n};
  return true;
}

static vs_status time_once(vs_learner *learner, const sample *s, double *best_s, vs_error *err) {
  vs_ppo_stats stats = {0};
  int64_t start_us = vs_clock_monotonic_us();
  const vs_minibatch minibatch = {s->rows, s->batch.rows, s->batch.rows, 0.0, 1.0};
  vs_status status = vs_learner_gradient(learner, &s->batch, &minibatch, &stats, err);
  *best_s = fmin(*best_s, 1e-6 * (double)(vs_clock_monotonic_us() - start_us));
  return status;
}

vs_status vs_precision_time(const vs_learner_def *def, vs_pool *pool, vs_precision_times *out, vs_error *err) {
  vs_learner_def own = *def;
  vs_learner learner[2] = {0};
  sample s = {0};
  double best_s[2] = {HUGE_VAL, HUGE_VAL};
  own.precision = VS_PRECISION_FP32;
  vs_status status = vs_learner_init(&learner[0], &own, pool, 1, err);
  bool both = status == VS_OK && vs_blas_has_bf16(&learner[0].blas);
  own.precision = VS_PRECISION_BF16;
  if (both) status = vs_learner_init(&learner[1], &own, pool, 1, err);
  if (status == VS_OK && !make_sample(def, &s)) status = vs_fail(err, VS_FAIL, "out of memory for a minibatch");
  // In turns, so that whatever else the machine does slows both; the first try makes the kernels.
  for (int i = 0; i < TRIES + 1 && status == VS_OK && both; i++) {
    if (i == 1) best_s[0] = best_s[1] = HUGE_VAL;
    for (int k = 0; k < 2 && status == VS_OK; k++) status = time_once(&learner[k], &s, &best_s[k], err);
  }
  for (int k = 0; k < 2; k++)
    if (learner[k].parameters) vs_learner_free(&learner[k]);
  free(s.numbers);
  free(s.rows);
  *out = (vs_precision_times){both ? best_s[0] : 0.0, best_s[1]};
  return status;
}
