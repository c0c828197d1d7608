// Tests src/referee/referee_league.c: one test a row of the league's rules.
#include "referee/referee_world.h"

// A situation in blue's area, or the same turned into yellow's.
static vs_world turned(const vs_world *w, int defender) {
  vs_world out;
  vs_world_for_team(w, (vs_team)defender, &out);
  return out;
}

static vs_team other(int team) { return team == VS_BLUE ? VS_YELLOW : VS_BLUE; }

// The quadrant of a ball at (-, +), or at (+, -) after turning.
static int quadrant_of(int defender) { return defender == VS_BLUE ? 2 : 4; }

// The ball, not slow, in the area of `defender` with n of its own robots and m of the others'.
static vs_world in_area(int defender, int n, int m) {
  vs_world w = quiet_world(-0.65, 0.05);
  w.ball.vx_mps = 0.5;
  for (int i = 0; i < n; i++) put(&w, VS_BLUE, i, -0.7, -0.3 + 0.2 * i);
  for (int i = 0; i < m; i++) put(&w, VS_YELLOW, i, -0.62, -0.3 + 0.2 * i);
  return turned(&w, defender);
}

static vs_world outside(int defender) {
  vs_world w = quiet_world(-0.5, 0.05);
  w.ball.vx_mps = 0.5;
  return turned(&w, defender);
}

static vs_world in_goal(int defender) {
  vs_world w = quiet_world(-0.8, 0.05);
  w.ball.vx_mps = -0.5;
  return turned(&w, defender);
}

static void step_n(vs_referee *r, const vs_world *w, int frames) {
  for (int n = 0; n < frames; n++) assert_int_equal(vs_referee_step(r, w, FRAME_S).kind, VS_EVENT_NONE);
}

static void goal_without_a_foul_counts(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world play = in_area(d, 1, 1), goal = in_goal(d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &play);
    step_n(&r, &play, 10);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, other(d), 0);
    assert_int_equal(r.game.score[other(d)], 1);
  }
}

static void goal_after_the_defenders_foul_counts(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world play = in_area(d, 2, 1), goal = in_goal(d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &play);
    step_n(&r, &play, 10);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, other(d), 0);
  }
}

static void goal_after_the_attackers_foul_is_a_goal_kick(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world play = in_area(d, 1, 2), later = in_area(d, 1, 1), goal = in_goal(d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &play);
    step_n(&r, &play, 1);
    step_n(&r, &later, 10); // one attacker has left in time: the play is spoilt all the same
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
    assert_int_equal(r.game.score[other(d)], 0);
  }
}

static void goal_after_both_fouls_is_judged_by_the_later(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world attackers = in_area(d, 1, 2), defenders = in_area(d, 2, 1), goal = in_goal(d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &attackers);
    step_n(&r, &attackers, 5);
    step_n(&r, &defenders, 5);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_PENALTY, other(d), 0);
    r = referee_of(VS_RULES_LEAGUE, &attackers);
    step_n(&r, &defenders, 5);
    step_n(&r, &attackers, 5);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
    vs_world both = in_area(d, 2, 2);
    r = referee_of(VS_RULES_LEAGUE, &both);
    step_n(&r, &both, 5);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
  }
}

static void ball_that_leaves_the_area_is_judged_by_the_plays_later_foul(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world attackers = in_area(d, 1, 2), defenders = in_area(d, 2, 1), clean = in_area(d, 1, 1), out = outside(d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &clean);
    step_n(&r, &clean, 10);
    step_n(&r, &out, 10); // nothing was wrong
    step_n(&r, &defenders, 3);
    assert_event(vs_referee_step(&r, &out, FRAME_S), VS_EVENT_PENALTY, other(d), 0);
    vs_referee_restarted(&r, &out);
    step_n(&r, &attackers, 3);
    assert_event(vs_referee_step(&r, &out, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
    vs_referee_restarted(&r, &out);
    step_n(&r, &out, 10); // judged once
  }
}

static void two_defenders_for_three_seconds_are_a_penalty(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world play = in_area(d, 2, 0), relieved = in_area(d, 1, 0);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &play);
    double took_s;
    assert_event(wait_for_event(&r, &play, 10, &took_s), VS_EVENT_PENALTY, other(d), 0);
    assert_near(took_s, 3, 1e-9);
    vs_referee_restarted(&r, &play);
    step_n(&r, &play, 80);
    step_n(&r, &relieved, 1); // for a moment only one: the three seconds begin anew
    assert_event(wait_for_event(&r, &play, 10, &took_s), VS_EVENT_PENALTY, other(d), 0);
    assert_near(took_s, 3, 1e-9);
  }
}

static void two_attackers_for_three_seconds_are_a_goal_kick(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world play = in_area(d, 1, 2);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &play);
    double took_s;
    assert_event(wait_for_event(&r, &play, 10, &took_s), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
    assert_near(took_s, 3, 1e-9);
  }
}

static void ball_stuck_in_an_area_between_both_teams_is_a_goal_kick(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world w = quiet_world(-0.65, 0.05);
    put(&w, VS_BLUE, 0, -0.7, 0.05);        // 5 cm from the ball
    put(&w, VS_YELLOW, 0, -0.55, 0.05);     // 10 cm
    w.ball.vx_mps = w.ball.vy_mps = 0.0707; // 0.09998 m/s: stuck
    vs_world stuck = turned(&w, d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &stuck);
    double took_s;
    assert_event(wait_for_event(&r, &stuck, 10, &took_s), VS_EVENT_GOAL_KICK, (vs_team)d, quadrant_of(d));
    assert_near(took_s, 5 + FRAME_S, 1e-9); // the first frame shows it coming in
  }
}

static void ball_stuck_in_an_area_otherwise_is_a_penalty(void **state) {
  (void)state;
  for (int d = 0; d < VS_TEAMS; d++) {
    vs_world w = quiet_world(-0.65, 0.05);
    put(&w, VS_BLUE, 0, -0.7, 0.05);     // the keeper has it and does not clear it
    put(&w, VS_YELLOW, 0, -0.535, 0.05); // 11.5 cm away: 11.25 cm would be near
    vs_world stuck = turned(&w, d);
    vs_referee r = referee_of(VS_RULES_LEAGUE, &stuck);
    double took_s;
    assert_event(wait_for_event(&r, &stuck, 10, &took_s), VS_EVENT_PENALTY, other(d), 0);
    assert_near(took_s, 5 + FRAME_S, 1e-9);
  }
}

static void ball_stuck_elsewhere_is_a_free_ball_in_its_quadrant(void **state) {
  (void)state;
  static const struct {
    double x_m, y_m;
    int quadrant;
  } row[] = {{0.3, 0.1, 1}, {-0.3, 0.1, 2}, {-0.3, -0.1, 3}, {0.3, -0.1, 4}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_world w = quiet_world(row[k].x_m, row[k].y_m);
    w.ball.vx_mps = 0.1;
    vs_referee r = referee_of(VS_RULES_LEAGUE, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 10, &took_s), VS_EVENT_FREE_BALL, VS_BLUE, row[k].quadrant);
    assert_near(took_s, 5, 1e-9);
  }
}

static void ball_faster_than_ten_centimetres_a_second_is_not_stuck(void **state) {
  (void)state;
  vs_world slow = quiet_world(0.3, 0.1), fast = slow;
  fast.ball.vy_mps = -0.101;
  vs_referee r = referee_of(VS_RULES_LEAGUE, &slow);
  step_n(&r, &slow, 149);
  step_n(&r, &fast, 1);
  step_n(&r, &slow, 149);
  assert_event(vs_referee_step(&r, &slow, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 1);
}

static void slow_ball_that_enters_an_area_gets_its_five_seconds_there(void **state) {
  (void)state;
  vs_world before = quiet_world(-0.59, 0), inside = quiet_world(-0.61, 0);
  vs_referee r = referee_of(VS_RULES_LEAGUE, &before);
  double took_s;
  step_n(&r, &before, 140);
  assert_event(wait_for_event(&r, &inside, 10, &took_s), VS_EVENT_PENALTY, VS_YELLOW, 0);
  assert_near(took_s, 5 + FRAME_S, 1e-9);
}

static void ball_over_the_wall_is_a_free_ball(void **state) {
  (void)state;
  vs_world w = quiet_world(-0.2, -0.7);
  w.ball.vx_mps = 1;
  vs_referee r = referee_of(VS_RULES_LEAGUE, &w);
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 3);
}

static void match_has_two_halves_of_300_s(void **state) {
  (void)state;
  vs_world w = quiet_world(0, 0);
  w.ball.vx_mps = 1;
  vs_referee r = referee_of(VS_RULES_LEAGUE, &w);
  double took_s;
  assert_event(wait_for_event(&r, &w, 1000, &took_s), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
  assert_near(took_s, 300, 1e-6);
  assert_event(wait_for_event(&r, &w, 1000, &took_s), VS_EVENT_END, VS_BLUE, 0);
  assert_near(took_s, 300, 1e-6);
  assert_true(r.over);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(goal_without_a_foul_counts),
      cmocka_unit_test(goal_after_the_defenders_foul_counts),
      cmocka_unit_test(goal_after_the_attackers_foul_is_a_goal_kick),
      cmocka_unit_test(goal_after_both_fouls_is_judged_by_the_later),
      cmocka_unit_test(ball_that_leaves_the_area_is_judged_by_the_plays_later_foul),
      cmocka_unit_test(two_defenders_for_three_seconds_are_a_penalty),
      cmocka_unit_test(two_attackers_for_three_seconds_are_a_goal_kick),
      cmocka_unit_test(ball_stuck_in_an_area_between_both_teams_is_a_goal_kick),
      cmocka_unit_test(ball_stuck_in_an_area_otherwise_is_a_penalty),
      cmocka_unit_test(ball_stuck_elsewhere_is_a_free_ball_in_its_quadrant),
      cmocka_unit_test(ball_faster_than_ten_centimetres_a_second_is_not_stuck),
      cmocka_unit_test(slow_ball_that_enters_an_area_gets_its_five_seconds_there),
      cmocka_unit_test(ball_over_the_wall_is_a_free_ball),
      cmocka_unit_test(match_has_two_halves_of_300_s),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
