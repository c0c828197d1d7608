// Tests src/learn/train_matches.c: a run's matches, as its settings say.
#include <stdlib.h>

#include "assert_near.h"
#include "learn/train_matches.h"

enum { ENVS = 8, ROWS = VS_VECENV_ROWS(ENVS) };

static struct {
  float observation[ROWS][VS_OBS_SIZE], action[ROWS][VS_ACTION_SIZE];
  double reward_terms[ROWS][VS_REWARD_TERMS];
  uint8_t done[ENVS], time_limit[ENVS];
  int32_t score[ENVS][VS_TEAMS];
  float episode_s[ENVS];
} a;

// How many matches show the ball elsewhere than on the centre mark, up to the camera's noise.
static int away_from_the_mark(void) {
  int count = 0;
  for (int env = 0; env < ENVS; env++) {
    const float *ball = a.observation[env * VS_TEAMS * VS_TEAM_SIZE] + VS_OBS_SIZE - VS_OBS_FRAME + VS_OBS_BALL_XY;
    count += ball[0] * ball[0] + ball[1] * ball[1] > 0.05f * 0.05f;
  }
  return count;
}

// Open play from the second million on: the matches that go on before it end as they began.
static void episodes_begin_otherwise_from_start_from_m_on(void **state) {
  (void)state;
  vs_train_def def = vs_train_def_default();
  def.envs = ENVS, def.threads = 1, def.episode_s = 1.0;
  def.start_open = 1.0, def.start_penalty = def.start_free_ball = 0.0, def.start_from_m = 2.0;
  vs_matches matches;
  const vs_vecenv_buffers b = {.observation = a.observation[0],
                               .action = a.action[0],
                               .reward_terms = a.reward_terms[0],
                               .done = a.done,
                               .time_limit = a.time_limit,
                               .score = a.score[0],
                               .episode_s = a.episode_s};
  assert_ok(vs_train_matches_open(&def, NULL, 0, "zero:", &matches, err));
  matches.learnt(matches.self, 1.9);
  assert_ok(matches.reset(matches.self, &b, err));
  assert_int_equal(away_from_the_mark(), 0);
  for (int step = 0; step < 10; step++) assert_ok(matches.step(matches.self, &b, err));
  assert_true(a.done[0]);
  assert_int_equal(away_from_the_mark(), 0); // the second episode
  matches.learnt(matches.self, 2.0);
  assert_ok(matches.step(matches.self, &b, err));
  assert_int_equal(away_from_the_mark(), 0);
  for (int step = 1; step < 10; step++) assert_ok(matches.step(matches.self, &b, err));
  assert_true(a.done[0]);
  assert_int_equal(away_from_the_mark(), ENVS); // the third
  matches.free(matches.self);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(episodes_begin_otherwise_from_start_from_m_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
