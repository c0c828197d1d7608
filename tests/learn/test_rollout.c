// Tests src/learn/rollout.c
#include <stdio.h>

#include "assert_near.h"
#include "learn/gae.h"
#include "learn/train_internal.h"
#include "tiny_matches.h"

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
  def.reversible = false; // the tiny task has no robots
  vs_matches matches = tiny_matches(def.envs, length, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(&def, &matches, NULL, &train, err));
  return train;
}

// Episodes of 7 steps; every third ends by a goal, the others by the clock: of 20 steps, steps 6 (goal) and 13 (clock)
// end one. Rows of the learning side only, three a match.
// gain (2u - 1), clipped to [-1, 1].
static double command(const vs_train *t, double log_u) {
  return fmin(fmax(t->def.action_gain * (2.0 * exp(log_u) - 1.0), -1.0), 1.0);
}

static void episodes_terminate_by_goals_or_are_truncated_and_rewards_are_the_weighted_terms(void **state) {
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
      assert_int_equal(r->end[at], step == 6 ? VS_TERMINATED : step == 13 ? VS_TRUNCATED : VS_GOES_ON);
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
  vs_rollout_act(r, 0, t->learner.parameters);
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

// With augment, rows are shown versions of their own, kept for so many decisions; a mirror image drives mirrored wheels.
static void augmented_rows_see_versions_that_change_now_and_then(void **state) {
  (void)state;
  vs_train *t = open_tiny("frozen", 7);
  vs_rollout *r = &t->rollout;
  r->def.io.augment = 3;
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  vs_rollout_begin(r);
  int mirrored = 0, changed = 0, steps = 9;
  for (int step = 0; step < steps; step++)
    for (int row = 0; row < r->rows; row++) {
      if (row == 0) {
        for (int k = 0; k < r->rows; k++) {
          float *newest = r->io.observation + (r->row[k] + 1) * VS_OBS_SIZE - VS_OBS_FRAME;
          newest[VS_OBS_BALL_XY + 1] = 0.5f;
        }
        vs_rollout_act(r, step, t->learner.parameters);
      }
      size_t at = (size_t)step * (size_t)r->rows + (size_t)row;
      int flip = r->x[(at + 1) * VS_OBS_SIZE - VS_OBS_FRAME + VS_OBS_BALL_XY + 1] < 0;
      int before = step > 0 && r->x[(at - (size_t)r->rows + 1) * VS_OBS_SIZE - VS_OBS_FRAME + VS_OBS_BALL_XY + 1] < 0;
      mirrored += flip;
      changed += step > 0 && flip != before;
      assert_near(r->io.action[2 * r->row[row] + flip], command(t, r->log_u[2 * at]), 1e-6);
    }
  assert_in_range(mirrored, steps * r->rows / 4, steps * r->rows * 3 / 4);
  assert_in_range(changed, 1, (steps - 1) * r->rows / 3); // half of every third
  vs_train_free(t);
}

// A robot that heads away from their goal is seen by its other end, mirrored or not, and driven by it.
static void a_robot_that_faces_back_is_driven_by_its_other_end(void **state) {
  (void)state;
  vs_train *t = open_tiny("self", 7);
  vs_rollout *r = &t->rollout;
  r->def.io = (vs_policy_io){.reversible = true, .canonical = true, .action_gain = t->def.action_gain};
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  for (int row = 0; row < r->rows; row++) {
    float *newest = r->io.observation + (row + 1) * VS_OBS_SIZE - VS_OBS_FRAME;
    newest[VS_OBS_OWN_HEADING + 1] = row % 2 ? -0.5f : 0.5f;
    newest[VS_OBS_BALL_XY + 1] = row / 2 % 2 ? -0.5f : 0.5f;
    newest[VS_OBS_OWN_ACTION] = 0.25f;
  }
  vs_rollout_begin(r);
  vs_rollout_act(r, 0, t->learner.parameters);
  for (int row = 0; row < r->rows; row++) {
    const float *newest = r->x + (row + 1) * VS_OBS_SIZE - VS_OBS_FRAME, *action = r->io.action + 2 * row;
    int back = row % 2, swapped = back ^ (row / 2 % 2);
    double way = back ? -1 : 1;
    assert_near(newest[VS_OBS_OWN_HEADING + 1], 0.5, 0);
    assert_near(newest[VS_OBS_OWN_ACTION + swapped], 0.25 * way, 0);
    assert_near(action[swapped], way * command(t, r->log_u[2 * row]), 1e-6);
    assert_near(action[!swapped], way * command(t, r->log_u[2 * row + 1]), 1e-6);
  }
  vs_train_free(t);
}

// The commands that all rows but the learner's get at decision `at` of their present episodes, into out [24][2].
static void opponents_act(vs_train *t, long long at, float (*out)[2]) {
  vs_rollout *r = &t->rollout;
  r->decision = at;
  vs_rollout_begin(r);
  vs_rollout_act(r, 0, t->learner.parameters);
  for (int row = 0; row < 4 * 6; row++) memcpy(out[row], r->io.action + 2 * row, sizeof out[row]);
  for (int i = 0; i < r->rows; i++) memset(out[r->row[i]], 0, sizeof out[0]);
}

// Earlier selves at gains from 0.25 to 0.75, at the mean of what they draw from: each robot's command is its gain times
// that of a gain of 1, through the whole episode; one gain a team in some matches, one a robot in the others; other
// gains in other episodes.
static void opponents_drive_at_gains_drawn_for_each_episode(void **state) {
  (void)state;
  enum { EPISODES = 40, ROWS = 4 * 6 };
  vs_train *t = open_tiny("frozen", 7);
  vs_rollout *r = &t->rollout;
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  float plain[ROWS][2], before[ROWS][2], now[ROWS][2];
  int alike = 0, apart = 0, row_count = 0;
  double low = 9, high = 0, sum = 0;
  r->def.opponent = (vs_opponent_style){.gain_low = 1.0, .gain_high = 1.0, .mean = 1.0};
  opponents_act(t, 0, plain);
  for (int episode = 0; episode < EPISODES; episode++) {
    r->def.opponent = (vs_opponent_style){.gain_low = 0.25, .gain_high = 0.75, .mean = 1.0};
    opponents_act(t, 5, before);
    opponents_act(t, 6, now);
    assert_memory_equal(before, now, sizeof now);
    for (int env = 0; env < 4; env++) {
      double gain[3];
      int first = env * 6 + (r->league->slot[env].learner == VS_BLUE ? 3 : 0);
      for (int k = 0; k < 3; k++) {
        gain[k] = now[first + k][0] / plain[first + k][0];
        assert_near(now[first + k][1], gain[k] * plain[first + k][1], 1e-6);
        low = fmin(low, gain[k]), high = fmax(high, gain[k]), sum += gain[k], row_count++;
      }
      bool same = fabs(gain[1] - gain[0]) < 1e-4 && fabs(gain[2] - gain[0]) < 1e-4;
      *(same ? &alike : &apart) += 1;
      vs_league_episode_over(r->league, env, 1, 0);
    }
  }
  assert_in_range(alike, EPISODES * 4 / 3, EPISODES * 4 * 2 / 3);
  assert_int_equal(alike + apart, EPISODES * 4);
  assert_true(low >= 0.2499 && low < 0.3 && high > 0.7 && high <= 0.7501);
  assert_near(sum / row_count, 0.5, 0.05);
  vs_train_free(t);
}

// Where the mean has a share of a half, opponents sample in about half of the episodes; the learner always does.
static void opponents_take_the_mean_in_their_share_of_episodes(void **state) {
  (void)state;
  enum { EPISODES = 40, ROWS = 4 * 6 };
  vs_train *t = open_tiny("frozen", 7);
  vs_rollout *r = &t->rollout;
  assert_ok(t->matches.reset(t->matches.self, &r->io, err));
  r->def.opponent = (vs_opponent_style){.mean = 0.5};
  float a[ROWS][2], b[ROWS][2];
  int same = 0;
  for (int episode = 0; episode < EPISODES; episode++) {
    opponents_act(t, 5, a);
    float learner = r->io.action[2 * r->row[0]];
    opponents_act(t, 6, b);
    assert_true(learner != r->io.action[2 * r->row[0]]);
    for (int env = 0; env < 4; env++) {
      same += !memcmp(a[env * 6], b[env * 6], 6 * sizeof a[0]);
      vs_league_episode_over(r->league, env, 1, 0);
    }
  }
  assert_in_range(same, EPISODES * 4 / 3, EPISODES * 4 * 2 / 3);
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
      cmocka_unit_test(episodes_terminate_by_goals_or_are_truncated_and_rewards_are_the_weighted_terms),
      cmocka_unit_test(a_mirrored_observation_drives_mirrored_wheels),
      cmocka_unit_test(a_robot_that_faces_back_is_driven_by_its_other_end),
      cmocka_unit_test(augmented_rows_see_versions_that_change_now_and_then),
      cmocka_unit_test(opponents_drive_at_gains_drawn_for_each_episode),
      cmocka_unit_test(opponents_take_the_mean_in_their_share_of_episodes),
      cmocka_unit_test(the_present_policy_plays_the_same_whatever_the_opponents),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
