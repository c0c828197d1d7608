// Stable: part of libvsss (deploy/docs/library.md).
//
// What a player is told of an object that its camera does not see, the same on the field and in the simulator
// (sensor_model.h):
//   not seen for a moment              it goes on as it went, for VS_UNSEEN_HOLD_US: valid
//   for longer, or since a placement   it stays where that ended: not valid, its velocity 0
//   never yet                          a robot is where vs_world_parked says, the ball in the middle: not valid
// An own robot that is not valid gets no command: it stands. What else a team does without a ball is
// the field's own: deploy/docs/faults.md. In the simulator a share of the episodes is without ball or adversaries where the realism
// file says so (never_seen_share).
#ifndef VSSS_UNSEEN_H
#define VSSS_UNSEEN_H

#include <stdint.h>

#include "vsss/api.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_UNSEEN_HOLD_US 100000

// estimate: pose and velocities estimate_us after the last sight; out (may be the same): as told since_us after it.
VSSS_API void vs_unseen_robot(const vs_robot *estimate, int64_t estimate_us, int64_t since_us, vs_robot *out);
VSSS_API void vs_unseen_ball(const vs_ball *estimate, int64_t estimate_us, int64_t since_us, vs_ball *out);

#ifdef __cplusplus
}
#endif
#endif
