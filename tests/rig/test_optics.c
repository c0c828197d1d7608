// src/rig/optics.c
#include <string.h>

#include "assert_near.h"
#include "rig/optics.h"

enum { W = 80, H = 60 };
static uint8_t rgb[H][W][3];
static vs_optics o;

static void apply(vs_rig_optics def, uint32_t seq) {
  assert_ok(vs_optics_open(&o, &def, W, H, 7, err));
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_anything_the_picture_stays),
      cmocka_unit_test(noise_has_the_deviation_asked_for_and_differs_from_picture_to_picture),
      cmocka_unit_test(light_falls_from_the_bottom_left_to_the_top_right),
      cmocka_unit_test(blur_spreads_a_line),
  };
  return cmocka_run_group_tests_name("rig/optics", tests, NULL, NULL);
}
