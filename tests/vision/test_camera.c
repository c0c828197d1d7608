// src/vision/camera.c and src/vision/camera_recording.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/camera.h"
#include "vsss/clock.h"
#include "vsss/image.h"

enum { W = 32, H = 24, PICTURES = 5 };
static char folder[] = "/tmp/vsss_camera_XXXXXX";

// Picture i is of one grey, 40 * i; named so that their order is not that of their making.
static const char *const names[PICTURES] = {"a.png", "b.png", "c.bmp", "d.png", "e.PNG"};

static int make_folder(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  for (int i = PICTURES - 1; i >= 0; i--) {
    static uint8_t bgr[H][W][3];
    char path[64];
    memset(bgr, 40 * i, sizeof bgr);
    snprintf(path, sizeof path, "%s/%s", folder, names[i]);
    vs_error err;
    if (vs_image_save(path, &bgr[0][0][0], 3 * W, W, H, &err) != VS_OK) return -1;
  }
  char path[64];
  snprintf(path, sizeof path, "%s/notes.txt", folder);
  FILE *f = fopen(path, "w");
  return f ? fclose(f) : -1;
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static void a_folder_gives_its_pictures_by_name_one_by_one_then_ends(void **state) {
  (void)state;
  vs_camera_def def = vs_camera_def_default();
  def.every_frame = true;
  def.fps = 50;
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_open(folder, &def, &camera, err));
  const vs_camera_info *info = vs_camera_about(camera);
  assert_int_equal(info->width, W);
  assert_int_equal(info->height, H);
  assert_near(info->fps, 50, 0);
  int64_t first_us = 0;
  for (int i = 0; i < PICTURES; i++) {
    assert_ok(vs_camera_read(camera, 100, &frame, &got, err));
    assert_int_equal(got, VS_CAMERA_FRAME);
    assert_int_equal(frame.seq, i);
    assert_int_equal(frame.grey[0], 40 * i);
    assert_int_equal(frame.bgr[3 * W * H - 1], 40 * i);
    if (i == 0) first_us = frame.capture_us;
    assert_int_equal(frame.capture_us - first_us, 20000 * i);
  }
  assert_ok(vs_camera_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_END);
  vs_camera_close(camera);
}

static void at_its_own_pace_a_reader_that_is_late_gets_the_newest(void **state) {
  (void)state;
  vs_camera_def def = vs_camera_def_default();
  def.fps = 100;
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_open(folder, &def, &camera, err));
  assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(frame.seq, 0);
  int64_t start_us = frame.capture_us;
  vs_clock_sleep_until_us(start_us + 25000); // frames 1 and 2 are due by now
  assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_true(frame.seq >= 2); // later on a busy machine
  assert_int_equal(frame.capture_us, start_us + 10000 * (int64_t)frame.seq);
  while (got == VS_CAMERA_FRAME) {
    assert_true(frame.capture_us <= vs_clock_monotonic_us()); // never from the future
    assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  }
  assert_int_equal(got, VS_CAMERA_END);
  vs_camera_close(camera);
}

static void a_frame_not_due_within_the_timeout_is_a_timeout(void **state) {
  (void)state;
  vs_camera_def def = vs_camera_def_default();
  def.fps = 0.1;
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_open(folder, &def, &camera, err));
  assert_ok(vs_camera_read(camera, 0, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_ok(vs_camera_read(camera, 5, &frame, &got, err)); // the next is due in 10 s
  assert_int_equal(got, VS_CAMERA_TIMEOUT);
  vs_camera_close(camera);
}

static void a_picture_alone_gives_one_frame(void **state) {
  (void)state;
  char path[64];
  snprintf(path, sizeof path, "%s/c.bmp", folder);
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_open(path, NULL, &camera, err));
  assert_string_equal(vs_camera_about(camera)->name, "c.bmp");
  assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(frame.grey[5], 80);
  assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_END);
  vs_camera_close(camera);
}

static void a_picture_of_another_size_in_the_folder_is_named(void **state) {
  (void)state;
  static uint8_t bgr[H * 2][W * 2][3];
  char path[64];
  snprintf(path, sizeof path, "%s/bb.png", folder);
  assert_ok(vs_image_save(path, &bgr[0][0][0], 6 * W, 2 * W, 2 * H, err));
  vs_camera_def def = vs_camera_def_default();
  def.every_frame = true;
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  vs_error err;
  assert_ok(vs_camera_open(folder, &def, &camera, err));
  assert_ok(vs_camera_read(camera, 0, &frame, &got, err));
  assert_ok(vs_camera_read(camera, 0, &frame, &got, err));
  assert_int_equal(vs_camera_read(camera, 0, &frame, &got, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "bb.png"));
  assert_non_null(strstr(err.text, "64 x 48"));
  vs_camera_close(camera);
  unlink(path);
}

static void sources_that_cannot_be_opened_are_named_with_what_a_source_is(void **state) {
  (void)state;
  vs_camera *camera;
  vs_error err;
  assert_int_equal(vs_camera_open("/nowhere/match.mp4", NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/match.mp4"));
  assert_non_null(strstr(err.text, "/dev/videoN"));
  assert_null(camera);
  assert_int_equal(vs_camera_open("udp:1234", NULL, &camera, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "udp:1234"));
  assert_int_equal(vs_camera_open("/dev/video987", NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/video987"));
  char path[64];
  snprintf(path, sizeof path, "%s/notes.txt", folder);
  assert_int_equal(vs_camera_open(path, NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "notes.txt"));
  char empty[] = "/tmp/vsss_camera_XXXXXX";
  assert_non_null(mkdtemp(empty));
  assert_int_equal(vs_camera_open(empty, NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "no picture"));
  rmdir(empty);
}

// A scheme of the program's own.
static int closed;
static vs_status toy_open(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                          vs_error *err) {
  (void)def;
  if (strcmp(rest, "good")) return vs_fail(err, VS_FAIL, "toy: '%s' is not good", rest);
  *handle = &closed;
  info->width = 7;
  return VS_OK;
}
static vs_status toy_read(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  (void)handle, (void)err;
  *out = (vs_frame){.seq = (uint32_t)timeout_ms};
  *got = VS_CAMERA_FRAME;
  return VS_OK;
}
static void toy_close(void *handle) { ++*(int *)handle; }

static void a_registered_scheme_is_opened_read_and_closed(void **state) {
  (void)state;
  static const vs_camera_api toy = {"toy", "toy:NAME  a toy", toy_open, toy_read, toy_close};
  vs_camera_register(&toy);
  vs_camera_register(&toy);
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  vs_error err;
  assert_int_equal(vs_camera_open("toy:bad", NULL, &camera, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "'bad'"));
  assert_ok(vs_camera_open("toy:good", NULL, &camera, err));
  assert_int_equal(vs_camera_about(camera)->width, 7);
  assert_ok(vs_camera_read(camera, 42, &frame, &got, err));
  assert_int_equal(frame.seq, 42);
  vs_camera_close(camera);
  assert_int_equal(closed, 1);
  const char *first = strstr(vs_camera_sources(), "toy:NAME");
  assert_non_null(first);
  assert_null(strstr(first + 1, "toy:NAME")); // registered twice, listed once
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_folder_gives_its_pictures_by_name_one_by_one_then_ends),
      cmocka_unit_test(at_its_own_pace_a_reader_that_is_late_gets_the_newest),
      cmocka_unit_test(a_frame_not_due_within_the_timeout_is_a_timeout),
      cmocka_unit_test(a_picture_alone_gives_one_frame),
      cmocka_unit_test(a_picture_of_another_size_in_the_folder_is_named),
      cmocka_unit_test(sources_that_cannot_be_opened_are_named_with_what_a_source_is),
      cmocka_unit_test(a_registered_scheme_is_opened_read_and_closed),
  };
  return cmocka_run_group_tests_name("vision/camera", tests, make_folder, remove_folder);
}
