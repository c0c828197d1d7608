// Tests src/learn/ppo.c
// The policy is uniform where both raw outputs are so low that alpha = beta = 1: then ln p = 0 and the entropy is 0, and
// a ratio is set by the old log-probability alone.
#include "assert_near.h"
#include "learn/beta.h"
#include "learn/ppo.h"

#define LOW -60.0f // 1 + softplus(-60) = 1
static const float uniform[4] = {LOW, LOW, LOW, LOW};
static const float half[2] = {-0.69314718f, -0.69314718f}; // u = 1/2

static vs_ppo_stats one_row(const vs_ppo_def *def, double old_log_p, double advantage, double target, double old_value,
                            float value, float d_raw[4], float *d_value) {
  float old = (float)old_log_p, a = (float)advantage, r = (float)target, v = (float)old_value;
  const vs_ppo_batch batch = {1, NULL, half, half, &old, &a, &r, &v};
  vs_ppo_stats stats = {0};
  const vs_ppo_outputs outputs = {uniform, &value, d_raw, d_value};
  vs_ppo_loss(def, &batch, &outputs, 1.0, &stats);
  return stats;
}

// ln p = 0, old ln p = -0.5: ratio e^0.5 = 1.6487, outside 1.2. Advantage 2: min(3.2974, 2.4) = 2.4. Advantage -2:
// min(-3.2974, -2.4) = -3.2974. kl = 1.6487 - 1 - 0.5 = 0.14872.
static void a_ratio_over_the_clip_limits_gains_but_not_losses(void **state) {
  (void)state;
  const vs_ppo_def def = {.clip = 0.2};
  float d_raw[4], d_value;
  vs_ppo_stats s = one_row(&def, -0.5, 2.0, 0.0, 0.0, 0.0f, d_raw, &d_value);
  assert_near(s.policy_loss, -2.4, 1e-6);
  assert_near(s.kl, 0.1487212707, 1e-6);
  assert_near(s.clipped, 1.0, 0.0);
  s = one_row(&def, -0.5, -2.0, 0.0, 0.0, 0.0f, d_raw, &d_value);
  assert_near(s.policy_loss, 3.2974425414, 1e-6);
}

// old ln p = 0.5: ratio e^-0.5 = 0.60653, under 0.8. Advantage 2: min(1.2131, 1.6) = 1.2131. Advantage -2:
// min(-1.2131, -1.6) = -1.6.
static void a_ratio_under_the_clip_limits_losses_but_not_gains(void **state) {
  (void)state;
  const vs_ppo_def def = {.clip = 0.2};
  float d_raw[4], d_value;
  assert_near(one_row(&def, 0.5, 2.0, 0.0, 0.0, 0.0f, d_raw, &d_value).policy_loss, -1.2130613194, 1e-6);
  assert_near(one_row(&def, 0.5, -2.0, 0.0, 0.0, 0.0f, d_raw, &d_value).policy_loss, 1.6, 1e-6);
}

// value 1.5, old 1, target 3, clip 0.2: clipped value 1.2; 0.5 max(1.5^2, 1.8^2) = 1.62, flat. Target 0: 0.5 max(1.5^2,
// 1.2^2) = 1.125, derivative 1.5. Without clipping: 1.125 and -1.5.
static void the_value_is_clipped_around_the_old_one_where_asked(void **state) {
  (void)state;
  vs_ppo_def def = {.clip = 0.2, .clip_value = true, .value_weight = 1.0};
  float d_raw[4], d_value;
  assert_near(one_row(&def, 0.0, 0.0, 3.0, 1.0, 1.5f, d_raw, &d_value).value_loss, 1.62, 1e-6);
  assert_near(d_value, 0.0, 0.0);
  assert_near(one_row(&def, 0.0, 0.0, 0.0, 1.0, 1.5f, d_raw, &d_value).value_loss, 1.125, 1e-6);
  assert_near(d_value, 1.5, 1e-6);
  def.clip_value = false;
  assert_near(one_row(&def, 0.0, 0.0, 3.0, 1.0, 1.5f, d_raw, &d_value).value_loss, 1.125, 1e-6);
  assert_near(d_value, -1.5, 1e-6);
}

// Random rows; every derivative against a central difference of the total loss. Rows whose ratio or value sits at a
// corner of the loss are left out by construction (ratios 0.7, 1, 1.4; no value within h of its clip).
enum { ROWS = 12 };
typedef struct rows {
  float raw[ROWS][4], value[ROWS], log_u[ROWS][2], log_1_u[ROWS][2], old_log_p[ROWS], advantage[ROWS], target[ROWS],
      old_value[ROWS];
} rows;

static void make_rows(rows *r) {
  vs_rng rng = vs_rng_make(3, 0);
  static const double log_ratio[3] = {-0.35, 0.0, 0.35};
  for (int i = 0; i < ROWS; i++) {
    double log_p = 0.0;
    for (int k = 0; k < 4; k++) r->raw[i][k] = (float)vs_rng_range(&rng, -2.0, 3.0);
    for (int k = 0; k < 2; k++) {
      double u = vs_rng_range(&rng, 0.05, 0.95);
      r->log_u[i][k] = (float)log(u);
      r->log_1_u[i][k] = (float)log1p(-u);
      log_p += vs_beta_log_density(1.0 + vs_softplus(r->raw[i][k]), 1.0 + vs_softplus(r->raw[i][2 + k]), r->log_u[i][k],
                                   r->log_1_u[i][k]);
    }
    r->old_log_p[i] = (float)(log_p - log_ratio[i % 3]);
    r->advantage[i] = (float)vs_rng_range(&rng, -2.0, 2.0);
    r->target[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
    r->old_value[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
    r->value[i] = r->old_value[i] + (i % 2 ? 0.1f : 0.5f);
  }
}

static double total(const vs_ppo_def *def, const rows *r, float d_raw[][4], float *d_value) {
  const vs_ppo_batch batch = {ROWS,         NULL,         r->log_u[0], r->log_1_u[0],
                              r->old_log_p, r->advantage, r->target,   r->old_value};
  vs_ppo_stats stats = {0};
  const vs_ppo_outputs outputs = {r->raw[0], r->value, d_raw[0], d_value};
  vs_ppo_loss(def, &batch, &outputs, ROWS, &stats);
  return vs_ppo_total(def, &stats);
}

static void derivatives_agree_with_finite_differences(void **state) {
  (void)state;
  const vs_ppo_def def = {.clip = 0.2, .clip_value = true, .entropy = 0.01, .value_weight = 0.5};
  const float h = 1e-2f;
  static rows at, moved;
  float d_raw[ROWS][4], d_value[ROWS], unused[ROWS][4], unused_value[ROWS];
  make_rows(&at);
  total(&def, &at, d_raw, d_value);
  for (int i = 0; i < ROWS; i++) {
    for (int k = 0; k < 4; k++) {
      moved = at;
      moved.raw[i][k] = at.raw[i][k] + h;
      double more = total(&def, &moved, unused, unused_value);
      moved.raw[i][k] = at.raw[i][k] - h;
      double less = total(&def, &moved, unused, unused_value);
      assert_near(d_raw[i][k], (more - less) / (2.0 * h), 2e-5);
    }
    moved = at;
    moved.value[i] = at.value[i] + h;
    double more = total(&def, &moved, unused, unused_value);
    moved.value[i] = at.value[i] - h;
    assert_near(d_value[i], (more - total(&def, &moved, unused, unused_value)) / (2.0 * h), 1e-5);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_ratio_over_the_clip_limits_gains_but_not_losses),
      cmocka_unit_test(a_ratio_under_the_clip_limits_losses_but_not_gains),
      cmocka_unit_test(the_value_is_clipped_around_the_old_one_where_asked),
      cmocka_unit_test(derivatives_agree_with_finite_differences),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
