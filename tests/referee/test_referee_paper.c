// Tests src/referee/referee_paper.c: one test a row of the paper's rules (goal and time: test_referee.c).
#include "referee/referee_world.h"

static void two_defenders_and_the_ball_in_their_area_are_a_penalty(void **state) {
  (void)state;
  // Blue's area: x < -0.6, |y| < 0.35. Defenders count by their centre, in the goal too.
  static const struct {
    double ball_x_m, ball_y_m, a_x_m, a_y_m, b_x_m, b_y_m;
    bool penalty;
  } row[] = {
      {-0.65, 0, -0.65, 0.2, -0.7, -0.2, true},     {-0.65, 0.34, -0.61, 0.2, -0.61, -0.34, true},
      {-0.65, 0, -0.78, 0.05, -0.7, -0.2, true},    {-0.59, 0, -0.65, 0.2, -0.7, -0.2, false},
      {-0.65, 0.36, -0.65, 0.2, -0.7, -0.2, false}, {-0.65, 0, -0.65, 0.2, -0.59, -0.2, false},
      {-0.65, 0, -0.65, 0.2, -0.7, -0.36, false},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    for (int team = 0; team < VS_TEAMS; team++) {
      vs_world w = quiet_world(row[k].ball_x_m, row[k].ball_y_m), turned;
      put(&w, VS_BLUE, 0, row[k].a_x_m, row[k].a_y_m);
      put(&w, VS_BLUE, 2, row[k].b_x_m, row[k].b_y_m);
      vs_world_for_team(&w, (vs_team)team, &turned); // for yellow the same on the other side
      vs_referee r = referee_of(VS_RULES_PAPER, &turned);
      vs_event event = vs_referee_step(&r, &turned, FRAME_S);
      if (row[k].penalty)
        assert_event(event, VS_EVENT_PENALTY, team == VS_BLUE ? VS_YELLOW : VS_BLUE, 0);
      else
        assert_event(event, VS_EVENT_NONE, VS_BLUE, 0);
    }
  }
}

static void attackers_in_the_area_are_no_foul(void **state) {
  (void)state;
  vs_world w = quiet_world(-0.65, 0);
  put(&w, VS_BLUE, 0, -0.7, 0.1);
  for (int i = 0; i < VS_TEAM_SIZE; i++) put(&w, VS_YELLOW, i, -0.65, -0.3 + 0.1 * i);
  vs_referee r = referee_of(VS_RULES_PAPER, &w);
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_NONE, VS_BLUE, 0);
}

static void goal_comes_before_the_penalty(void **state) {
  (void)state;
  vs_world w = quiet_world(-0.78, 0);
  put(&w, VS_BLUE, 0, -0.7, 0.1);
  put(&w, VS_BLUE, 1, -0.7, -0.1);
  vs_referee r = referee_of(VS_RULES_PAPER, &w);
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_GOAL, VS_YELLOW, 0);
}

static void ball_still_for_ten_seconds_is_a_free_ball_in_its_quadrant(void **state) {
  (void)state;
  static const struct {
    double x_m, y_m;
    int quadrant;
  } row[] = {{0.3, 0.1, 1}, {-0.3, 0.1, 2}, {-0.3, -0.1, 3}, {0.3, -0.1, 4}, {0, 0, 1}, {-0.7, 0.3, 2}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_world w = quiet_world(row[k].x_m, row[k].y_m);
    vs_referee r = referee_of(VS_RULES_PAPER, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_FREE_BALL, VS_BLUE, row[k].quadrant);
    assert_near(took_s, 10, 1e-9); // 300 frames
  }
}

static void ball_that_creeps_two_centimetres_starts_the_clock_anew(void **state) {
  (void)state;
  vs_world w = quiet_world(0.3, 0.1);
  vs_referee r = referee_of(VS_RULES_PAPER, &w);
  double took_s;
  for (int n = 0; n < 200; n++) vs_referee_step(&r, &w, FRAME_S);
  w.ball.x_m += 0.0199; // not yet moved
  for (int n = 0; n < 50; n++) assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  w.ball.x_m += 0.0002; // 2.01 cm from where the clock started
  assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_FREE_BALL, VS_BLUE, 1);
  assert_near(took_s, 10, 1e-9);
}

static void ball_that_oscillates_by_less_than_two_centimetres_is_still(void **state) {
  (void)state;
  vs_world a = quiet_world(0.3, 0.1), b = quiet_world(0.315, 0.1);
  vs_referee r = referee_of(VS_RULES_PAPER, &a);
  for (int n = 0; n < 299; n++) assert_int_equal(vs_referee_step(&r, n % 2 ? &a : &b, FRAME_S).kind, VS_EVENT_NONE);
  assert_event(vs_referee_step(&r, &a, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 1);
}

static void restart_forgets_how_long_the_ball_lay_still(void **state) {
  (void)state;
  vs_world w = quiet_world(0.3, 0.1);
  vs_referee r = referee_of(VS_RULES_PAPER, &w);
  double took_s;
  for (int n = 0; n < 250; n++) vs_referee_step(&r, &w, FRAME_S);
  vs_referee_restarted(&r, &w);
  wait_for_event(&r, &w, 20, &took_s);
  assert_near(took_s, 10, 1e-9);
}

// Training's own clock: 3 s within 10 cm. A jam that wanders by 9 cm is one, a ball that gets 11 cm away is not.
static void a_clock_of_its_own_judges_by_its_time_and_distance(void **state) {
  (void)state;
  vs_world near = quiet_world(0.3, 0.1), jam = quiet_world(0.39, 0.1), away = quiet_world(0.41, 0.1);
  vs_referee r = referee_of(VS_RULES_PAPER, &near);
  r.def.still_s = 3;
  r.def.still_distance_m = 0.1;
  for (int n = 0; n < 89; n++) assert_int_equal(vs_referee_step(&r, n % 2 ? &near : &jam, FRAME_S).kind, VS_EVENT_NONE);
  assert_event(vs_referee_step(&r, &jam, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 1);
  vs_referee_restarted(&r, &near);
  for (int n = 0; n < 200; n++)
    assert_int_equal(vs_referee_step(&r, n % 60 ? &near : &away, FRAME_S).kind, VS_EVENT_NONE);
}

static void ball_over_the_wall_is_a_free_ball(void **state) {
  (void)state;
  static const struct {
    double x_m, y_m;
    int quadrant;
  } row[] = {{0.1, 0.68, 1}, {-0.1, 0.68, 2}, {-0.8, -0.3, 3}, {0.8, -0.3, 4}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_world w = quiet_world(row[k].x_m, row[k].y_m);
    vs_referee r = referee_of(VS_RULES_PAPER, &w);
    assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, row[k].quadrant);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_defenders_and_the_ball_in_their_area_are_a_penalty),
      cmocka_unit_test(attackers_in_the_area_are_no_foul),
      cmocka_unit_test(goal_comes_before_the_penalty),
      cmocka_unit_test(ball_still_for_ten_seconds_is_a_free_ball_in_its_quadrant),
      cmocka_unit_test(ball_that_creeps_two_centimetres_starts_the_clock_anew),
      cmocka_unit_test(ball_that_oscillates_by_less_than_two_centimetres_is_still),
      cmocka_unit_test(restart_forgets_how_long_the_ball_lay_still),
      cmocka_unit_test(a_clock_of_its_own_judges_by_its_time_and_distance),
      cmocka_unit_test(ball_over_the_wall_is_a_free_ball),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
