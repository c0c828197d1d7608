// src/field/field_loop.c, src/field/eyes.c and src/actuate/sender.c through the real binary: the fault table of
// deploy/docs/faults.md, row by row.
#include "cli/field_venue.h"
#include "policy/plugins/compile.h"

static void a_camera_that_goes_away_stops_the_robots_and_play_goes_on(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  for (int i = 0; i < 3; i++) {
    unplug_camera(v);
    assert_within("camera gone: brakes", wait_until(v, false), 200);
    live_for(v, 0.1 + 0.4 * i);
    assert_true(v->drives.brake);
    plug_camera(v);
    assert_within("camera back: drives", wait_until(v, true), 500);
  }
  close_venue(v, 0);
  assert_non_null(strstr(read_text(v->log_path), "the rig is gone"));
  assert_non_null(strstr(read_text(v->log_path), "camera lost 3 times, back 3 times"));
}

static void a_camera_that_freezes_stops_the_robots(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  v->drop = 1;
  assert_within("camera frozen: brakes", wait_until(v, false), 300);
  v->drop = 0;
  assert_within("camera thawed: drives", wait_until(v, true), 200);
  close_venue(v, 0);
}

static void pictures_of_another_size_are_refused_loudly_until_they_are_right(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  unplug_camera(v);
  wait_until(v, false);
  plug_camera_of(v, PICTURE_W / 2, PICTURE_H / 2);
  live_for(v, 1);
  assert_true(v->drives.brake);
  unplug_camera(v);
  plug_camera(v);
  assert_within("right size again: drives", wait_until(v, true), 500);
  close_venue(v, 0);
  const char *said = read_text(v->log_path);
  assert_non_null(strstr(said, "now gives pictures of 320x240, the calibration is for 640x480"));
}

static void a_player_that_fails_stops_the_robots_and_plays_on(void **state) {
  (void)state;
  static const char *const ways[] = {"nan", "segv", "abort", "hang"}, *const said[] = {"nan rad/s", "SIGSEGV",
                                                                                       "SIGABRT",
                                                                                       "no answer within 100 ms"};
  for (int i = 0; i < 4; i++) {
    char flags[256], text[96];
    snprintf(flags, sizeof flags, "--policy 'plugin:%s/bad.so?late=%s'", folder, ways[i]);
    venue *v = open_venue(folder, flags);
    wait_until(v, true);
    int64_t start_us = vs_clock_monotonic_us();
    wait_until(v, false); // after its thirtieth step, a second later
    assert_true(vs_clock_monotonic_us() - start_us > 500000);
    snprintf(text, sizeof text, "player %s: drives again", ways[i]);
    assert_within(text, wait_until(v, true), 300);
    close_venue(v, 0);
    if (!strstr(read_text(v->log_path), said[i])) fail_msg("%s: %s", ways[i], read_text(v->log_path));
    assert_true(number_after(read_text(v->log_path), "player failed ") >= 1);
  }
}

static void the_fallback_takes_over(void **state) {
  (void)state;
  char flags[256];
  snprintf(flags, sizeof flags, "--policy 'plugin:%s/bad.so?late=segv' --fallback random:", folder);
  venue *v = open_venue(folder, flags);
  wait_until(v, true);
  wait_until(v, false);
  assert_within("fallback: drives", wait_until(v, true), 100);
  live_for(v, 3); // and stays: the policy alone would have failed twice again
  close_venue(v, 0);
  assert_non_null(strstr(read_text(v->log_path), "random: plays"));
  assert_non_null(strstr(read_text(v->log_path), "player failed 1 times"));
}

static void a_radio_that_comes_back_is_used_at_once(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  for (int i = 0; i < 2; i++) {
    unplug_radio(v);
    assert_within("radio gone: brakes", wait_until(v, false), 200);
    live_for(v, 2 + i);
    plug_radio(v);
    assert_within("radio back: drives", wait_until(v, true), 300);
  }
  close_venue(v, 0);
}

// What ends the program, and how the robots learn of it.
static void every_end_stops_the_robots(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int number;
    int frames;   // STOP frames at least
    double limit; // ms until the robot brakes
  } row[] = {{"SIGKILL", SIGKILL, 0, 200},  {"SIGQUIT", SIGQUIT, 10, 100}, {"SIGSEGV", SIGSEGV, 10, 100},
             {"SIGABRT", SIGABRT, 10, 100}, {"SIGHUP", SIGHUP, 10, 100},   {"SIGTERM", SIGTERM, 10, 100},
             {"SIGINT", SIGINT, 10, 100}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    venue *v = open_venue(folder, "--policy random:");
    wait_until(v, true);
    kill(v->field, row[i].number);
    char text[64];
    snprintf(text, sizeof text, "%s: brakes", row[i].name);
    assert_within(text, wait_until(v, false), row[i].limit);
    int status = -1;
    for (int k = 0; k < 20000 && waitpid(v->field, &status, WNOHANG) != v->field; k++) live(v);
    live_for(v, 0.05);
    assert_true(v->trailing_stops >= row[i].frames);
    bool clean = row[i].number == SIGHUP || row[i].number == SIGTERM || row[i].number == SIGINT;
    if (clean)
      assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    else
      assert_true(WIFSIGNALED(status) && WTERMSIG(status) == row[i].number);
    unplug_camera(v);
    unplug_radio(v);
  }
}

static void noise_before_the_frames_costs_none(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  v->garbage = true;
  int frames = v->frames, taken = v->robot.rx_ok;
  live_for(v, 4);
  frames = v->frames - frames;
  taken = v->robot.rx_ok - taken;
  print_message("noise before frames: %d of %d taken\n", taken, frames);
  assert_true(frames > 50);
  assert_true(taken >= 0.99 * frames);
  close_venue(v, 0);
}

static void lost_pictures_are_bridged(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);
  for (int i = 0; i < 2; i++) {
    v->drop = i ? 0.5 : -1;
    int frames = v->frames, stops = v->stops;
    live_for(v, 10);
    double share = (double)(v->stops - stops) / (v->frames - frames);
    print_message("%s of the pictures lost: %.2f %% of the radio frames are STOP\n",
                  i ? "half, at random," : "every second", 100 * share);
    assert_true(share < 0.05); // 8 % without the bridge, at random, on an idle machine
  }
  close_venue(v, 0);
  assert_true(number_after(strstr(read_text(v->log_path), "missed\n"), "missed\n") >= 50); // bridged
}

static void without_a_ball_the_robots_stand_and_without_opponents_they_play(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random:");
  wait_until(v, true);                                             // the picture shows no opponents
  memset(v->picture + 3 * PICTURE_W * 335, 0, 3 * PICTURE_W * 30); // somebody took the ball
  double ms = wait_until(v, false);
  assert_true(ms > 2000);
  assert_within("ball lost: brakes", ms, 3300);
  close_venue(v, 0);
}

static void a_full_disk_does_not_end_play(void **state) {
  (void)state;
  venue *v = open_venue(folder, "--policy random: --record /dev/full --stats /dev/full");
  wait_until(v, true);
  live_for(v, 3);
  assert_false(v->drives.brake);
  close_venue(v, 1);
  assert_non_null(strstr(read_text(v->log_path), "/dev/full"));
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  if (too_slow_for_real_time()) return 0;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_camera_that_goes_away_stops_the_robots_and_play_goes_on),
      cmocka_unit_test(a_camera_that_freezes_stops_the_robots),
      cmocka_unit_test(pictures_of_another_size_are_refused_loudly_until_they_are_right),
      cmocka_unit_test(a_player_that_fails_stops_the_robots_and_plays_on),
      cmocka_unit_test(the_fallback_takes_over),
      cmocka_unit_test(a_radio_that_comes_back_is_used_at_once),
      cmocka_unit_test(every_end_stops_the_robots),
      cmocka_unit_test(noise_before_the_frames_costs_none),
      cmocka_unit_test(lost_pictures_are_bridged),
      cmocka_unit_test(without_a_ball_the_robots_stand_and_without_opponents_they_play),
      cmocka_unit_test(a_full_disk_does_not_end_play),
  };
  return cmocka_run_group_tests_name("cli/field_faults", tests, make_folder, remove_folder);
}
