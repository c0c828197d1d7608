// Tests src/comms/radio_link.c together with deploy/firmware/firmware.c: the PC's and the robots' side of one protocol.
#include <string.h>

#include "assert_near.h"
#include "vsss/firmware.h"
#include "vsss/radio_link.h"

static const uint8_t ids[VS_TEAM_SIZE] = {4, 7, 9};
static const vs_wheels wheels[VS_TEAM_SIZE] = {{1.0, -1.0}, {46.66, -46.66}, {0.5, 99.0}};

static vs_radio_link fresh(void) {
  vs_radio_link link;
  assert_ok(vs_radio_link_init(&link, ids, err));
  return link;
}

// Decodes the one frame in bytes.
static vs_radio_command command_in(const uint8_t *bytes, size_t size) {
  vs_radio_decoder decoder = {0};
  vs_radio_frame frame;
  bool complete = false;
  for (size_t i = 0; i < size; i++) complete = vs_radio_decode(&decoder, bytes[i], &frame);
  assert_true(complete && frame.type == VS_RADIO_COMMAND);
  return frame.as.command;
}

static void without_a_command_it_sends_stop(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  size_t size = vs_radio_link_due(&link, 1000000, bytes);
  assert_int_equal(size, 24);
  assert_int_equal(command_in(bytes, size).flags, VS_RADIO_FLAG_STOP);
  assert_true(link.stopping);
  assert_int_equal(link.command_age_us, -1);
}

static void the_newest_command_is_repeated_at_50_hz(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  int frames = 0;
  // One second in steps of 1 ms, a command every 100 ms: frames at 0, 20, ... 980 ms.
  for (int64_t now = 1000000; now < 2000000; now += 1000) {
    if (now % 100000 == 0) vs_radio_link_command(&link, wheels, false, now);
    size_t size = vs_radio_link_due(&link, now, bytes);
    if (!size) continue;
    vs_radio_command c = command_in(bytes, size);
    assert_int_equal(c.seq, frames % 256);
    assert_int_equal(c.flags, 0);
    assert_int_equal(c.robot[1].id, 7);
    assert_int_equal(c.robot[1].right, -4666);
    frames++;
  }
  assert_int_equal(frames, 50);
}

static void a_command_of_150_ms_drives_and_an_older_one_stops(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  vs_radio_link_command(&link, wheels, false, 1000000);
  size_t size = vs_radio_link_due(&link, 1150000, bytes);
  assert_int_equal(command_in(bytes, size).flags, 0);
  size = vs_radio_link_due(&link, 1170001, bytes);
  vs_radio_command c = command_in(bytes, size);
  assert_int_equal(c.flags, VS_RADIO_FLAG_STOP);
  assert_int_equal(c.robot[1].left, 0);
}

static void a_late_caller_gets_one_frame_not_a_burst(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  assert_true(vs_radio_link_due(&link, 1000000, bytes) > 0);
  assert_true(vs_radio_link_due(&link, 1500000, bytes) > 0);
  assert_int_equal(vs_radio_link_due(&link, 1500001, bytes), 0);
  assert_true(link.next_us > 1500000 && link.next_us <= 1520000);
}

static void a_wheel_that_is_no_number_stops(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  const vs_wheels bad[VS_TEAM_SIZE] = {{1, 1}, {1, NAN}, {1, 1}};
  vs_radio_link_command(&link, bad, false, 1000000);
  size_t size = vs_radio_link_due(&link, 1000000, bytes);
  assert_int_equal(command_in(bytes, size).flags, VS_RADIO_FLAG_STOP);
}

static void two_robots_with_one_id_are_refused(void **state) {
  (void)state;
  vs_radio_link link;
  vs_error err = {0};
  const uint8_t twice[VS_TEAM_SIZE] = {1, 2, 1};
  assert_int_equal(vs_radio_link_init(&link, twice, &err), VS_USAGE);
  assert_string_equal(err.text, "robots 0 and 2 have the same radio id 1");
}

// One frame for the three robots of ids.
static size_t make(uint8_t seq, uint8_t flags, int16_t speed, uint8_t out[VS_RADIO_FRAME_MAX]) {
  vs_radio_frame f = {.type = VS_RADIO_COMMAND};
  f.as.command = (vs_radio_command){
      .seq = seq, .flags = flags, .n = 3, .robot = {{4, speed, speed}, {7, speed, (int16_t)-speed}, {9, 0, 0}}};
  return vs_radio_encode(&f, out);
}

static void give(vs_firmware *robot, uint8_t seq, uint8_t flags, int16_t speed, uint32_t now_ms) {
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  vs_firmware_receive(robot, bytes, make(seq, flags, speed, bytes), now_ms);
}

static void robot_starts_braked_and_drives_on_a_command(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 7, 0);
  assert_true(vs_firmware_tick(&robot, 10).brake);
  give(&robot, 200, 0, 1000, 10);
  vs_firmware_drive d = vs_firmware_tick(&robot, 11);
  assert_false(d.brake);
  assert_int_equal(d.left, 1000);
  assert_int_equal(d.right, -1000);
}

static void watchdog_lets_drive_at_149_ms_and_brakes_at_151(void **state) {
  (void)state;
  // From before the millisecond counter wraps to after it.
  const uint32_t starts[] = {1000, UINT32_MAX - 100};
  for (int i = 0; i < 2; i++) {
    vs_firmware robot;
    vs_firmware_init(&robot, 4, starts[i]);
    give(&robot, 1, 0, 1000, starts[i]);
    assert_false(vs_firmware_tick(&robot, starts[i] + 149).brake);
    assert_true(vs_firmware_tick(&robot, starts[i] + 151).brake);
  }
}

static void stale_and_repeated_frames_neither_drive_nor_feed_the_watchdog(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 4, 0);
  give(&robot, 10, 0, 1000, 0);
  give(&robot, 10, 0, 2000, 100);
  give(&robot, 9, 0, 2000, 100);
  assert_int_equal(vs_firmware_tick(&robot, 150).left, 1000);
  assert_true(vs_firmware_tick(&robot, 151).brake);
  assert_int_equal(robot.rx_ok, 1);
  assert_int_equal(robot.rx_bad, 2);
}

static void seq_wrap_is_followed(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 4, 0);
  for (uint32_t i = 0; i < 600; i++) {
    give(&robot, (uint8_t)(250 + i), 0, (int16_t)i, 20 * i);
    assert_int_equal(vs_firmware_tick(&robot, 20 * i).left, (int16_t)i);
  }
  assert_int_equal(robot.rx_ok, 600);
}

static void stop_holds_until_a_fresh_command_without_it(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 4, 0);
  give(&robot, 1, 0, 1000, 0);
  give(&robot, 2, VS_RADIO_FLAG_STOP, 1000, 20);
  assert_true(vs_firmware_tick(&robot, 21).brake);
  give(&robot, 1, 0, 1000, 40); // older than the STOP
  assert_true(vs_firmware_tick(&robot, 41).brake);
  give(&robot, 3, 0, 500, 60);
  assert_int_equal(vs_firmware_tick(&robot, 61).left, 500);
}

static void stop_reaches_robots_the_frame_does_not_name(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 33, 0);
  give(&robot, 1, 0, 1000, 0);
  assert_int_equal(robot.rx_ok, 0); // not for it
  robot.running = true;
  robot.stopped = false;
  robot.last_ms = 10;
  robot.left = 100;
  give(&robot, 2, VS_RADIO_FLAG_STOP, 0, 20);
  assert_true(vs_firmware_tick(&robot, 21).brake);
}

static void after_silence_any_seq_is_taken(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 4, 0);
  give(&robot, 100, 0, 1000, 0);
  give(&robot, 0, 0, 700, 100); // older within the watchdog's time: refused
  assert_int_equal(vs_firmware_tick(&robot, 101).left, 1000);
  give(&robot, 0, 0, 700, 300); // a PC that was started anew
  assert_int_equal(vs_firmware_tick(&robot, 301).left, 700);
}

static void targets_are_limited(void **state) {
  (void)state;
  vs_firmware robot;
  vs_firmware_init(&robot, 7, 0);
  give(&robot, 1, 0, 32767, 0);
  vs_firmware_drive d = vs_firmware_tick(&robot, 1);
  assert_int_equal(d.left, 4666);
  assert_int_equal(d.right, -4666);
}

static void telemetry_comes_back_with_the_round_trip(void **state) {
  (void)state;
  vs_radio_link link = fresh();
  vs_firmware robot;
  vs_firmware_init(&robot, 7, 0);
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  vs_radio_link_command(&link, wheels, false, 1000000);
  size_t size = vs_radio_link_due(&link, 1000000, bytes);
  vs_firmware_receive(&robot, bytes, size, 1000);
  size = vs_firmware_telemetry(&robot, 1002, 4600, -4600, 7400, -61, bytes);
  vs_radio_link_receive(&link, bytes, size, 1003500);
  const vs_radio_robot_state *r = &link.robot[1];
  assert_true(r->heard);
  assert_int_equal(r->round_trip_us, 3500);
  assert_int_equal(r->last.left, 4600);
  assert_int_equal(r->last.battery_mv, 7400);
  assert_int_equal(r->last.uptime_ms, 1002);
  assert_int_equal(r->last.rx_ok, 1);
  assert_false(link.robot[0].heard);
  vs_firmware stranger;
  vs_firmware_init(&stranger, 200, 0);
  size = vs_firmware_telemetry(&stranger, 1, 0, 0, 0, 0, bytes);
  vs_radio_link_receive(&link, bytes, size, 1003600);
  assert_int_equal(link.foreign, 1);
}

static vs_radio_link keyed(int team, int64_t wall_us) {
  vs_radio_link link = fresh();
  vs_radio_key key;
  assert_true(vs_radio_key_parse(
      team, team == 1 ? "0102030405060708090a0b0c0d0e0f10" : "1112131415161718191a1b1c1d1e1f20", &key));
  vs_radio_link_set_key(&link, &key, wall_us);
  return link;
}

static vs_firmware robot_of(const vs_radio_link *link) {
  vs_firmware robot;
  vs_firmware_init(&robot, 7, 0);
  vs_firmware_set_key(&robot, &link->decoder.key);
  return robot;
}

// Both teams number their robots 4, 7, 9 and send at 50 Hz on one channel, 10 ms apart; the other team drives backwards and
// then stops, and a program without a key sends too.
static void two_teams_on_one_channel_drive_their_own_robots(void **state) {
  (void)state;
  vs_radio_link ours = keyed(1, 1700000000000000), theirs = keyed(2, 1900000000000000), nobodys = fresh();
  vs_firmware robot = robot_of(&ours), opponent = robot_of(&theirs);
  const vs_wheels ahead[VS_TEAM_SIZE] = {{5, 5}, {5, 5}, {5, 5}}, back[VS_TEAM_SIZE] = {{-5, -5}, {-5, -5}, {-5, -5}};
  int right = 0, opponent_right = 0;
  for (int ms = 0; ms < 5000; ms++) {
    int64_t now_us = 1000000 + 1000LL * ms;
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    size_t size = 0;
    bool stops = ms >= 2500;
    if (ms % 20 == 0) {
      vs_radio_link_command(&ours, ahead, false, now_us);
      size = vs_radio_link_due(&ours, now_us, bytes);
    } else if (ms % 20 == 10) {
      vs_radio_link_command(&theirs, back, stops, now_us);
      size = vs_radio_link_due(&theirs, now_us, bytes);
    } else if (ms % 20 == 15) {
      size = vs_radio_link_stop(&nobodys, now_us, bytes);
    }
    vs_firmware_receive(&robot, bytes, size, (uint32_t)ms);
    vs_firmware_receive(&opponent, bytes, size, (uint32_t)ms);
    vs_firmware_drive a = vs_firmware_tick(&robot, (uint32_t)ms), b = vs_firmware_tick(&opponent, (uint32_t)ms);
    right += !a.brake && a.left == 500 && a.right == 500;
    opponent_right += stops ? b.brake : !b.brake && b.left == -500;
    // Our telemetry is ours alone, though the numbers on the air are the same.
    size = vs_firmware_telemetry(&opponent, (uint32_t)ms, 1, 1, 1111, 0, bytes);
    vs_radio_link_receive(&ours, bytes, size, now_us);
    size = vs_firmware_telemetry(&robot, (uint32_t)ms, 1, 1, 7777, 0, bytes);
    vs_radio_link_receive(&ours, bytes, size, now_us);
    assert_int_equal(ours.robot[1].last.battery_mv, 7777);
  }
  assert_int_equal(right, 5000);
  assert_true(opponent_right >= 4980); // 10 ms of silence at its start and at its stop
  assert_int_equal(ours.decoder.foreign, 5000);
}

static void a_frame_with_a_key_is_taken_once_after_silence_too(void **state) {
  (void)state;
  vs_radio_link link = keyed(1, 1700000000000000);
  vs_firmware robot = robot_of(&link);
  uint8_t bytes[VS_RADIO_FRAME_MAX], later[VS_RADIO_FRAME_MAX];
  vs_radio_link_command(&link, wheels, false, 1000000);
  size_t size = vs_radio_link_due(&link, 1000000, bytes);
  vs_firmware_receive(&robot, bytes, size, 0);
  assert_false(vs_firmware_tick(&robot, 1).brake);
  assert_true(vs_firmware_tick(&robot, 1000).brake); // the watchdog
  vs_firmware_receive(&robot, bytes, size, 1001);    // recorded and sent again
  assert_true(vs_firmware_tick(&robot, 1002).brake);
  assert_int_equal(robot.rx_bad, 1);
  // A PC that starts anew 20 ms later counts on above; one whose clock is a second behind does not.
  vs_radio_link next = keyed(1, 1700000000020000), behind = keyed(1, 1699999999000000);
  vs_radio_link_command(&next, wheels, false, 1000000);
  vs_radio_link_command(&behind, wheels, false, 1000000);
  size = vs_radio_link_due(&behind, 1000000, later);
  vs_firmware_receive(&robot, later, size, 1003);
  assert_true(vs_firmware_tick(&robot, 1004).brake);
  size = vs_radio_link_due(&next, 1000000, later);
  vs_firmware_receive(&robot, later, size, 1005);
  assert_false(vs_firmware_tick(&robot, 1006).brake);
  // The last word of a program that dies is newer than any frame it sent.
  size = vs_radio_link_last_stop(&next, 16, later);
  vs_firmware_receive(&robot, later, size, 1007);
  assert_true(vs_firmware_tick(&robot, 1008).brake);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_a_command_it_sends_stop),
      cmocka_unit_test(the_newest_command_is_repeated_at_50_hz),
      cmocka_unit_test(a_command_of_150_ms_drives_and_an_older_one_stops),
      cmocka_unit_test(a_late_caller_gets_one_frame_not_a_burst),
      cmocka_unit_test(a_wheel_that_is_no_number_stops),
      cmocka_unit_test(two_robots_with_one_id_are_refused),
      cmocka_unit_test(robot_starts_braked_and_drives_on_a_command),
      cmocka_unit_test(watchdog_lets_drive_at_149_ms_and_brakes_at_151),
      cmocka_unit_test(stale_and_repeated_frames_neither_drive_nor_feed_the_watchdog),
      cmocka_unit_test(seq_wrap_is_followed),
      cmocka_unit_test(stop_holds_until_a_fresh_command_without_it),
      cmocka_unit_test(stop_reaches_robots_the_frame_does_not_name),
      cmocka_unit_test(after_silence_any_seq_is_taken),
      cmocka_unit_test(targets_are_limited),
      cmocka_unit_test(telemetry_comes_back_with_the_round_trip),
      cmocka_unit_test(two_teams_on_one_channel_drive_their_own_robots),
      cmocka_unit_test(a_frame_with_a_key_is_taken_once_after_silence_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
