// src/vision/calib_file.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/calib.h"

static char path[] = "/tmp/vsss_calib_XXXXXX";

static int make_file(void **state) {
  (void)state;
  int fd = mkstemp(path);
  return fd < 0 ? -1 : close(fd);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

static void write_text(const char *text) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static void what_is_saved_is_loaded(void **state) {
  (void)state;
  // Straight down, where the rotation is half a turn and a careless conversion divides by zero; and turned cameras.
  for (int turn = 0; turn < 8; turn++) {
    vs_calib a = vs_calib_overhead(1280, 720, 2.15, 0.62), b;
    double c = cos(0.8 * turn), s = sin(0.8 * turn);
    const double r[3][3] = {{c, s, 0}, {s, -c, 0}, {0, 0, -1}};
    memcpy(a.rotation, r, sizeof r);
    a.translation_m[0] = 0.02 * turn;
    snprintf(a.camera, sizeof a.camera, "HD; cam #2");
    snprintf(a.date, sizeof a.date, "2026-11-22T10:00:00Z");
    a.k1 = -0.31, a.k2 = 0.11, a.p1 = 2e-4, a.p2 = -3e-4, a.k3 = 0.01;
    a.intrinsics_rms_px = 0.21, a.points = 9, a.rms_mm = 1.75, a.worst_mm = 3.5;
    assert_ok(vs_calib_save(path, &a, err));
    assert_ok(vs_calib_load(path, &b, err));
    assert_string_equal(b.camera, "HD_ cam _2"); // what would begin a comment is replaced
    assert_string_equal(b.date, a.date);
    assert_int_equal(b.width, 1280);
    assert_int_equal(b.height, 720);
    assert_int_equal(b.points, 9);
    assert_near(b.rms_mm, 1.75, 1e-6);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) assert_near(b.rotation[i][j], a.rotation[i][j], 1e-10);
    double px, py, x, y;
    assert_true(vs_calib_to_pixel(&a, 0.6, -0.5, 0.08, &px, &py));
    assert_true(vs_calib_to_field(&b, px, py, 0.08, &x, &y));
    assert_near(x, 0.6, 1e-6);
    assert_near(y, -0.5, 1e-6);
  }
}

static void a_part_that_is_missing_is_named(void **state) {
  (void)state;
  vs_calib c;
  vs_error err;
  write_text("[camera]\nwidth_px = 640\nheight_px = 480\n[lens]\nfx_px = 500\nfy_px = 500\n");
  assert_int_equal(vs_calib_load(path, &c, &err), VS_FAIL);
  assert_non_null(strstr(err.text, path));
  assert_non_null(strstr(err.text, "pose.x_m"));
}

static void an_unknown_key_and_a_bad_value_are_named_with_their_line(void **state) {
  (void)state;
  vs_calib c;
  vs_error err;
  write_text("[camera]\nwidth_px = 640\nhight_px = 480\n");
  assert_int_equal(vs_calib_load(path, &c, &err), VS_USAGE);
  assert_non_null(strstr(err.text, ":3"));
  assert_non_null(strstr(err.text, "camera.height_px"));
  write_text("[pose]\nz_m = -2\n");
  assert_int_equal(vs_calib_load(path, &c, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "0.1 to 20"));
}

static void no_file_and_no_folder_are_errors_that_name_the_path(void **state) {
  (void)state;
  vs_calib c = vs_calib_overhead(640, 480, 2, 0.8);
  vs_error err;
  assert_int_equal(vs_calib_load("/nowhere/venue.ini", &c, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/venue.ini"));
  assert_int_equal(vs_calib_save("/nowhere/venue.ini", &c, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/venue.ini"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_saved_is_loaded),
      cmocka_unit_test(a_part_that_is_missing_is_named),
      cmocka_unit_test(an_unknown_key_and_a_bad_value_are_named_with_their_line),
      cmocka_unit_test(no_file_and_no_folder_are_errors_that_name_the_path),
  };
  return cmocka_run_group_tests_name("vision/calib_file", tests, make_file, remove_file);
}
