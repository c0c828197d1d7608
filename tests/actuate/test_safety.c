// Tests src/actuate/safety.c: the whole table, and what goes out in every situation of a match.
#include "vsss/safety.h"

#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"

// The order of precedence, written down a second time: the first thing that is wrong names the state.
static vs_safety_state expected_state(vs_safety_state from, unsigned c) {
  if (from == VS_SAFETY_SHUTDOWN || c & VS_SAFETY_IF_SHUTDOWN) return VS_SAFETY_SHUTDOWN;
  if (!(c & VS_SAFETY_IF_ARMED)) return VS_SAFETY_UNARMED;
  if (from == VS_SAFETY_FAULT || !(c & VS_SAFETY_IF_SANE)) return VS_SAFETY_FAULT;
  if (c & VS_SAFETY_IF_HALTED) return VS_SAFETY_HALTED;
  if (!(c & VS_SAFETY_IF_CAMERA)) return VS_SAFETY_DARK;
  if (!(c & VS_SAFETY_IF_SEEN)) return VS_SAFETY_BLIND;
  if (!(c & VS_SAFETY_IF_BALL)) return VS_SAFETY_NO_BALL;
  if (!(c & VS_SAFETY_IF_PLAYER)) return VS_SAFETY_MINDLESS;
  return c & VS_SAFETY_IF_FRESH ? VS_SAFETY_RUNNING : VS_SAFETY_STALE;
}

static void every_state_under_every_condition_goes_where_it_should(void **state) {
  (void)state;
  int running = 0;
  for (int from = 0; from < VS_SAFETY_STATES; from++)
    for (unsigned c = 0; c < VS_SAFETY_CONDITIONS; c++) {
      vs_safety_state to = vs_safety_next((vs_safety_state)from, c);
      if (to != expected_state((vs_safety_state)from, c))
        fail_msg("%s under %#x goes to %s", vs_safety_name((vs_safety_state)from), c, vs_safety_name(to));
      running += to == VS_SAFETY_RUNNING ? 1 : 0;
    }
  // Of 5,120 cases commands go out in one a state: armed, sane, camera, seen, ball, player, fresh, not halted, no
  // shutdown; never from FAULT or SHUTDOWN.
  assert_int_equal(running, VS_SAFETY_STATES - 2);
}

static vs_world seen_world(void) {
  vs_world w = {0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) w.robot[VS_BLUE][i].valid = true;
  return w;
}

static vs_safety_input good_input(const vs_world *world, int64_t now_us) {
  vs_safety_input in = {.now_us = now_us, .armed = true, .team = VS_BLUE, .world = world, .command_us = now_us - 40000};
  for (int i = 0; i < VS_TEAM_SIZE; i++) in.wheels[i] = (vs_wheels){10 + i, -20 - i};
  return in;
}

static void assert_sent(const vs_wheels *out, const vs_wheels *expected) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(out[i].left_radps, expected ? expected[i].left_radps : 0, 0);
    assert_near(out[i].right_radps, expected ? expected[i].right_radps : 0, 0);
  }
}

// A safety that runs since one second.
static vs_safety running_safety(const vs_world *world) {
  vs_safety safety;
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_init(&safety, 0);
  vs_safety_input in = good_input(world, 1000000);
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_RUNNING);
  assert_sent(out, in.wheels);
  return safety;
}

static void nothing_goes_out_before_the_robots_are_released(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety;
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_init(&safety, 0);
  vs_safety_input in = good_input(&w, 1000000);
  in.armed = false;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_UNARMED);
  assert_sent(out, NULL);
}

// Each row: what goes wrong while running, the state it leads to, and whether mending it lets play go on.
static void each_mishap_stops_the_robots(void **state) {
  (void)state;
  vs_world good = seen_world(), lost = seen_world(), nan_world = seen_world(), far = seen_world();
  for (int i = 0; i < VS_TEAM_SIZE; i++) lost.robot[VS_BLUE][i].valid = false;
  nan_world.ball.vx_mps = NAN;
  far.robot[VS_BLUE][1].pose.x_m = 5;
  vs_safety_input base = good_input(&good, 1100000), in;
  const struct {
    const char *what;
    vs_safety_input input;
    vs_safety_state to;
    bool recovers;
  } row[] = {
      {"disarmed", (in = base, in.armed = false, in), VS_SAFETY_UNARMED, true},
      {"halt", (in = base, in.referee = VS_EVENT_HALT, in), VS_SAFETY_HALTED, true},
      {"end", (in = base, in.referee = VS_EVENT_END, in), VS_SAFETY_HALTED, true},
      {"all own robots lost", (in = base, in.world = &lost, in), VS_SAFETY_BLIND, true},
      {"no world", (in = base, in.world = NULL, in), VS_SAFETY_BLIND, true},
      {"camera gone", (in = base, in.no_camera = true, in), VS_SAFETY_DARK, true},
      {"ball lost", (in = base, in.no_ball = true, in), VS_SAFETY_NO_BALL, true},
      {"player failed", (in = base, in.no_player = true, in), VS_SAFETY_MINDLESS, true},
      {"stale", (in = base, in.command_us = in.now_us - 150001, in), VS_SAFETY_STALE, true},
      {"no command", (in = base, in.command_us = 0, in), VS_SAFETY_STALE, true},
      {"from the future", (in = base, in.command_us = in.now_us + 1, in), VS_SAFETY_STALE, true},
      {"NaN wheel", (in = base, in.wheels[1].right_radps = NAN, in), VS_SAFETY_FAULT, false},
      {"infinite wheel", (in = base, in.wheels[0].left_radps = INFINITY, in), VS_SAFETY_FAULT, false},
      {"NaN in the world", (in = base, in.world = &nan_world, in), VS_SAFETY_FAULT, false},
      {"robot 5 m away", (in = base, in.world = &far, in), VS_SAFETY_FAULT, false},
      {"shutdown", (in = base, in.shutdown = true, in), VS_SAFETY_SHUTDOWN, false},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_safety safety = running_safety(&good);
    vs_wheels out[VS_TEAM_SIZE];
    vs_safety_state got = vs_safety_step(&safety, &row[k].input, out);
    if (got != row[k].to) fail_msg("%s: %s, expected %s", row[k].what, vs_safety_name(got), vs_safety_name(row[k].to));
    assert_sent(out, NULL);
    assert_int_equal(safety.entered[row[k].to], 1);
    assert_near(safety.since_us, 1100000, 0);

    // All is well again, 0.2 s later: the robots go on, or stay where they are.
    vs_safety_input well = good_input(&good, 1300000);
    got = vs_safety_step(&safety, &well, out);
    if (got != (row[k].recovers ? VS_SAFETY_RUNNING : row[k].to))
      fail_msg("%s: then %s", row[k].what, vs_safety_name(got));
    assert_sent(out, row[k].recovers ? well.wheels : NULL);
  }
}

static void command_of_exactly_150_ms_still_goes_out(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety = running_safety(&w);
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_input in = good_input(&w, 1100000);
  in.command_us = in.now_us - VS_SAFETY_STALE_US;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_RUNNING);
  assert_sent(out, in.wheels);
}

static void command_from_before_the_stop_does_not_start_the_robots_again(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety = running_safety(&w);
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_input in = good_input(&w, 1100000);
  in.referee = VS_EVENT_HALT;
  vs_safety_step(&safety, &in, out);
  in.now_us = 1110000; // play goes on 10 ms later, with the command of before the whistle
  in.referee = VS_EVENT_KICK_OFF;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_STALE);
  assert_sent(out, NULL);
  in.now_us = 1150000;
  in.command_us = 1120000; // decided after the robots stopped
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_RUNNING);
  assert_sent(out, in.wheels);
}

static void other_events_of_the_referee_let_play_go_on(void **state) {
  (void)state;
  vs_world w = seen_world();
  for (int kind = VS_EVENT_NONE; kind < VS_EVENT_KINDS; kind++) {
    vs_safety safety = running_safety(&w);
    vs_wheels out[VS_TEAM_SIZE];
    vs_safety_input in = good_input(&w, 1100000);
    in.referee = (vs_event_kind)kind;
    bool halts = kind == VS_EVENT_HALT || kind == VS_EVENT_END;
    assert_int_equal(vs_safety_step(&safety, &in, out), halts ? VS_SAFETY_HALTED : VS_SAFETY_RUNNING);
  }
}

static void robot_that_is_lost_stands_while_the_others_play(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety = running_safety(&w);
  vs_wheels out[VS_TEAM_SIZE];
  w.robot[VS_BLUE][1].valid = false;
  vs_safety_input in = good_input(&w, 1100000);
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_RUNNING);
  assert_near(out[0].left_radps, 10, 0);
  assert_near(out[1].left_radps, 0, 0);
  assert_near(out[1].right_radps, 0, 0);
  assert_near(out[2].right_radps, -22, 0);
  // The same robots of the other team: none of yellow's is seen.
  in.team = VS_YELLOW;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_BLIND);
}

static void command_beyond_the_wheels_is_limited(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety = running_safety(&w);
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_input in = good_input(&w, 1100000);
  in.wheels[0] = (vs_wheels){500, -500};
  vs_safety_step(&safety, &in, out);
  assert_near(out[0].left_radps, VS_WHEEL_LIMIT_RADPS, 0);
  assert_near(out[0].right_radps, -VS_WHEEL_LIMIT_RADPS, 0);
}

static void fault_is_left_by_disarming_and_shutdown_never(void **state) {
  (void)state;
  vs_world w = seen_world();
  vs_safety safety = running_safety(&w);
  vs_wheels out[VS_TEAM_SIZE];
  vs_safety_input in = good_input(&w, 1100000);
  in.wheels[2].left_radps = NAN;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_FAULT);
  in = good_input(&w, 1200000);
  in.armed = false;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_UNARMED);
  in = good_input(&w, 1400000);
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_RUNNING);
  in.shutdown = true;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_SHUTDOWN);
  in = good_input(&w, 1600000);
  in.armed = false;
  assert_int_equal(vs_safety_step(&safety, &in, out), VS_SAFETY_SHUTDOWN);
}

static void every_state_has_a_name_and_every_stop_a_reason(void **state) {
  (void)state;
  for (int a = 0; a < VS_SAFETY_STATES; a++) {
    assert_int_equal(strlen(vs_safety_reason((vs_safety_state)a)) == 0, a == VS_SAFETY_RUNNING);
    for (int b = 0; b < a; b++)
      assert_string_not_equal(vs_safety_name((vs_safety_state)a), vs_safety_name((vs_safety_state)b));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_state_under_every_condition_goes_where_it_should),
      cmocka_unit_test(nothing_goes_out_before_the_robots_are_released),
      cmocka_unit_test(each_mishap_stops_the_robots),
      cmocka_unit_test(command_of_exactly_150_ms_still_goes_out),
      cmocka_unit_test(command_from_before_the_stop_does_not_start_the_robots_again),
      cmocka_unit_test(other_events_of_the_referee_let_play_go_on),
      cmocka_unit_test(robot_that_is_lost_stands_while_the_others_play),
      cmocka_unit_test(command_beyond_the_wheels_is_limited),
      cmocka_unit_test(fault_is_left_by_disarming_and_shutdown_never),
      cmocka_unit_test(every_state_has_a_name_and_every_stop_a_reason),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
