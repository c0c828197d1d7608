// A venue without hardware: a match in real time whose own team is driven over a radio and seen by a camera, as on a real
// field. The simulator moves the pieces, the referee judges and places them, the opponents are any player; the camera is
// a frame stream (frame_stream.h), the radio a pseudo terminal behind which the robots' firmware runs.
#ifndef VSSS_RIG_H
#define VSSS_RIG_H

#include "vsss/frame_stream.h"
#include "vsss/mark.h"
#include "vsss/radio_codec.h"
#include "vsss/referee.h"
#include "vsss/sim.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// From a picture to the wheels that answer to it, where `field` needs less than that for it: motors are told what came over
// the air once a picture, at the next one's moment.
#define VS_RIG_LATENCY_S (1.0 / VS_CAMERA_HZ)

// What spoils the camera's pictures; all 0: nothing does.
typedef struct vs_rig_optics {
  double noise;      // deviation, grey levels
  double uneven;     // share of the light that the darkest corner lacks, 0..1
  double blur_px;    // deviation of the lens's blur
  double lens_k1;    // radial distortion as calib.h has it, -0.4 (barrel) to 0.4; calib.ini carries it
  double exposure_s; // for so long things move while a picture is taken
} vs_rig_optics;

typedef struct vs_rig_def {
  const vs_model *model; // outlives the rig
  vs_team team;          // the one with tags and radios, played by `vsss field`
  const char *opponent;  // player URI
  vs_referee_def referee;
  uint64_t seed;
  int width_px, height_px;
  double camera_height_m;
  bool white_walls; // as LARC 2026 has them
  vs_rig_optics optics;
  int delay_frames;         // pictures by which the own robots act late, as slow electronics would: 0 to 10
  bool opponent_at_once;    // the other team's commands act in the picture they answer to; else VS_RIG_LATENCY_S and
                            // delay_frames later, at most 7 pictures, as the own team's do
  vs_mark own, their;       // what the teams wear: VS_MARK_APRIL, VS_MARK_PATCH
  int tag_id[VS_TEAM_SIZE]; // AprilTags of the own team; ArUco marks are the league's
  uint8_t radio_id[VS_TEAM_SIZE];
  vs_radio_key key;    // that the own robots have
  const char *folder;  // where camera, radio and calib.ini are put; made if it is missing
  bool lcm;            // VSSS_TRUTH and VSSS_REFEREE
  const char *lcm_url; // NULL: the default one, without which the rig goes on; given: failing to open it is an error
} vs_rig_def;
vs_rig_def vs_rig_def_default(const vs_model *model);

typedef struct vs_rig vs_rig;

// note: as in vs_field_new.
vs_status vs_rig_new(const vs_rig_def *def, vs_rig **out, char *note, size_t note_size, vs_error *err);
void vs_rig_free(vs_rig *rig); // NULL is allowed; removes what it put into the folder

typedef struct vs_rig_step_result {
  bool playing;   // false: waiting for somebody to open the camera
  bool over;      // the match ended with this frame; the next call starts another
  vs_event event; // of this frame
  vs_world truth; // time_us is that of the picture, monotonic clock
  int skipped;    // pictures not drawn because the machine was late; their frames were simulated all the same
} vs_rig_step_result;

// Waits for the next frame's moment while it serves the radio, simulates it and shows it to the camera.
vs_status vs_rig_step(vs_rig *rig, vs_rig_step_result *out, vs_error *err);

typedef struct vs_rig_stats {
  int64_t frames;   // simulated
  int64_t late;     // pictures skipped
  int64_t touches;  // times an own robot came to touch the ball
  int64_t commands; // radio frames that the own robots took, all three together
  int64_t driven;   // frames in which an own robot's wheels were commanded to turn
  double act_s;     // from a new command's bytes to what the robots make of it, in the mean; 0: there was none
  vs_frame_server_stats camera;
} vs_rig_stats;
vs_rig_stats vs_rig_get_stats(vs_rig *rig);
const vs_game *vs_rig_game(const vs_rig *rig);

// Paths to hand to `vsss field`.
const char *vs_rig_camera_path(const vs_rig *rig); // of the socket
const char *vs_rig_radio_path(const vs_rig *rig);  // a link to the pseudo terminal
const char *vs_rig_calib_path(const vs_rig *rig);

#ifdef __cplusplus
}
#endif
#endif
