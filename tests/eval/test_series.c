// src/eval/series.c
#include <stdio.h>
#include <string.h>

#include "planar_model.h"
#include "vsss/eval.h"

static vs_series_def short_matches(const char *blue, const char *yellow, int matches, int threads) {
  vs_series_def def = {.env = vs_env_def_default(model), .matches = matches, .threads = threads, .seed = 3};
  def.env.player[VS_BLUE] = blue;
  def.env.player[VS_YELLOW] = yellow;
  def.env.referee.duration_s = 5;
  return def;
}

static void results_are_the_same_for_1_2_and_4_threads(void **state) {
  (void)state;
  enum { MATCHES = 6 };
  static vs_match_result result[3][MATCHES];
  const int threads[3] = {1, 2, 4};
  for (int k = 0; k < 3; k++) {
    vs_series_def def = short_matches("emc:", "inf:", MATCHES, threads[k]);
    assert_ok(vs_series_play(&def, result[k], err));
  }
  for (int i = 0; i < MATCHES; i++) {
    assert_true(result[0][i].played);
    assert_near(result[0][i].time_s, 5, 1e-6);
    assert_int_equal(result[0][i].seed, vs_seed_mix(3, (uint64_t)i));
    for (int k = 1; k < 3; k++) assert_memory_equal(&result[k][i], &result[0][i], sizeof result[0][i]);
    if (i > 0) assert_int_not_equal(result[0][i].hash, result[0][i - 1].hash);
  }
}

static bool two_matches(void *context, int index, const vs_match_result *result) {
  (void)index;
  assert_true(result->played);
  return ++*(int *)context < 2;
}

static void progress_can_stop_a_series_and_what_is_done_stays(void **state) {
  (void)state;
  vs_match_result result[8];
  vs_series_def def = short_matches("zero:", "random:", 8, 1);
  int done = 0;
  def.progress = two_matches;
  def.context = &done;
  assert_ok(vs_series_play(&def, result, err));
  assert_int_equal(done, 2);
  for (int i = 0; i < 8; i++) assert_int_equal(result[i].played, i < 2);
}

static bool never(void *context) {
  (void)context;
  return false;
}

static void a_match_under_way_can_be_left(void **state) {
  (void)state;
  vs_match_result result[2];
  vs_series_def def = short_matches("zero:", "random:", 2, 2);
  def.go_on = never;
  assert_ok(vs_series_play(&def, result, err));
  assert_false(result[0].played);
  assert_false(result[1].played);
}

// Events are counted by the team they name; the goals among them are the score.
static void counted_goals_are_the_score(void **state) {
  (void)state;
  vs_series_def def = short_matches("emc:", "random:", 1, 1);
  def.env.referee.duration_s = 40;
  vs_match_result result;
  assert_ok(vs_series_play(&def, &result, err));
  for (int t = 0; t < VS_TEAMS; t++) assert_int_equal(result.events[t][VS_EVENT_GOAL], result.score[t]);
}

static void a_player_that_does_not_open_and_no_matches_are_refused(void **state) {
  (void)state;
  vs_match_result result[2];
  vs_error err = {0};
  vs_series_def def = short_matches("nobody:", "random:", 2, 2);
  assert_int_equal(vs_series_play(&def, result, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "nobody"));
  def = short_matches("zero:", "random:", 0, 1);
  assert_int_equal(vs_series_play(&def, result, &err), VS_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(results_are_the_same_for_1_2_and_4_threads),
      cmocka_unit_test(progress_can_stop_a_series_and_what_is_done_stays),
      cmocka_unit_test(a_match_under_way_can_be_left),
      cmocka_unit_test(counted_goals_are_the_score),
      cmocka_unit_test(a_player_that_does_not_open_and_no_matches_are_refused),
  };
  return cmocka_run_group_tests_name("eval/series", tests, load_model, free_model);
}
