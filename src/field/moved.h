// Looks now and then whether the camera still hangs where it was calibrated.
#ifndef VSSS_FIELD_MOVED_H
#define VSSS_FIELD_MOVED_H

#include "vsss/calib_watch.h"

#define VS_MOVED_PERIOD_US 10000000

typedef struct vs_moved {
  vs_calib_watch *watch; // NULL: no calibration file to check
  int64_t next_us;
  double told_mm;
  char said[200];
} vs_moved;

vs_status vs_moved_open(vs_moved *moved, const vs_calib *calib, vs_error *err);
void vs_moved_close(vs_moved *moved);
// Some milliseconds where a look is due. Returns a warning where the camera has moved, or has moved on, else NULL.
const char *vs_moved_look(vs_moved *moved, const vs_frame *frame);

#endif
