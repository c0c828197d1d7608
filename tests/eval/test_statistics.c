// src/eval/statistics.c
#include "assert_near.h"
#include "vsss/eval.h"

// A sample of 60 ones and 40 zeros: the mean of a resample is binomial(100, 0.6)/100. Its distribution function passes
// 0.025 at 50 (0.0168 at 49, 0.0271 at 50) and 0.975 at 69 (0.9602 at 68, 0.9752 at 69); one step for the drawing.
static void interval_of_a_rate_is_the_binomial_one(void **state) {
  (void)state;
  double value[100];
  for (int i = 0; i < 100; i++) value[i] = i < 60;
  vs_estimate e = vs_bootstrap(value, 100, 1);
  assert_near(e.mean, 0.60, 1e-12);
  assert_near(e.low, 0.50, 0.011);
  assert_near(e.high, 0.69, 0.011);
}

// Twenty matches: 0 goals 6 times, 1 three times, 2 five times, 3 four times, 7 twice. The exact distribution of the
// mean of a resample (20-fold convolution) passes 0.025 at 1.15 (0.0230 at 1.10, 0.0319 at 1.15) and 0.975 at 2.90
// (0.9731 at 2.85, 0.9785 at 2.90). It is skewed: a symmetric normal interval would be 1.10 to 2.80.
static void interval_of_skewed_goals_is_the_exact_one(void **state) {
  (void)state;
  const double value[20] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3, 7, 7};
  vs_estimate e = vs_bootstrap(value, 20, 1);
  assert_near(e.mean, 1.95, 1e-12);
  assert_near(e.low, 1.15, 0.051);
  assert_near(e.high, 2.90, 0.051);
}

static void interval_of_equal_values_is_a_point_and_of_none_is_nan(void **state) {
  (void)state;
  const double value[3] = {2, 2, 2};
  vs_estimate e = vs_bootstrap(value, 3, 1);
  assert_near(e.low, 2, 0);
  assert_near(e.high, 2, 0);
  assert_true(isnan(vs_bootstrap(value, 0, 1).mean));
}

// By hand: 0 of 100 ends at z^2/(n + z^2) = 3.84146/103.84146; 60 of 100 at (0.6 + 0.0192073 +- 1.96 * sqrt(0.0024 +
// 0.000096036))/1.0384146.
static void interval_of_a_rate_has_a_width_at_its_ends(void **state) {
  (void)state;
  vs_estimate none = vs_rate(0, 100), all = vs_rate(100, 100), some = vs_rate(60, 100);
  assert_near(none.low, 0.0, 0.0);
  assert_near(none.high, 0.036994, 1e-6);
  assert_near(all.low, 1.0 - 0.036994, 1e-6);
  assert_near(all.high, 1.0, 0.0);
  assert_near(some.mean, 0.6, 1e-12);
  assert_near(some.low, 0.50200, 1e-4);
  assert_near(some.high, 0.69060, 1e-4);
  assert_true(isnan(vs_rate(0, 0).mean));
}

static void a_mirrored_match_is_the_other_teams(void **state) {
  (void)state;
  vs_match_result match = {.played = true, .score = {4, 1}, .idle_warnings = {3, 0}}, other, back;
  match.events[VS_BLUE][VS_EVENT_PENALTY] = 2;
  vs_match_mirror(&match, &other);
  assert_int_equal(other.score[VS_BLUE], 1);
  assert_int_equal(other.score[VS_YELLOW], 4);
  assert_int_equal(other.events[VS_YELLOW][VS_EVENT_PENALTY], 2);
  assert_int_equal(other.events[VS_BLUE][VS_EVENT_PENALTY], 0);
  vs_match_mirror(&other, &back);
  assert_memory_equal(back.score, match.score, sizeof match.score);
  assert_memory_equal(back.events, match.events, sizeof match.events);
}

// 2:1, 0:0, 1:3, 5:0 and one match that was not finished.
static void summary_counts_finished_matches_from_blues_side(void **state) {
  (void)state;
  vs_match_result result[5] = {
      {.played = true, .time_s = 120, .score = {2, 1}},
      {.played = true, .time_s = 120, .score = {0, 0}},
      {.played = false, .score = {9, 0}},
      {.played = true, .time_s = 120, .score = {1, 3}},
      {.played = true, .time_s = 60, .score = {5, 0}},
  };
  const vs_event penalty = {.kind = VS_EVENT_PENALTY, .team = VS_YELLOW}, free_ball = {.kind = VS_EVENT_FREE_BALL};
  for (int i = 0; i < 3; i++) vs_match_count(&result[0], &penalty);
  vs_match_count(&result[4], &free_ball);
  vs_series_summary s;
  assert_ok(vs_series_sum_up(result, 5, &s, err));
  assert_int_equal(s.matches, 4);
  assert_near(s.win.mean, 0.5, 1e-12);
  assert_near(s.draw.mean, 0.25, 1e-12);
  assert_near(s.loss.mean, 0.25, 1e-12);
  assert_near(s.goals_for.mean, 2.0, 1e-12);     // (2 + 0 + 1 + 5) / 4
  assert_near(s.goals_against.mean, 1.0, 1e-12); // (1 + 0 + 3 + 0) / 4
  assert_near(s.score.mean, 1.0, 1e-12);         // paper (17)
  // Means of four draws of 1, 0, -2, 5: 5 (1/256), 4 (4/256), 3.75 (4/256), ...; 2.5 % = 6.4/256 lie above 3.75.
  assert_near(s.score.high, 3.75, 1e-12);
  assert_near(s.penalties_against, 0.75, 1e-12);
  assert_near(s.penalties_for, 0.0, 1e-12);
  assert_near(s.free_balls, 0.25, 1e-12);
  assert_near(s.mean_time_s, 105.0, 1e-9); // (3 * 120 + 60) / 4
}

// A goal 4 s after a penalty is the penalty's, one 6 s after a free ball is of open play, and one 1 s after the kick-off
// that follows it is the kick-off's. The ball lay still for 2 of 4 s.
static void goals_are_counted_by_the_restart_they_came_of(void **state) {
  (void)state;
  vs_match_result m = {.played = true, .time_s = 4, .still_s = 2};
  const struct {
    vs_event_kind kind;
    vs_team team;
    double time_s;
  } row[] = {{VS_EVENT_PENALTY, VS_BLUE, 10},   {VS_EVENT_GOAL, VS_BLUE, 14},     {VS_EVENT_FREE_BALL, VS_BLUE, 30},
             {VS_EVENT_GOAL, VS_YELLOW, 36},    {VS_EVENT_GOAL, VS_YELLOW, 37},   {VS_EVENT_FREE_BALL, VS_BLUE, 50},
             {VS_EVENT_GOAL, VS_YELLOW, 54.99}, {VS_EVENT_PENALTY, VS_YELLOW, 60}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    const vs_event event = {.kind = row[i].kind, .team = row[i].team, .time_s = row[i].time_s};
    vs_match_count(&m, &event);
  }
  assert_int_equal(m.goals_from[VS_BLUE][VS_EVENT_PENALTY], 1);
  assert_int_equal(m.goals_from[VS_YELLOW][VS_EVENT_NONE], 1);
  assert_int_equal(m.goals_from[VS_YELLOW][VS_EVENT_KICK_OFF], 1);
  assert_int_equal(m.goals_from[VS_YELLOW][VS_EVENT_FREE_BALL], 1);
  vs_series_summary s;
  assert_ok(vs_series_sum_up(&m, 1, &s, err));
  assert_near(s.penalty_goals_for, 1, 0);
  assert_near(s.free_ball_goals_against, 1, 0);
  assert_near(s.still_share, 0.5, 1e-9);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(interval_of_a_rate_is_the_binomial_one),
      cmocka_unit_test(interval_of_skewed_goals_is_the_exact_one),
      cmocka_unit_test(interval_of_equal_values_is_a_point_and_of_none_is_nan),
      cmocka_unit_test(interval_of_a_rate_has_a_width_at_its_ends),
      cmocka_unit_test(a_mirrored_match_is_the_other_teams),
      cmocka_unit_test(goals_are_counted_by_the_restart_they_came_of),
      cmocka_unit_test(summary_counts_finished_matches_from_blues_side),
  };
  return cmocka_run_group_tests_name("eval/statistics", tests, NULL, NULL);
}
