// src/rig/optics.c
#include <string.h>

#include "assert_near.h"
#include "rig/optics.h"

enum { W = 80, H = 60 };
#define FOCAL 60.0
static uint8_t rgb[H][W][3];
static vs_optics o;

static void apply(vs_rig_optics def, uint32_t seq) {
  assert_ok(vs_optics_open(&o, &def, W, H, FOCAL, 7, err));
  vs_optics_apply(&o, &rgb[0][0][0], seq);
  vs_optics_close(&o);
}

static void without_anything_the_picture_stays(void **state) {
  (void)state;
  memset(rgb, 77, sizeof rgb);
  apply((vs_rig_optics){0}, 1);
  for (int i = 0; i < W * H; i++) assert_int_equal(rgb[i / W][i % W][0], 77);
}

static void noise_has_the_deviation_asked_for_and_differs_from_picture_to_picture(void **state) {
  (void)state;
  static uint8_t first[H][W][3];
  for (int round = 0; round < 3; round++) {
    memset(rgb, 100, sizeof rgb);
    apply((vs_rig_optics){.noise = 5}, round == 2 ? 0 : (uint32_t)round);
    double sum = 0, square = 0;
    for (int i = 0; i < W * H; i++) sum += rgb[i / W][i % W][1] - 100, square += pow(rgb[i / W][i % W][1] - 100, 2);
    assert_near(sum / (W * H), 0, 0.4);
    assert_near(sqrt(square / (W * H)), 5, 0.4);
    if (round == 0) memcpy(first, rgb, sizeof rgb);
    assert_int_equal(memcmp(first, rgb, sizeof rgb) == 0, round != 1); // the same number, the same noise
  }
}

static void light_falls_from_the_bottom_left_to_the_top_right(void **state) {
  (void)state;
  memset(rgb, 200, sizeof rgb);
  apply((vs_rig_optics){.uneven = 0.5}, 0);
  assert_near(rgb[H - 1][0][0], 200, 1);
  assert_near(rgb[0][W - 1][0], 100, 3);
}

// A line of one pixel spreads over a deviation of 1 px and keeps its light.
static void blur_spreads_a_line(void **state) {
  (void)state;
  memset(rgb, 0, sizeof rgb);
  for (int y = 0; y < H; y++) rgb[y][40][0] = 240;
  apply((vs_rig_optics){.blur_px = 1}, 0);
  double sum = 0, square = 0;
  for (int x = 0; x < W; x++) sum += rgb[30][x][0], square += rgb[30][x][0] * pow(x - 40, 2);
  assert_near(sum, 240, 6);
  assert_near(sqrt(square / sum), 1, 0.05);
}

// A spot at (30, 20) px from the middle: x = 0.5, y = 1/3, r^2 = 0.361; a barrel of -0.2 draws it in to 0.928 of that, to
// (27.83, 18.55) from the middle, (67.83, 48.55) in the picture.
static void a_barrel_draws_the_picture_in_as_the_calibration_says(void **state) {
  (void)state;
  memset(rgb, 0, sizeof rgb);
  for (int y = -1; y <= 0; y++)
    for (int x = -1; x <= 0; x++) rgb[H / 2 + 20 + y][W / 2 + 30 + x][0] = 200; // its middle is that corner of pixels
  apply((vs_rig_optics){.lens_k1 = -0.2}, 0);
  double sum = 0, x_px = 0, y_px = 0;
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) {
      sum += rgb[y][x][0];
      x_px += rgb[y][x][0] * (x + 0.5);
      y_px += rgb[y][x][0] * (y + 0.5);
    }
  assert_near(x_px / sum, 67.83, 0.15);
  assert_near(y_px / sum, 48.55, 0.15);
  memset(rgb, 90, sizeof rgb); // even pictures stay even, to their corners
  apply((vs_rig_optics){.lens_k1 = 0.3}, 0);
  for (int i = 0; i < W * H; i++) assert_int_equal(rgb[i / W][i % W][2], 90);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_anything_the_picture_stays),
      cmocka_unit_test(noise_has_the_deviation_asked_for_and_differs_from_picture_to_picture),
      cmocka_unit_test(light_falls_from_the_bottom_left_to_the_top_right),
      cmocka_unit_test(blur_spreads_a_line),
      cmocka_unit_test(a_barrel_draws_the_picture_in_as_the_calibration_says),
  };
  return cmocka_run_group_tests_name("rig/optics", tests, NULL, NULL);
}
