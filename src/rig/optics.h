// What a real lens, lamp and sensor do to a picture.
#ifndef VSSS_RIG_OPTICS_H
#define VSSS_RIG_OPTICS_H

#include "vsss/rig.h"

enum { VS_OPTICS_NOISE = 1 << 16 };
typedef struct vs_optics {
  vs_rig_optics def;
  int width, height;
  uint8_t *row; // [3 * max(width, height)]
  // Lens: where in the straight picture each pixel looks, 1/256 px; and the straight picture. NULL: no distortion.
  uint32_t *look; // [height][width][2]
  uint8_t *straight;
  int8_t noise[VS_OPTICS_NOISE];
} vs_optics;

// focal_px: of the straight picture, whose middle the lens looks through.
vs_status vs_optics_open(vs_optics *optics, const vs_rig_optics *def, int width, int height, double focal_px,
                         uint64_t seed, vs_error *err);
void vs_optics_close(vs_optics *optics);
// Lens, then blur, then light, then noise, into rgb[height][width][3]. The same seq gives the same noise.
void vs_optics_apply(vs_optics *optics, uint8_t *rgb, uint32_t seq);

#endif
