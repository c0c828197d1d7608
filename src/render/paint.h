// The textures of the renderer, painted from field.h's sizes: the floor with its lines, the robots' caps.
#ifndef VSSS_RENDER_PAINT_H
#define VSSS_RENDER_PAINT_H

#include <stdint.h>

#include "vsss/render.h"

// rgb: uint8_t[height][width][3] over x in +-half_x_m (left to right) and y in +-half_y_m (top row is +y).
void vs_paint_floor(uint8_t *rgb, int width, int height, const vs_pitch *pitch);

// The texture of a cap of VS_ROBOT_SIZE_M: column 0 at the robot's back, top row at its left, as MuJoCo lays a texture on
// a plane. cap->rgb NULL: colours.
void vs_paint_cap(uint8_t *rgb, int size, vs_team team, int index, vs_view view, const vs_cap *cap);

#endif
