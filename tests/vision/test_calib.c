// src/vision/calib.c
#include <string.h>

#include "assert_near.h"
#include "vsss/calib.h"
#include "vsss/geom.h"

// 640 x 480 at 2.2 m, focal length 480 px: fovy = 2 atan(240 / 480).
static vs_calib overhead(void) { return vs_calib_overhead(640, 480, 2.2, 2 * atan(0.5)); }

static void the_middle_of_the_picture_is_the_middle_of_the_field_at_any_height(void **state) {
  (void)state;
  vs_calib c = overhead();
  assert_near(c.fx_px, 480, 1e-9);
  double x, y;
  for (double h = 0; h < 0.2; h += 0.04) {
    assert_true(vs_calib_to_field(&c, 320, 240, h, &x, &y));
    assert_near(x, 0, 1e-12);
    assert_near(y, 0, 1e-12);
  }
}

static void picture_right_is_plus_x_and_picture_up_is_plus_y(void **state) {
  (void)state;
  vs_calib c = overhead();
  double x, y;
  // 480 px from the middle is 45 degrees: 48 px right are 2.2 * 48 / 480 = 0.22 m, 96 px up are 0.44 m.
  assert_true(vs_calib_to_field(&c, 368, 144, 0, &x, &y));
  assert_near(x, 0.22, 1e-12);
  assert_near(y, 0.44, 1e-12);
}

static void a_cap_in_the_corner_is_corrected_by_37_mm(void **state) {
  (void)state;
  vs_calib c = overhead();
  double px, py, x, y;
  // A cap 8 cm high at (0.75, 0.65) appears on the floor too far out by r h / (H - h) = 0.9925 * 0.08 / 2.12 = 37.5 mm.
  assert_true(vs_calib_to_pixel(&c, 0.75, 0.65, 0.08, &px, &py));
  assert_true(vs_calib_to_field(&c, px, py, 0, &x, &y));
  assert_near(hypot(x, y) - hypot(0.75, 0.65), 0.03745, 1e-5);
  assert_true(vs_calib_to_field(&c, px, py, 0.08, &x, &y));
  assert_near(x, 0.75, 1e-12);
  assert_near(y, 0.65, 1e-12);
}

static void pixels_per_metre_is_focal_length_over_distance(void **state) {
  (void)state;
  vs_calib c = overhead();
  assert_near(vs_calib_px_per_m(&c, 0), 480 / 2.2, 0.01);
  assert_near(vs_calib_px_per_m(&c, 0.08), 480 / 2.12, 0.01);
}

// A turned, tilted, distorted camera: what it sees is mapped back.
static void a_tilted_camera_with_distortion_maps_there_and_back(void **state) {
  (void)state;
  vs_calib c = overhead();
  c.k1 = -0.28, c.k2 = 0.09, c.p1 = 0.001, c.p2 = -0.0015, c.k3 = -0.01;
  // Rows of a rotation: 0.1 rad about x after 0.3 rad about z after the overhead one, worked out as a product.
  double a = cos(0.1), b = sin(0.1), d = cos(0.3), e = sin(0.3);
  const double r[3][3] = {{d, e, 0}, {a * e, -a * d, b}, {b * e, -b * d, -a}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c.rotation[i][j] = r[i][j];
  c.translation_m[0] = 0.1, c.translation_m[1] = -0.05, c.translation_m[2] = 2.3;
  for (double x = -0.8; x <= 0.8; x += 0.2)
    for (double y = -0.7; y <= 0.7; y += 0.2)
      for (double z = 0; z <= 0.08; z += 0.04) {
        double px, py, fx, fy;
        assert_true(vs_calib_to_pixel(&c, x, y, z, &px, &py));
        assert_true(vs_calib_to_field(&c, px, py, z, &fx, &fy));
        assert_near(fx, x, 1e-7);
        assert_near(fy, y, 1e-7);
      }
}

static void a_square_s_corners_give_its_middle_and_the_way_its_top_shows(void **state) {
  (void)state;
  vs_calib c = overhead();
  c.k1 = -0.2;
  // Corners bottom left, bottom right, top right, top left of a square of 40 mm that shows 0.6 rad to the left of +x.
  const double u[4] = {-0.02, -0.02, 0.02, 0.02}, v[4] = {0.02, -0.02, -0.02, 0.02};
  double corner[4][2], x, y, theta;
  for (int i = 0; i < 4; i++)
    assert_true(vs_calib_to_pixel(&c, 0.6 + cos(0.6) * u[i] - sin(0.6) * v[i], -0.5 + sin(0.6) * u[i] + cos(0.6) * v[i],
                                  0.08, &corner[i][0], &corner[i][1]));
  assert_true(vs_calib_square(&c, corner, 0.08, &x, &y, &theta));
  assert_near(x, 0.6, 1e-7);
  assert_near(y, -0.5, 1e-7);
  assert_near(theta, 0.6, 1e-6);
  assert_false(vs_calib_square(&c, corner, 3.0, &x, &y, &theta)); // above the camera
}

static void the_lens_is_where_the_pose_says(void **state) {
  (void)state;
  vs_calib c = overhead();
  double lens[3];
  vs_calib_lens(&c, lens);
  assert_near(lens[0], 0, 1e-12);
  assert_near(lens[1], 0, 1e-12);
  assert_near(lens[2], 2.2, 1e-12);
}

static void a_ray_that_misses_the_plane_is_refused(void **state) {
  (void)state;
  vs_calib c = overhead();
  double x, y;
  assert_false(vs_calib_to_field(&c, 320, 240, 3.0, &x, &y)); // above the camera
  assert_false(vs_calib_to_pixel(&c, 0, 0, 2.5, &x, &y));     // behind it
}

static void another_picture_size_is_refused_with_both_sizes(void **state) {
  (void)state;
  vs_calib c = overhead();
  vs_error err;
  assert_int_equal(vs_calib_check_size(&c, "venue.ini", 640, 480, &err), VS_OK);
  assert_int_equal(vs_calib_check_size(&c, "venue.ini", 1280, 720, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "venue.ini"));
  assert_non_null(strstr(err.text, "640 x 480"));
  assert_non_null(strstr(err.text, "1280 x 720"));
  assert_non_null(strstr(err.text, "vsss calibrate"));
}

static void the_error_of_a_pair_is_in_mm_on_its_plane(void **state) {
  (void)state;
  vs_calib c = overhead();
  // 48 px right of the middle is x = 0.22 on the floor; said to be at (0.223, 0.004): 3 and 4 mm off make 5.
  vs_calib_point p = {368, 240, 0.223, 0.004, 0};
  assert_near(vs_calib_error_mm(&c, &p), 5.0, 1e-9);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_middle_of_the_picture_is_the_middle_of_the_field_at_any_height),
      cmocka_unit_test(picture_right_is_plus_x_and_picture_up_is_plus_y),
      cmocka_unit_test(a_cap_in_the_corner_is_corrected_by_37_mm),
      cmocka_unit_test(pixels_per_metre_is_focal_length_over_distance),
      cmocka_unit_test(a_tilted_camera_with_distortion_maps_there_and_back),
      cmocka_unit_test(a_square_s_corners_give_its_middle_and_the_way_its_top_shows),
      cmocka_unit_test(the_lens_is_where_the_pose_says),
      cmocka_unit_test(a_ray_that_misses_the_plane_is_refused),
      cmocka_unit_test(another_picture_size_is_refused_with_both_sizes),
      cmocka_unit_test(the_error_of_a_pair_is_in_mm_on_its_plane),
  };
  return cmocka_run_group_tests_name("vision/calib", tests, NULL, NULL);
}
