// Tests src/learn/actor_mean.c: what it is the mean of, where it starts, and that it is what a run exports.
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "learn/train_internal.h"
#include "test_folder.h"
#include "tiny_matches.h"

static vs_train *open_tiny(double horizon_m) {
  vs_train_def def = vs_train_def_default();
  snprintf(def.precision, sizeof def.precision, "fp32");
  snprintf(def.hidden, sizeof def.hidden, "8,8");
  def.envs = 10;
  def.steps = 8;
  def.minibatch = 100;
  def.threads = 1;
  def.export_horizon_m = horizon_m;
  vs_matches matches = tiny_matches(def.envs, 7, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(&def, &matches, NULL, &train, err));
  return train;
}

static void update(vs_train *train) {
  vs_train_report report;
  assert_ok(vs_train_update(train, &report, err));
}

// The recurrence in double, beside the run: over a fifth of a young run, over the horizon of an older one.
static void follows_the_actors_over_its_horizon(void **state) {
  (void)state;
  vs_train *train = open_tiny(0.0005);
  double expected[4] = {0};
  bool was_young = false, was_old = false;
  for (int k = 0; k < 20; k++) {
    long long before = train->transitions;
    update(train);
    double rows = (double)(train->transitions - before), young = 0.2 * (double)train->transitions;
    double weight = fmin(1.0, rows / fmin(young, 500.0));
    was_young |= young < 500.0;
    was_old |= young > 500.0;
    for (int i = 0; i < 4; i++) expected[i] += weight * ((double)train->actor[i * 40] - expected[i]);
    for (int i = 0; i < 4; i++) assert_near(train->actor_mean[i * 40], expected[i], 1e-5);
  }
  assert_true(was_young && was_old);
  assert_memory_not_equal(train->actor_mean, train->actor, train->league.size * sizeof(float));
  vs_train_free(train);
}

static void starts_anew_where_the_networks_are_replaced(void **state) {
  (void)state;
  vs_train *train = open_tiny(5.0);
  for (int k = 0; k < 8; k++) update(train);
  assert_memory_not_equal(train->actor_mean, train->actor, train->league.size * sizeof(float));
  vs_train_hand_over(train);
  assert_memory_equal(train->actor_mean, train->actor, train->league.size * sizeof(float));
  vs_train_free(train);
}

// Whether the run's file holds this actor: the biases of its first layer, byte for byte.
static bool exports(const vs_train *train, const float *actor) {
  static char bytes[1 << 20]; // more than the file
  char path[96];
  snprintf(path, sizeof path, "%s/policy.onnx", folder);
  assert_ok(vs_train_export(train, path, false, NULL, err));
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  size_t n = fread(bytes, 1, sizeof bytes, f);
  fclose(f);
  assert_true(n < sizeof bytes);
  const float *bias = actor + train->rollout.actor.bias[0];
  return memmem(bytes, n, bias, 8 * sizeof *bias) != NULL;
}

static void is_what_a_run_exports(void **state) {
  (void)state;
  vs_train *mean = open_tiny(5.0), *newest = open_tiny(0.0);
  for (int k = 0; k < 8; k++) update(mean), update(newest);
  assert_null(newest->actor_mean);
  assert_memory_equal(mean->actor, newest->actor, mean->league.size * sizeof(float)); // learning is the same
  assert_true(exports(mean, mean->actor_mean));
  assert_false(exports(mean, mean->actor));
  assert_true(exports(newest, newest->actor));
  vs_train_free(mean);
  vs_train_free(newest);
}

// With the matches it is saved; a checkpoint of the networks alone, or of before, starts it anew.
static void is_saved_with_a_run(void **state) {
  (void)state;
  vs_train *train = open_tiny(5.0), *again = open_tiny(5.0);
  char path[96];
  for (int k = 0; k < 8; k++) update(train);
  const size_t size = train->league.size * sizeof(float);
  snprintf(path, sizeof path, "%s/checkpoint", folder);
  assert_ok(vs_train_save(train, path, err));
  assert_ok(vs_train_load(again, path, NULL, err));
  assert_memory_equal(again->actor_mean, train->actor_mean, size);
  update(train), update(again);
  assert_memory_equal(again->actor_mean, train->actor_mean, size);
  assert_ok(vs_train_save_slim(train, path, err));
  assert_ok(vs_train_load(again, path, NULL, err));
  assert_memory_equal(again->actor_mean, train->actor, size);
  vs_train_free(train);
  vs_train_free(again);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(follows_the_actors_over_its_horizon),
      cmocka_unit_test(starts_anew_where_the_networks_are_replaced),
      cmocka_unit_test(is_what_a_run_exports),
      cmocka_unit_test(is_saved_with_a_run),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
