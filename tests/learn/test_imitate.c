// Tests src/learn/imitate.c
#include <stdio.h>

#include "assert_near.h"
#include "learn/beta.h"
#include "learn/train_internal.h"
#include "tiny_matches.h"

static vs_train *open_tiny(void) {
  vs_train_def def = vs_train_def_default();
  snprintf(def.precision, sizeof def.precision, "fp32"); // auto may choose another one each time
  snprintf(def.hidden, sizeof def.hidden, "16,16");
  snprintf(def.opponent, sizeof def.opponent, "frozen");
  def.envs = 16;
  def.steps = 32;
  def.minibatch = 256;
  def.learning_rate = def.learning_rate_end = 3e-3;
  def.threads = 1;
  vs_matches matches = tiny_matches(def.envs, 10, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(&def, &matches, NULL, &train, err));
  return train;
}

// Mean action of the policy where the sign shown is s.
// The wheel command: the mean of the distribution times the gain.
static void mean_action(vs_train *train, float s, double action[2]) {
  float x[VS_OBS_SIZE] = {s, 1.0f};
  vs_net_work work;
  assert_ok(vs_net_work_init(&work, &train->learner.net, 1, false, NULL, err));
  vs_net_forward(&train->learner.net, &train->learner.blas, train->learner.parameters, x, 1, &work);
  for (int k = 0; k < 2; k++) {
    double alpha = 1.0 + vs_softplus(work.raw[k]), beta = 1.0 + vs_softplus(work.raw[2 + k]);
    action[k] = train->def.action_gain * (2.0 * alpha / (alpha + beta) - 1.0);
  }
  vs_net_work_free(&work);
}

static double first_loss, last_loss;
static bool watch(void *context, double part, double loss) {
  int *calls = context;
  if ((*calls)++ == 0) first_loss = loss;
  last_loss = loss;
  return part < 1.0 || *calls > 0;
}

static void the_clone_does_what_the_script_does_and_the_league_has_it(void **state) {
  (void)state;
  vs_train *train = open_tiny();
  vs_matches scripted = tiny_matches(train->def.envs, 10, 4);
  ((tiny *)scripted.self)->scripted = true;
  int calls = 0;
  assert_ok(vs_train_imitate_over(train, &scripted, 40, watch, &calls, err));
  assert_int_equal(calls, 40);
  assert_true(last_loss < first_loss - 1.0);
  for (int sign = -1; sign <= 1; sign += 2) {
    double action[2];
    mean_action(train, (float)sign, action);
    assert_near(action[0], 0.5 * sign, 0.05);
    assert_near(action[1], -0.5, 0.05);
  }
  assert_memory_equal(train->league.self[train->league.frozen].parameters, train->actor,
                      train->league.size * sizeof(float));
  // And the run goes on as any other.
  vs_train_report report;
  assert_ok(vs_train_update(train, &report, err));
  assert_near(report.update, 1.0, 0.0);
  vs_error err = {0};
  assert_int_equal(vs_train_imitate(train, "emc:", 1, NULL, NULL, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "start of a run"));
  vs_train_free(train);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_clone_does_what_the_script_does_and_the_league_has_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
