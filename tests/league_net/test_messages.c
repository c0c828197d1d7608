// Tests src/league_net/messages.c: the bytes of the league's datagrams, and what garbage does.
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/league_messages.h"
#include "vsss/rng.h"

static vs_world full_world(void) {
  vs_world world = {0};
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      world.robot[t][i] = (vs_robot){.pose = {-0.7123 + 0.21 * i + t, 0.61 - 0.37 * i, -3.1 + i},
                                     .vx_mps = 1.3131,
                                     .vy_mps = -1.21,
                                     .omega_radps = 12.345,
                                     .valid = true};
  world.ball = (vs_ball){0.7421, -0.613, 0.0213, 2.2, -1.1, 0.01, true};
  return world;
}

// A client of FIRASim reads no more than 512 bytes.
static void the_fullest_world_fits_into_512_bytes(void **state) {
  (void)state;
  vs_fira_environment e = {.step = UINT32_MAX, .world = full_world(), .goals = {99, 99}};
  uint8_t bytes[VS_LEAGUE_DATAGRAM_MAX];
  size_t size = vs_fira_environment_encode(&e, bytes, sizeof bytes);
  assert_true(size > 400 && size <= 512);
  assert_int_equal(vs_fira_environment_encode(&e, bytes, size - 1), 0);
}

// Of 5 against 5 no more than 1024, and it says which field it is of; 3 against 3's decoder has no fifth robot.
static void the_fullest_world_of_ten_robots_fits_into_1024_bytes(void **state) {
  (void)state;
  vs_fira_environment e = {.step = UINT32_MAX, .goals = {99, 99}}, back;
  e.world.division = VS_5V5;
  for (int i = 0; i < 10; i++)
    e.world.robot[i / 5][i % 5] = (vs_robot){.pose = {-1.0123 + 0.21 * i, 0.8123 - 0.17 * i, -3.1 + 0.5 * i},
                                             .vx_mps = 1.3131,
                                             .vy_mps = -1.21,
                                             .omega_radps = 12.345,
                                             .valid = true};
  e.world.ball = (vs_ball){1.21, -0.813, 0.0213, 2.2, -1.1, 0.01, true};
  uint8_t bytes[VS_LEAGUE_DATAGRAM_5V5_MAX];
  size_t size = vs_fira_environment_encode(&e, bytes, sizeof bytes);
  assert_true(size > 600 && size <= 1024);
  assert_ok(vs_fira_environment_decode(bytes, size, &back, err));
  assert_int_equal(back.world.division, VS_5V5);
  assert_true(back.world.robot[VS_YELLOW][4].valid && back.world.ball.valid);
  assert_near(back.world.robot[VS_YELLOW][4].pose.x_m, -1.0123 + 0.21 * 9, 0);
  e.world.division = VS_3V3;
  size = vs_fira_environment_encode(&e, bytes, sizeof bytes);
  assert_ok(vs_fira_environment_decode(bytes, size, &back, err));
  assert_false(back.world.robot[VS_YELLOW][4].valid);
  assert_false(back.world.ball.valid); // at 1.21 m: off that field
}

// What the match has not is left out and counted.
static void a_packet_is_cut_to_the_division(void **state) {
  (void)state;
  vs_fira_packet p = {.commands = 2, .robots = 3, .places_ball = true, .ball = {.x_m = 1.0}};
  p.command[0].robot = 4;
  p.command[1].robot = 1;
  p.place[0].robot = 3;
  p.place[1].robot = 0;
  p.place[1].pose.x_m = 1.0;
  p.place[2].robot = 2;
  vs_fira_packet five = p;
  vs_fira_packet_fit(&five, VS_5V5);
  assert_true(five.commands == 2 && five.robots == 3 && five.places_ball && five.dropped == 0);
  vs_fira_packet_fit(&p, VS_3V3);
  assert_true(p.commands == 1 && p.command[0].robot == 1 && p.robots == 1 && p.place[0].robot == 2);
  assert_true(!p.places_ball && p.dropped == 4);
}

static void a_world_comes_back_as_it_was_sent(void **state) {
  (void)state;
  vs_fira_environment e = {.step = 1234, .world = full_world(), .goals = {2, 1}}, back;
  e.world.robot[VS_YELLOW][1].valid = false; // not seen: left out
  uint8_t bytes[512];
  size_t size = vs_fira_environment_encode(&e, bytes, sizeof bytes);
  assert_ok(vs_fira_environment_decode(bytes, size, &back, err));
  assert_int_equal(back.step, 1234);
  assert_int_equal(back.goals[VS_BLUE], 2);
  assert_int_equal(back.goals[VS_YELLOW], 1);
  assert_false(back.world.robot[VS_YELLOW][1].valid);
  assert_true(back.world.robot[VS_YELLOW][2].valid);
  assert_near(back.world.robot[VS_BLUE][2].pose.x_m, e.world.robot[VS_BLUE][2].pose.x_m, 0);
  assert_near(back.world.robot[VS_BLUE][1].pose.theta_rad, -2.1, 1e-12);
  assert_near(back.world.robot[VS_YELLOW][0].omega_radps, 12.345, 0);
  assert_near(back.world.ball.vy_mps, -1.1, 0);
}

// By hand from the fields' numbers: Packet.cmd (1) { robot_commands (1) { yellowteam (2) = 1, wheel_left (6) = 1.0,
// wheel_right (7) = -2.0 } }; id 0 is not on the wire. Keys: 6 << 3 | 1 = 0x31, 7 << 3 | 1 = 0x39.
static const uint8_t command_bytes[] = {0x0a, 22,   0x0a, 20,   0x10, 1, 0x31, 0, 0, 0, 0, 0,
                                        0,    0xf0, 0x3f, 0x39, 0,    0, 0,    0, 0, 0, 0, 0xc0};

static void a_command_has_the_bytes_of_the_protocol(void **state) {
  (void)state;
  vs_fira_packet p = {.commands = 1}, back;
  p.command[0].team = VS_YELLOW;
  p.command[0].wheels = (vs_wheels){1, -2};
  uint8_t bytes[64];
  size_t size = vs_fira_packet_encode(&p, true, bytes, sizeof bytes);
  assert_int_equal(size, sizeof command_bytes);
  assert_memory_equal(bytes, command_bytes, size);
  assert_ok(vs_fira_packet_decode(bytes, size, true, &back, err));
  assert_int_equal(back.commands, 1);
  assert_int_equal(back.command[0].team, VS_YELLOW);
  assert_int_equal(back.command[0].robot, 0);
  assert_near(back.command[0].wheels.right_radps, -2, 0);
}

// FIRASim's replacements turn robots in degrees, TraveSim's in radians.
static void a_replacement_turns_in_the_dialects_unit(void **state) {
  (void)state;
  vs_fira_packet p = {.robots = 1, .places_ball = true, .ball = {.x_m = 0.25, .vy_mps = -1}}, back;
  p.place[0].team = VS_BLUE;
  p.place[0].robot = 2;
  p.place[0].pose = (vs_pose){-0.5, 0.25, 1.5707963267948966};
  for (int degrees = 0; degrees < 2; degrees++) {
    uint8_t bytes[128];
    size_t size = vs_fira_packet_encode(&p, degrees, bytes, sizeof bytes);
    assert_true(size > 0);
    assert_ok(vs_fira_packet_decode(bytes, size, degrees, &back, err));
    assert_int_equal(back.robots, 1);
    assert_int_equal(back.place[0].robot, 2);
    assert_near(back.place[0].pose.theta_rad, 1.5707963267948966, 1e-12);
    assert_true(back.places_ball);
    assert_near(back.ball.x_m, 0.25, 0);
    assert_near(back.ball.vy_mps, -1, 0);
    // The other unit: 90 rad are 90 - 14 * 2 pi = 2.035 rad.
    assert_ok(vs_fira_packet_decode(bytes, size, !degrees, &back, err));
    if (degrees) assert_near(back.place[0].pose.theta_rad, 90 - 14 * 2 * 3.14159265358979, 1e-9);
  }
}

static void rows_that_cannot_be_are_dropped_and_counted(void **state) {
  (void)state;
  vs_fira_packet p = {.commands = 3, .robots = 2}, back;
  p.command[0].wheels = (vs_wheels){NAN, 1};
  p.command[1].robot = 7;
  p.command[2].robot = 1;
  p.command[2].wheels = (vs_wheels){2000, -442}; // faster than any wheel: taken, the simulator saturates
  p.place[0].pose = (vs_pose){3, 0, 0};
  p.place[1].pose = (vs_pose){0.1, 0.1, INFINITY};
  uint8_t bytes[512];
  size_t size = vs_fira_packet_encode(&p, true, bytes, sizeof bytes);
  assert_ok(vs_fira_packet_decode(bytes, size, true, &back, err));
  assert_int_equal(back.commands, 1);
  assert_int_equal(back.command[0].robot, 1);
  assert_near(back.command[0].wheels.left_radps, 2000, 0);
  assert_int_equal(back.robots, 0);
  assert_int_equal(back.dropped, 4);
}

static void a_call_of_the_referee_comes_back(void **state) {
  (void)state;
  const vs_ref_command calls[] = {{VS_FOUL_FREE_KICK, VS_BLUE, 0, 0, 0}, // all zero: an empty datagram
                                  {VS_FOUL_FREE_BALL, -1, 3, 12.5, 1},
                                  {VS_FOUL_KICKOFF, VS_YELLOW, 0, 301, 2},
                                  {VS_FOUL_HALT, -1, 0, 600, 5}};
  for (size_t k = 0; k < 4; k++) {
    uint8_t bytes[64];
    vs_ref_command back;
    size_t size = vs_ref_command_encode(&calls[k], bytes, sizeof bytes);
    assert_ok(vs_ref_command_decode(bytes, size, &back, err));
    assert_int_equal(back.foul, calls[k].foul);
    assert_int_equal(back.team, calls[k].team);
    assert_int_equal(back.quadrant, calls[k].quadrant);
    assert_int_equal(back.half, calls[k].half);
    assert_near(back.timestamp_s, calls[k].timestamp_s, 0);
  }
  // foul (1) = 9: there is none.
  vs_ref_command back;
  vs_error err = {0};
  assert_int_equal(vs_ref_command_decode((const uint8_t[]){0x08, 9}, 2, &back, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "foul 9"));
  // HALT at a time (4) that is no number: obeyed, at 0.
  const uint8_t no_time[] = {0x08, 7, 0x21, 0, 0, 0, 0x40, 0xff, 0xff, 0xff, 0xff};
  assert_ok(vs_ref_command_decode(no_time, sizeof no_time, &back, err));
  assert_int_equal(back.foul, VS_FOUL_HALT);
  assert_near(back.timestamp_s, 0, 0);
}

static void a_placement_comes_back_or_is_refused_with_the_robot(void **state) {
  (void)state;
  vs_ref_placement p = {.team = VS_YELLOW, .given = {true, false, true}, .pose = {{0.7, 0.1, 1}, {0}, {0.3, -0.2, -2}}},
                   back;
  uint8_t bytes[256];
  size_t size = vs_ref_placement_encode(&p, bytes, sizeof bytes);
  assert_ok(vs_ref_placement_decode(bytes, size, &back, err));
  assert_int_equal(back.team, VS_YELLOW);
  assert_true(back.given[0] && !back.given[1] && back.given[2]);
  assert_near(back.pose[2].theta_rad, -2, 1e-12);
  p.pose[2].x_m = 4;
  size = vs_ref_placement_encode(&p, bytes, sizeof bytes);
  vs_error err = {0};
  assert_int_equal(vs_ref_placement_decode(bytes, size, &back, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "yellow places robot 2 at 4"));
}

// A million datagrams: random bytes, messages cut short, messages with a damaged length.
static void a_million_datagrams_of_garbage_command_nothing(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(9, 0);
  vs_fira_packet p = {.commands = 3, .robots = 3, .places_ball = true}, got;
  for (int i = 0; i < 3; i++) p.command[i].robot = p.place[i].robot = i, p.command[i].wheels.left_radps = 10 + i;
  uint8_t whole[512], bytes[600];
  size_t size = vs_fira_packet_encode(&p, true, whole, sizeof whole);
  size_t first = 2 + whole[1]; // the commands alone are a message too
  int refused = 0;
  for (int k = 0; k < 1000000; k++) {
    size_t n;
    if (k % 4 == 0) {
      n = vs_rng_below(&rng, (uint32_t)size);
      if (n == first) continue;
      memcpy(bytes, whole, n);
    } else if (k % 4 == 1) { // the outer length is wrong
      n = first;
      memcpy(bytes, whole, n);
      bytes[1] = (uint8_t)(bytes[1] + 1 + vs_rng_below(&rng, 100));
    } else {
      n = vs_rng_below(&rng, sizeof bytes / 8) * 8;
      for (size_t i = 0; i < n; i += 8) {
        uint64_t r = vs_rng_u64(&rng);
        memcpy(bytes + i, &r, 8);
      }
    }
    if (n == 0) continue; // an empty datagram is an empty message
    memset(&got, 0, sizeof got);
    if (vs_fira_packet_decode(bytes, n, true, &got, NULL) != VS_OK) refused++;
    if (got.commands || got.robots || got.places_ball) fail_msg("datagram %d of %zu bytes commands something", k, n);
  }
  assert_true(refused > 900000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_fullest_world_fits_into_512_bytes),
      cmocka_unit_test(the_fullest_world_of_ten_robots_fits_into_1024_bytes),
      cmocka_unit_test(a_packet_is_cut_to_the_division),
      cmocka_unit_test(a_world_comes_back_as_it_was_sent),
      cmocka_unit_test(a_command_has_the_bytes_of_the_protocol),
      cmocka_unit_test(a_replacement_turns_in_the_dialects_unit),
      cmocka_unit_test(rows_that_cannot_be_are_dropped_and_counted),
      cmocka_unit_test(a_call_of_the_referee_comes_back),
      cmocka_unit_test(a_placement_comes_back_or_is_refused_with_the_robot),
      cmocka_unit_test(a_million_datagrams_of_garbage_command_nothing),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
