// Tests src/learn/train.c and train_update.c on a tiny task that PPO must solve.
#include <stdio.h>

#include "assert_near.h"
#include "learn/train_internal.h"
#include "tiny_matches.h"

static vs_train_def tiny_def(void) {
  vs_train_def def = vs_train_def_default();
  snprintf(def.precision, sizeof def.precision, "fp32"); // auto may choose another one each time
  snprintf(def.hidden, sizeof def.hidden, "16,16");
  snprintf(def.opponent, sizeof def.opponent, "frozen");
  snprintf(def.reward, sizeof def.reward, "dense,progress=1,approach=0,distance=0,own_distance=0");
  snprintf(def.reward_end, sizeof def.reward_end, "%s", def.reward);
  def.envs = 16;
  def.steps = 32;
  def.minibatch = 256;
  def.epochs = 4;
  def.learning_rate = def.learning_rate_end = 3e-3;
  def.gamma = 0.9;
  def.threads = 1;
  return def;
}

static vs_train *open_tiny(const vs_train_def *def) {
  vs_matches matches = tiny_matches(def->envs, 10, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(def, &matches, NULL, &train, err));
  return train;
}

// Random play earns 0 - E[right^2] a step; the best policy 1. Sampling from a Beta costs a little: 0.8 is solved.
static void the_tiny_task_is_solved(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  vs_train_report report = {0};
  assert_ok(vs_train_update(train, &report, err));
  assert_true(report.term[VS_REWARD_PROGRESS] < 0.1);
  double first = report.term[VS_REWARD_PROGRESS];
  for (int i = 0; i < 60; i++) assert_ok(vs_train_update(train, &report, err));
  if (report.term[VS_REWARD_PROGRESS] < 0.8)
    fail_msg("reward %.3f after 61 updates (%.3f at first): PPO does not learn", report.term[VS_REWARD_PROGRESS],
             first);
  assert_true(report.explained_variance > -0.5);
  assert_near(report.transitions, 61.0 * 16 * 32 * 3, 0.5);
  vs_train_free(train);
}

static void the_number_of_threads_changes_no_bit_of_a_run(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  snprintf(def.opponent, sizeof def.opponent, "self=0.4,pool=0.3,frozen=0.3");
  def.pool_every = 1;
  def.pool_size = 2;
  vs_train_report report;
  vs_train *one = open_tiny(&def);
  def.threads = 3;
  vs_train *three = open_tiny(&def);
  for (int i = 0; i < 5; i++) {
    assert_ok(vs_train_update(one, &report, err));
    assert_ok(vs_train_update(three, &report, err));
  }
  assert_memory_equal(one->learner.parameters, three->learner.parameters, one->learner.net.size * sizeof(float));
  vs_train_free(one);
  vs_train_free(three);
}

// Both sides learn: 6 rows a match instead of 3.
static void self_play_learns_from_both_sides(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  snprintf(def.opponent, sizeof def.opponent, "self");
  vs_train *train = open_tiny(&def);
  vs_train_report report;
  assert_ok(vs_train_update(train, &report, err));
  assert_near(report.transitions, 16.0 * 32 * 6, 0.5);
  vs_train_free(train);
}

static void the_torch_engine_trains_as_our_kernels_do(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  snprintf(def.learner, sizeof def.learner, "torch");
  vs_matches matches = tiny_matches(def.envs, 10, 3);
  vs_train *torch = NULL;
  vs_error err = {0};
  if (vs_train_new_over(&def, &matches, NULL, &torch, &err) != VS_OK) {
    assert_non_null(strstr(err.text, "libtorch-dev"));
    printf("note: this build has no libtorch\n");
    skip();
  }
  snprintf(def.learner, sizeof def.learner, "own");
  snprintf(def.precision, sizeof def.precision, "fp32");
  vs_train *own = open_tiny(&def);
  vs_train_report a, b;
  for (int i = 0; i < 2; i++) {
    assert_ok(vs_train_update(torch, &a, err));
    assert_ok(vs_train_update(own, &b, err));
  }
  assert_near(a.policy_loss, b.policy_loss, 1e-4);
  assert_near(a.value_loss, b.value_loss, 1e-3);
  assert_near(a.entropy, b.entropy, 1e-3);
  vs_train_free(torch);
  vs_train_free(own);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_tiny_task_is_solved),
      cmocka_unit_test(the_number_of_threads_changes_no_bit_of_a_run),
      cmocka_unit_test(self_play_learns_from_both_sides),
      cmocka_unit_test(the_torch_engine_trains_as_our_kernels_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
