// src/cli/cmd_rig.c, with src/rig/rig.c, src/rig/rig_open.c and
// src/rig/robots.c, src/rig/venue.c
#include <sys/stat.h>

#include "assert_near.h"
#include "cli/field_match.h"
#include "vsss/calib.h"
#include "vsss/camera.h"
#include "vsss/clock.h"
#include "vsss/detect.h"
#include "vsss/frame_stream.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"

static char folder[] = "/tmp/vsss_rig_XXXXXX", log_path[64], venue[64];

static int make_folder(void **state) {
  (void)state;
  vs_camera_register(vs_frame_stream_camera());
  if (!mkdtemp(folder)) return 1;
  snprintf(log_path, sizeof log_path, "%s/log", folder);
  snprintf(venue, sizeof venue, "%s/venue", folder);
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

// A rig that waits for its viewer; 0 where this machine cannot draw.
static pid_t start_rig(const char *flags) {
  char arguments[512];
  snprintf(arguments, sizeof arguments, "rig --no-lcm --dir %s %s", venue, flags);
  pid_t rig = vsss_start(log_path, arguments);
  if (wait_for_text(log_path, "waiting for the camera", 60)) return rig;
  int status = vsss_wait(rig, 1);
  const char *said = read_text(log_path);
  if (!strstr(said, "install ")) fail_msg("rig: status %d: %s", status, said);
  print_message("note: %s", said);
  skip();
  return 0;
}

static void see_the_kick_off(const char *flags) {
  pid_t rig = start_rig(flags);
  if (!rig) return;
  char source[96], calib_path[96];
  snprintf(source, sizeof source, "rig:%s/camera", venue);
  snprintf(calib_path, sizeof calib_path, "%s/calib.ini", venue);
  vs_camera *camera;
  vs_calib calib;
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  assert_ok(vs_calib_load(calib_path, &calib, err));
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_TIMEOUT;
  for (int i = 0; i < 40 && got != VS_CAMERA_FRAME; i++) assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  vs_detector_def def = vs_detector_def_default();
  def.adversary = VS_BLUE;
  def.px_per_m = vs_calib_px_per_m(&calib, 0.08);
  vs_detector *detector;
  static vs_detections seen;
  assert_ok(vs_detector_new(&def, &detector, err));
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 3);
  assert_int_equal(seen.adversaries, 3);
  assert_int_equal(seen.balls, 1);
  double x, y;
  assert_true(vs_calib_to_field(&calib, seen.ball[0].x_px, seen.ball[0].y_px, 0.02135, &x, &y));
  assert_near(x, 0, 0.002); // kick-off: the ball lies on the centre mark
  assert_near(y, 0, 0.002);
  for (int i = 0; i < 3; i++) { // yellow defends +x
    assert_true(vs_calib_to_field(&calib, seen.tag[i].centre_px[0], seen.tag[i].centre_px[1], 0.08, &x, &y));
    assert_true(x > 0 && x < 0.75 && fabs(y) < 0.65);
  }
  vs_detector_free(detector);
  vs_camera_close(camera);
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
}

static void the_camera_shows_the_kick_off_where_the_calibration_says(void **state) {
  (void)state;
  see_the_kick_off("--team yellow --opponent zero:");
}

static void so_does_one_with_a_distorting_lens_and_a_slow_shutter(void **state) {
  (void)state;
  see_the_kick_off("--team yellow --opponent zero: --lens -0.25 --exposure 8");
}

// By a shell, from where the rig was started; the folder's name needs quotes.
static void the_play_line_can_be_pasted(void **state) {
  (void)state;
  char plain[sizeof venue], line[4096], out[128];
  memcpy(plain, venue, sizeof plain);
  snprintf(venue, sizeof venue, "'%s/it is ours'", folder);
  pid_t rig = start_rig("");
  memcpy(venue, plain, sizeof plain);
  if (!rig) return;
  const char *play = strstr(read_text(log_path), "\nplay ");
  assert_non_null(play);
  play += strlen("\nplay ");
  snprintf(out, sizeof out, "%s/played", folder);
  snprintf(line, sizeof line, "%.*s --no-lcm --seconds 1 >%s 2>&1 </dev/null", (int)strcspn(play, "\n"), play, out);
  int status = system(line);
  if (status != 0) fail_msg("%s: %s", line, read_text(out));
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 10), 0);
}

static void the_robots_obey_the_radio_and_report(void **state) {
  (void)state;
  pid_t rig = start_rig("--opponent zero:");
  if (!rig) return;
  char source[96], device[96], path[128];
  snprintf(source, sizeof source, "rig:%s/camera", venue);
  snprintf(device, sizeof device, "%s/radio", venue);
  vs_camera *camera;
  vs_serial *radio;
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  assert_ok(vs_serial_open(device, VS_SERIAL_BAUD, &radio, err));
  vs_radio_frame frame = {.type = VS_RADIO_COMMAND};
  frame.as.command = (vs_radio_command){.n = 3, .robot = {{0, 500, 500}, {1, -500, 500}, {2, 0, 0}}};
  vs_radio_decoder decoder = {0};
  int reports[3] = {0}, echoed = 0;
  double fastest = 0; // what robot 0 says of its left wheel
  for (int i = 0; i < 300 && (reports[0] < 5 || reports[2] < 5 || fastest < 4.5); i++) {
    uint8_t bytes[256];
    frame.as.command.seq = (uint8_t)i;
    vs_serial_write(radio, bytes, vs_radio_encode(&frame, bytes), vs_clock_monotonic_us());
    size_t n = vs_serial_read(radio, bytes, sizeof bytes, vs_clock_monotonic_us());
    for (size_t k = 0; k < n; k++) {
      vs_radio_frame report;
      if (!vs_radio_decode(&decoder, bytes[k], &report) || report.type != VS_RADIO_TELEMETRY) continue;
      const vs_radio_telemetry *t = &report.as.telemetry;
      assert_in_range(t->id, 0, 2);
      reports[t->id]++;
      echoed += t->seq_echo > 0;
      if (t->id == 0) fastest = fmax(fastest, vs_radio_radps(t->left));
    }
    vs_frame picture;
    vs_camera_got got;
    assert_ok(vs_camera_read(camera, 100, &picture, &got, err));
  }
  assert_true(reports[0] >= 5 && reports[1] >= 1 && reports[2] >= 5);
  assert_true(echoed > 0);
  assert_near(fastest, 5.0, 1.0); // commanded: 5 rad/s
  vs_serial_close(radio);
  vs_camera_close(camera);
  kill(rig, SIGTERM);
  assert_int_equal(vsss_wait(rig, 20), 0);
  assert_non_null(strstr(read_text(log_path), "radio frames taken"));
  snprintf(path, sizeof path, "%s/radio", venue);
  assert_int_not_equal(access(path, F_OK), 0); // what it made it took away
  snprintf(path, sizeof path, "%s/camera", venue);
  assert_int_not_equal(access(path, F_OK), 0);
}

// Frames from the kick-off until one of yellow's robots has moved; -1: none did.
static int frames_until_yellow_moves(const char *flags) {
  char arguments[256], truth[96], source[96];
  snprintf(truth, sizeof truth, "%s/truth.csv", folder);
  snprintf(source, sizeof source, "rig:%s/camera", venue);
  snprintf(arguments, sizeof arguments, "--opponent random: --truth %s %s", truth, flags);
  pid_t rig = start_rig(arguments);
  if (!rig) return -1;
  vs_camera *camera;
  assert_ok(vs_camera_open(source, NULL, &camera, err));
  vs_clock_sleep_until_us(vs_clock_monotonic_us() + 1500000);
  vs_camera_close(camera);
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
  static table t;
  read_table(truth, &t);
  int begin = 0;
  while (begin < t.rows && !t.row[begin].event) begin++;
  for (int i = begin + 1; i < t.rows; i++)
    for (int k = 3; k < 6; k++) {
      const struct row *now = &t.row[i], *then = &t.row[begin];
      if (hypot(now->x_m[k] - then->x_m[k], now->y_m[k] - then->y_m[k]) > 5e-4 ||
          fabs(now->theta_rad[k] - then->theta_rad[k]) > 5e-3)
        return (int)lround(1e-6 * VS_CAMERA_HZ * (double)(now->time_us - then->time_us));
    }
  return -1;
}

// A late machine draws the kick-off some pictures late, so that fewer are counted.
static void the_other_team_waits_for_its_commands_as_long_as_ours(void **state) {
  (void)state;
  int at_once = frames_until_yellow_moves("--opponent-at-once --robot-delay 6");
  int late = frames_until_yellow_moves("--robot-delay 5"); // and the one that the radio takes: 6
  print_message("moves after %d frames, delayed after %d\n", at_once, late);
  assert_in_range(at_once, 1, 2);
  assert_in_range(late, 4, 8);
}

static void write_text(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

// Frames with the key of field.ini drive the robots, others do nothing; each is sent until it was surely read.
static void robots_with_a_key_obey_nobody_else(void **state) {
  (void)state;
  char config[96], flags[128], device[96];
  snprintf(config, sizeof config, "%s/field.ini", folder);
  write_text(config, "[radio]\nteam_id = 9\nkey = 0102030405060708090a0b0c0d0e0f10\n");
  snprintf(flags, sizeof flags, "--opponent zero: --config %s", config);
  pid_t rig = start_rig(flags);
  if (!rig) return;
  vs_serial *radio;
  snprintf(device, sizeof device, "%s/radio", venue);
  assert_ok(vs_serial_open(device, VS_SERIAL_BAUD, &radio, err));
  vs_radio_key key;
  assert_true(vs_radio_key_parse(9, "0102030405060708090a0b0c0d0e0f10", &key));
  vs_radio_frame frame = {.type = VS_RADIO_COMMAND};
  frame.as.command = (vs_radio_command){.n = 3, .robot = {{0, 500, 500}, {1, 500, 500}, {2, 500, 500}}};
  for (int i = 0; i < 40; i++) {
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    frame.as.command.seq = (uint8_t)i;
    frame.as.command.counter = (uint64_t)(i + 1);
    bool keyed = i >= 20;
    vs_serial_write(radio, bytes, keyed ? vs_radio_encode_keyed(&frame, &key, bytes) : vs_radio_encode(&frame, bytes),
                    vs_clock_monotonic_us());
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 10000);
  }
  vs_clock_sleep_until_us(vs_clock_monotonic_us() + 200000);
  vs_serial_close(radio);
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
  assert_non_null(strstr(read_text(log_path), " 60 radio frames taken")); // 20 by each of three robots
}

static void a_second_rig_in_the_same_folder_is_refused(void **state) {
  (void)state;
  pid_t rig = start_rig("");
  if (!rig) return;
  char arguments[128];
  snprintf(arguments, sizeof arguments, "rig --no-lcm --dir %s", venue);
  assert_refused(arguments, 1, "in use by another rig");
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
}

static void make_venue(void) {
  char command[160];
  snprintf(command, sizeof command, "rm -rf '%s' && mkdir -m 700 '%s'", venue, venue);
  assert_int_equal(system(command), 0);
}

static void refuse_rig(const char *text) {
  char arguments[128];
  snprintf(arguments, sizeof arguments, "rig --no-lcm --matches 1 --seconds 1 --dir %s", venue);
  assert_refused(arguments, 1, text);
}

static void files_that_no_rig_left_are_kept_and_named(void **state) {
  (void)state;
  static const char *const names[] = {"calib.ini", "radio", "camera"};
  for (int i = 0; i < 3; i++) {
    char path[128];
    make_venue();
    snprintf(path, sizeof path, "%s/%s", venue, names[i]);
    write_text(path, "mine\n");
    refuse_rig("is already there and no rig left it");
    assert_string_equal(read_text(path), "mine\n");
  }
}

// A link where a file is to be made would have its target overwritten.
static void planted_links_are_refused_and_what_they_point_at_is_kept(void **state) {
  (void)state;
  static const char *const names[] = {"calib.ini", "calib.ini.part", "radio", "camera"};
  char target[80], path[128];
  snprintf(target, sizeof target, "%s/precious", folder);
  for (int i = 0; i < 4; i++) {
    make_venue();
    write_text(target, "mine\n");
    snprintf(path, sizeof path, "%s/%s", venue, names[i]);
    assert_int_equal(symlink(target, path), 0);
    if (i != 1) {
      refuse_rig(names[i]);
    } else {
      pid_t rig = start_rig("");
      if (!rig) return;
      kill(rig, SIGINT);
      assert_int_equal(vsss_wait(rig, 20), 0);
    }
    struct stat info;
    assert_true(lstat(path, &info) == 0 && S_ISLNK(info.st_mode));
    assert_string_equal(read_text(target), "mine\n");
  }
}

static void a_folder_that_is_not_only_the_users_is_refused(void **state) {
  (void)state;
  char real[80];
  snprintf(real, sizeof real, "%s/real", folder);
  make_venue();
  assert_int_equal(chmod(venue, 0777), 0);
  refuse_rig("others may write into it");
  assert_int_equal(rename(venue, real), 0);
  assert_int_equal(chmod(real, 0700), 0);
  assert_int_equal(symlink(real, venue), 0);
  refuse_rig("is a link");
  unlink(venue);
  if (geteuid() != 0) {
    print_message("note: another user's folder needs root to be made\n");
    skip();
  }
  make_venue();
  assert_int_equal(chown(venue, 65534, 65534), 0);
  refuse_rig("belongs to user 65534");
}

static void what_a_killed_rig_left_is_replaced_and_the_folder_is_private(void **state) {
  (void)state;
  char command[160];
  snprintf(command, sizeof command, "rm -rf '%s'", venue);
  assert_int_equal(system(command), 0);
  pid_t rig = start_rig("");
  if (!rig) return;
  struct stat info;
  assert_int_equal(stat(venue, &info), 0);
  assert_int_equal(info.st_mode & 0777, 0700);
  kill(rig, SIGKILL);
  vsss_wait(rig, 20);
  rig = start_rig("--width 320 --height 240");
  char path[128];
  vs_calib calib;
  snprintf(path, sizeof path, "%s/calib.ini", venue);
  assert_ok(vs_calib_load(path, &calib, err));
  assert_int_equal(calib.width, 320);
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
  assert_int_equal(rmdir(venue), 0); // nothing of it is left
}

static void bad_input_is_named_in_one_line(void **state) {
  (void)state;
  assert_refused("rig --team green", 2, "--team green: expected blue or yellow");
  assert_refused("rig --opponent clever:", 2, "clever");
  assert_refused("rig --rules house", 2, "house");
  assert_refused("rig --drive rocket", 2, "rocket");
  assert_refused("rig --seconds -1", 2, "--seconds -1: allowed are 0 to 86400");
  assert_refused("rig extra", 2, "'extra' is not expected here");
}

static void a_folder_that_cannot_be_made_is_named(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, "rig --no-lcm --dir /nonexistent/venue");
  if (strstr(run.err, "install ")) {
    print_message("note: %s", run.err);
    skip();
  }
  assert_int_equal(run.status, 1);
  assert_non_null(strstr(run.err, "/nonexistent/venue: cannot make this folder: No such file"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_input_is_named_in_one_line),
      cmocka_unit_test(a_folder_that_cannot_be_made_is_named),
      cmocka_unit_test(the_camera_shows_the_kick_off_where_the_calibration_says),
      cmocka_unit_test(so_does_one_with_a_distorting_lens_and_a_slow_shutter),
      cmocka_unit_test(the_play_line_can_be_pasted),
      cmocka_unit_test(the_robots_obey_the_radio_and_report),
      cmocka_unit_test(the_other_team_waits_for_its_commands_as_long_as_ours),
      cmocka_unit_test(files_that_no_rig_left_are_kept_and_named),
      cmocka_unit_test(planted_links_are_refused_and_what_they_point_at_is_kept),
      cmocka_unit_test(a_folder_that_is_not_only_the_users_is_refused),
      cmocka_unit_test(what_a_killed_rig_left_is_replaced_and_the_folder_is_private),
      cmocka_unit_test(robots_with_a_key_obey_nobody_else),
      cmocka_unit_test(a_second_rig_in_the_same_folder_is_refused),
  };
  return cmocka_run_group_tests_name("cli/rig", tests, make_folder, remove_folder);
}
