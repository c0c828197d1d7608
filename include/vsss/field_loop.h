// The real field, or a rig: newest frame -> tags -> poses -> tracked world -> policy -> wheels -> safety -> framed bytes
// -> radio, then LCM. One pipeline thread, driven by frames; beside it one thread that repeats the newest command at
// 50 Hz and stops the robots when it grows old.
#ifndef VSSS_FIELD_LOOP_H
#define VSSS_FIELD_LOOP_H

#include "vsss/calib.h"
#include "vsss/camera.h"
#include "vsss/detect.h"
#include "vsss/histogram.h"
#include "vsss/radio_link.h"
#include "vsss/radio_serial.h"
#include "vsss/safety.h"
#include "vsss/track.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// No decision is made on a frame older than this; a policy that sees the past steers into walls.
#define VS_FIELD_MAX_AGE_US 100000

typedef struct vs_field_def {
  const char *camera; // source (camera.h)
  const char *calib;  // file; NULL: a camera camera_height_m straight above the middle, as high as it must be
  const char *radio;  // serial device; NULL: a dry run, everything but the bytes on the line
  const char *policy; // player URI
  vs_team team;       // ours; which way it attacks is in tracker.attack_plus_x
  uint64_t seed;      // of a policy that draws
  double duration_s;  // of the match, for the policy's clock; a referee on LCM says otherwise
  int baud;
  uint8_t radio_id[VS_TEAM_SIZE]; // number on the air of robot i
  double camera_height_m;
  vs_camera_def camera_def;
  vs_detector_def detector;
  vs_track_def tracker;
  bool lcm;            // publish, and listen to a referee
  double image_hz;     // pictures a second on VSSS_IMAGE, 0.1..5; 0: none
  const char *lcm_url; // NULL: the default one, without which we play on; given: failing to open it is an error
} vs_field_def;
vs_field_def vs_field_def_default(void);

// Where the time of a frame goes. The first is counted from mid-exposure, the next from the end of the one before; AGE
// and TOTAL again from mid-exposure, for frames that were decided on only: to the decision, and to the bytes written.
typedef enum vs_stage {
  VS_STAGE_CAMERA,
  VS_STAGE_DETECT,
  VS_STAGE_TRACK,
  VS_STAGE_CONTROL,
  VS_STAGE_WRITE,
  VS_STAGE_PUBLISH,
  VS_STAGE_AGE,
  VS_STAGE_TOTAL,
  VS_STAGES
} vs_stage;
const char *vs_stage_name(vs_stage stage);

typedef struct vs_field_stats {
  int64_t frames;       // taken from the camera
  int64_t dropped;      // by the camera or because we were busy: gaps in its numbering
  int64_t too_old;      // not decided on: older than VS_FIELD_MAX_AGE_US
  int64_t decisions;    // commands made
  int64_t missed_ticks; // decision periods that went by without one while frames came
  int64_t events;       // heard from a referee
  int64_t lost_messages;
  vs_histogram stage[VS_STAGES];
  vs_track_stats track;
  vs_serial_stats serial; // zero in a dry run
  vs_radio_robot_state robot[VS_TEAM_SIZE];
} vs_field_stats;

// What one frame came to.
typedef struct vs_field_tick_result {
  vs_camera_got got;      // the rest is valid for VS_CAMERA_FRAME only
  vs_world world;         // tracked, at the frame's capture time
  bool decided, stop;     // stop: safety holds the robots
  vs_safety_state safety; // and why
  vs_wheels wheels[VS_TEAM_SIZE];
  int64_t age_us; // of the frame when the bytes were written
} vs_field_tick_result;

typedef struct vs_field vs_field;

// Opens everything; the robots are told to stop from here on. note (may be NULL): lines worth showing, each ended by a
// newline: what was assumed, what the camera refused, why there is no LCM.
vs_status vs_field_new(const vs_field_def *def, vs_field **out, char *note, size_t note_size, vs_error *err);
// Sends stop frames, waits until they have left, closes all. NULL is allowed.
void vs_field_free(vs_field *field);

// Waits for the next frame (up to 100 ms) and takes it all the way to the wheels. VS_FAIL: camera gone, policy broken.
vs_status vs_field_tick(vs_field *field, vs_field_tick_result *out, vs_error *err);

void vs_field_get_stats(vs_field *field, vs_field_stats *out);
const vs_tracker *vs_field_tracker(const vs_field *field); // robot[VS_OWN], robot[VS_ADVERSARY]
const vs_camera_info *vs_field_camera(const vs_field *field);

#ifdef __cplusplus
}
#endif
#endif
