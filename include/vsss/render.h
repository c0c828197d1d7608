// Stable: part of libvsss (deploy/docs/library.md).
//
// Pictures of a vs_world, off screen: EGL without a window, drawn by MuJoCo. Two views: BROADCAST for people (coloured
// robots, shadows, score, clock, captions) and CAMERA, the overhead camera of a venue (plain, fast, exact pinhole).
// Only poses are read, so a world from the simulator, a tracker or a log is drawn alike.
#ifndef VSSS_RENDER_H
#define VSSS_RENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/api.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_RENDER_PATCH_M 0.06 // what a camera finds adversaries by

typedef enum vs_view { VS_VIEW_BROADCAST, VS_VIEW_CAMERA } vs_view;

// A picture printed on a robot's cap, size_m wide in the middle of white: px x px of red, green, blue, row 0 at the robot's
// front, column 0 on its left. Read by vs_render_new only.
typedef struct vs_cap {
  const uint8_t *rgb;
  int px;
  double size_m;
} vs_cap;

typedef struct vs_render_def {
  vs_view view;
  vs_division division;    // VS_3V3; the worlds that are drawn are of it
  int width_px, height_px; // 64..3840 x 64..2160
  // What each robot wears. rgb NULL: the team's colour with two identity patches, or for CAMERA a dark cap with a
  // team-coloured square of VS_RENDER_PATCH_M.
  vs_cap cap[VS_TEAMS][VS_TEAM_MOST];
  double camera_height_m; // CAMERA: lens over the floor; 2.2
  bool white_walls;       // CAMERA: instead of dark ones
  const char *title;      // BROADCAST: shown beside the score, such as "EMC  INF"; NULL: none. Copied.
} vs_render_def;

VSSS_API vs_render_def
vs_render_def_default(vs_view view); // 1280x720 broadcast, 640x480 camera, no pictures on the caps

typedef struct vs_render vs_render; // owns one OpenGL context; one thread at a time

// VS_FAIL: no EGL (built without its headers, library or driver missing): says which package to install.
VSSS_API vs_status vs_render_new(const vs_render_def *def, vs_render **out, vs_error *err);
VSSS_API void vs_render_set_title(vs_render *render, const char *title); // as def.title
VSSS_API void vs_render_free(vs_render *render);                         // NULL is allowed

// Draws world into rgb, uint8_t[height_px][width_px][3], top row first. Pieces that are not valid are left out. game:
// NULL for a picture without score and captions; the CAMERA view never shows them.
VSSS_API vs_status vs_render_world(vs_render *render, const vs_world *world, const vs_game *game, uint8_t *rgb,
                                   vs_error *err);

// The CAMERA view's exact geometry: square pixels, no distortion, looking straight down on the field's centre, with the
// image's right = +x and its top = +y. (0, 0) is the outer corner of the first pixel: the middle of 640
// pixels is 320.
// x_px = cx_px + focal_px * x_m / (height_m - z_m), y_px = cy_px - focal_px * y_m / (height_m - z_m).
typedef struct vs_pinhole {
  int width_px, height_px;
  double focal_px, cx_px, cy_px;
  double height_m; // of the lens over the floor
} vs_pinhole;
VSSS_API vs_pinhole vs_render_pinhole(const vs_render *render);

#ifdef __cplusplus
}
#endif
#endif
