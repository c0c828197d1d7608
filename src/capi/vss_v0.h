// One environment of rSoccer's VSS-v0 task on our simulator.
//
// What a script written for rsoccer-gym 1.4 relies on is kept: fields and their order, scales, rewards, random drivers, 25 ms
// a step (the model's frame_hz is 40, so a step is a whole number of physics steps). What differs is the simulator: true
// velocities instead of differences, robots of 8 cm with wheels of 3 cm (a wheel command is still a rim speed), pieces put
// down at least 12 cm apart so that none overlap (there 10 cm).
#ifndef VSSS_CAPI_VSS_V0_H
#define VSSS_CAPI_VSS_V0_H

#include "capi_internal.h"
#include "vsss/rng.h"

// rsoccer-gym 1.4 with rc-robosim 1.2, as its objects say: 440 rpm on wheels of 2.6 cm, and a robot of 4 cm radius.
#define VSS_V0_MAX_MPS   1.1979939985689076
#define VSS_V0_MAX_DEGPS 1715.9999999999998
#define VSS_V0_MAX_POS_M 0.9
#define VSS_V0_BOUND     1.2
#define VSS_V0_WHEEL_M   0.026
#define VSS_V0_DEAD_ZONE 0.05 // m/s
#define VSS_V0_OU_THETA  0.17
#define VSS_V0_OU_SIGMA  0.5
#define VSS_V0_APART_M   0.12
#define VSS_V0_GOAL      10.0
#define VSS_V0_MOVE      0.2
#define VSS_V0_BALL      0.8
#define VSS_V0_ENERGY    2e-4

// Plain data: a copy is, with the simulator's own, a snapshot.
typedef struct vss_v0 {
  vs_rng rng;
  uint64_t seed, episode;                    // of the environment; the number of the next episode
  double driver[VS_TEAMS * VS_TEAM_SIZE][2]; // of the random drivers
  double potential;                          // of the ball, in the last step
  bool has_potential;
  int steps;
  double shaping[CAPI_SHAPING]; // sums since the reset, in the order of vs_capi_name("shaping")
  vs_world world;
} vss_v0;

void vss_v0_reset(vss_v0 *e, vs_sim *sim, const vs_realism *realism);
void vss_v0_observe(const vss_v0 *e, float out[CAPI_VSS_OBSERVATION]);
// action: left and right wheel in [-1, 1], clipped. goal: the ball is behind a goal line.
vs_status vss_v0_step(vss_v0 *e, vs_sim *sim, const float action[CAPI_VSS_ACTION], float *reward, bool *goal,
                      vs_error *err);

#endif
