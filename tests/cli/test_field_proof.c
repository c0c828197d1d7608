// src/cli/cmd_field.c with src/cli/cmd_rig.c, through the real binary: a minute of our policy against inf: in which all that
// can happen happens. The test holds the cables: pictures and radio of the rig pass through it.
#define _GNU_SOURCE
#include <sched.h>

#include "cli/field_venue.h"
#include "test_folder.h"

static char rig_folder[80], rig_log[96];
static pid_t rig;

// Real-time priority where the right to it is there, so that a busy machine does not stand between.
static const char *realtime(const char *flag) { return SANITIZED ? "" : flag; }

static void start_rig(venue *v) {
  char arguments[256], source[128], device[128];
  snprintf(arguments, sizeof arguments, "rig%s --no-lcm --opponent inf: --seconds 600 --dir %s", realtime(" --rt 40"),
           rig_folder);
  rig = vsss_start(rig_log, arguments);
  for (int i = 0; i < 60 && !strstr(read_text(rig_log), "waiting for the camera"); i++) {
    if (waitpid(rig, NULL, WNOHANG) == rig) { // it ended: this machine cannot draw
      print_message("note: %s", read_text(rig_log));
      skip();
    }
    live_for(v, 1); // the others live on meanwhile
  }
  snprintf(source, sizeof source, "rig:%s/camera", rig_folder);
  snprintf(device, sizeof device, "%s/radio", rig_folder);
  assert_ok(vs_serial_open(device, VS_SERIAL_BAUD, &v->rig_radio, err));
  assert_ok(vs_camera_open(source, NULL, &v->rig_camera, err));
}

static void lose_rig(venue *v) {
  kill(rig, SIGKILL);
  waitpid(rig, NULL, 0);
  vs_camera_close(v->rig_camera);
  vs_serial_close(v->rig_radio);
  v->rig_camera = NULL;
  v->rig_radio = NULL;
}

static pid_t child_of(pid_t parent) {
  char path[64], text[64] = "";
  snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)parent, (int)parent);
  FILE *f = fopen(path, "r");
  if (f) {
    if (!fgets(text, sizeof text, f)) text[0] = '\0';
    fclose(f);
  }
  return (pid_t)strtol(text, NULL, 10);
}

// The player is the keeper's child.
static void hit_player(venue *v, int signal) {
  pid_t player = child_of(child_of(v->field));
  assert_true(player > 1);
  kill(player, signal);
}

static void play(venue *v, double seconds) {
  live_for(v, seconds);
  wait_until(v, true);
  if (waitpid(v->field, NULL, WNOHANG) != 0) fail_msg("field ended: %s", read_text(v->log_path));
}

static void lose_the_camera(venue *v) {
  unplug_camera(v);
  assert_within("camera closed: brakes", wait_until(v, false), 200);
  live_for(v, 1);
  assert_true(v->drives.brake);
  plug_camera(v);
  assert_within("camera reopened: drives", wait_until(v, true), 500);
}

static void freeze_the_camera(venue *v) {
  v->drop = 1;
  assert_within("camera frozen: brakes", wait_until(v, false), 300);
  v->drop = 0;
  assert_within("camera thawed: drives", wait_until(v, true), 200);
}

static void crash_and_hang_the_player(venue *v) {
  static const struct {
    const char *brakes, *drives;
    int signal;
    double limit_ms;
  } row[] = {{"player crashed: brakes", "player crashed: drives again", SIGSEGV, 200},
             {"player hangs: brakes", "player hangs: drives again", SIGSTOP, 450}};
  for (int i = 0; i < 2; i++) {
    hit_player(v, row[i].signal);
    assert_within(row[i].brakes, wait_until(v, false), row[i].limit_ms);
    assert_within(row[i].drives, wait_until(v, true), 500);
    play(v, 1);
  }
}

static void lose_the_radio(venue *v) {
  unplug_radio(v);
  assert_within("radio gone: brakes by itself", wait_until(v, false), 200);
  live_for(v, 2);
  plug_radio(v);
  assert_within("radio back: drives", wait_until(v, true), 300);
}

static void lose_half_of_the_pictures(venue *v) {
  int frames = v->frames, stops = v->stops;
  v->drop = 0.5;
  live_for(v, 8);
  v->drop = 0;
  double share = (double)(v->stops - stops) / (v->frames - frames);
  print_message("half of the pictures lost: %.1f %% of the radio frames are STOP\n", 100 * share);
  assert_true(share < 0.2);
}

static void show_another_size(venue *v) {
  unplug_camera(v);
  assert_within("pictures of another size: brakes", wait_until(v, false), 200);
  vs_camera *real = v->rig_camera;
  v->rig_camera = NULL; // nothing is passed on to a camera of another size
  plug_camera_of(v, PICTURE_W / 2, PICTURE_H / 2);
  live_for(v, 1);
  assert_true(v->drives.brake);
  unplug_camera(v);
  v->rig_camera = real;
  plug_camera(v);
  assert_within("right size again: drives", wait_until(v, true), 500);
}

static void restart_the_rig(venue *v) {
  lose_rig(v);
  unplug_camera(v);
  unplug_radio(v);
  assert_within("rig killed: brakes by itself", wait_until(v, false), 200);
  start_rig(v);
  plug_radio(v);
  plug_camera(v);
  assert_within("rig restarted: drives", wait_until(v, true), 1000);
}

static void nothing_ends_a_match(void **state) {
  (void)state;
  if (SANITIZED) { // each fault by itself is tested there too: test_field_faults.c
    print_message("note: a minute in real time is played without sanitizers\n");
    skip();
  }
  if (access("models/policy/field.onnx", R_OK) != 0) {
    print_message("note: no models/policy/field.onnx here\n");
    skip();
  }
  char flags[256];
  snprintf(rig_folder, sizeof rig_folder, "%s/rig", folder);
  snprintf(rig_log, sizeof rig_log, "%s/rig.log", folder);
  venue *v = make_venue_in(folder);
  unplug_camera(v);
  start_rig(v);
  plug_camera(v);
  vs_firmware_init(&v->robot, 0, venue_ms());
  snprintf(flags, sizeof flags, "--calib %s/calib.ini%s", rig_folder, realtime(" --rt 50"));
  start_field(v, flags);
  const struct sched_param fifo = {.sched_priority = 45};
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &fifo); // without the right to it: as it is
  wait_until(v, true);
  int64_t start_us = vs_clock_monotonic_us();
  static void (*const fault[])(venue *) = {lose_the_camera,           freeze_the_camera,
                                           crash_and_hang_the_player, lose_the_radio,
                                           show_another_size,         lose_half_of_the_pictures,
                                           crash_and_hang_the_player, restart_the_rig,
                                           lose_the_camera,           lose_the_radio};
  for (size_t i = 0; i < sizeof fault / sizeof *fault; i++) {
    play(v, 1.5);
    fault[i](v);
  }
  double left_s = 60 - 1e-6 * (double)(vs_clock_monotonic_us() - start_us);
  play(v, left_s > 3 ? left_s : 3);
  close_venue(v, 0);
  const struct sched_param other = {0};
  sched_setscheduler(0, SCHED_OTHER, &other);
  vs_camera_close(v->rig_camera);
  vs_serial_close(v->rig_radio);
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
  const char *said = read_text(v->log_path);
  assert_true(number_after(said, "camera lost ") >= 3);
  assert_true(number_after(said, "player failed ") >= 4);
  assert_true(number_after(strstr(said, "radio: "), "device reopened ") >= 3);
  said = read_text(rig_log);
  assert_true(number_after(said, "driven in ") > 100); // of the last rig's frames
  print_message("%s", strstr(said, "ball touched"));
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  if (too_slow_for_real_time()) return 0;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing_ends_a_match),
  };
  return cmocka_run_group_tests_name("cli/field_proof", tests, make_folder, remove_folder);
}
