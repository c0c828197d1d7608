// src/field/pictures.c
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "field/pictures.h"
#include "vsss/clock.h"
#include "vsss/rng.h"

enum { W = 1280, H = 720 };
static uint8_t bgr[H][W][3];
static const vs_frame frame = {
    .bgr = &bgr[0][0][0], .width = W, .height = H, .bgr_stride = 3 * W, .capture_us = 1, .seq = 1};

typedef struct heard {
  int pictures;
  vs_msg_image image;
  int64_t utime_capture_us;
  uint8_t start[2];
} heard;

static void hear(const vs_message *message, void *user) {
  heard *h = user;
  h->pictures++;
  h->image = message->as.image;
  h->utime_capture_us = message->utime_capture_us;
  memcpy(h->start, message->as.image.data, sizeof h->start);
}

// A bus within the process with pictures on it, or a skip where LCM or OpenCV is not there.
static vs_bus *a_bus(heard *h, double hz, vs_pictures **pictures) {
  vs_bus *bus;
  vs_error err = {0};
  memset(h, 0, sizeof *h);
  if (vs_bus_supported(NULL) != VS_OK) skip();
  assert_ok(vs_bus_open("memq://", &bus, err));
  assert_ok(vs_bus_subscribe(bus, VS_CH_IMAGE, false, hear, h, err));
  if (vs_pictures_new(bus, hz, pictures, &err) == VS_OK) return bus;
  vs_bus_close(bus);
  if (!strstr(err.text, "install")) fail_msg("%s", err.text);
  skip();
  return NULL;
}

static void wait_for(vs_bus *bus, const heard *h, int pictures) {
  for (int i = 0; i < 300 && h->pictures < pictures; i++) assert_ok(vs_bus_handle(bus, 100, NULL, err));
  assert_int_equal(h->pictures, pictures);
}

static void a_calm_picture_is_sent_640_wide(void **state) {
  (void)state;
  heard h;
  vs_pictures *pictures;
  vs_bus *bus = a_bus(&h, 5, &pictures);
  memset(bgr, 90, sizeof bgr);
  vs_pictures_show(pictures, &frame, 777);
  wait_for(bus, &h, 1);
  assert_int_equal(h.image.width_px, 640);
  assert_int_equal(h.image.height_px, 360);
  assert_string_equal(h.image.format, "jpeg");
  assert_in_range(h.image.size, 300, 10000);
  assert_int_equal(h.start[0], 0xFF); // JPEG's start of image
  assert_int_equal(h.start[1], 0xD8);
  assert_int_equal(h.utime_capture_us, 777);
  assert_int_equal(vs_pictures_lost(pictures), 0);
  vs_pictures_free(pictures);
  vs_bus_close(bus);
}

static void a_picture_that_does_not_fit_is_made_smaller_until_it_does(void **state) {
  (void)state;
  heard h;
  vs_pictures *pictures;
  vs_bus *bus = a_bus(&h, 5, &pictures);
  vs_rng rng = vs_rng_make(1, 1);
  // Noise in squares of 4 pixels, black or white: nothing JPEG could leave out.
  for (int y = 0; y < H; y++)
    for (int x = 0; x < W; x++)
      if (x % 4 || y % 4)
        memcpy(bgr[y][x], bgr[y - y % 4][x - x % 4], 3);
      else
        for (int c = 0; c < 3; c++) bgr[y][x][c] = vs_rng_uniform(&rng) < 0.5 ? 0 : 255;
  vs_pictures_show(pictures, &frame, 1);
  wait_for(bus, &h, 1);
  assert_in_range(h.image.size, 10000, VS_BUS_IMAGE_MAX);
  assert_true(h.image.width_px < 640);
  assert_near(h.image.height_px, (double)h.image.width_px * H / W, 1);
  vs_pictures_free(pictures);
  vs_bus_close(bus);
}

static void frames_between_two_pictures_are_passed_over(void **state) {
  (void)state;
  heard h;
  vs_pictures *pictures;
  vs_bus *bus = a_bus(&h, 0.1, &pictures); // the second would be due in 10 s
  memset(bgr, 90, sizeof bgr);
  vs_pictures_show(pictures, &frame, 1);
  wait_for(bus, &h, 1);
  for (int i = 0; i < 5; i++) {
    vs_pictures_show(pictures, &frame, 2);
    vs_bus_handle(bus, 20, NULL, NULL);
  }
  assert_int_equal(h.pictures, 1);
  vs_pictures_free(pictures);
  vs_bus_close(bus);

  bus = a_bus(&h, 5, &pictures);
  vs_pictures_show(pictures, &frame, 1);
  wait_for(bus, &h, 1);
  int64_t end_us = vs_clock_monotonic_us() + 30000000;
  while (h.pictures < 2 && vs_clock_monotonic_us() < end_us) {
    vs_pictures_show(pictures, &frame, 3);
    vs_bus_handle(bus, 20, NULL, NULL);
  }
  assert_int_equal(h.pictures, 2);
  assert_int_equal(h.utime_capture_us, 3);
  vs_pictures_free(pictures);
  vs_bus_close(bus);
}

static void rates_out_of_range_are_refused(void **state) {
  (void)state;
  vs_pictures *pictures;
  vs_error err = {0};
  assert_int_equal(vs_pictures_new(NULL, 6, &pictures, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "6 pictures a second"));
  assert_null(pictures);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_calm_picture_is_sent_640_wide),
      cmocka_unit_test(a_picture_that_does_not_fit_is_made_smaller_until_it_does),
      cmocka_unit_test(frames_between_two_pictures_are_passed_over),
      cmocka_unit_test(rates_out_of_range_are_refused),
  };
  return cmocka_run_group_tests_name("field/pictures", tests, NULL, NULL);
}
