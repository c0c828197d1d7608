// Robots as other simulators of the league have them. Their clients command wheels of another radius than ours; how fast
// a robot then drives is set by its rim speed, so a command w of theirs is w * wheel_radius_m / VS_WHEEL_RADIUS_M of
// ours, and both saturate at the same rim speed.
#ifndef VSSS_ROBOT_PRESET_H
#define VSSS_ROBOT_PRESET_H

#include "vsss/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_robot_preset {
  const char *name;
  double wheel_radius_m;                                      // that commands from outside mean
  double accelerate_mps2, brake_mps2, ball_deceleration_mps2; // 0: ours
  double ball_restitution;                                    // at walls
} vs_robot_preset;

// "paper": ours. "firasim": wheels of 2 cm, acceleration and braking as a team fitted them to FIRASim, its ball's rolling
// and bounce. "travesim": wheels of 2.5 cm, else ours.
vs_status vs_robot_preset_find(const char *name, const vs_robot_preset **out, vs_error *err);
vs_sim_params vs_robot_preset_params(const vs_robot_preset *preset);
// A command in rad/s of the preset's wheel in rad/s of ours, not limited.
vs_wheels vs_robot_preset_wheels(const vs_robot_preset *preset, vs_wheels command);

#ifdef __cplusplus
}
#endif
#endif
