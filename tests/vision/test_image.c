// src/vision/image.c and src/vision/opencv.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/camera.h"
#include "vsss/image.h"

static void grey_weighs_the_colours_as_bt601(void **state) {
  (void)state;
  const uint8_t bgr[5][3] = {{0, 0, 0}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
  uint8_t grey[5];
  vs_image_grey(&bgr[0][0], 15, 5, 1, grey, 5);
  assert_int_equal(grey[0], 0);
  assert_int_equal(grey[1], 255);
  assert_near(grey[2], 0.114 * 255, 1);
  assert_near(grey[3], 0.587 * 255, 1);
  assert_near(grey[4], 0.299 * 255, 1);
}

static void rows_are_taken_at_their_strides(void **state) {
  (void)state;
  uint8_t bgr[2][8] = {{9, 9, 9, 9, 9, 9, 200, 200}, {40, 40, 40, 40, 40, 40, 200, 200}}, grey[2][4] = {{0}};
  vs_image_grey(&bgr[0][0], 8, 2, 2, &grey[0][0], 4);
  assert_int_equal(grey[0][1], 9);
  assert_int_equal(grey[1][0], 40);
  assert_int_equal(grey[0][2], 0);
}

static void yuyv_of_known_colours_becomes_those_colours(void **state) {
  (void)state;
  // BT.601 limited range: white 235 128 128, black 16, red 81 90 240, blue 41 240 110 (Y U V).
  const uint8_t yuyv[4][4] = {{235, 128, 16, 128}, {81, 90, 81, 240}, {41, 240, 41, 110}, {128, 128, 128, 128}};
  uint8_t grey[8], bgr[8][3];
  vs_image_from_yuyv(&yuyv[0][0], 16, 8, 1, grey, 8, &bgr[0][0], 24);
  const int expected[8][3] = {{255, 255, 255}, {0, 0, 0},   {0, 0, 254},     {0, 0, 254},
                              {255, 0, 0},     {255, 0, 0}, {130, 130, 130}, {130, 130, 130}};
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++) assert_near(bgr[i][k], expected[i][k], 2);
  assert_int_equal(grey[0], 235);
  assert_int_equal(grey[1], 16);
  assert_int_equal(grey[2], 81);
}

static void drawing_stays_inside_the_picture(void **state) {
  (void)state;
  enum { W = 20, H = 10, GUARD = 200 };
  static uint8_t memory[GUARD + W * H * 3 + GUARD];
  memset(memory, 7, sizeof memory);
  vs_image image = {memory + GUARD, W, H, 3 * W};
  const uint8_t red[3] = {0, 0, 255};
  vs_image_line(&image, -50, -20, 60, 40, 3, red);
  vs_image_disc(&image, 0, 9, 5, red);
  vs_image_disc(&image, 500, 500, 5, red);
  vs_image_line(&image, NAN, 0, 5, 5, 1, red);
  for (int i = 0; i < GUARD; i++) {
    assert_int_equal(memory[i], 7);
    assert_int_equal(memory[sizeof memory - 1 - i], 7);
  }
  assert_int_equal(image.bgr[(9 * W + 0) * 3 + 2], 255);
}

static void a_saved_picture_is_read_back_by_a_camera(void **state) {
  (void)state;
  enum { W = 32, H = 24 };
  uint8_t bgr[H][W][3];
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++) bgr[y][x][0] = (uint8_t)(8 * x), bgr[y][x][1] = (uint8_t)(9 * y), bgr[y][x][2] = 77;
  char folder[] = "/tmp/vsss_image_XXXXXX", path[64];
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/a.png", folder);
  assert_ok(vs_image_save(path, &bgr[0][0][0], 3 * W, W, H, err));
  vs_camera *camera;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_camera_open(path, NULL, &camera, err));
  assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_memory_equal(frame.bgr, bgr, sizeof bgr);
  vs_camera_close(camera);
  unlink(path);
  rmdir(folder);
  vs_error err;
  assert_int_equal(vs_image_save("/nowhere/a.png", &bgr[0][0][0], 3 * W, W, H, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/a.png"));
}

static void a_jpeg_shrinks_and_is_refused_where_it_does_not_fit(void **state) {
  (void)state;
  enum { W = 64, H = 48 };
  static uint8_t bgr[H][W][3], out[65536];
  for (int i = 0; i < W * H * 3; i++) (&bgr[0][0][0])[i] = (uint8_t)(i * 2654435761u >> 24);
  size_t full, half;
  assert_ok(vs_image_jpeg(&(vs_image){&bgr[0][0][0], W, H, 3 * W}, &(vs_jpeg_def){80, 1}, out, sizeof out, &full, err));
  assert_true(out[0] == 0xff && out[1] == 0xd8); // a JPEG begins so
  assert_ok(vs_image_jpeg(&(vs_image){&bgr[0][0][0], W, H, 3 * W}, &(vs_jpeg_def){80, 2}, out, sizeof out, &half, err));
  assert_true(half < full);
  vs_error err;
  assert_int_equal(vs_image_jpeg(&(vs_image){&bgr[0][0][0], W, H, 3 * W}, &(vs_jpeg_def){80, 1}, out, 100, &full, &err),
                   VS_FAIL);
  assert_non_null(strstr(err.text, "does not fit 100"));
}

// One pair of pixels of luma 100 and 180, U 90, V 160, in each way to pack it, is the same picture.
static void every_packing_of_the_same_pixels_gives_the_same_picture(void **state) {
  (void)state;
  const uint8_t yuyv[8] = {100, 90, 180, 160, 100, 90, 180, 160}, uyvy[8] = {90, 100, 160, 180, 90, 100, 160, 180};
  const uint8_t nv12[6] = {100, 180, 100, 180, 90, 160}; // two rows of luma, one of chroma
  uint8_t grey[3][2][2], bgr[3][2][6];
  vs_image_from_yuyv(yuyv, 4, 2, 2, &grey[0][0][0], 2, &bgr[0][0][0], 6);
  vs_image_from_uyvy(uyvy, 4, 2, 2, &grey[1][0][0], 2, &bgr[1][0][0], 6);
  vs_image_from_nv12(nv12, 2, 2, 2, &grey[2][0][0], 2, &bgr[2][0][0], 6);
  for (int i = 1; i < 3; i++) {
    assert_memory_equal(grey[i], grey[0], sizeof grey[0]);
    assert_memory_equal(bgr[i], bgr[0], sizeof bgr[0]);
  }
  assert_int_equal(grey[0][1][1], 180);
  // 298 (100 - 16) / 256 = 97.8; red + 409 * 32 / 256 = 51.1; blue + 516 * -38 / 256 = -76.6.
  assert_near(bgr[0][0][2], 97.8 + 51.1, 1);
  assert_near(bgr[0][0][0], 97.8 - 76.6, 1);
  const uint8_t luma[2] = {7, 200};
  vs_image_from_grey(luma, 2, 2, 1, &grey[0][0][0], 2, &bgr[0][0][0], 6);
  assert_int_equal(grey[0][0][1], 200);
  for (int i = 3; i < 6; i++) assert_int_equal(bgr[0][0][i], 200);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grey_weighs_the_colours_as_bt601),
      cmocka_unit_test(rows_are_taken_at_their_strides),
      cmocka_unit_test(yuyv_of_known_colours_becomes_those_colours),
      cmocka_unit_test(drawing_stays_inside_the_picture),
      cmocka_unit_test(a_saved_picture_is_read_back_by_a_camera),
      cmocka_unit_test(a_jpeg_shrinks_and_is_refused_where_it_does_not_fit),
      cmocka_unit_test(every_packing_of_the_same_pixels_gives_the_same_picture),
  };
  return cmocka_run_group_tests_name("vision/image", tests, NULL, NULL);
}
