// The camera as the field needs it: one that goes away is looked for until it is back, and one that comes back with
// pictures of another size than the calibration's is refused until it gives them again.
#ifndef VSSS_FIELD_EYES_H
#define VSSS_FIELD_EYES_H

#include "vsss/camera.h"

#define VS_EYES_RETRY_MAX_US 250000 // between two looks for a camera that is gone

typedef struct vs_eyes {
  const char *source; // the definition's
  vs_camera_def def;
  vs_camera *camera;   // NULL: gone
  vs_camera_info info; // of the camera that is, or was last, there
  int width, height;   // of every picture; those of the first camera
  bool live;           // a device or a rig, not a recording
  int64_t retry_us, pause_us;
  int64_t lost, reopened; // how often
  char why[256];          // it is gone
} vs_eyes;

// VS_FAIL, VS_USAGE: as vs_camera_open; a camera must be there at the start.
vs_status vs_eyes_open(vs_eyes *eyes, const char *source, const vs_camera_def *def, vs_error *err);
void vs_eyes_close(vs_eyes *eyes);

// As vs_camera_read, but a live camera that fails is closed and looked for again after 50 ms, doubling to
// VS_EYES_RETRY_MAX_US: VS_CAMERA_TIMEOUT, with eyes->camera NULL until it is back. VS_FAIL: a recording that cannot be
// read.
vs_status vs_eyes_read(vs_eyes *eyes, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err);

// Gives the camera up as if it had failed.
void vs_eyes_lose(vs_eyes *eyes, const char *why);

#endif
