// Tests src/learn/value_scale.c
#include <stdlib.h>

#include "assert_near.h"
#include "learn/value_scale.h"

enum { INPUTS = 4 };

typedef struct fixture {
  vs_net net;
  vs_blas blas;
  float *parameters;
} fixture;

static void set_up(fixture *f) {
  const vs_net_shape shape = {INPUTS, 2, {8, 8}, 2, true};
  vs_rng rng = vs_rng_make(5, 0);
  assert_ok(vs_net_init(&f->net, &shape, err));
  assert_ok(vs_blas_open(&f->blas, VS_BLAS_ANY, err));
  f->parameters = malloc(f->net.size * sizeof *f->parameters);
  assert_ok(vs_net_randomise(&f->net, 4.0, &rng, f->parameters, err));
}

// Two batches of targets: 1, 3 (mean 2, squares 10) and 5, 5 (sum 10, squares 50). Kept part of the first: 0.9. Mean
// (0.9 * 4 + 10)/(0.9 * 2 + 2) = 3.5789; mean square (0.9 * 10 + 50)/3.8 = 15.526; deviation sqrt(2.7175) = 1.6485.
static void the_scale_follows_the_returns(void **state) {
  (void)state;
  vs_value_scale scale = vs_value_scale_make(true);
  vs_value_scale_update(&scale, 2, 4, 10);
  assert_near(scale.mean, 2.0, 1e-12);
  assert_near(scale.deviation, 1.0, 1e-12);
  vs_value_scale_update(&scale, 2, 10, 50);
  assert_near(scale.mean, 3.578947, 1e-6);
  assert_near(scale.deviation, 1.648469, 1e-5);
  vs_value_scale off = vs_value_scale_make(false);
  vs_value_scale_update(&off, 2, 4, 10);
  assert_near(off.mean, 0.0, 0.0);
  assert_near(off.deviation, 1.0, 0.0);
}

// A change of scale may not change what the critic says in reward units.
static void the_critic_says_the_same_after_a_change_of_scale(void **state) {
  (void)state;
  fixture f;
  set_up(&f);
  const float x[INPUTS] = {0.7f, -0.3f};
  vs_net_work work;
  const vs_value_scale from = {.mean = 0.5, .deviation = 2.0}, to = {.mean = -3.0, .deviation = 0.25};
  assert_ok(vs_net_work_init(&work, &f.net, 1, false, NULL, err));
  vs_net_forward(&f.net, &f.blas, f.parameters, x, 1, &work);
  double before = work.value[0] * from.deviation + from.mean;
  vs_value_scale_fit(&from, &to, &f.net, f.parameters);
  vs_net_forward(&f.net, &f.blas, f.parameters, x, 1, &work);
  assert_near(work.value[0] * to.deviation + to.mean, before, 1e-5);
  vs_net_work_free(&work);
  free(f.parameters);
}

// Targets 1 and 3 of this rank, 5 and 7 of the other: mean 4, squares 84/4 = 21, deviation sqrt(21 - 16) = 2.2361. So 1
// becomes -3/2.2361 = -1.3416, 3 becomes -0.4472; old values 4 and 6.2361 become 0 and 1.
static vs_status add_the_other_rank(void *self, double *values, size_t count, vs_error *err) {
  (void)self, (void)err;
  assert_int_equal(count, 3);
  values[0] += 2, values[1] += 5 + 7, values[2] += 25 + 49;
  return VS_OK;
}

static void a_batch_comes_out_in_the_critics_unit_over_all_ranks(void **state) {
  (void)state;
  fixture f;
  set_up(&f);
  const vs_group group = {.size = 2, .sum_doubles = add_the_other_rank};
  float target[2] = {1, 3}, old[2];
  const float value[2] = {4.0f, 6.2360680f};
  const vs_value_batch batch = {2, target, old, value};
  vs_value_scale scale = vs_value_scale_make(true);
  assert_ok(vs_value_scale_follow(&scale, &group, &batch, &f.net, f.parameters, err));
  assert_near(scale.mean, 4.0, 1e-12);
  assert_near(scale.deviation, 2.2360680, 1e-6);
  assert_near(target[0], -1.3416408, 1e-6);
  assert_near(target[1], -0.4472136, 1e-6);
  assert_near(old[0], 0.0, 1e-6);
  assert_near(old[1], 1.0, 1e-6);
  assert_near(vs_value_in_reward(&scale, old[1]), 6.2360680, 1e-5);
  free(f.parameters);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_scale_follows_the_returns),
      cmocka_unit_test(the_critic_says_the_same_after_a_change_of_scale),
      cmocka_unit_test(a_batch_comes_out_in_the_critics_unit_over_all_ranks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
