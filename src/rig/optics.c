#include "optics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/rng.h"

vs_status vs_optics_open(vs_optics *o, const vs_rig_optics *def, int width, int height, uint64_t seed, vs_error *err) {
  o->def = *def;
  o->width = width, o->height = height;
  o->row = malloc(3 * (size_t)(width > height ? width : height));
  if (!o->row) return vs_fail(err, VS_FAIL, "out of memory");
  vs_rng rng = vs_rng_make(seed, 0x0971c5);
  for (int i = 0; i < VS_OPTICS_NOISE; i++) {
    double value = def->noise * sqrt(-2 * log(1 - vs_rng_uniform(&rng))) * cos(2 * M_PI * vs_rng_uniform(&rng));
    o->noise[i] = (int8_t)lround(fmin(fmax(value, -127), 127));
  }
  return VS_OK;
}

void vs_optics_close(vs_optics *o) {
  free(o->row);
  o->row = NULL;
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
  if (o->def.blur_px > 0) blur(o, rgb);
  if (o->def.uneven > 0 || o->def.noise > 0) shade_and_spoil(o, rgb, seq);
}
