// What a team's camera and radio make of the true world: noise, delay, lost detections; and what its radio makes of
// commands. Default: the paper's noise, nothing else. Ranges: field.md 6.3, deploy/config/realism.ini.
#ifndef VSSS_SENSOR_MODEL_H
#define VSSS_SENSOR_MODEL_H

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

// A range from which one value an episode is drawn; low == high: fixed.
typedef struct vs_range {
  double low, high;
} vs_range;

typedef struct vs_realism {
  bool noise;                                      // the paper's noise at all
  vs_range noise_scale;                            // 1
  vs_range position_bias_m, heading_bias_rad;      // amplitude of a constant offset; 0
  vs_range position_scale;                         // 1
  vs_range latency_s, latency_jitter_s;            // capture -> wheel; 0
  vs_range detection_loss, detection_burst_frames; // probability per object and frame; length; 0, 1
  vs_range radio_loss, radio_burst_frames;         // probability per frame; length; 0, 1
  vs_range motor_tau_s, wheel_gain, wheel_limit_scale, dead_zone_radps;
  vs_range floor_friction_scale, robot_mass_scale, ball_mass_scale, ball_rolling_scale;
} vs_realism;

vs_realism vs_realism_default(void);                                         // the paper's noise only
vs_status vs_realism_load(const char *path, vs_realism *out, vs_error *err); // INI over the default

#define VS_SENSOR_DELAY_FRAMES 8
// One match's sensors and radios. Plain data: a copy is a snapshot. Truth in, measurement out, once a frame; both
// teams see the same camera. Latency delays the commands (camera and radio delay are one number to the policy).
typedef struct vs_sensors {
  vs_rng rng;
  vs_sim_params params; // drawn for this episode
  double noise_scale, bias_x_m, bias_y_m, bias_heading_rad, position_scale, latency_s, latency_jitter_s;
  double detection_loss, detection_burst_frames, radio_loss, radio_burst_frames;
  bool noise;
  int lost_frames[VS_TEAMS * VS_TEAM_SIZE + 1]; // left in this burst; the ball is last
  int radio_lost_frames[VS_TEAMS];
  vs_world last; // last measurement: held where a detection is lost
  int have_last;
  vs_wheels queue[VS_SENSOR_DELAY_FRAMES][VS_TEAMS][VS_TEAM_SIZE]; // newest first
  vs_wheels applied[VS_TEAMS][VS_TEAM_SIZE];
} vs_sensors;

void vs_sensors_reset(vs_sensors *sensors, const vs_realism *realism, uint64_t seed);
void vs_sensors_measure(vs_sensors *sensors, const vs_world *truth, vs_world *measured);
// Commands as decided in this frame -> commands as they arrive at the robots in this frame.
void vs_sensors_command(vs_sensors *sensors, const vs_wheels in[VS_TEAMS][VS_TEAM_SIZE],
                        vs_wheels out[VS_TEAMS][VS_TEAM_SIZE]);

#ifdef __cplusplus
}
#endif
#endif
