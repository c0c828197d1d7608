#include "tile.h"

#include <math.h>

#define RIM_PX 2 // edges are smoothed, and half a pixel rounds

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The frustum's size at its near plane; MuJoCo takes the width from the picture's shape.
static float near_height(const vs_tile_picture *p) { return p->eye.frustum_top - p->eye.frustum_bottom; }

static void project(const vs_tile_picture *p, const float point[3], float *x_px, float *y_px) {
  const mjvGLCamera *e = &p->eye;
  float right[3] = {e->forward[1] * e->up[2] - e->forward[2] * e->up[1],
                    e->forward[2] * e->up[0] - e->forward[0] * e->up[2],
                    e->forward[0] * e->up[1] - e->forward[1] * e->up[0]};
  float from[3] = {point[0] - e->pos[0], point[1] - e->pos[1], point[2] - e->pos[2]};
  float depth = fmaxf(dot(from, e->forward), e->frustum_near), scale = e->frustum_near / depth;
  float px_per_m = (float)p->height_px / near_height(p);
  *x_px = 0.5f * (float)p->width_px + (dot(from, right) * scale - e->frustum_center) * px_per_m;
  *y_px = (dot(from, e->up) * scale - e->frustum_bottom) * px_per_m;
}

mjrRect vs_tile_around(const vs_tile_picture *p, const float low[3], const float high[3], const float *lamp) {
  float x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
  for (int i = 0; i < (lamp ? 16 : 8); i++) {
    float point[3] = {i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]};
    if (i & 8) { // where its shadow falls
      float fall = fmaxf(point[2], 0.0f) / -lamp[2];
      point[0] += fall * lamp[0];
      point[1] += fall * lamp[1];
      point[2] = 0.0f;
    }
    float x, y;
    project(p, point, &x, &y);
    x0 = fminf(x0, x);
    x1 = fmaxf(x1, x);
    y0 = fminf(y0, y);
    y1 = fmaxf(y1, y);
  }
  int left = (int)fmaxf(floorf(x0) - RIM_PX, 0), right = (int)fminf(ceilf(x1) + RIM_PX, (float)p->width_px);
  int bottom = (int)fmaxf(floorf(y0) - RIM_PX, 0), top = (int)fminf(ceilf(y1) + RIM_PX, (float)p->height_px);
  if (left >= right || bottom >= top) return (mjrRect){0, 0, 0, 0};
  return (mjrRect){left, bottom, right - left, top - bottom};
}

mjvGLCamera vs_tile_camera(const vs_tile_picture *p, mjrRect part) {
  mjvGLCamera camera = p->eye;
  float m_per_px = near_height(p) / (float)p->height_px;
  float middle_px = (float)part.left + 0.5f * (float)part.width - 0.5f * (float)p->width_px;
  camera.frustum_center = p->eye.frustum_center + m_per_px * middle_px;
  camera.frustum_bottom = p->eye.frustum_bottom + m_per_px * (float)part.bottom;
  camera.frustum_top = p->eye.frustum_bottom + m_per_px * (float)(part.bottom + part.height);
  return camera;
}
