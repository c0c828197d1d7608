// What robots wear on top so that a camera knows them: which kinds there are, and each as the picture of an 80 mm cap.
#ifndef VSSS_MARK_H
#define VSSS_MARK_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_mark {
  VS_MARK_APRIL, // an AprilTag; legal where white is allowed
  VS_MARK_ARUCO, // ArUco Original; what LARC 2026 asks for
  VS_MARK_PATCH, // the team's colour in the middle and nothing else: a place without id or heading
  VS_MARKS
} vs_mark;
const char *vs_mark_name(vs_mark mark); // "april" ...
// theirs: whether opponents wear it. VS_USAGE: unknown, or not for that side; the text names what is.
vs_status vs_mark_parse(const char *what, const char *text, bool theirs, vs_mark *out, vs_error *err);

// LARC VSSS 2026 rules: marker 70 mm with a light margin of 5 mm; 7 x 7 cells, the outer ring dark.
#define VS_ARUCO_SIDE_M   0.070
#define VS_ARUCO_MARGIN_M 0.005
#define VS_ARUCO_CELLS    7
// By the same rules: blue 256, 272, 273 (white on blue), yellow 955, 771, 939 (yellow on black). Any two of them differ in
// at least 3 of 25 bits however they are turned, so that one corrected bit is safe.
extern const int vs_aruco_league_id[VS_TEAMS][VS_TEAM_SIZE];

// A cap as a picture: px x px, red, green, blue, row 0 to the front, column 0 to the left, size_m wide in the cap's middle.
// What lies outside of it on the cap is white.
enum { VS_MARK_PX = 32 };
typedef struct vs_mark_picture {
  int px;
  double size_m;
  uint8_t rgb[VS_MARK_PX * VS_MARK_PX * 3];
} vs_mark_picture;
// VS_USAGE: no such id.
vs_status vs_mark_paint(vs_mark mark, vs_team team, int id, vs_mark_picture *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
