// Stable: part of libvsss (deploy/docs/library.md).
//
// What a team's camera and radio make of the true world: noise, delay, lost detections; and what its radio makes of
// commands. Default: the paper's noise, nothing else. Ranges: field.md, Ranges, deploy/config/realism.ini.
#ifndef VSSS_SENSOR_MODEL_H
#define VSSS_SENSOR_MODEL_H

#include "vsss/api.h"
#include "vsss/kalman.h"
#include "vsss/rng.h"
#include "vsss/sim.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Paper, section VI: deviation of one measurement.
#define VS_NOISE_X_M         1.854e-3
#define VS_NOISE_Y_M         1.679e-3
#define VS_NOISE_HEADING_RAD 3.123e-2

// A range from which one value an episode is drawn, for each wheel or robot where they differ; low == high: fixed.
typedef struct vs_range {
  double low, high;
} vs_range;

typedef struct vs_realism {
  bool noise;              // the paper's noise at all
  double ideal_share;      // of the episodes have the default instead of this; 0
  double never_seen_share; // of the episodes, for each team: it never sees the ball, and so for each opponent; 0
  vs_range noise_scale;    // 1
  vs_range position_bias_m, heading_bias_rad;      // size of a constant offset, in a random direction; 0
  vs_range position_scale;                         // 1
  vs_range latency_s, latency_jitter_s;            // capture -> wheel; changes by up to +- jitter each frame; 0
  vs_range detection_loss, detection_burst_frames; // probability per object and frame; length of each; 0, 1
  vs_range radio_loss, radio_burst_frames;         // probability per team and frame; length of each; 0, 1
  vs_range motor_tau_s, wheel_gain, wheel_limit_scale, dead_zone_radps;
  vs_range wheel_radius_scale, track_scale, com_offset_m;
  vs_range floor_friction_scale, robot_mass_scale, ball_mass_scale, ball_rolling_scale, ball_restitution;
  vs_range push_per_s, push_mps;
} vs_realism;

VSSS_API vs_realism vs_realism_default(void); // the paper's noise only
// INI over the default: one section per range of the struct with keys low and high; noise = true or false and
// ideal_share, never_seen_share = 0 to 1 at the top.
VSSS_API vs_status vs_realism_load(const char *path, vs_realism *out, vs_error *err);
VSSS_API vs_status vs_realism_parse(const char *name_for_errors, const char *text, vs_realism *out, vs_error *err);
// The simulator's parameters of the episode with this seed.
VSSS_API vs_sim_params vs_realism_draw(const vs_realism *realism, uint64_t seed);

#define VS_SENSOR_DELAY_FRAMES 8
#define VS_SENSOR_OBJECTS      (VS_TEAMS * VS_TEAM_MOST + 1) // team * VS_TEAM_MOST + robot; the ball is last
// How fast robots and ball may change their velocity: the deviations of the filter that estimates it, on the field too.
#define VS_SENSOR_ROBOT_ACCELERATION_MPS2  6.0
#define VS_SENSOR_BALL_ACCELERATION_MPS2   20.0
#define VS_SENSOR_TURN_ACCELERATION_RADPS2 200.0
// One match's sensors and radios. Plain data: a copy is a snapshot. Truth in, measurement out, once a frame; both
// teams see the same camera. Latency delays the commands (camera and radio delay are one number to the policy).
typedef struct vs_sensors {
  vs_rng rng;
  vs_sim_params params; // drawn for this episode
  bool noise;
  double noise_scale, bias_x_m, bias_y_m, bias_heading_rad, position_scale;
  double latency_s, latency_jitter_s, detection_loss, radio_loss;
  vs_range detection_burst_frames, radio_burst_frames;
  int lost_frames[VS_SENSOR_OBJECTS]; // left in this burst
  int held_frames[VS_SENSOR_OBJECTS]; // since the last detection; what is told meanwhile: unseen.h
  int radio_lost_frames[VS_TEAMS];
  vs_kalman filter[VS_SENSOR_OBJECTS][3]; // x, y, heading of what was measured: whence the velocities
  bool filtering[VS_SENSOR_OBJECTS];      // ... seen since the last restart
  vs_world last;                          // each object's last measurement
  bool ever[VS_SENSOR_OBJECTS];           // seen since the reset
  vs_wheels queue[VS_SENSOR_DELAY_FRAMES][VS_TEAMS][VS_TEAM_MOST]; // newest first
  vs_wheels applied[VS_TEAMS][VS_TEAM_MOST];
} vs_sensors;

// A new episode from this seed; give params to vs_sim_reset.
VSSS_API void vs_sensors_reset(vs_sensors *sensors, const vs_realism *realism, uint64_t seed);
// Whether they can be gone on from: false for numbers that no reset and no frame makes, as in a damaged file.
VSSS_API bool vs_sensors_ok(const vs_sensors *sensors);
// Velocities are those that a Kalman filter of the measured poses estimates, as on the field; wheel speeds are not seen
// by a camera and become 0.
VSSS_API void vs_sensors_measure(vs_sensors *sensors, const vs_world *truth, vs_world *measured);
// What each team's camera misses for a whole episode, of the ball and the opponents: colours that nobody taught it. The same
// realism and seed as given to vs_sensors_reset, the same answer; it is part of no state.
VSSS_API void vs_sensors_never(const vs_realism *realism, uint64_t seed, bool never[VS_TEAMS][VS_SENSOR_OBJECTS]);
// What is measured as one team is told it: what it never sees as unseen.h says.
VSSS_API void vs_sensors_hide(const bool never[VS_SENSOR_OBJECTS], vs_world *measured);
// After a placement: what is seen next says nothing about how fast anything moved.
VSSS_API void vs_sensors_restart(vs_sensors *sensors);
// Commands as decided in this frame -> commands at the robots, the mean over this frame. A delay of 1.8 frames mixes
// the commands of one and two frames ago, 0.2 to 0.8. A team whose radio frame is lost keeps its last command. A robot that
// is no longer seen is told to stand, as on the field.
VSSS_API void vs_sensors_command(vs_sensors *sensors, const vs_wheels in[VS_TEAMS][VS_TEAM_MOST],
                                 vs_wheels out[VS_TEAMS][VS_TEAM_MOST]);

#ifdef __cplusplus
}
#endif
#endif
