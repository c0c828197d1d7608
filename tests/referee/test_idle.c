// Tests src/referee/idle.c: who is warned, who is sent off, who is excused.
#include "referee/referee_world.h"

#include <string.h>

#include "vsss/idle.h"

static const vs_event nothing = {.kind = VS_EVENT_NONE};

// Everybody but blue 1 moves; blue 1 does what the test says.
static void play(vs_idle *idle, vs_world *w, double seconds, double blue1_turns_radps, double blue1_circles_m) {
  for (int k = 0; k < seconds / FRAME_S - 0.5; k++) {
    double now_s = k * FRAME_S;
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++)
        if (t != VS_BLUE || i != 1) put(w, (vs_team)t, i, (t ? 0.4 : -0.4) + 0.1 * sin(now_s), 0.2 * (i - 1));
    put(w, VS_BLUE, 1, -0.2 + blue1_circles_m * cos(now_s), 0.3 + blue1_circles_m * sin(now_s));
    w->robot[VS_BLUE][1].pose.theta_rad = blue1_turns_radps * now_s;
    vs_idle_step(idle, w, &nothing, FRAME_S);
  }
}

static void spinning_on_the_spot_is_warned_after_10_s_and_sent_off_after_20(void **state) {
  (void)state;
  for (int spins = 0; spins < 2; spins++) {
    vs_idle idle = {0};
    vs_world w = quiet_world(0.1, 0.1);
    play(&idle, &w, 9.9, 6.0 * spins, 0);
    assert_int_equal(idle.warnings[VS_BLUE], 0);
    play(&idle, &w, 0.2, 6.0 * spins, 0);
    assert_int_equal(idle.warnings[VS_BLUE], 1);
    assert_int_equal(idle.sent_off[VS_BLUE], 0);
    play(&idle, &w, 10, 6.0 * spins, 0);
    assert_int_equal(idle.warnings[VS_BLUE], 2);
    assert_int_equal(idle.sent_off[VS_BLUE], 1);
    play(&idle, &w, 60, 6.0 * spins, 0); // it is off: counted once
    assert_int_equal(idle.sent_off[VS_BLUE], 1);
    assert_int_equal(idle.warnings[VS_YELLOW] + idle.sent_off[VS_YELLOW], 0);
  }
}

static void driving_in_a_circle_of_10_cm_is_not_idle(void **state) {
  (void)state;
  vs_idle idle = {0};
  vs_world w = quiet_world(0.1, 0.1);
  play(&idle, &w, 60, 6, 0.05);
  assert_int_equal(idle.warnings[VS_BLUE], 0);
}

static void a_move_between_two_warnings_saves_the_robot(void **state) {
  (void)state;
  vs_idle idle = {0};
  vs_world w = quiet_world(0.1, 0.1);
  for (int k = 0; k < 4; k++) {
    play(&idle, &w, 11, 0, 0);
    play(&idle, &w, 1, 0, 0.2);
  }
  assert_int_equal(idle.warnings[VS_BLUE], 4);
  assert_int_equal(idle.sent_off[VS_BLUE], 0);
}

static void a_restart_begins_the_10_s_anew_and_half_time_brings_robots_back(void **state) {
  (void)state;
  vs_idle idle = {0};
  vs_world w = quiet_world(0.1, 0.1);
  const vs_event free_ball = {.kind = VS_EVENT_FREE_BALL}, half = {.kind = VS_EVENT_HALF_TIME};
  play(&idle, &w, 9.5, 0, 0);
  vs_idle_step(&idle, &w, &free_ball, FRAME_S);
  play(&idle, &w, 9.5, 0, 0);
  assert_int_equal(idle.warnings[VS_BLUE], 0);
  play(&idle, &w, 11, 0, 0);
  assert_int_equal(idle.sent_off[VS_BLUE], 1);
  vs_idle_step(&idle, &w, &half, FRAME_S);
  play(&idle, &w, 20.5, 0, 0);
  assert_int_equal(idle.sent_off[VS_BLUE], 2);
}

// Yellow's keeper stands; the others of both teams move. A second robot that stands in the area is not excused, and the
// keeper is not while the ball is there.
static void a_keeper_may_stand_while_the_ball_is_elsewhere(void **state) {
  (void)state;
  const struct {
    double ball_x_m;
    bool second;
    int warnings;
  } row[] = {{0.1, false, 0}, {0.1, true, 1}, {0.65, false, 1}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_idle idle = {0};
    vs_world w = quiet_world(row[k].ball_x_m, 0.1);
    for (int f = 0; f < 11 * 30; f++) {
      for (int t = 0; t < VS_TEAMS; t++)
        for (int i = 0; i < VS_TEAM_SIZE; i++)
          put(&w, (vs_team)t, i, (t ? 0.2 : -0.4) + 0.1 * sin(f * FRAME_S), 0.2 * i);
      put(&w, VS_YELLOW, 0, 0.7, 0);
      if (row[k].second) put(&w, VS_YELLOW, 1, 0.65, 0.3);
      vs_idle_step(&idle, &w, &nothing, FRAME_S);
    }
    assert_int_equal(idle.warnings[VS_YELLOW], row[k].warnings);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(spinning_on_the_spot_is_warned_after_10_s_and_sent_off_after_20),
      cmocka_unit_test(driving_in_a_circle_of_10_cm_is_not_idle),
      cmocka_unit_test(a_move_between_two_warnings_saves_the_robot),
      cmocka_unit_test(a_restart_begins_the_10_s_anew_and_half_time_brings_robots_back),
      cmocka_unit_test(a_keeper_may_stand_while_the_ball_is_elsewhere),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
