// What robots wear on top so that a camera knows them: which kinds there are, and each as the picture of an 80 mm cap.
#ifndef VSSS_MARK_H
#define VSSS_MARK_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_mark {
  VS_MARK_APRIL,  // an AprilTag; legal where white is allowed
  VS_MARK_ARUCO,  // ArUco Original; what LARC 2026 asks for
  VS_MARK_COLOUR, // a plate of three colours, as the rules of 2023 to 2025 ask for
  VS_MARK_PATCH,  // the team's colour in the middle and nothing else: a place without id or heading
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

// Colour plates (rules of 2023): on 80 mm a bar of the team's colour, 30 x 65 mm, at the robot's rear, and in front of it two
// squares of 30 x 30 mm, 5 mm apart. The squares' colours say which robot it is. Hue in degrees and saturation (0..1) are
// what a camera sees of them; a colour counts as the nearest of the four.
#define VS_PLATE_SIDE_M           0.065
#define VS_PLATE_SQUARE_M         0.030
#define VS_PLATE_LEAST_ELONGATION 1.4 // of a bar; 2.17 unblurred
typedef enum vs_plate_colour {
  VS_PLATE_RED,
  VS_PLATE_GREEN,
  VS_PLATE_PINK,
  VS_PLATE_CYAN,
  VS_PLATE_COLOURS
} vs_plate_colour;
typedef struct vs_hue {
  double hue_deg, saturation;
} vs_hue;
extern const uint8_t vs_team_rgb[VS_TEAMS][3], vs_plate_rgb[VS_PLATE_COLOURS][3]; // as printed
extern const vs_hue vs_plate_default[VS_PLATE_COLOURS];
const char *vs_plate_colour_name(vs_plate_colour colour); // "red" ...
// The id of a plate: left and right square, seen from behind.
int vs_plate_code(vs_team team, int left, int right);
// "red green": left and right. "" or "-": no such robot, *code -1. VS_USAGE: anything else.
vs_status vs_plate_parse(const char *what, const char *text, vs_team team, int *code, vs_error *err);
// What the rig draws and field.ini says: robot 0 red green, 1 green pink, 2 pink cyan.
int vs_plate_default_code(vs_team team, int index);

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
