// src/cli/cmd_field.c, with src/cli/field_config.c, src/cli/field_report.c and
// src/cli/world_csv.c
#include "assert_near.h"
#include "cli/field_match.h"
#include "field/tagged_picture.h"
#include "test_folder.h"
#include "vsss/bus.h"
#include "vsss/calib.h"
#include "vsss/clock.h"
#include "vsss/frame_stream.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"

static const char *in_folder(const char *name) {
  static char path[4][128];
  static int next;
  char *p = path[next++ % 4];
  snprintf(p, sizeof path[0], "%s/%s", folder, name);
  return p;
}

// LCM between rig and field on a port of this test's own, or none where the
// machine has no multicast route.
static const char *lcm_flags(void) {
  static char flags[96];
  char url[64];
  snprintf(url, sizeof url, "udpm://239.255.76.67:%d?ttl=0", 20000 + (int)(getpid() % 20000));
  vs_bus *bus;
  vs_error err = {0};
  if (vs_bus_open(url, &bus, &err) == VS_OK)
    snprintf(flags, sizeof flags, "--lcm '%s'", url);
  else
    snprintf(flags, sizeof flags, "--no-lcm");
  vs_bus_close(bus);
  return flags;
}

static double difference(double a, double b) { return remainder(a - b, 2.0 * 3.14159265358979); }

// Root mean squares over every sight of an own robot (0, 1, 2), and the nearest
// adversary for 3, 4, 5; and how many.
static void compare(const table *tracked, const table *truth, int first, double *rms_m, double *rms_rad, int *sights,
                    int *rows) {
  double metres = 0, radians = 0;
  *sights = *rows = 0;
  for (int i = 0; i < tracked->rows; i++) {
    const struct row *seen = &tracked->row[i], *is = row_at(truth, seen->time_us);
    if (!is || is->event)
      continue; // the moment in which pieces are placed belongs to neither side
                // of it
    for (int k = first; k < first + 3; k++) {
      ++*rows;
      if (!seen->valid[k]) continue;
      double nearest = INFINITY;
      for (int j = first; j < first + 3; j++) {
        if (first == 0 && j != k) continue;
        nearest = fmin(nearest, hypot(seen->x_m[k] - is->x_m[j], seen->y_m[k] - is->y_m[j]));
      }
      double turn = first == 0 ? difference(seen->theta_rad[k], is->theta_rad[k]) : 0.0;
      metres += nearest * nearest;
      radians += turn * turn;
      ++*sights;
    }
  }
  *rms_m = sqrt(metres / *sights);
  *rms_rad = sqrt(radians / *sights);
}

static void field_plays_in_the_rig_with_true_poses_and_fresh_frames(void **state) {
  (void)state;
  if (SANITIZED) {
    print_message("note: a sanitizer is too slow for 20 s of "
                  "real time\n");
    skip();
  }
  char arguments[1024];
  const char *lcm = lcm_flags();
  snprintf(arguments, sizeof arguments,
           "rig --rt 40 --seconds 20 --matches 1 --opponent random: --seed 3 "
           "--dir %s/venue --truth %s/truth.csv %s",
           folder, folder, lcm);
  pid_t rig = vsss_start(in_folder("rig.log"), arguments);
  if (!wait_for_text(in_folder("rig.log"), "waiting for the camera", 30)) {
    int status = vsss_wait(rig, 1);
    const char *said = read_text(in_folder("rig.log"));
    if (!strstr(said, "install ")) fail_msg("rig: status %d: %s", status, said);
    print_message("note: %s", said); // no EGL, no AprilTag
    skip();
  }
  snprintf(arguments, sizeof arguments,
           "field --go --rt 50 --policy emc: --camera rig:%s/venue/camera --radio "
           "%s/venue/radio --calib %s/venue/calib.ini "
           "--seconds 18 --stats %s/stats.json --record %s/tracked.csv %s",
           folder, folder, folder, folder, folder, lcm);
  pid_t field = vsss_start(in_folder("field.log"), arguments);
  int field_status = vsss_wait(field, 60), rig_status = vsss_wait(rig, 60);
  if (field_status || rig_status)
    fail_msg("field %d, rig %d: %s", field_status, rig_status, read_text(in_folder("field.log")));

  // The ball is touched, the wheels' commands arrive: three robots, 50 frames a
  // second, 18 s; half of it is asked for.
  const char *rig_said = read_text(in_folder("rig.log"));
  assert_true(number_after(rig_said, "ball touched ") >= 1);
  assert_true(number_after(strstr(rig_said, " frames, "), " frames, ") >= 0.5 * 3 * 50 * 18);
  assert_true(number_after(rig_said, "driven in ") >= 200); // of 540 frames

  // Frames are never older than 100 ms at decision time.
  const char *stats = read_text(in_folder("stats.json"));
  const char *age = strstr(stats, "\"decision age\"");
  assert_non_null(age);
  assert_true(number_after(age, "\"count\": ") >= 100);
  assert_true(number_after(age, "\"max_us\": ") <= 100000);

  static table tracked, truth;
  read_table(in_folder("tracked.csv"), &tracked);
  read_table(in_folder("truth.csv"), &truth);
  double rms_m, rms_rad;
  int sights, rows;
  compare(&tracked, &truth, 0, &rms_m, &rms_rad, &sights, &rows);
  print_message("own robots: %d of %d seen, rms %.2f mm, %.2f degrees; frames %d\n", sights, rows, 1e3 * rms_m,
                rms_rad * 57.29578, tracked.rows);
  assert_true(rows >= 3 * 150);
  assert_true(sights >= 0.9 * rows);
  assert_true(rms_m < 0.005);
  assert_true(rms_rad < 2.0 / 57.29578);
  compare(&tracked, &truth, 3, &rms_m, &rms_rad, &sights, &rows);
  print_message("adversaries: %d of %d seen, rms %.2f mm\n", sights, rows, 1e3 * rms_m);
  assert_true(sights >= 0.9 * rows);
  assert_true(rms_m < 0.005);
}

// A camera under which three robots stand still.
static uint8_t picture[3 * PICTURE_W * PICTURE_H];
static vs_frame_server *still_camera(void) {
  vs_frame_server *server;
  paint_tagged_picture(picture);
  assert_ok(vs_frame_server_new(in_folder("still"), PICTURE_W, PICTURE_H, 30, &server, err));
  return server;
}

typedef struct heard {
  int frames, stops, trailing_stops;
} heard;

// Shows pictures and listens to the radio for some time.
static void show_and_listen(vs_frame_server *camera, vs_pty *pty, vs_radio_decoder *decoder, int pictures, heard *h) {
  static uint32_t seq;
  for (int i = 0; i < pictures; i++) {
    if (camera) vs_frame_server_put(camera, picture, vs_clock_monotonic_us(), seq++);
    uint8_t bytes[2048];
    size_t n = vs_pty_read(pty, bytes, sizeof bytes);
    for (size_t k = 0; k < n; k++) {
      vs_radio_frame frame;
      if (!vs_radio_decode(decoder, bytes[k], &frame) || frame.type != VS_RADIO_COMMAND) continue;
      int stop = (frame.as.command.flags & VS_RADIO_FLAG_STOP) != 0;
      h->frames++;
      h->stops += stop;
      h->trailing_stops = stop ? h->trailing_stops + 1 : 0;
    }
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 33333);
  }
}

static void interrupt_stops_the_robots_prints_the_latencies_and_exits_0(void **state) {
  (void)state;
  vs_frame_server *camera = still_camera();
  vs_pty *pty;
  assert_ok(vs_pty_new(&pty, err));
  char arguments[512];
  snprintf(arguments, sizeof arguments, "field --go --no-lcm --policy random: --camera rig:%s/still --radio %s", folder,
           vs_pty_path(pty));
  pid_t field = vsss_start(in_folder("field.log"), arguments);
  vs_radio_decoder decoder = {0};
  heard h = {0};
  for (int i = 0; i < 900 && h.frames - h.stops < 20; i++) show_and_listen(camera, pty, &decoder, 1, &h);
  assert_true(h.frames - h.stops >= 20); // it drives
  kill(field, SIGINT);
  memset(&h, 0, sizeof h);
  int status = -1;
  for (int i = 0; i < 300; i++) {
    show_and_listen(camera, pty, &decoder, 1, &h);
    if (waitpid(field, &status, WNOHANG) == field) break;
  }
  show_and_listen(NULL, pty, &decoder, 1, &h);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  assert_true(h.trailing_stops >= 10);
  const char *said = read_text(in_folder("field.log"));
  assert_non_null(strstr(said, "camera to radio"));
  assert_non_null(strstr(said, "p99.9"));
  vs_frame_server_free(camera);
  vs_pty_free(pty);
}

static void without_a_radio_it_says_that_it_is_a_dry_run(void **state) {
  (void)state;
  vs_frame_server *camera = still_camera();
  char arguments[256];
  snprintf(arguments, sizeof arguments, "field --no-lcm --policy zero: --seconds 0.3 --camera rig:%s/still", folder);
  pid_t field = vsss_start(in_folder("field.log"), arguments);
  assert_int_equal(vsss_wait(field, 30), 0);
  assert_non_null(strstr(read_text(in_folder("field.log")), "dry run"));
  assert_non_null(strstr(read_text(in_folder("field.log")), "no --calib"));
  vs_frame_server_free(camera);
}

static void write_file(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static void bad_input_is_named_in_one_line(void **state) {
  (void)state;
  char arguments[512];
  assert_refused("field", 2, "--camera is missing");
  assert_refused("field --no-lcm --camera /dev/video99", 1, "/dev/video99");
  assert_refused("field --no-lcm --camera telescope:1", 2, "telescope");
  assert_refused("field --no-lcm --camera rig:/nonexistent/camera", 1, "/nonexistent/camera");
  assert_refused("field --no-lcm --camera x --radio /dev/no-such-radio", 1, "/dev/no-such-radio");
  assert_refused("field --no-lcm --camera x --policy clever:", 2, "clever");
  assert_refused("field --camera x --team green", 2, "--team green: expected blue or yellow");
  assert_refused("field --camera x --attack up", 2, "--attack up: expected +x or -x");
  assert_refused("field --camera x --config /nonexistent.ini", 1, "/nonexistent.ini");

  write_file(in_folder("bad.ini"), "[radio]\nbaud = 115200\nbuad = 9600\n");
  snprintf(arguments, sizeof arguments, "field --camera x --config %s/bad.ini", folder);
  assert_refused(arguments, 2, "bad.ini:3: unknown key 'radio.buad' (did you mean 'radio.baud'?)");
  write_file(in_folder("bad.ini"), "[field]\nteam = green\n");
  assert_refused(arguments, 2, "field.team = green: expected blue or yellow");
  write_file(in_folder("bad.ini"), "[radio]\nrobot0_id = 2\n");
  assert_refused(arguments, 2, "radio id");

  // A calibration for pictures of another size.
  vs_frame_server *camera = still_camera();
  vs_calib calib = vs_calib_overhead(1280, 720, 2.2, 0.6);
  assert_ok(vs_calib_save(in_folder("other.ini"), &calib, err));
  snprintf(arguments, sizeof arguments,
           "field --no-lcm --policy zero: --camera rig:%s/still --calib "
           "%s/other.ini",
           folder, folder);
  assert_refused(arguments, 1, "1280");
  vs_frame_server_free(camera);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_input_is_named_in_one_line),
      cmocka_unit_test(without_a_radio_it_says_that_it_is_a_dry_run),
      cmocka_unit_test(interrupt_stops_the_robots_prints_the_latencies_and_exits_0),
      cmocka_unit_test(field_plays_in_the_rig_with_true_poses_and_fresh_frames),
  };
  return cmocka_run_group_tests_name("cli/field", tests, make_folder, remove_folder);
}
