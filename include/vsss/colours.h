// Colours of a venue, learnt from labelled points of a picture, and put into a copy of the field's configuration.
#ifndef VSSS_COLOURS_H
#define VSSS_COLOURS_H

#include "vsss/detect.h"

#ifdef __cplusplus
extern "C" {
#endif

// What a point can show: ball, blue, yellow (ranges of vs_detector_def), then the squares of colour plates.
enum {
  VS_COLOUR_BALL,
  VS_COLOUR_BLUE,
  VS_COLOUR_YELLOW,
  VS_COLOUR_SQUARE,
  VS_COLOURS = VS_COLOUR_SQUARE + VS_PLATE_COLOURS
};
const char *vs_colour_name(int colour); // "ball", "blue", "yellow", "red", "green", "pink", "cyan"

typedef struct vs_colour_point {
  double x_px, y_px; // inside the patch, at least 3 px from its rim
  int colour;
} vs_colour_point;
// From a text file, one a line: x_px y_px NAME; "#" begins a comment. VS_USAGE names the line and the fix.
vs_status vs_colours_load_points(const char *path, vs_colour_point *out, int capacity, int *count, vs_error *err);

// Sets in def the colours that have points; the others stay. Each range spans what was seen with some room, but no more than
// half of the way to the next labelled colour. VS_USAGE: a point off the picture, or on something without colour.
vs_status vs_colours_learn(const vs_frame *frame, const vs_colour_point *points, int count, vs_detector_def *def,
                           vs_error *err);

// Writes to path the configuration file from with def's colours in its [vision] section; everything else stays as it is.
vs_status vs_colours_save(const char *path, const char *from, const vs_detector_def *def, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
