// Whether the camera still hangs where it hung when it was calibrated: the field's lines, or its walls, are looked for where
// the calibration says they are, and around it. Pure; some milliseconds for a picture, so for the start and now and then.
#ifndef VSSS_CALIB_WATCH_H
#define VSSS_CALIB_WATCH_H

#include "vsss/calib.h"
#include "vsss/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_CALIB_WATCH_REACH_M 0.36 // further off it is not looked for
#define VS_CALIB_WATCH_WARN_MM 15.0 // what a user should hear of; the walls alone are worth 5 to 10

typedef struct vs_calib_watch_result {
  bool sure;       // false: neither lines nor walls stand out, nothing can be said
  bool lines;      // seen by the lines (else by the walls)
  double error_mm; // how far a corner of the field seems to be from where the calibration has it
  double x_m, y_m; // the shift, in the calibration's frame
  double turn_rad; // about the field's centre
} vs_calib_watch_result;

typedef struct vs_calib_watch vs_calib_watch;
// VS_FAIL: out of memory, or a calibration that shows no field.
vs_status vs_calib_watch_new(const vs_calib *calib, vs_calib_watch **out, vs_error *err);
void vs_calib_watch_free(vs_calib_watch *watch); // NULL is allowed
// frame must have the calibration's size. Uses frame->grey only; allocates nothing.
vs_calib_watch_result vs_calib_watch_check(vs_calib_watch *watch, const vs_frame *frame);

#ifdef __cplusplus
}
#endif
#endif
