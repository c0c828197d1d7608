// src/vision/jpeg.c
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vision/jpeg.h"
#include "vsss/image.h"

enum { W = 96, H = 64 };
static uint8_t bgr[H][W][3], out[H][W][3], grey[H][W], file[1 << 16];

// Left half orange, right half blue, as a JPEG of quality 95.
static size_t make(void) {
  static const uint8_t colour[2][3] = {{20, 110, 235}, {200, 80, 25}};
  for (int i = 0; i < W * H; i++) memcpy(bgr[i / W][i % W], colour[i % W >= W / 2], 3);
  size_t size;
  assert_ok(
      vs_image_jpeg(&(vs_image){&bgr[0][0][0], W, H, 3 * W}, &(vs_jpeg_def){95, 1}, file, sizeof file, &size, err));
  return size;
}

static void a_picture_comes_back_in_colours_and_grey(void **state) {
  (void)state;
  size_t size = make();
  vs_jpeg *j;
  assert_ok(vs_jpeg_new(&j, err));
  for (int round = 0; round < 2; round++) { // one decoder for all frames
    memset(out, 0, sizeof out);
    assert_ok(vs_jpeg_decode(j, file, size, W, H, &out[0][0][0], &grey[0][0], err));
    for (int x = 8; x < W; x += 64)
      for (int k = 0; k < 3; k++) assert_near(out[20][x][k], bgr[20][x][k], 6);
    // 0.299 R + 0.587 G + 0.114 B of orange: 70.3 + 64.6 + 2.3.
    assert_near(grey[20][8], 137, 4);
  }
  vs_jpeg_free(j);
}

static void broken_and_foreign_pictures_fail_and_the_decoder_goes_on(void **state) {
  (void)state;
  size_t size = make();
  vs_jpeg *j;
  vs_error why;
  assert_ok(vs_jpeg_new(&j, err));
  assert_int_equal(vs_jpeg_decode(j, file, size, W, H + 8, &out[0][0][0], &grey[0][0], &why), VS_FAIL);
  assert_non_null(strstr(why.text, "96 x 64"));
  assert_int_equal(vs_jpeg_decode(j, file, 40, W, H, &out[0][0][0], &grey[0][0], &why), VS_FAIL);
  assert_int_equal(vs_jpeg_decode(j, (const uint8_t *)"no picture", 10, W, H, &out[0][0][0], &grey[0][0], &why),
                   VS_FAIL);
  assert_ok(vs_jpeg_decode(j, file, size, W, H, &out[0][0][0], &grey[0][0], err));
  vs_jpeg_free(j);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_picture_comes_back_in_colours_and_grey),
      cmocka_unit_test(broken_and_foreign_pictures_fail_and_the_decoder_goes_on),
  };
  return cmocka_run_group_tests_name("vision/jpeg", tests, NULL, NULL);
}
