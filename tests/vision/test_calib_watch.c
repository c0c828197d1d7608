// src/vision/calib_watch.c, on drawn frames
#include "assert_near.h"
#include "vision/scene.h"
#include "vsss/calib_watch.h"

static scene s;

static vs_frame full_field(int width, int height) {
  scene_init(&s, width, height);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    s.world.robot[i / 3][i % 3] =
        (vs_robot){.pose = {-0.5 + 0.5 * (i % 3), i < 3 ? 0.3 : -0.25, 0.7 * i}, .valid = true};
  s.world.ball = (vs_ball){.x_m = 0.1, .y_m = 0.05, .valid = true};
  return scene_draw(&s, 0, 0);
}

static vs_calib_watch_result check(const vs_calib *c, const vs_frame *frame) {
  vs_calib_watch *w;
  assert_ok(vs_calib_watch_new(c, &w, err));
  vs_calib_watch_result r = vs_calib_watch_check(w, frame);
  vs_calib_watch_free(w);
  return r;
}

static void a_camera_that_did_not_move_is_within_a_few_millimetres(void **state) {
  (void)state;
  const int size[2][2] = {{640, 480}, {1280, 720}};
  for (int i = 0; i < 2; i++) {
    vs_frame frame = full_field(size[i][0], size[i][1]);
    vs_calib c = vs_calib_overhead(size[i][0], size[i][1], s.height_m, scene_fov_rad(&s));
    vs_calib_watch_result r = check(&c, &frame);
    assert_true(r.sure);
    assert_true(r.lines);
    assert_true(r.error_mm < VS_CALIB_WATCH_WARN_MM);
    scene_free(&s);
  }
}

static void a_moved_camera_is_told_with_how_far(void **state) {
  (void)state;
  vs_frame frame = full_field(640, 480);
  const double shift[][2] = {{0.03, 0}, {0, -0.05}, {0.12, 0.08}, {-0.3, 0.02}};
  for (size_t i = 0; i < sizeof shift / sizeof *shift; i++) {
    vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
    // The calibration has the field shift to the left of, or below, where it is seen.
    c.translation_m[0] -= shift[i][0];
    c.translation_m[1] += shift[i][1];
    vs_calib_watch_result r = check(&c, &frame);
    assert_true(r.sure);
    assert_near(r.x_m, shift[i][0], 0.008);
    assert_near(r.y_m, shift[i][1], 0.008);
    assert_near(r.error_mm, 1000 * hypot(shift[i][0], shift[i][1]), 20);
    assert_true(r.error_mm > VS_CALIB_WATCH_WARN_MM);
  }
  scene_free(&s);
}

static void a_turned_camera_is_told(void **state) {
  (void)state;
  vs_frame frame = full_field(640, 480);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  double a = 0.035; // 2 degrees: 35 mm at a corner
  const double r[3][3] = {{cos(a), sin(a), 0}, {sin(a), -cos(a), 0}, {0, 0, -1}};
  memcpy(c.rotation, r, sizeof r);
  vs_calib_watch_result found = check(&c, &frame);
  assert_true(found.sure);
  assert_near(fabs(found.turn_rad), a, 0.009);
  assert_near(found.error_mm, 35, 12);
  scene_free(&s);
}

static void a_picture_of_nothing_says_nothing(void **state) {
  (void)state;
  static uint8_t grey[640 * 480];
  vs_frame frame = {.grey = grey, .width = 640, .height = 480, .grey_stride = 640};
  vs_calib c = vs_calib_overhead(640, 480, 2.2, 0.66);
  assert_false(check(&c, &frame).sure);
  vs_rng rng = vs_rng_make(1, 1);
  for (int i = 0; i < 640 * 480; i++) grey[i] = (uint8_t)(40 + 20 * vs_rng_uniform(&rng));
  assert_false(check(&c, &frame).sure);
  frame.width = 320;
  assert_false(check(&c, &frame).sure); // another size
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_camera_that_did_not_move_is_within_a_few_millimetres),
      cmocka_unit_test(a_moved_camera_is_told_with_how_far),
      cmocka_unit_test(a_turned_camera_is_told),
      cmocka_unit_test(a_picture_of_nothing_says_nothing),
  };
  return cmocka_run_group_tests_name("vision/calib_watch", tests, NULL, NULL);
}
