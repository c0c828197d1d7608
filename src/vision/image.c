// Pixels in memory: pure conversions and drawing.
#include "vsss/image.h"

#include <math.h>

void vs_image_grey(const uint8_t *bgr, int bgr_stride, int width, int height, uint8_t *grey, int grey_stride) {
  for (int y = 0; y < height; y++) {
    const uint8_t *in = bgr + (size_t)y * bgr_stride;
    uint8_t *out = grey + (size_t)y * grey_stride;
    // 29, 150, 77 are 0.114, 0.587, 0.299 in 1/256; they sum to 256, so white stays 255.
    for (int x = 0; x < width; x++, in += 3) out[x] = (uint8_t)((29 * in[0] + 150 * in[1] + 77 * in[2] + 128) >> 8);
  }
}

static uint8_t byte_of(int value) { return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value); }

// BT.601: luma 16..235 to 0..255 (298/256); coefficients of chroma in 1/256.
static void pixel_from_yuv(int luma, int red, int green, int blue, uint8_t *bgr) {
  int l = 298 * (luma - 16) + 128;
  bgr[0] = byte_of((l + blue) >> 8);
  bgr[1] = byte_of((l + green) >> 8);
  bgr[2] = byte_of((l + red) >> 8);
}

// Two neighbours that share their chroma.
static void pair(int luma0, int luma1, int u, int v, uint8_t *luma, uint8_t *bgr) {
  int red = 409 * v, green = -100 * u - 208 * v, blue = 516 * u;
  luma[0] = (uint8_t)luma0;
  luma[1] = (uint8_t)luma1;
  pixel_from_yuv(luma0, red, green, blue, bgr);
  pixel_from_yuv(luma1, red, green, blue, bgr + 3);
}

void vs_image_from_yuyv(const uint8_t *yuyv, int yuyv_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride) {
  for (int y = 0; y < height; y++) {
    const uint8_t *in = yuyv + (size_t)y * yuyv_stride;
    uint8_t *luma = grey + (size_t)y * grey_stride, *out = bgr + (size_t)y * bgr_stride;
    for (int x = 0; x + 1 < width; x += 2, in += 4) pair(in[0], in[2], in[1] - 128, in[3] - 128, luma + x, out + 3 * x);
  }
}

void vs_image_from_uyvy(const uint8_t *uyvy, int uyvy_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride) {
  for (int y = 0; y < height; y++) {
    const uint8_t *in = uyvy + (size_t)y * uyvy_stride;
    uint8_t *luma = grey + (size_t)y * grey_stride, *out = bgr + (size_t)y * bgr_stride;
    for (int x = 0; x + 1 < width; x += 2, in += 4) pair(in[1], in[3], in[0] - 128, in[2] - 128, luma + x, out + 3 * x);
  }
}

void vs_image_from_nv12(const uint8_t *nv12, int nv12_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride) {
  for (int y = 0; y < height; y++) {
    const uint8_t *in = nv12 + (size_t)y * nv12_stride, *uv = nv12 + (size_t)(height + y / 2) * nv12_stride;
    uint8_t *luma = grey + (size_t)y * grey_stride, *out = bgr + (size_t)y * bgr_stride;
    for (int x = 0; x + 1 < width; x += 2) pair(in[x], in[x + 1], uv[x] - 128, uv[x + 1] - 128, luma + x, out + 3 * x);
  }
}

void vs_image_from_grey(const uint8_t *from, int from_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride) {
  for (int y = 0; y < height; y++) {
    const uint8_t *in = from + (size_t)y * from_stride;
    uint8_t *luma = grey + (size_t)y * grey_stride, *out = bgr + (size_t)y * bgr_stride;
    for (int x = 0; x < width; x++) luma[x] = out[3 * x] = out[3 * x + 1] = out[3 * x + 2] = in[x];
  }
}

static void put(vs_image *image, int x, int y, const uint8_t colour[3]) {
  if (x < 0 || y < 0 || x >= image->width || y >= image->height) return;
  uint8_t *pixel = image->bgr + (size_t)y * image->stride + 3 * (size_t)x;
  for (int i = 0; i < 3; i++) pixel[i] = colour[i];
}

void vs_image_disc(vs_image *image, double x_px, double y_px, double radius_px, const uint8_t colour[3]) {
  double x0 = fmax(x_px - radius_px, 0), x1 = fmin(x_px + radius_px, image->width - 1);
  double y0 = fmax(y_px - radius_px, 0), y1 = fmin(y_px + radius_px, image->height - 1);
  for (int y = (int)y0; y <= (int)y1; y++)
    for (int x = (int)x0; x <= (int)x1; x++)
      if (hypot(x + 0.5 - x_px, y + 0.5 - y_px) <= radius_px) put(image, x, y, colour);
}

void vs_image_box(vs_image *image, int x_px, int y_px, int width_px, int height_px, const uint8_t colour[3]) {
  for (int y = y_px; y < y_px + height_px; y++)
    for (int x = x_px; x < x_px + width_px; x++) put(image, x, y, colour);
}

void vs_image_line(vs_image *image, double x0_px, double y0_px, double x1_px, double y1_px, int width_px,
                   const uint8_t colour[3]) {
  if (!(fabs(x0_px) < 1e5 && fabs(y0_px) < 1e5 && fabs(x1_px) < 1e5 && fabs(y1_px) < 1e5)) return;
  int steps = 1 + (int)fmax(fabs(x1_px - x0_px), fabs(y1_px - y0_px));
  int low = -(width_px - 1) / 2, high = width_px / 2;
  for (int i = 0; i <= steps; i++) {
    int x = (int)floor(x0_px + (x1_px - x0_px) * i / steps), y = (int)floor(y0_px + (y1_px - y0_px) * i / steps);
    for (int dy = low; dy <= high; dy++)
      for (int dx = low; dx <= high; dx++) put(image, x + dx, y + dy, colour);
  }
}
