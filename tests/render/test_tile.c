// src/render/tile.c
#include "assert_near.h"
#include "render/tile.h"

// 2 m over the floor, looking straight down, up = +y: at the near plane of 0.1 m a pixel of 100 x 80 is 0.001 m, on the
// floor 0.02 m.
static const vs_tile_picture overhead = {.eye = {.pos = {0, 0, 2},
                                                 .forward = {0, 0, -1},
                                                 .up = {0, 1, 0},
                                                 .frustum_bottom = -0.04f,
                                                 .frustum_top = 0.04f,
                                                 .frustum_near = 0.1f,
                                                 .frustum_far = 10.0f},
                                         .width_px = 100,
                                         .height_px = 80};

static void assert_part(mjrRect part, int left, int bottom, int width, int height) {
  assert_int_equal(part.left, left);
  assert_int_equal(part.bottom, bottom);
  assert_int_equal(part.width, width);
  assert_int_equal(part.height, height);
}

static void a_part_covers_the_box_with_a_rim_of_two_pixels(void **state) {
  (void)state;
  // x 0.21..0.41 m is pixel 50 + 10.5..20.5 on the floor, so 60..71; 1 m up a metre is 100 px: 50 + 21..41. Both: 60..91.
  // y -0.1099..0.1099 m: 40 - 5.5..5.5, and 1 m up 40 - 11..11: 29..51 rounded outwards.
  const float low[3] = {0.21f, -0.1099f, 0.0f}, high[3] = {0.4099f, 0.1099f, 1.0f};
  assert_part(vs_tile_around(&overhead, low, high, NULL), 58, 27, 35, 26);
}

static void a_part_covers_the_shadow_too(void **state) {
  (void)state;
  // Light that goes 0.5 m to -x for each metre down: the top's shadow lies 0.05 m further left, and 0.1 m up a pixel is
  // 0.019 m. Left: (0.11 - 0.05) / 0.02 = 3; right: 0.2899 / 0.019 = 15.3 -> 16; y +-0.0899 / 0.019 = 4.7 -> 5.
  const float low[3] = {0.111f, -0.0899f, 0.0f}, high[3] = {0.2899f, 0.0899f, 0.1f}, lamp[3] = {-0.4f, 0.0f, -0.8f};
  assert_part(vs_tile_around(&overhead, low, high, lamp), 51, 33, 17, 14);
  assert_part(vs_tile_around(&overhead, low, high, NULL), 53, 33, 15, 14);
}

static void a_part_ends_where_the_picture_ends(void **state) {
  (void)state;
  const float low[3] = {0.95f, 0.75f, 0.0f}, high[3] = {1.5f, 1.5f, 0.0f};
  assert_part(vs_tile_around(&overhead, low, high, NULL), 95, 75, 5, 5); // 97.5 and 77.5, less the rim
  const float out[3] = {1.2f, 0.0f, 0.0f}, further[3] = {1.5f, 0.1f, 0.0f};
  assert_int_equal(vs_tile_around(&overhead, out, further, NULL).width, 0);
}

static void the_camera_of_a_part_sees_its_pixels_alone(void **state) {
  (void)state;
  // Columns 60..80 of 0.001 m, from the middle (50) on: centre 0.020 m. Rows 10..30 from the bottom (-0.04 m).
  mjvGLCamera c = vs_tile_camera(&overhead, (mjrRect){60, 10, 20, 20});
  assert_near(c.frustum_center, 0.020, 1e-6);
  assert_near(c.frustum_bottom, -0.030, 1e-6);
  assert_near(c.frustum_top, -0.010, 1e-6);
  c = vs_tile_camera(&overhead, (mjrRect){0, 0, 100, 80});
  assert_near(c.frustum_center, 0.0, 1e-6);
  assert_near(c.frustum_top, 0.04, 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_part_covers_the_box_with_a_rim_of_two_pixels),
      cmocka_unit_test(a_part_covers_the_shadow_too),
      cmocka_unit_test(a_part_ends_where_the_picture_ends),
      cmocka_unit_test(the_camera_of_a_part_sees_its_pixels_alone),
  };
  return cmocka_run_group_tests_name("render/tile", tests, NULL, NULL);
}
