// src/vision/mark.c
#include <string.h>

#include "assert_near.h"
#include "vsss/mark.h"

static const uint8_t *at(const vs_mark_picture *p, int row, int column) { return p->rgb + 3 * (row * p->px + column); }

static void the_league_s_marks_are_white_on_blue_and_yellow_on_black(void **state) {
  (void)state;
  static vs_mark_picture p;
  assert_ok(vs_mark_paint(VS_MARK_ARUCO, VS_BLUE, 256, &p, err));
  assert_int_equal(p.px, 7);
  assert_near(p.size_m, 0.07, 1e-12);
  const uint8_t *corner = at(&p, 0, 0), *light = at(&p, 1, 1); // 256 begins ".#.###." in its second row
  assert_true(corner[2] > 200 && corner[0] < 60 && corner[1] < 110);
  assert_true(light[0] == 255 && light[1] == 255 && light[2] == 255);
  assert_ok(vs_mark_paint(VS_MARK_ARUCO, VS_YELLOW, 955, &p, err));
  corner = at(&p, 0, 0), light = at(&p, 1, 2);
  assert_true(corner[0] + corner[1] + corner[2] == 0);
  assert_true(light[0] > 200 && light[1] > 180 && light[2] < 60);
}

static void a_patch_is_the_team_s_colour_in_the_middle_60_mm(void **state) {
  (void)state;
  static vs_mark_picture p;
  assert_ok(vs_mark_paint(VS_MARK_PATCH, VS_YELLOW, 0, &p, err));
  int coloured = 0;
  for (int i = 0; i < p.px * p.px; i++) coloured += at(&p, i / p.px, i % p.px)[0] > 200;
  assert_near(sqrt((double)coloured) / p.px * p.size_m, 0.06, 1e-9);
}

static void each_side_wears_what_it_can(void **state) {
  (void)state;
  vs_mark mark;
  vs_error err;
  assert_int_equal(vs_mark_parse("--own-tags", "aruco", false, &mark, &err), VS_OK);
  assert_int_equal(mark, VS_MARK_ARUCO);
  assert_int_equal(vs_mark_parse("--their-tags", "patch", true, &mark, &err), VS_OK);
  assert_int_equal(mark, VS_MARK_PATCH);
  assert_int_equal(vs_mark_parse("--own-tags", "patch", false, &mark, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "--own-tags patch"));
  assert_int_equal(vs_mark_parse("--their-tags", "april", true, &mark, &err), VS_USAGE);
}

static void plates_have_codes_by_their_colours_names(void **state) {
  (void)state;
  int code;
  vs_error err;
  assert_int_equal(vs_plate_parse("x", "pink cyan", VS_YELLOW, &code, &err), VS_OK);
  assert_int_equal(code, 123);
  assert_int_equal(vs_plate_parse("x", "-", VS_YELLOW, &code, &err), VS_OK);
  assert_int_equal(code, -1);
  assert_int_equal(vs_plate_parse("vision.blue0_plate =", "pink", VS_BLUE, &code, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "vision.blue0_plate = pink"));
  assert_int_equal(vs_plate_parse("x", "red green pink", VS_BLUE, &code, &err), VS_USAGE);
  assert_int_equal(vs_plate_parse("x", "red brown", VS_BLUE, &code, &err), VS_USAGE);
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_int_equal(vs_plate_default_code(VS_BLUE, i), 11 * i + 1);
}

static void an_id_that_is_none_is_refused(void **state) {
  (void)state;
  static vs_mark_picture p;
  vs_error err;
  assert_int_equal(vs_mark_paint(VS_MARK_ARUCO, VS_BLUE, 1024, &p, &err), VS_USAGE);
  assert_int_equal(vs_mark_paint(VS_MARK_COLOUR, VS_BLUE, 4, &p, &err), VS_USAGE);
  assert_int_equal(vs_mark_paint(VS_MARK_COLOUR, VS_BLUE, 201, &p, &err), VS_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_league_s_marks_are_white_on_blue_and_yellow_on_black),
      cmocka_unit_test(a_patch_is_the_team_s_colour_in_the_middle_60_mm),
      cmocka_unit_test(each_side_wears_what_it_can),
      cmocka_unit_test(plates_have_codes_by_their_colours_names),
      cmocka_unit_test(an_id_that_is_none_is_refused),
  };
  return cmocka_run_group_tests_name("vision/mark", tests, NULL, NULL);
}
