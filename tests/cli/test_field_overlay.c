// src/cli/field_overlay.c and src/cli/field_scene.c: what is drawn where, and that a writer of videos which hangs holds
// nothing up.
#include "cli/field_venue.h"
#include "cli/field_overlay.h"
#include <sys/stat.h>

#include "test_folder.h"

enum { W = 640, H = 480 };
static uint8_t drawn[3 * W * H];

static field_scene a_scene(void) {
  field_scene s = {.team = VS_BLUE, .picture = true, .age_ms = 9.5, .latency_s = 0.05};
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_robot *r = &s.now.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    r->pose = (vs_pose){i < VS_TEAM_SIZE ? -0.5 : 0.5, -0.3 * (i % VS_TEAM_SIZE), 0};
    r->valid = true;
  }
  s.now.ball = (vs_ball){.x_m = 0, .y_m = 0, .valid = true};
  s.ahead = s.now;
  return s;
}

static vs_calib draw(const field_scene *s) {
  vs_calib calib = vs_calib_overhead(W, H, 2.2, 0.6);
  vs_image image = {drawn, W, H, 3 * W};
  memset(drawn, 0, sizeof drawn);
  field_scene_draw(s, &calib, &image);
  return calib;
}

// Whether a pixel within two of the place that shows (x, y) has this colour.
static bool shows(const vs_calib *calib, double x_m, double y_m, double z_m, uint8_t blue, uint8_t green, uint8_t red) {
  double u, v;
  assert_true(vs_calib_to_pixel(calib, x_m, y_m, z_m, &u, &v));
  for (int y = (int)v - 2; y <= (int)v + 2; y++)
    for (int x = (int)u - 2; x <= (int)u + 2; x++) {
      const uint8_t *p = drawn + 3 * (y * W + x);
      if (p[0] == blue && p[1] == green && p[2] == red) return true;
    }
  return false;
}

#define TOP VS_ROBOT_HEIGHT_M
static void tracks_predictions_and_commands_are_drawn_where_they_are(void **state) {
  (void)state;
  field_scene s = a_scene();
  s.ahead.robot[VS_BLUE][0].pose.x_m = -0.3;
  s.wheels[0] = (vs_wheels){46.66, -46.66};
  vs_calib calib = draw(&s);
  assert_true(shows(&calib, -0.5, 0.04, TOP, 255, 130, 40));         // the side of blue 0, 8 cm wide
  assert_true(shows(&calib, 0.54, 0, TOP, 30, 230, 250));            // the front of yellow 0
  assert_true(shows(&calib, -0.3, 0.04, TOP, 255, 255, 255));        // where blue 0 will be
  assert_true(shows(&calib, -0.5 + 0.14, 0.035, TOP, 230, 60, 230)); // its left wheel ahead, its right one back
  assert_true(shows(&calib, -0.5 - 0.14, -0.035, TOP, 230, 60, 230));
  assert_false(shows(&calib, -0.5 - 0.14, 0.035, TOP, 230, 60, 230));
  assert_true(shows(&calib, 1.5 * VS_BALL_RADIUS_M, 0, VS_BALL_RADIUS_M, 0, 140, 255));
  assert_false(shows(&calib, 0.3, 0.25, 0, 255, 255, 255));
}

static void the_picture_of_who_attacks_the_other_way_is_turned(void **state) {
  (void)state;
  field_scene s = a_scene();
  s.turned = true;
  vs_calib calib = draw(&s);
  assert_true(shows(&calib, 0.5, 0.04, TOP, 255, 130, 40));
}

static int red_pixels(void) {
  int n = 0;
  for (int i = 0; i < 3 * W * 30; i += 3) n += drawn[i] == 40 && drawn[i + 1] == 40 && drawn[i + 2] == 235;
  return n;
}

static void a_stop_is_red_and_what_is_not_seen_is_grey(void **state) {
  (void)state;
  field_scene s = a_scene();
  draw(&s);
  assert_int_equal(red_pixels(), 0);
  s.stop = true;
  s.safety = VS_SAFETY_BLIND;
  s.now.robot[VS_BLUE][0].valid = false;
  vs_calib calib = draw(&s);
  assert_true(red_pixels() > 100);
  assert_true(shows(&calib, -0.5, 0.04, TOP, 150, 150, 150));
  assert_false(shows(&calib, -0.5, 0.04, TOP, 255, 130, 40));
}

// Tag 0 of the venue's picture has its corners 3 px cells from (100, 200) on; the outline is green.
static void the_video_shows_the_cameras_pictures_with_the_marks_outlined(void **state) {
  (void)state;
  char flags[128], path[96];
  snprintf(path, sizeof path, "%s/out.mp4", folder);
  snprintf(flags, sizeof flags, "--policy random: --overlay %s", path);
  venue *v = open_venue(folder, flags);
  for (int i = 0; i < 200 && !strstr(read_text(v->log_path), "policy  "); i++) {
    live_for(v, 0.05);
    if (!strstr(read_text(v->log_path), "install ffmpeg")) continue;
    print_message("note: no ffmpeg\n");
    waitpid(v->field, NULL, 0);
    unplug_camera(v);
    unplug_radio(v);
    skip();
  }
  wait_until(v, true);
  live_for(v, 3);
  close_venue(v, 0);
  assert_non_null(strstr(read_text(v->log_path), "out.mp4: "));
  vs_camera *camera;
  vs_camera_def def = vs_camera_def_default();
  def.every_frame = true;
  if (vs_camera_open(path, &def, &camera, NULL) != VS_OK) {
    print_message("note: no OpenCV to read a video with\n");
    skip();
  }
  int frames = 0, outlined = 0;
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_FRAME;
  while (got == VS_CAMERA_FRAME) {
    assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
    if (got != VS_CAMERA_FRAME) break;
    frames++;
    assert_int_equal(frame.width, PICTURE_W);
    int green = 0;
    for (int y = 190; y < 300; y++)
      for (int x = 90; x < 200; x++) {
        const uint8_t *p = frame.bgr + y * frame.bgr_stride + 3 * x;
        green += p[1] > p[0] + 50 && p[1] > p[2] + 50;
      }
    outlined += green > 40;
  }
  vs_camera_close(camera);
  print_message("%d frames, the tag outlined in %d\n", frames, outlined);
  assert_true(frames > 45); // three seconds are 90
  // The last ones may be of the camera's end, and a busy machine's of a picture that came too late.
  assert_true(outlined > frames / 2);
}

// It takes the pipe and reads nothing for five seconds.
static void a_video_writer_that_hangs_holds_nothing_up(void **state) {
  (void)state;
  char script[96], flags[128], path[4096];
  snprintf(script, sizeof script, "%s/ffmpeg", folder);
  FILE *f = fopen(script, "w");
  assert_non_null(f);
  fputs("#!/bin/sh\nexec sleep 5\n", f);
  fclose(f);
  assert_int_equal(chmod(script, 0700), 0);
  const char *old = getenv("PATH");
  snprintf(path, sizeof path, "%s:%s", folder, old);
  char *kept = strdup(old);
  setenv("PATH", path, 1);
  snprintf(flags, sizeof flags, "--policy random: --overlay %s/hung.mp4", folder);
  venue *v = open_venue(folder, flags);
  wait_until(v, true);
  setenv("PATH", kept, 1);
  free(kept);
  int frames = v->frames, stops = v->stops;
  live_for(v, 3);
  frames = v->frames - frames;
  stops = v->stops - stops;
  print_message("%d radio frames, %d of them STOP\n", frames, stops);
  assert_true(frames > 100);
  assert_true(stops < frames / 10);
  close_venue(v, 1); // the file is not whole
  assert_non_null(strstr(read_text(v->log_path), "hung.mp4: ffmpeg ended without a reason"));
  assert_true(number_after(strstr(read_text(v->log_path), "too old to decide on; "), "too old to decide on; ") >= 20);
}

static void what_cannot_be_a_video_is_refused_at_once(void **state) {
  (void)state;
  venue *v = make_venue_in(folder);
  char arguments[256];
  snprintf(arguments, sizeof arguments, "field --go --no-lcm --camera rig:%s --policy zero: --overlay out.txt",
           v->camera_path);
  assert_refused(arguments, 2, "out.txt: the name of a video ends in .mp4");
  unplug_camera(v);
  unplug_radio(v);
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  if (too_slow_for_real_time()) return 0;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tracks_predictions_and_commands_are_drawn_where_they_are),
      cmocka_unit_test(the_picture_of_who_attacks_the_other_way_is_turned),
      cmocka_unit_test(a_stop_is_red_and_what_is_not_seen_is_grey),
      cmocka_unit_test(the_video_shows_the_cameras_pictures_with_the_marks_outlined),
      cmocka_unit_test(a_video_writer_that_hangs_holds_nothing_up),
      cmocka_unit_test(what_cannot_be_a_video_is_refused_at_once),
  };
  return cmocka_run_group_tests_name("cli/field_overlay", tests, make_folder, remove_folder);
}
