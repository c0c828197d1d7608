// A drawn field for the vision tests: a calibrated camera over black floor with white lines, tagged caps, colour
// patches and an orange ball, each at its height, smoothed over sub-pixels, with sensor noise. Ray by ray, by the
// inverse of nothing under test but vs_calib_to_pixel's formula, written out again here for a pinhole.
#ifndef VSSS_TESTS_VISION_SCENE_H
#define VSSS_TESTS_VISION_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/camera.h"
#include "vsss/detect.h"
#include "vsss/field.h"
#include "vsss/image.h"
#include "vsss/mark.h"
#include "vsss/rng.h"
#include "vsss/tag.h"
#include "vsss/world.h"

enum { SCENE_SAMPLES = 4 }; // per pixel and axis

// A pinhole looking straight down from (0, 0, height_m), picture top towards +y.
typedef struct scene {
  int width, height;
  double height_m, focal_px;
  vs_world world; // robot[own] carry tags 0, 1, 2, the others patches, unless scene_wear says otherwise
  vs_team own;
  double noise; // deviation in grey levels
  uint64_t seed;
  vs_tag_pattern tag[VS_TEAM_SIZE];
  vs_mark_picture mark[VS_TEAMS][VS_TEAM_SIZE]; // px 0: as above
  uint8_t *bgr, *grey;
} scene;

static const uint8_t scene_orange[3] = {20, 110, 235}, scene_yellow[3] = {30, 210, 230}, scene_blue[3] = {200, 80, 25};

static inline void scene_init(scene *s, int width, int height) {
  memset(s, 0, sizeof *s);
  s->width = width;
  s->height = height;
  s->height_m = 2.2;
  // 1.9 m of floor across the width, or 1.5 m down the height, whichever needs the wider view.
  s->focal_px = fmin(width / 1.9, height / 1.5) * s->height_m;
  s->noise = 4.0;
  s->own = VS_BLUE;
  vs_error err;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (vs_tag_pattern_of(VS_TAG_FAMILY, i, &s->tag[i], &err) != VS_OK) abort();
  s->bgr = malloc((size_t)width * height * 3);
  s->grey = malloc((size_t)width * height);
  if (!s->bgr || !s->grey) abort();
}

static inline void scene_wear(scene *s, int team, int index, vs_mark mark, int id) {
  vs_error err;
  if (vs_mark_paint(mark, (vs_team)team, id, &s->mark[team][index], &err) != VS_OK) abort();
}

static inline void scene_free(scene *s) {
  free(s->bgr);
  free(s->grey);
}

static inline double scene_fov_rad(const scene *s) { return 2 * atan(0.5 * s->height / s->focal_px); }

static inline void scene_floor(double x, double y, uint8_t out[3]) {
  double ax = fabs(x), ay = fabs(y), r = hypot(x, y);
  bool inside = ax < VS_FIELD_HALF_LENGTH_M && ay < VS_FIELD_HALF_WIDTH_M;
  bool line = inside && (ax < 0.0015 || fabs(r - VS_CIRCLE_RADIUS_M) < 0.0015 ||
                         (fabs(ax - (VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M)) < 0.0015 && ay < VS_AREA_HALF_WIDTH_M));
  memset(out, line ? 230 : inside ? 18 : 60, 3);
}

// Colour of the cap of a robot at (u, v) in its own frame, u to the front, v to its left.
static inline void scene_cap(const scene *s, int team, int index, double u, double v, uint8_t out[3]) {
  const vs_mark_picture *m = &s->mark[team][index];
  memset(out, 25, 3);
  if (m->px) {
    int row = (int)floor((0.5 - u / m->size_m) * m->px), column = (int)floor((0.5 - v / m->size_m) * m->px);
    memset(out, 225, 3);
    // Printed colours are paler than the picture's: 15 to 225.
    if (row >= 0 && row < m->px && column >= 0 && column < m->px)
      for (int k = 0; k < 3; k++) out[k] = (uint8_t)(15 + m->rgb[3 * (row * m->px + column) + 2 - k] * 210 / 255);
  } else if (team == (int)s->own) {
    const vs_tag_pattern *t = &s->tag[index];
    int row = (int)floor((VS_TAG_PAPER_M / 2 - u) / VS_TAG_PAPER_M * t->cells);
    int column = (int)floor((VS_TAG_PAPER_M / 2 - v) / VS_TAG_PAPER_M * t->cells);
    if (row >= 0 && row < t->cells && column >= 0 && column < t->cells) memset(out, t->cell[row][column] ? 225 : 15, 3);
  } else if (fabs(u) < VS_PATCH_M / 2 && fabs(v) < VS_PATCH_M / 2) {
    memcpy(out, team == VS_BLUE ? scene_blue : scene_yellow, 3);
  }
}

static inline bool scene_robot(const scene *s, double x, double y, uint8_t out[3]) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    const vs_robot *r = &s->world.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    double dx = x - r->pose.x_m, dy = y - r->pose.y_m;
    if (!r->valid || dx * dx + dy * dy > 0.0033) continue; // beyond the cap's corner
    double c = cos(r->pose.theta_rad), sn = sin(r->pose.theta_rad), u = c * dx + sn * dy, v = c * dy - sn * dx;
    if (fabs(u) > VS_ROBOT_SIZE_M / 2 || fabs(v) > VS_ROBOT_SIZE_M / 2) continue;
    scene_cap(s, i / VS_TEAM_SIZE, i % VS_TEAM_SIZE, u, v, out);
    return true;
  }
  return false;
}

// Along the ray through the floor point (x, y): the caps at 8 cm, then the ball, then the floor.
static inline void scene_ray(const scene *s, double x, double y, uint8_t out[3]) {
  double cap = 1 - VS_ROBOT_HEIGHT_M / s->height_m;
  if (scene_robot(s, x * cap, y * cap, out)) return;
  const vs_ball *b = &s->world.ball;
  if (b->valid) {
    // Distance of the ball's centre from the ray (0, 0, H) -> (x, y, 0).
    double d[3] = {x, y, -s->height_m}, n = sqrt(x * x + y * y + s->height_m * s->height_m);
    double p[3] = {b->x_m, b->y_m, VS_BALL_RADIUS_M - s->height_m}, along = 0, square = 0;
    for (int i = 0; i < 3; i++) along += p[i] * d[i] / n, square += p[i] * p[i];
    if (square - along * along < VS_BALL_RADIUS_M * VS_BALL_RADIUS_M) {
      memcpy(out, scene_orange, 3);
      return;
    }
  }
  scene_floor(x, y, out);
}

// Draws the world as it is; the frame's pixels belong to the scene.
static inline vs_frame scene_draw(scene *s, int64_t capture_us, uint32_t seq) {
  vs_rng rng = vs_rng_make(s->seed, seq);
  for (int y = 0; y < s->height; y++)
    for (int x = 0; x < s->width; x++) {
      int sum[3] = {0};
      for (int k = 0; k < SCENE_SAMPLES * SCENE_SAMPLES; k++) {
        double px = x + (k % SCENE_SAMPLES + 0.5) / SCENE_SAMPLES, py = y + (k / SCENE_SAMPLES + 0.5) / SCENE_SAMPLES;
        uint8_t c[3];
        scene_ray(s, (px - 0.5 * s->width) * s->height_m / s->focal_px,
                  (0.5 * s->height - py) * s->height_m / s->focal_px, c);
        for (int i = 0; i < 3; i++) sum[i] += c[i];
      }
      // Noise of one draw for the pixel: three from one uniform sum are enough for a sensor.
      double noise = s->noise > 0 ? s->noise * (vs_rng_uniform(&rng) + vs_rng_uniform(&rng) - 1.0) * 2.449 : 0;
      for (int i = 0; i < 3; i++) {
        double value = (double)sum[i] / (SCENE_SAMPLES * SCENE_SAMPLES) + noise;
        s->bgr[3 * ((size_t)y * s->width + x) + i] = (uint8_t)fmin(fmax(value + 0.5, 0), 255);
      }
    }
  vs_image_grey(s->bgr, 3 * s->width, s->width, s->height, s->grey, s->width);
  return (vs_frame){s->grey, s->bgr, s->width, s->height, s->width, 3 * s->width, capture_us, seq};
}

#endif
