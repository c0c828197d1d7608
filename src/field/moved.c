#include "moved.h"

#include <stdio.h>

vs_status vs_moved_open(vs_moved *moved, const vs_calib *calib, vs_error *err) {
  return vs_calib_watch_new(calib, &moved->watch, err);
}

void vs_moved_close(vs_moved *moved) {
  vs_calib_watch_free(moved->watch);
  moved->watch = NULL;
}

const char *vs_moved_look(vs_moved *m, const vs_frame *frame) {
  if (!m->watch || frame->capture_us < m->next_us) return NULL;
  m->next_us = frame->capture_us + VS_MOVED_PERIOD_US;
  vs_calib_watch_result now = vs_calib_watch_check(m->watch, frame);
  if (!now.sure) return NULL;
  if (now.error_mm < VS_CALIB_WATCH_WARN_MM) m->told_mm = 0;
  if (now.error_mm < m->told_mm + VS_CALIB_WATCH_WARN_MM) return NULL;
  m->told_mm = now.error_mm;
  snprintf(m->said, sizeof m->said,
           "warning: the camera has moved: the field's %s are up to %.0f mm from where the calibration has them; "
           "calibrate anew",
           now.lines ? "lines" : "walls", now.error_mm);
  return m->said;
}
