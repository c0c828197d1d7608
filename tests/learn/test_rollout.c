// Tests src/learn/rollout.c
#include <stdio.h>

#include "assert_near.h"
#include "learn/gae.h"
#include "learn/train_internal.h"
#include "tiny_matches.h"

// Two batches of targets: 1, 3 (mean 2, squares 10) and 5, 5 (sum 10, squares 50). Kept part of the first: 0.9. Mean
// (0.9 * 4 + 10)/(0.9 * 2 + 2) = 3.5789; mean square (0.9 * 10 + 50)/3.8 = 15.526; deviation sqrt(2.7175) = 1.6485.
static void the_scale_follows_the_returns(void **state) {
  (void)state;
  vs_value_scale scale = {.on = true, .deviation = 1.0};
  vs_value_scale_update(&scale, 2, 4, 10);
  assert_near(scale.mean, 2.0, 1e-12);
  assert_near(scale.deviation, 1.0, 1e-12);
  vs_value_scale_update(&scale, 2, 10, 50);
  assert_near(scale.mean, 3.578947, 1e-6);
  assert_near(scale.deviation, 1.648469, 1e-5);
  vs_value_scale off = {.deviation = 1.0};
  vs_value_scale_update(&off, 2, 4, 10);
  assert_near(off.mean, 0.0, 0.0);
  assert_near(off.deviation, 1.0, 0.0);
}

static vs_train *open_tiny(const char *opponent, int length) {
  vs_train_def def = vs_train_def_default();
  snprintf(def.precision, sizeof def.precision, "fp32"); // auto may choose another one each time
  snprintf(def.hidden, sizeof def.hidden, "8,8");
  snprintf(def.opponent, sizeof def.opponent, "%s", opponent);
  snprintf(def.reward, sizeof def.reward, "goals,progress=1");
  def.envs = 4;
  def.steps = 20;
  def.minibatch = 60;
  def.threads = 1;
  vs_matches matches = tiny_matches(def.envs, length, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(&def, &matches, NULL, &train, err));
  return train;
}

// A change of scale may not change what the critic says in reward units.
static void the_critic_says_the_same_after_a_change_of_scale(void **state) {
  (void)state;
  vs_train *t = open_tiny("frozen", 7);
  float x[VS_OBS_SIZE] = {0.7f, -0.3f};
  vs_net_work work;
  const vs_value_scale from = {.mean = 0.5, .deviation = 2.0}, to = {.mean = -3.0, .deviation = 0.25};
  assert_ok(vs_net_work_init(&work, &t->learner.net, 1, false, NULL, err));
  vs_net_forward(&t->learner.net, &t->learner.blas, t->learner.parameters, x, 1, &work);
  double before = work.value[0] * from.deviation + from.mean;
  vs_value_scale_fit(&from, &to, &t->learner.net, t->learner.parameters);
  vs_net_forward(&t->learner.net, &t->learner.blas, t->learner.parameters, x, 1, &work);
  assert_near(work.value[0] * to.deviation + to.mean, before, 1e-5);
  vs_net_work_free(&work);
  vs_train_free(t);
}

// Episodes of 7 steps; every third ends by a goal, the others by the clock: of 20 steps, steps 6 (goal) and 13 (clock)
// end one. Rows of the learning side only, three a match.
// gain (2u - 1), clipped to [-1, 1].
static double command(const vs_train *t, double log_u) {
  return fmin(fmax(t->def.action_gain * (2.0 * exp(log_u) - 1.0), -1.0), 1.0);
}

static void ends_are_goals_or_cuts_and_rewards_are_the_weighted_terms(void **state) {
  (void)state;
  vs_train *t = open_tiny("frozen", 7);
  vs_rollout *r = &t->rollout;
  double unused = 0.0;
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  assert_ok(vs_train_collect(t, &t->reward_start, &unused, &unused, err));
  assert_int_equal(r->rows, 4 * 3);
  for (int step = 0; step < 20; step++)
    for (int i = 0; i < r->rows; i++) {
      int at = step * r->rows + i;
      assert_int_equal(r->end[at], step == 6 ? VS_ENDED : step == 13 ? VS_CUT : VS_GOES_ON);
      // progress = s left - right^2 of the action taken.
      double left = command(t, r->log_u[2 * at]), right = command(t, r->log_u[2 * at + 1]);
      assert_near(r->reward[at], r->x[(size_t)at * VS_OBS_SIZE] * left - right * right, 1e-5);
    }
  assert_near(r->stats.episodes, 2.0 * 4, 0.0);
  vs_train_free(t);
}

// With the ball on the right (y < 0) the network sees the mirror image, and what it draws for the left wheel drives the
// right one; on the left it is as it is.
static void a_mirrored_observation_drives_mirrored_wheels(void **state) {
  (void)state;
  vs_train *t = open_tiny("self", 7);
  vs_rollout *r = &t->rollout;
  r->def.io.canonical = true;
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  for (int row = 0; row < r->rows; row++) {
    float *newest = r->io.observation + (row + 1) * VS_OBS_SIZE - VS_OBS_FRAME;
    newest[VS_OBS_BALL_XY + 1] = row % 2 ? -0.5f : 0.5f;
    newest[VS_OBS_OWN_ACTION] = 0.25f;
  }
  vs_rollout_begin(r);
  vs_rollout_act(r, 0, t->learner.parameters, &t->scale);
  for (int row = 0; row < r->rows; row++) {
    const float *newest = r->x + (row + 1) * VS_OBS_SIZE - VS_OBS_FRAME, *action = r->io.action + 2 * row;
    int mirrored = row % 2;
    assert_near(newest[VS_OBS_BALL_XY + 1], 0.5, 0);
    assert_near(newest[VS_OBS_OWN_ACTION + mirrored], 0.25, 0);
    assert_near(action[mirrored], command(t, r->log_u[2 * row]), 1e-6);
    assert_near(action[!mirrored], command(t, r->log_u[2 * row + 1]), 1e-6);
  }
  vs_train_free(t);
}

// Each row draws from its own stream: an action depends on seed, decision and row, not on who else plays.
static void the_present_policy_plays_the_same_whatever_the_opponents(void **state) {
  (void)state;
  vs_train *a = open_tiny("frozen", 7), *b = open_tiny("pool", 7);
  double unused = 0.0;
  assert_ok(a->matches.reset(a->matches.self, &a->rollout.io, err));
  assert_ok(b->matches.reset(b->matches.self, &b->rollout.io, err));
  assert_ok(vs_train_collect(a, &a->reward_start, &unused, &unused, err));
  assert_ok(vs_train_collect(b, &b->reward_start, &unused, &unused, err));
  assert_int_equal(a->rollout.rows, b->rollout.rows);
  assert_memory_equal(a->rollout.log_u, b->rollout.log_u, (size_t)a->rollout.rows * 20 * 2 * sizeof(float));
  vs_train_free(a);
  vs_train_free(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_scale_follows_the_returns),
      cmocka_unit_test(the_critic_says_the_same_after_a_change_of_scale),
      cmocka_unit_test(ends_are_goals_or_cuts_and_rewards_are_the_weighted_terms),
      cmocka_unit_test(a_mirrored_observation_drives_mirrored_wheels),
      cmocka_unit_test(the_present_policy_plays_the_same_whatever_the_opponents),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
