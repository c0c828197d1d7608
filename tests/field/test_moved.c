// src/field/moved.c
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "field/moved.h"
#include "vision/scene.h"

static void a_camera_that_moves_is_told_once_and_again_when_it_moves_on(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_frame still = scene_draw(&s, 1000000, 0);
  static uint8_t grey[640 * 480];
  vs_frame moved = still; // 20 px to the right, 60 mm
  moved.grey = grey;
  for (int y = 0; y < 480; y++) memcpy(grey + 640 * y + 20, still.grey + 640 * y, 620);
  vs_moved m = {0};
  assert_null(vs_moved_look(&m, &still)); // no calibration
  assert_ok(vs_moved_open(&m, &c, err));
  assert_null(vs_moved_look(&m, &still));
  moved.capture_us = still.capture_us + VS_MOVED_PERIOD_US - 1;
  assert_null(vs_moved_look(&m, &moved)); // not due
  moved.capture_us++;
  const char *said = vs_moved_look(&m, &moved);
  double mm;
  assert_non_null(said);
  assert_int_equal(sscanf(strstr(said, "up to "), "up to %lf mm", &mm), 1);
  assert_near(mm, 20 / (s.focal_px / s.height_m) * 1000, 10);
  moved.capture_us += VS_MOVED_PERIOD_US;
  assert_null(vs_moved_look(&m, &moved)); // told already
  still.capture_us = moved.capture_us + VS_MOVED_PERIOD_US;
  assert_null(vs_moved_look(&m, &still)); // put back
  moved.capture_us = still.capture_us + VS_MOVED_PERIOD_US;
  assert_non_null(vs_moved_look(&m, &moved));
  vs_moved_close(&m);
  scene_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_camera_that_moves_is_told_once_and_again_when_it_moves_on),
  };
  return cmocka_run_group_tests_name("field/moved", tests, NULL, NULL);
}
