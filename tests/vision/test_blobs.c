// src/vision/blobs.c
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vision/blobs.h"
#include "vsss/image.h"

enum { W = 160, H = 120, BIT = 1 };
static uint8_t pixels[H][W][3], table[VS_COLOUR_TABLE];
static const uint8_t orange[3] = {20, 110, 235};
static const vs_colour orange_range = {5, 40, 0.5, 0.3};

static vs_frame blank(void) {
  memset(pixels, 20, sizeof pixels);
  memset(table, 0, sizeof table);
  vs_colour_table_add(table, &orange_range, BIT);
  return (vs_frame){.bgr = &pixels[0][0][0], .width = W, .height = H, .bgr_stride = 3 * W};
}

static void disc(double x, double y, double radius) {
  vs_image image = {&pixels[0][0][0], W, H, 3 * W};
  vs_image_disc(&image, x, y, radius, orange);
}

static void rectangle(int x0, int y0, int x1, int y1) {
  for (int y = y0; y < y1; y++)
    for (int x = x0; x < x1; x++) memcpy(pixels[y][x], orange, 3);
}

static int find(const vs_frame *frame, const vs_blob_gate *gate, int step, vs_blob *out, int capacity) {
  vs_blob_finder *finder = vs_blob_finder_new();
  assert_non_null(finder);
  int count = -1;
  assert_ok(vs_blobs_find(finder, frame, table, gate, step, out, capacity, &count, err));
  vs_blob_finder_free(finder);
  return count;
}

static bool classed(uint8_t b, uint8_t g, uint8_t r) { return table[(b >> 3) << 10 | (g >> 3) << 5 | (r >> 3)] & BIT; }

static void the_table_holds_the_hues_of_its_range_only(void **state) {
  (void)state;
  blank();
  assert_true(classed(20, 110, 235));   // orange: hue 25
  assert_false(classed(30, 210, 230));  // yellow: hue 54
  assert_false(classed(200, 80, 25));   // blue
  assert_false(classed(120, 120, 120)); // grey: no saturation
  assert_false(classed(0, 15, 30));     // hue 30, but too dark
}

static void a_range_may_wrap_through_red(void **state) {
  (void)state;
  const vs_colour red = {350, 10, 0.5, 0.3};
  memset(table, 0, sizeof table);
  vs_colour_table_add(table, &red, BIT);
  assert_true(classed(20, 20, 230));
  assert_true(classed(40, 20, 230)); // hue 354
  assert_true(classed(20, 40, 230)); // hue 6
  assert_false(classed(20, 110, 235));
  assert_false(classed(230, 20, 20));
}

static void a_disc_is_found_in_its_middle_with_its_area(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 0, 12, 1e4, 1, 2};
  vs_blob seen[4];
  for (int step = 1; step <= 4; step++)
    for (double x = 40; x < 44; x += 0.7) {
      vs_frame frame = blank();
      disc(x, 61.3, 8);
      assert_int_equal(find(&frame, &gate, step, seen, 4), 1);
      assert_near(seen[0].x_px, x, 0.15);
      assert_near(seen[0].y_px, 61.3, 0.15);
      assert_near(seen[0].area_px, M_PI * 64, 5);
      assert_near(seen[0].elongation, 1, 0.05);
    }
}

static void sizes_and_shapes_outside_the_gate_are_left_out(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 200, 60, 320, 1, 2.2};
  vs_blob seen[8];
  vs_frame frame = blank();
  disc(20, 20, 3);             // 28 px: too small
  disc(60, 60, 15);            // 707 px: too big
  rectangle(100, 10, 150, 14); // 200 px, but 50 x 4
  disc(120, 90, 8);
  assert_int_equal(find(&frame, &gate, 2, seen, 8), 1);
  assert_near(seen[0].x_px, 120, 0.2);
}

static void the_best_of_several_comes_first(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 200, 60, 320, 1, 2.2};
  vs_blob seen[8];
  vs_frame frame = blank();
  disc(30, 30, 5.5);
  disc(120, 90, 8);
  disc(30, 100, 6.5);
  assert_int_equal(find(&frame, &gate, 2, seen, 8), 3);
  assert_near(seen[0].y_px, 90, 0.2);
  assert_near(seen[1].y_px, 100, 0.2);
  assert_near(seen[2].y_px, 30, 0.2);
}

static void two_patches_that_touch_are_cut_into_two(void **state) {
  (void)state;
  // Patches of 14 x 14 px: 196 each. Side by side, then corner over side.
  const vs_blob_gate gate = {BIT, 196, 60, 314, 3, 2.2};
  vs_blob seen[4];
  vs_frame frame = blank();
  rectangle(50, 40, 64, 54);
  rectangle(64, 40, 78, 54);
  assert_int_equal(find(&frame, &gate, 3, seen, 4), 2);
  double left = fmin(seen[0].x_px, seen[1].x_px), right = fmax(seen[0].x_px, seen[1].x_px);
  assert_near(left, 57, 0.2);
  assert_near(right, 71, 0.2);
  assert_near(seen[0].y_px, 47, 0.2);
  frame = blank();
  rectangle(50, 40, 64, 54);
  rectangle(64, 48, 78, 62);
  rectangle(78, 56, 92, 70);
  assert_int_equal(find(&frame, &gate, 3, seen, 4), 3);
  for (int i = 0; i < 3; i++) {
    int k = (int)((seen[i].x_px - 50) / 14);
    assert_near(seen[i].x_px, 57 + 14 * k, 1.0);
    assert_near(seen[i].y_px, 47 + 8 * k, 1.0);
  }
}

static void a_heap_larger_than_a_team_is_left_out(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 196, 60, 314, 3, 2.2};
  vs_blob seen[4];
  vs_frame frame = blank();
  rectangle(20, 20, 120, 100);
  assert_int_equal(find(&frame, &gate, 3, seen, 4), 0);
}

static void a_blob_at_the_border_and_a_picture_of_one_colour_are_survived(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 0, 12, 1e4, 1, 2.2};
  vs_blob seen[4];
  vs_frame frame = blank();
  disc(0, 0, 8);
  disc(W, H, 8);
  assert_int_equal(find(&frame, &gate, 3, seen, 4), 2);
  rectangle(0, 0, W, H);
  for (int step = 1; step <= 4; step++) assert_int_equal(find(&frame, &gate, step, seen, 4), 0);
}

static void no_more_than_the_capacity_is_written(void **state) {
  (void)state;
  const vs_blob_gate gate = {BIT, 0, 12, 1e4, 1, 2.2};
  vs_blob seen[3];
  vs_frame frame = blank();
  for (int i = 0; i < 9; i++) disc(15 + 16 * i, 60, 4);
  assert_int_equal(find(&frame, &gate, 2, seen, 3), 3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_table_holds_the_hues_of_its_range_only),
      cmocka_unit_test(a_range_may_wrap_through_red),
      cmocka_unit_test(a_disc_is_found_in_its_middle_with_its_area),
      cmocka_unit_test(sizes_and_shapes_outside_the_gate_are_left_out),
      cmocka_unit_test(the_best_of_several_comes_first),
      cmocka_unit_test(two_patches_that_touch_are_cut_into_two),
      cmocka_unit_test(a_heap_larger_than_a_team_is_left_out),
      cmocka_unit_test(a_blob_at_the_border_and_a_picture_of_one_colour_are_survived),
      cmocka_unit_test(no_more_than_the_capacity_is_written),
  };
  return cmocka_run_group_tests_name("vision/blobs", tests, NULL, NULL);
}
