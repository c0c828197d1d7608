// The real field, or a rig: newest frame -> tags -> poses -> tracked world -> policy -> wheels -> safety -> framed bytes
// -> radio, then LCM. One pipeline thread, driven by frames; beside it one thread that repeats the newest command at
// 50 Hz and stops the robots when it grows old; the player lives in a process of its own. Nothing that goes wrong outside
// ends it: deploy/docs/faults.md is the table of what does go wrong, what the robots do, and how play goes on.
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

// A player that has not answered by then hangs: the robots stop and it is started anew.
#define VS_FIELD_PATIENCE_MS 100

// The run that a record is of, for computing it again: instead of a camera, a radio and a clock.
typedef struct vs_field_rerun {
  int width_px, height_px; // of the pictures
  int64_t start_us;        // when it began, monotonic
} vs_field_rerun;

typedef struct vs_field_def {
  const char *camera;   // source (camera.h)
  const char *calib;    // file; NULL: a camera camera_height_m straight above the middle, as high as it must be
  const char *radio;    // serial device; NULL: a dry run, everything but the bytes on the line
  const char *policy;   // player URI
  const char *fallback; // of the player that takes over when that one fails, and the other way round; NULL: none
  vs_team team;         // ours; which way it attacks is in tracker.attack_plus_x
  uint64_t seed;        // of a policy that draws
  double duration_s;    // of the match, for the policy's clock; a referee on LCM says otherwise
  int baud;
  uint8_t radio_id[VS_TEAM_SIZE]; // number on the air of robot i
  vs_radio_key key;               // of our team on the air
  const vs_wire *wire;            // what the robots speak; NULL: our own protocol
  double camera_height_m;
  double latency_s;   // mid-exposure to wheel: players are shown the world moved on by it (vs_control_set_latency)
  bool latency_fixed; // else that is a first guess, until the robots' motion tells (latency_meter.h)
  double ball_hold_s; // a ball never seen, or not for longer, stops the robots; 0: they play on with its last place
  vs_camera_def camera_def;
  vs_detector_def detector;
  vs_track_def tracker;
  bool go;            // the robots may move from the start, and after a FAULT by itself: for rigs and unattended tests
  bool referee_goes;  // a referee on LCM releases the robots with each restart and stops them at half time
  bool lcm;           // publish, and listen to a referee
  double image_hz;    // pictures a second on VSSS_IMAGE, 0.1..5; 0: none
  bool lcm_remote;    // hear a referee on another machine too
  const char *record; // file: a log of LCM from which the run can be computed again; NULL: none
  const char *config_file;     // the field.ini this was made of, for the record; NULL: none
  const vs_field_rerun *rerun; // NULL: a field
  const char *lcm_url;         // NULL: the default one, without which we play on; given: failing to open it is an error
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
  double latency_s;     // what the player's world is moved on by now
  bool latency_told;    // ... by the robots' motion
  int64_t bridged;      // missing frames that the prediction stood in for
  int64_t camera_lost, camera_reopened;
  int64_t player_failures; // wrong numbers, crashes, hangs; the robots stopped and the player was started anew
  int64_t events;          // heard from a referee
  int64_t lost_messages;
  int64_t lost_record; // messages that the record lacks
  vs_histogram stage[VS_STAGES];
  vs_track_stats track;
  uint64_t entered[VS_SAFETY_STATES]; // how often each state of safety.h
  vs_serial_stats serial;             // zero in a dry run
  vs_radio_robot_state robot[VS_TEAM_SIZE];
} vs_field_stats;

// What one frame came to, or the time in which none came.
typedef struct vs_field_tick_result {
  vs_camera_got got;      // VS_CAMERA_TIMEOUT: no frame; world is then predicted, or the last
  int64_t now_us;         // when the tick ended, monotonic
  int64_t silent_us;      // since the last frame came; without one yet: since the start
  vs_world world;         // tracked, at the frame's capture time
  bool bridged;           // the world was predicted for a frame that did not come, and played on
  const char *said;       // a line worth showing now: what failed, what came back; NULL: nothing. Until the next tick
  bool decided, stop;     // stop: safety holds the robots; where they drive to places nothing is decided
  vs_safety_state safety; // and why
  vs_wheels wheels[VS_TEAM_SIZE];
  int64_t age_us; // of the frame when the bytes were written; of VS_CAMERA_FRAME only
} vs_field_tick_result;

typedef struct vs_field vs_field;

// Opens everything; the robots are told to stop from here on. note (may be NULL): lines worth showing, each ended by a
// newline: what was assumed, what the camera refused, why there is no LCM.
vs_status vs_field_new(const vs_field_def *def, vs_field **out, char *note, size_t note_size, vs_error *err);
// Sends stop frames, waits until they have left, closes all. NULL is allowed.
void vs_field_free(vs_field *field);

// Waits for the next frame (up to 100 ms) and takes it all the way to the wheels. A frame that does not come is bridged by
// the tracker's prediction for VS_TRACK_HOLD_US; then, or when the camera or the player is gone, the robots stop until it
// is back. VS_FAIL: a recording that cannot be read.
vs_status vs_field_tick(vs_field *field, vs_field_tick_result *out, vs_error *err);

// One turn of a record computed again, with def.rerun set: tracker, referee, player and safety as they were then. What came of
// it is in out, and the same in the fields of *again that a turn leaves. VS_FAIL: the turn took another way than the recorded
// one: it looked at the clock more often.
struct vs_tick;
vs_status vs_field_again(vs_field *field, const struct vs_tick *tick, struct vs_tick *again, vs_error *err);

// 16 digits of the file behind a player's URI; "": it has none.
const char *vs_field_policy_hash(const char *uri, char out[20]);

// The operator's word: releases the robots, out of a FAULT too, or stops them at once. Until the first release they stand.
void vs_field_arm(vs_field *field, bool go);

// A network referee's word, beside the operator's. BY_EVENTS: there is none; HALT and END of a referee on LCM stop, all else
// lets play. PLACE: the robots drive to the places of the last restart that was told, without the player.
typedef enum vs_field_task { VS_FIELD_BY_EVENTS, VS_FIELD_STAND, VS_FIELD_PLACE, VS_FIELD_PLAY } vs_field_task;
void vs_field_set_task(vs_field *field, vs_field_task task);
// Its call, as one on LCM would be heard with the next tick. An event NONE leaves the last one, and gives the match's time.
void vs_field_tell(vs_field *field, const vs_event *event);

void vs_field_get_stats(vs_field *field, vs_field_stats *out);
const vs_tracker *vs_field_tracker(const vs_field *field); // robot[VS_OWN], robot[VS_ADVERSARY]
const vs_camera_info *vs_field_camera(const vs_field *field);
const vs_game *vs_field_game(const vs_field *field); // clock and score, as a referee told them; absolute frame
// For who draws what is going on: the picture of the last tick, whole until the next one (NULL: it had none), what was found
// in it, where the camera is, and the world that the player was shown.
const vs_frame *vs_field_frame(const vs_field *field);
const vs_detections *vs_field_seen(const vs_field *field);
const vs_calib *vs_field_calib(const vs_field *field);
void vs_field_ahead(const vs_field *field, const vs_world *now, vs_world *out);
double vs_field_latency_s(const vs_field *field); // by which that world is moved on

#ifdef __cplusplus
}
#endif
#endif
