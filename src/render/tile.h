// Pictures by parts: what of a picture a piece and its shadow cover, and the camera that draws just that.
#ifndef VSSS_RENDER_TILE_H
#define VSSS_RENDER_TILE_H

#include <mujoco/mujoco.h>

// A camera's picture: eye looks at width x height pixels, row 0 of a mjrRect at the bottom.
typedef struct vs_tile_picture {
  mjvGLCamera eye; // of MuJoCo: its frustum is the whole picture's
  int width_px, height_px;
} vs_tile_picture;

// The part that shows every point of the box from low to high (m) and of its shadow on the floor, with a rim of a few
// pixels. lamp: where light goes, lamp[2] < 0; NULL: no shadow. Width 0: nothing of it is in the picture.
mjrRect vs_tile_around(const vs_tile_picture *picture, const float low[3], const float high[3], const float *lamp);

// The camera whose whole picture is that part, pixel by pixel.
mjvGLCamera vs_tile_camera(const vs_tile_picture *picture, mjrRect part);

#endif
