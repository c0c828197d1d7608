// What `vsss calibrate` is asked for, and each thing it does. All print what they found; VS_USAGE where a flag is missing.
#ifndef VSSS_CLI_CALIBRATE_H
#define VSSS_CLI_CALIBRATE_H

#include "cli.h"
#include "vsss/calib.h"
#include "vsss/camera.h"

enum { CALIBRATE_MOST_POINTS = 256 };

typedef struct calibrate_request {
  const char *camera, *points, *calib, *out, *size, *board, *print_tags, *family, *snapshot, *colours, *config;
  double height_m, square_mm, paper_mm, tolerance_mm, tag_height_mm;
  int pictures;
  bool check;
  vs_flag_list at;
} calibrate_request;

vs_status calibrate_lens(const calibrate_request *r, vs_error *err);   // by pictures of a checkerboard
vs_status calibrate_points(const calibrate_request *r, vs_error *err); // where the camera hangs, by measured points
vs_status calibrate_colours(const calibrate_request *r, vs_error *err);

// VS_FAIL where r->calib is off by more than is tolerated: at r->points, at the tags of r->at, by the field's own lines.
vs_status calibrate_check_points(const calibrate_request *r, vs_error *err);
vs_status calibrate_check_tags(const calibrate_request *r, vs_error *err);
vs_status calibrate_check_field(const calibrate_request *r, vs_error *err);

// What they share. Both cameras are the caller's to close, also after an error.
vs_status calibrate_open_camera(const char *source, bool every_frame, vs_camera **camera, vs_error *err);
// A picture worth learning from: a device's first ones are of its old exposure. It stays the camera's.
vs_status calibrate_settled_picture(const char *source, vs_camera **camera, vs_frame *frame, vs_error *err);
// The points of r->points, and what is known before they are used: r->calib, or an empty calibration of the picture's
// size, which --size or the camera tells.
typedef struct calibrate_measured {
  vs_calib calib;
  vs_calib_point point[CALIBRATE_MOST_POINTS];
  int count;
  char camera[96]; // its name; empty: none was given
} calibrate_measured;
vs_status calibrate_read(const calibrate_request *r, calibrate_measured *out, vs_error *err);
void calibrate_print_points(const calibrate_measured *m);

#endif
