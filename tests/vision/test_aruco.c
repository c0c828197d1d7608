// src/vision/aruco.c
#include <string.h>

#include "assert_near.h"
#include "vision/aruco.h"

// The league's six as OpenCV 4.6 draws DICT_ARUCO_ORIGINAL: # light, . dark.
static const struct {
  int id;
  const char *row[7];
} drawn[] = {
    {256, {".......", ".#.###.", ".#.....", ".#.....", ".#.....", ".#.....", "......."}},
    {272, {".......", ".#.###.", ".#.....", ".#.###.", ".#.....", ".#.....", "......."}},
    {273, {".......", ".#.###.", ".#.....", ".#.###.", ".#.....", ".#.###.", "......."}},
    {955, {".......", "..###..", "..#..#.", "..###..", "..#..#.", "..###..", "......."}},
    {771, {".......", "..###..", ".#.....", ".#.....", ".#.....", "..###..", "......."}},
    {939, {".......", "..###..", "..#..#.", "..#..#.", "..#..#.", "..###..", "......."}},
};

static void the_league_s_marks_are_as_opencv_draws_them(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof drawn / sizeof *drawn; i++) {
    vs_tag_pattern p;
    assert_ok(vs_aruco_pattern(drawn[i].id, &p, err));
    assert_int_equal(p.cells, 7);
    assert_int_equal(p.border_cells, 7);
    for (int k = 0; k < 49; k++) assert_int_equal(p.cell[k / 7][k % 7], drawn[i].row[k / 7][k % 7] == '#' ? 255 : 0);
    assert_int_equal(drawn[i].id, vs_aruco_league_id[i / 3][i % 3]);
  }
}

// One corrected bit is safe where any two marks, however turned, differ in three bits or more.
static void any_two_of_the_league_s_marks_differ_in_three_bits_or_more_however_turned(void **state) {
  (void)state;
  int least = 25;
  for (size_t a = 0; a < 6; a++)
    for (size_t b = 0; b < 6; b++)
      for (int turns = a == b; turns < 4; turns++) {
        int differ = 0;
        for (int k = 0; k < 49; k++) {
          int row = k / 7, column = k % 7;
          for (int t = 0; t < turns; t++) {
            int old = row;
            row = 6 - column;
            column = old;
          }
          differ += vs_aruco_light(drawn[a].id, k / 7, k % 7) != vs_aruco_light(drawn[b].id, row, column);
        }
        if (differ < least) least = differ;
      }
  assert_int_equal(least, 3);
}

static void an_id_that_is_none_is_refused(void **state) {
  (void)state;
  vs_tag_pattern p;
  vs_error err;
  assert_int_equal(vs_aruco_pattern(1024, &p, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "0 to 1023"));
  assert_int_equal(vs_aruco_pattern(-1, &p, &err), VS_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_league_s_marks_are_as_opencv_draws_them),
      cmocka_unit_test(any_two_of_the_league_s_marks_differ_in_three_bits_or_more_however_turned),
      cmocka_unit_test(an_id_that_is_none_is_refused),
  };
  return cmocka_run_group_tests_name("vision/aruco", tests, NULL, NULL);
}
