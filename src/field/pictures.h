// What the camera saw, for people who watch over LCM: a few small JPEGs a second on VSSS_IMAGE. They are made by a thread
// of their own; the pipeline only copies a frame when one is due.
#ifndef VSSS_FIELD_PICTURES_H
#define VSSS_FIELD_PICTURES_H

#include "vsss/bus.h"
#include "vsss/camera.h"

typedef struct vs_pictures vs_pictures;

// bus: the caller's, stays open until vs_pictures_free. hz: 0.1..5. VS_FAIL: no OpenCV to make JPEGs with (says what to
// install).
vs_status vs_pictures_new(vs_bus *bus, double hz, vs_pictures **out, vs_error *err);
void vs_pictures_free(vs_pictures *pictures); // NULL is allowed

// Called for every frame: copies it when the next picture is due and the last one has left. utime_capture_us: since the
// epoch.
void vs_pictures_show(vs_pictures *pictures, const vs_frame *frame, int64_t utime_capture_us);

int64_t vs_pictures_lost(vs_pictures *pictures); // that could not be made or sent; NULL: 0

#endif
