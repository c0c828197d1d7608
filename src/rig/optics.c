#include "optics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/rng.h"

// Distorted to straight, by fixed-point iteration: x_d = x (1 + k1 r^2), as calib.h has it.
static void undistort(double k1, double xd, double yd, double *x, double *y) {
  *x = xd, *y = yd;
  for (int i = 0; i < 20; i++) {
    double radial = 1 + k1 * (*x * *x + *y * *y);
    *x = xd / radial, *y = yd / radial;
  }
}

// What lies outside the straight picture looks like its edge. In 1/256 of a pixel; the next pixel is there to blend with.
static uint32_t fixed(double px, int size) { return (uint32_t)fmin(fmax(256 * (px - 0.5), 0), 256 * (size - 1) - 1); }

static vs_status grind_lens(vs_optics *o, double focal_px, vs_error *err) {
  size_t pixels = (size_t)o->width * (size_t)o->height;
  o->look = malloc(pixels * 2 * sizeof *o->look);
  o->straight = malloc(pixels * 3);
  if (!o->look || !o->straight) return vs_fail(err, VS_FAIL, "out of memory");
  uint32_t *look = o->look;
  for (int v = 0; v < o->height; v++)
    for (int u = 0; u < o->width; u++) {
      double x, y;
      undistort(o->def.lens_k1, (u + 0.5 - 0.5 * o->width) / focal_px, (v + 0.5 - 0.5 * o->height) / focal_px, &x, &y);
      *look++ = fixed(0.5 * o->width + focal_px * x, o->width);
      *look++ = fixed(0.5 * o->height + focal_px * y, o->height);
    }
  return VS_OK;
}

static void through_lens(const vs_optics *o, uint8_t *rgb) {
  size_t row = 3 * (size_t)o->width, pixels = (size_t)o->width * (size_t)o->height;
  memcpy(o->straight, rgb, 3 * pixels);
  const uint32_t *look = o->look;
  for (size_t i = 0; i < pixels; i++, rgb += 3, look += 2) {
    uint32_t fx = look[0] & 255, fy = look[1] & 255;
    const uint8_t *a = o->straight + (look[1] >> 8) * row + 3 * (look[0] >> 8), *b = a + row;
    for (int k = 0; k < 3; k++)
      rgb[k] = (uint8_t)(((a[k] * (256 - fx) + a[k + 3] * fx) * (256 - fy) + (b[k] * (256 - fx) + b[k + 3] * fx) * fy +
                          32768) >>
                         16);
  }
}

vs_status vs_optics_open(vs_optics *o, const vs_rig_optics *def, int width, int height, double focal_px, uint64_t seed,
                         vs_error *err) {
  o->look = NULL;
  o->straight = NULL;
  o->def = *def;
  o->width = width, o->height = height;
  o->row = malloc(3 * (size_t)(width > height ? width : height));
  if (!o->row) return vs_fail(err, VS_FAIL, "out of memory");
  vs_rng rng = vs_rng_make(seed, 0x0971c5);
  for (int i = 0; i < VS_OPTICS_NOISE; i++) {
    double value = def->noise * sqrt(-2 * log(1 - vs_rng_uniform(&rng))) * cos(2 * M_PI * vs_rng_uniform(&rng));
    o->noise[i] = (int8_t)lround(fmin(fmax(value, -127), 127));
  }
  return def->lens_k1 != 0.0 ? grind_lens(o, focal_px, err) : VS_OK;
}

void vs_optics_close(vs_optics *o) {
  free(o->row);
  free(o->look);
  free(o->straight);
  o->row = NULL;
  o->look = NULL;
  o->straight = NULL;
}

// 1 2 1 along count pixels that lie stride bytes apart.
static void smooth(uint8_t *first, int count, size_t stride, uint8_t *copy) {
  for (int i = 0; i < count; i++) memcpy(copy + 3 * i, first + stride * (size_t)i, 3);
  for (int i = 0; i < count; i++) {
    const uint8_t *b = copy + 3 * i, *a = i > 0 ? b - 3 : b, *c = i + 1 < count ? b + 3 : b;
    uint8_t *out = first + stride * (size_t)i;
    for (int k = 0; k < 3; k++) out[k] = (uint8_t)((a[k] + 2 * b[k] + c[k] + 2) >> 2);
  }
}

static void blur(const vs_optics *o, uint8_t *rgb) {
  size_t row = 3 * (size_t)o->width;
  // A pass has a variance of half a pixel squared in each direction.
  for (int pass = (int)lround(2 * o->def.blur_px * o->def.blur_px); pass > 0; pass--) {
    for (int y = 0; y < o->height; y++) smooth(rgb + row * (size_t)y, o->width, 3, o->row);
    for (int x = 0; x < o->width; x++) smooth(rgb + 3 * (size_t)x, o->height, row, o->row);
  }
}

// Full light at the bottom left, the share def.uneven less at the top right.
static void shade_and_spoil(const vs_optics *o, uint8_t *rgb, uint32_t seq) {
  const double per_px = o->def.uneven / (o->width + o->height);
  for (int y = 0; y < o->height; y++) {
    uint32_t at = (seq * 2654435761u) ^ ((uint32_t)y * 40503u * 7u);
    for (int x = 0; x < o->width; x++) {
      int gain = (int)(256 * (1 - per_px * (x + o->height - 1 - y)));
      for (int k = 0; k < 3; k++, rgb++) {
        int value = (*rgb * gain >> 8) + o->noise[at++ % VS_OPTICS_NOISE];
        *rgb = (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
      }
    }
  }
}

void vs_optics_apply(vs_optics *o, uint8_t *rgb, uint32_t seq) {
  if (o->look) through_lens(o, rgb);
  if (o->def.blur_px > 0) blur(o, rgb);
  if (o->def.uneven > 0 || o->def.noise > 0) shade_and_spoil(o, rgb, seq);
}
