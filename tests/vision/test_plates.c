// src/vision/plates.c, through src/vision/detect.c, on drawn frames
#include "assert_near.h"
#include "vision/scene.h"
#include "vsss/calib.h"
#include "vsss/geom.h"

static scene s;
static vs_calib calib;

static vs_detector *detector_of(vs_mark own, vs_mark their, bool scaled) {
  calib = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.own = own, def.their = their;
  if (scaled) def.px_per_m = vs_calib_px_per_m(&calib, VS_ROBOT_HEIGHT_M);
  vs_detector *d;
  assert_ok(vs_detector_new(&def, &d, err));
  return d;
}

static void put(int team, int index, double x_m, double y_m, double theta_rad, int code) {
  s.world.robot[team][index] = (vs_robot){.pose = {x_m, y_m, theta_rad}, .valid = true};
  scene_wear(&s, team, index, VS_MARK_COLOUR, code);
}

// Every left colour with every second right one, at headings all around, on both teams.
static void plates_are_read_with_id_place_and_heading(void **state) {
  (void)state;
  scene_init(&s, 640, 480);
  vs_detector *d = detector_of(VS_MARK_COLOUR, VS_MARK_COLOUR, true);
  for (int k = 0; k < VS_PLATE_COLOURS * VS_PLATE_COLOURS; k += 2) {
    int code[2] = {vs_plate_code(VS_BLUE, k / 4, k % 4), vs_plate_code(VS_YELLOW, (k + 1) % 4, k / 4)};
    double theta = -3 + 0.4 * k;
    put(VS_BLUE, 0, -0.3 + 0.02 * k, 0.3, theta, code[0]);
    put(VS_YELLOW, 0, 0.4, -0.5 + 0.03 * k, -theta, code[1]);
    vs_frame frame = scene_draw(&s, 0, (uint32_t)k);
    vs_detections seen;
    assert_ok(vs_detect(d, &frame, &seen, err));
    assert_int_equal(seen.tags, 2);
    assert_int_equal(seen.balls, 0);
    for (int i = 0; i < 2; i++) {
      double x, y, heading;
      assert_int_equal(seen.tag[i].kind, VS_MARK_COLOUR);
      assert_int_equal(seen.tag[i].id, code[i]);
      assert_true(vs_calib_square(&calib, seen.tag[i].corner_px, VS_ROBOT_HEIGHT_M, &x, &y, &heading));
      const vs_pose *p = &s.world.robot[i][0].pose;
      assert_near(hypot(x - p->x_m, y - p->y_m), 0, 0.003);
      assert_near(vs_wrap_rad(heading - p->theta_rad), 0, 0.06);
    }
  }
  vs_detector_free(d);
  scene_free(&s);
}

static void without_a_scale_the_bar_s_own_size_gives_it(void **state) {
  (void)state;
  scene_init(&s, 640, 480);
  vs_detector *d = detector_of(VS_MARK_COLOUR, VS_MARK_PATCH, false);
  put(VS_BLUE, 1, 0.1, 0.2, 0.7, vs_plate_code(VS_BLUE, VS_PLATE_GREEN, VS_PLATE_PINK));
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_detections seen;
  assert_ok(vs_detect(d, &frame, &seen, err));
  assert_int_equal(seen.tags, 1);
  assert_int_equal(seen.tag[0].id, 12);
  vs_detector_free(d);
  scene_free(&s);
}

// A patch alone, bars without squares: no plate, and nothing read beyond the picture's rim.
static void what_is_no_plate_gives_none(void **state) {
  (void)state;
  scene_init(&s, 640, 480);
  memset(&s.world, 0, sizeof s.world);
  vs_detector *d = detector_of(VS_MARK_COLOUR, VS_MARK_COLOUR, true);
  s.world.robot[VS_YELLOW][0] = (vs_robot){.pose = {0.2, 0.2, 0.3}, .valid = true}; // a patch of 60 mm
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_image image = {s.bgr, 640, 480, 3 * 640};
  vs_image_line(&image, 5, 100, 5, 112, 10, scene_blue);     // at the rim
  vs_image_line(&image, 300, 300, 312, 300, 10, scene_blue); // in the open
  vs_detections seen;
  assert_ok(vs_detect(d, &frame, &seen, err));
  assert_int_equal(seen.tags, 0);
  vs_detector_free(d);
  scene_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plates_are_read_with_id_place_and_heading),
      cmocka_unit_test(without_a_scale_the_bar_s_own_size_gives_it),
      cmocka_unit_test(what_is_no_plate_gives_none),
  };
  return cmocka_run_group_tests_name("vision/plates", tests, NULL, NULL);
}
