#include "paint.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "vsss/field.h"

#define LINE_HALF_M 0.002

static const uint8_t floor_rgb[3] = {40, 46, 46}; // matt black under venue light
static const uint8_t hall_rgb[3] = {41, 46, 56};  // beside the goals
static const uint8_t line_rgb[3] = {232, 232, 228};
static const uint8_t team_rgb[VS_TEAMS][3] = {{24, 72, 232}, {250, 214, 20}};
// Identity patches of a cap without a picture: robot 0 green, 1 magenta, 2 cyan, as VSSS teams print them.
// For people robots 3 and 4 are told apart by orange and white.
static const uint8_t patch_rgb[VS_TEAM_MOST][3] = {
    {30, 200, 60}, {230, 40, 170}, {40, 210, 220}, {240, 130, 30}, {235, 235, 235}};

static double box_edge_m(double x, double y, double half_x, double half_y) { // distance to a rectangle's outline
  double dx = fabs(x) - half_x, dy = fabs(y) - half_y;
  if (dx > 0 && dy > 0) return hypot(dx, dy);
  if (dx > 0) return dx;
  if (dy > 0) return dy;
  return fmin(-dx, -dy);
}

static double cross_m(double x, double y, double arm) { // distance to a plus sign
  double ax = fabs(x), ay = fabs(y);
  return fmin(hypot(fmax(ax - arm, 0), ay), hypot(ax, fmax(ay - arm, 0)));
}

// Distance of a floor point to the nearest line. Both halves and both sides are alike: only |x|, |y| count.
static double line_distance_m(const vs_pitch *p, double x, double y) {
  double ax = fabs(x), ay = fabs(y), d = 1.0;
  if (ax <= p->half_length_m) {
    d = fmin(d, ax);                                       // half-way line
    d = fmin(d, fabs(hypot(ax, ay) - p->circle_radius_m)); // circle
    d = fmin(d, cross_m(ax - p->free_ball_mark_x_m, ay - p->free_ball_mark_y_m, 0.015));
    d = fmin(d, cross_m(ax - p->penalty_mark_x_m, ay, 0.015));
    d = fmin(d, box_edge_m(ax - p->half_length_m, ay, p->area_depth_m, p->area_half_width_m)); // goal area
  }
  if (ay <= p->goal_half_width_m) d = fmin(d, fabs(ax - p->half_length_m)); // goal line
  return d;
}

void vs_paint_floor(uint8_t *rgb, int width, int height, const vs_pitch *pitch) {
  double half_x_m = pitch->half_length_m + pitch->goal_depth_m, half_y_m = pitch->half_width_m;
  double texel_m = 2.0 * half_x_m / width;
  for (int row = 0; row < height; row++)
    for (int column = 0; column < width; column++) {
      double x = (column + 0.5) * texel_m - half_x_m;
      double y = half_y_m - (row + 0.5) * 2.0 * half_y_m / height;
      // Coverage of the texel by the line, for smooth edges.
      double cover = fmin(fmax((LINE_HALF_M - line_distance_m(pitch, x, y)) / texel_m + 0.5, 0.0), 1.0);
      bool inside = fabs(x) <= pitch->half_length_m || fabs(y) <= pitch->goal_half_width_m;
      const uint8_t *ground = inside ? floor_rgb : hall_rgb;
      for (int c = 0; c < 3; c++) *rgb++ = (uint8_t)lround(ground[c] + cover * (line_rgb[c] - ground[c]));
    }
}

static void colour_cap(double u, double v, vs_team team, int index, vs_view view, uint8_t *rgb) {
  static const uint8_t dark[3] = {20, 20, 22};
  if (view == VS_VIEW_CAMERA) {
    double half = 0.5 * VS_RENDER_PATCH_M / VS_ROBOT_SIZE_M;
    memcpy(rgb, fabs(u) < half && fabs(v) < half ? team_rgb[team] : dark, 3);
    return;
  }
  // For people: the back half in the team's colour, the front half with two identity patches, dark seams between.
  bool seam = fabs(u) > 0.46 || fabs(v) > 0.46 || fabs(u) < 0.03 || (u > 0 && fabs(v) < 0.03);
  const uint8_t *colour = u < 0   ? team_rgb[team]
                          : v > 0 ? patch_rgb[index]
                                  : patch_rgb[index < VS_TEAM_SIZE ? (index + 1) % VS_TEAM_SIZE : index];
  memcpy(rgb, seam ? dark : colour, 3);
}

void vs_paint_cap(uint8_t *rgb, int size, vs_team team, int index, vs_view view, const vs_cap *cap) {
  for (int row = 0; row < size; row++)
    for (int column = 0; column < size; column++, rgb += 3) {
      double u = (column + 0.5) / size - 0.5, v = 0.5 - (row + 0.5) / size; // of the cap's width; u forward, v left
      if (!cap->rgb) {
        colour_cap(u, v, team, index, view, rgb);
        continue;
      }
      int px = (int)floor((0.5 - v * VS_ROBOT_SIZE_M / cap->size_m) * cap->px);
      int py = (int)floor((0.5 - u * VS_ROBOT_SIZE_M / cap->size_m) * cap->px);
      if (px >= 0 && px < cap->px && py >= 0 && py < cap->px)
        memcpy(rgb, cap->rgb + 3 * (py * cap->px + px), 3);
      else
        memset(rgb, 255, 3);
    }
}
