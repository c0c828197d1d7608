// `vsss field --overlay FILE`: the camera's pictures with what was found, tracked, predicted and commanded drawn into them, as
// a video in real time. A thread of its own, without real-time priority, draws and writes; the loop only copies a picture,
// and leaves it out where the thread has not done with the one before.
#ifndef VSSS_CLI_FIELD_OVERLAY_H
#define VSSS_CLI_FIELD_OVERLAY_H

#include "vsss/field_loop.h"
#include "vsss/image.h"

#define FIELD_OVERLAY_HZ 30 // of the video; a picture that is left out is shown as the one before

// What is drawn of one turn, but for the pixels.
typedef struct field_scene {
  vs_team team;
  bool turned; // the absolute frame against the calibration's
  vs_world now, ahead;
  vs_detections seen; // none where no picture came
  vs_wheels wheels[VS_TEAM_SIZE];
  bool stop, picture, bridged;
  vs_safety_state safety;
  double age_ms, silent_s, latency_s;
} field_scene;

// Pure.
void field_scene_draw(const field_scene *scene, const vs_calib *calib, vs_image *image);

typedef struct field_overlay field_overlay;

// VS_FAIL, VS_USAGE: as vs_video_open (no ffmpeg, not writable, not the name of a video). field outlives it.
vs_status field_overlay_open(const char *path, const vs_field *field, const vs_field_def *def, field_overlay **out,
                             vs_error *err);
// After each tick.
void field_overlay_show(field_overlay *overlay, const vs_field *field, const vs_field_tick_result *tick);
// Ends the file; VS_FAIL: it is not whole. left_out: pictures that the thread had no time for. NULL is allowed.
vs_status field_overlay_close(field_overlay *overlay, int64_t *left_out, vs_error *err);

#endif
