// src/vision/calib_solve.c and src/vision/calib_opencv.cpp
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vision/board.h"
#include "vsss/calib.h"
#include "vsss/field.h"
#include "vsss/rng.h"

// A camera 3 cm off the middle, turned by 0.1 rad about the vertical and tilted by 0.08 rad, with a wide lens.
static vs_calib venue(void) {
  vs_calib c = vs_calib_overhead(1280, 720, 2.2, 0.75);
  double a = cos(0.08), b = sin(0.08), d = cos(0.1), e = sin(0.1);
  const double r[3][3] = {{d, e, 0}, {a * e, -a * d, b}, {b * e, -b * d, -a}};
  memcpy(c.rotation, r, sizeof r);
  c.translation_m[0] = 0.03, c.translation_m[1] = 0.02, c.translation_m[2] = 2.17;
  c.k1 = -0.2, c.k2 = 0.05;
  return c;
}

static int measure(const vs_calib *c, double noise_px, vs_calib_point *out) {
  const double xs[] = {-0.75, -0.375, 0, 0.375, 0.75}, ys[] = {-0.65, 0, 0.65};
  vs_rng rng = vs_rng_make(3, 0);
  int n = 0;
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 3; j++) {
      vs_calib_point *p = &out[n++];
      *p = (vs_calib_point){0, 0, xs[i], ys[j], j == 1 ? VS_WALL_HEIGHT_M : 0};
      assert_true(vs_calib_to_pixel(c, p->x_m, p->y_m, p->z_m, &p->x_px, &p->y_px));
      p->x_px += noise_px * vs_rng_normal(&rng);
      p->y_px += noise_px * vs_rng_normal(&rng);
    }
  return n;
}

static void exact_points_give_back_the_camera(void **state) {
  (void)state;
  vs_calib truth = venue(), solved = vs_calib_overhead(1280, 720, 1.0, 0.75);
  solved.k1 = truth.k1, solved.k2 = truth.k2;
  vs_calib_point points[16];
  int n = measure(&truth, 0.0, points);
  assert_ok(vs_calib_solve_pose(&solved, points, n, err));
  double a[3], b[3];
  vs_calib_lens(&truth, a);
  vs_calib_lens(&solved, b);
  for (int i = 0; i < 3; i++) assert_near(b[i], a[i], 1e-4);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) assert_near(solved.rotation[i][j], truth.rotation[i][j], 1e-4);
  assert_int_equal(solved.points, n);
  assert_near(solved.rms_mm, 0, 0.05);
}

static void points_clicked_with_half_a_pixel_of_error_give_a_field_within_2_mm(void **state) {
  (void)state;
  vs_calib truth = venue(), solved = truth;
  vs_calib_point points[16];
  int n = measure(&truth, 0.5, points);
  assert_ok(vs_calib_solve_pose(&solved, points, n, err));
  // A pixel is 2.2 m / 915 px = 2.4 mm: each pair is off by about 0.5 px * 2.4 mm * sqrt(2) = 1.7 mm, the fit by less.
  assert_near(solved.rms_mm, 1.5, 0.8);
  for (double x = -0.7; x <= 0.7; x += 0.35)
    for (double y = -0.6; y <= 0.6; y += 0.3) {
      double px, py, fx, fy;
      assert_true(vs_calib_to_pixel(&truth, x, y, 0.08, &px, &py));
      assert_true(vs_calib_to_field(&solved, px, py, 0.08, &fx, &fy));
      assert_near(hypot(fx - x, fy - y), 0, 0.002);
    }
}

static void three_points_a_line_of_points_and_swapped_points_are_refused(void **state) {
  (void)state;
  vs_calib truth = venue(), solved = truth;
  vs_calib_point points[16];
  vs_error err;
  measure(&truth, 0.0, points);
  assert_int_equal(vs_calib_solve_pose(&solved, points, 3, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "at least 4"));
  vs_calib_point line[5];
  for (int i = 0; i < 5; i++) line[i] = points[3 * i];
  assert_int_equal(vs_calib_solve_pose(&solved, line, 5, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "one line"));
  vs_calib_point swapped = points[0];
  points[0] = points[14];
  points[0].x_m = swapped.x_m, points[0].y_m = swapped.y_m;
  assert_int_equal(vs_calib_solve_pose(&solved, points, 15, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "swapped"));
  assert_near(solved.translation_m[2], truth.translation_m[2], 0); // a refused solution changes nothing
}

static void a_checkerboard_in_several_poses_gives_focal_length_and_distortion(void **state) {
  (void)state;
  vs_calib_board *board;
  assert_ok(vs_calib_board_new(BOARD_COLUMNS, BOARD_ROWS, BOARD_SQUARE_M, &board, err));
  unsigned char *grey = malloc(BOARD_WIDTH * BOARD_HEIGHT);
  assert_non_null(grey);
  int seen = 0;
  for (int pose = 0; pose < 7; pose++) {
    board_draw(pose, grey);
    bool found;
    assert_ok(vs_calib_board_add(board, grey, BOARD_WIDTH, BOARD_WIDTH, BOARD_HEIGHT, &found, err));
    seen += found;
  }
  assert_true(seen >= 6);
  bool found;
  vs_error err;
  assert_int_equal(vs_calib_board_add(board, grey, BOARD_WIDTH / 2, BOARD_WIDTH / 2, BOARD_HEIGHT / 2, &found, &err),
                   VS_FAIL);
  assert_non_null(strstr(err.text, "one size"));
  vs_calib solved = {0};
  assert_ok(vs_calib_board_solve(board, &solved, err));
  // fovy 0.9: 240 / tan(0.45) = 496.9 px.
  assert_near(solved.fx_px, 496.9, 4);
  assert_near(solved.fy_px, 496.9, 4);
  assert_near(solved.cx_px, 326, 3);
  assert_near(solved.cy_px, 236, 3);
  assert_near(solved.k1, -0.15, 0.05);
  assert_true(solved.intrinsics_rms_px < 0.2);
  assert_int_equal(solved.width, BOARD_WIDTH);
  free(grey);
  vs_calib_board_free(board);
}

static void too_few_pictures_and_a_silly_board_are_refused(void **state) {
  (void)state;
  vs_calib_board *board;
  vs_error err;
  assert_int_equal(vs_calib_board_new(2, 5, 0.03, &board, &err), VS_USAGE);
  assert_int_equal(vs_calib_board_new(7, 5, 0.0, &board, &err), VS_USAGE);
  assert_ok(vs_calib_board_new(7, 5, 0.03, &board, err));
  vs_calib c = {0};
  assert_int_equal(vs_calib_board_solve(board, &c, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "at least 3"));
  vs_calib_board_free(board);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_points_give_back_the_camera),
      cmocka_unit_test(points_clicked_with_half_a_pixel_of_error_give_a_field_within_2_mm),
      cmocka_unit_test(three_points_a_line_of_points_and_swapped_points_are_refused),
      cmocka_unit_test(a_checkerboard_in_several_poses_gives_focal_length_and_distortion),
      cmocka_unit_test(too_few_pictures_and_a_silly_board_are_refused),
  };
  return cmocka_run_group_tests_name("vision/calib_solve", tests, NULL, NULL);
}
