// What a robot makes of its commands: how long until one acts, how fast the wheels follow, how far. Fitted to what a camera
// saw of it. Pure.
//
// Model: each motor pulls in proportion to the gap between its wheel's speed and gain * command(t - delay), up to a limit.
// Both pull the robot forward and, the one against the other, turn it: speed' = gap / time constant, one time constant for
// driving straight and one for turning (mass and moment of inertia load the motors differently).
#ifndef VSSS_IDENTIFY_H
#define VSSS_IDENTIFY_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_motion_command {
  int64_t time_us; // when its bytes were written
  vs_wheels wheels;
} vs_motion_command;

typedef struct vs_motion_sight {
  int64_t time_us; // mid-exposure, of the same clock
  vs_pose pose;    // theta: where the robot's front points
} vs_motion_sight;

typedef struct vs_identified {
  int samples; // frames used
  double delay_s, tau_straight_s, tau_turn_s, gain_left, gain_right;
  double limit_radps;        // the gap at which a motor's torque stops growing; 0: it did not come to that
  double error_m, error_rad; // deviation of what is left, per frame
} vs_identified;

// Both in the order of time. VS_FAIL: too little to tell from, or hardly commanded; says what to record.
vs_status vs_identify(const vs_motion_command *command, int commands, const vs_motion_sight *sight, int sights,
                      vs_identified *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
