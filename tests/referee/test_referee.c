// Tests src/referee/referee.c: the course of a match that both sets of rules share.
#include "referee/referee_world.h"

#include <string.h>

static void match_begins_with_the_kick_off_of_the_team_asked_for(void **state) {
  (void)state;
  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  vs_referee r;
  def.kick_off = VS_YELLOW;
  assert_ok(vs_referee_init(&r, &def, err));
  assert_event(r.game.last_event, VS_EVENT_KICK_OFF, VS_YELLOW, 0);
  assert_int_equal(r.kick_off, VS_YELLOW);
  assert_near(r.game.duration_s, 120, 0);
  assert_false(r.over);
}

// The ball's centre has to be more than its radius, 21.35 mm, behind x = 0.75, between the posts.
static void goal_counts_when_the_whole_ball_is_over_the_line(void **state) {
  (void)state;
  static const struct {
    double x_m, y_m;
    vs_event_kind kind;
    vs_team scorer;
  } row[] = {
      {0.7713, 0, VS_EVENT_NONE, VS_BLUE},
      {0.7714, 0, VS_EVENT_GOAL, VS_BLUE},
      {0.7714, 0.17, VS_EVENT_GOAL, VS_BLUE},
      {0.84, -0.17, VS_EVENT_GOAL, VS_BLUE},
      {-0.7713, 0.1, VS_EVENT_NONE, VS_BLUE},
      {-0.7714, 0.1, VS_EVENT_GOAL, VS_YELLOW},
      {0.7714, 0.21, VS_EVENT_FREE_BALL, VS_BLUE} /* behind the wall: not a goal */,
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_world w = quiet_world(row[k].x_m, row[k].y_m);
    vs_referee r = referee_of(VS_RULES_PAPER, &w);
    vs_event event = vs_referee_step(&r, &w, FRAME_S);
    assert_int_equal(event.kind, row[k].kind);
    if (event.kind != VS_EVENT_GOAL) continue;
    assert_int_equal(event.team, row[k].scorer);
    assert_int_equal(r.game.score[row[k].scorer], 1);
    assert_int_equal(r.game.score[1 - row[k].scorer], 0);
    assert_int_equal(r.kick_off, 1 - row[k].scorer);
    assert_int_equal(r.game.last_event.kind, VS_EVENT_GOAL);
    assert_near(event.time_s, FRAME_S, 1e-12);
    assert_false(r.over);
  }
}

static void match_of_120_s_ends_after_3600_frames(void **state) {
  (void)state;
  vs_world a = quiet_world(0, 0), b = quiet_world(0.1, 0);
  vs_referee r = referee_of(VS_RULES_PAPER, &a);
  for (int n = 1; n < 3600; n++) {
    vs_event event = vs_referee_step(&r, n % 2 ? &b : &a, FRAME_S);
    assert_int_equal(event.kind, VS_EVENT_NONE);
  }
  assert_event(vs_referee_step(&r, &a, FRAME_S), VS_EVENT_END, VS_BLUE, 0);
  assert_true(r.over);
  assert_near(r.game.time_s, 120, 1e-9);
  vs_world goal = quiet_world(0.8, 0);
  assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_NONE, VS_BLUE, 0); // too late
  assert_int_equal(r.game.score[VS_BLUE], 0);
}

static void goal_in_the_last_frame_counts_and_ends_the_match(void **state) {
  (void)state;
  vs_world a = quiet_world(0, 0), b = quiet_world(0.1, 0), goal = quiet_world(-0.8, 0);
  vs_referee r = referee_of(VS_RULES_PAPER, &a);
  for (int n = 1; n < 3600; n++) vs_referee_step(&r, n % 2 ? &b : &a, FRAME_S);
  assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, VS_YELLOW, 0);
  assert_true(r.over);
}

static void ten_goals_difference_end_the_match_ten_goals_do_not(void **state) {
  (void)state;
  vs_world home = quiet_world(0.8, 0), away = quiet_world(-0.8, 0);
  vs_referee r = referee_of(VS_RULES_PAPER, &home);
  vs_referee_step(&r, &away, FRAME_S);
  for (int goals = 1; goals <= 11; goals++) {
    assert_false(r.over);
    vs_referee_step(&r, &home, FRAME_S);
  }
  assert_int_equal(r.game.score[VS_BLUE], 11);
  assert_true(r.over);

  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  def.goal_difference_stop = 0;
  assert_ok(vs_referee_init(&r, &def, err));
  for (int goals = 0; goals < 30; goals++) vs_referee_step(&r, &home, FRAME_S);
  assert_false(r.over);
}

static void training_episode_ends_at_the_first_goal_or_after_40_s(void **state) {
  (void)state;
  vs_referee_def def = vs_referee_def_training();
  vs_referee r;
  vs_world goal = quiet_world(0.8, 0), a = quiet_world(0, 0), b = quiet_world(0.1, 0);
  assert_ok(vs_referee_init(&r, &def, err));
  vs_referee_step(&r, &goal, FRAME_S);
  assert_true(r.over);
  assert_ok(vs_referee_init(&r, &def, err));
  int frames = 0;
  for (; !r.over && frames < 3000; frames++) vs_referee_step(&r, frames % 2 ? &a : &b, FRAME_S);
  assert_int_equal(frames, 1200);
  assert_int_equal(r.game.last_event.kind, VS_EVENT_END);
}

static void second_half_is_kicked_off_by_the_other_team(void **state) {
  (void)state;
  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  vs_referee r;
  vs_world a = quiet_world(0, 0), b = quiet_world(0.1, 0), goal = quiet_world(0.8, 0);
  def.halves = 2;
  def.duration_s = 60;
  assert_ok(vs_referee_init(&r, &def, err));
  vs_referee_restarted(&r, &a);
  for (int n = 1; n < 900; n++) assert_int_equal(vs_referee_step(&r, n % 2 ? &b : &a, FRAME_S).kind, VS_EVENT_NONE);
  // A goal in the very last frame of the half counts; half time comes with the next.
  assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, VS_BLUE, 0);
  assert_event(vs_referee_step(&r, &a, FRAME_S), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
  assert_int_equal(r.kick_off, VS_YELLOW);
  assert_false(r.over);
  int frames = 901;
  while (!r.over && frames < 3000) vs_referee_step(&r, ++frames % 2 ? &b : &a, FRAME_S);
  assert_int_equal(frames, 1800);
  assert_int_equal(r.game.last_event.kind, VS_EVENT_END);
}

static void numbers_out_of_range_are_refused_with_the_range(void **state) {
  (void)state;
  vs_referee r;
  vs_error err = {0};
  vs_referee_def def = vs_referee_def_default(VS_RULES_PAPER);
  static const double bad[] = {0, -1, 7201, NAN, INFINITY};
  for (int k = 0; k < 5; k++) {
    def.duration_s = bad[k];
    assert_int_equal(vs_referee_init(&r, &def, &err), VS_USAGE);
    assert_non_null(strstr(err.text, "1 to 7200 s"));
  }
  def = vs_referee_def_default(VS_RULES_PAPER);
  def.halves = 3;
  assert_int_equal(vs_referee_init(&r, &def, &err), VS_USAGE);
  def = vs_referee_def_default(VS_RULES_PAPER);
  def.goal_difference_stop = -1;
  assert_int_equal(vs_referee_init(&r, &def, &err), VS_USAGE);
}

static void names_are_parsed_and_unknown_ones_refused(void **state) {
  (void)state;
  vs_rules rules;
  vs_placement_mode mode;
  vs_error err = {0};
  assert_ok(vs_rules_parse("league", &rules, err));
  assert_int_equal(rules, VS_RULES_LEAGUE);
  assert_ok(vs_rules_parse("paper", &rules, err));
  assert_int_equal(rules, VS_RULES_PAPER);
  assert_int_equal(vs_rules_parse("fifa", &rules, &err), VS_USAGE);
  assert_string_equal(err.text, "rules 'fifa': expected paper, league, serie-a-2023 or larc-2026");
  assert_ok(vs_placement_parse("random", &mode, err));
  assert_int_equal(mode, VS_PLACEMENT_RANDOM);
  assert_ok(vs_placement_parse("mixed", &mode, err));
  assert_int_equal(mode, VS_PLACEMENT_MIXED);
  assert_int_equal(vs_placement_parse("", &mode, &err), VS_USAGE);
  assert_string_equal(err.text, "placement '': expected paper, random or mixed");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(match_begins_with_the_kick_off_of_the_team_asked_for),
      cmocka_unit_test(goal_counts_when_the_whole_ball_is_over_the_line),
      cmocka_unit_test(match_of_120_s_ends_after_3600_frames),
      cmocka_unit_test(goal_in_the_last_frame_counts_and_ends_the_match),
      cmocka_unit_test(ten_goals_difference_end_the_match_ten_goals_do_not),
      cmocka_unit_test(training_episode_ends_at_the_first_goal_or_after_40_s),
      cmocka_unit_test(second_half_is_kicked_off_by_the_other_team),
      cmocka_unit_test(numbers_out_of_range_are_refused_with_the_range),
      cmocka_unit_test(names_are_parsed_and_unknown_ones_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
