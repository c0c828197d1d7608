// Stable: part of libvsss (deploy/docs/library.md).
//
// World -> floats and floats -> wheels, pure, the same object file in simulation and on the field.
#ifndef VSSS_OBSERVE_H
#define VSSS_OBSERVE_H

#include "vsss/api.h"
#include "vsss/contract.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// One frame of each robot of a team, layout and scales in contract.h. Angles are those of the line from one point to the
// other in the team's frame (not relative to the robot's heading), 0 where the points coincide. Values are clamped to
// [-1, 1]; a number that is not finite comes out as one (check the world before). out float[VS_TEAM_SIZE][VS_OBS_FRAME]. view is the measured world in team view,
// last_action float[VS_TEAM_SIZE][2] what this team last commanded, in [-1, 1]. adversary_order[k] is the robot index
// shown in adversary slot k (a permutation of 0..2; NULL: 0, 1, 2).
VSSS_API void vs_observe_frame(const vs_world *view, const vs_game *game, const float *last_action,
                               const int *adversary_order, float *out);

// The stack of the last VS_OBS_STACK frames of one team. Plain data: a copy is a snapshot.
typedef struct vs_observer {
  int newest; // ring position of the newest frame
  int filled; // 0: the next frame fills the whole stack
  int adversary_order[VS_TEAM_SIZE];
  float frame[VS_OBS_STACK][VS_TEAM_SIZE][VS_OBS_FRAME];
} vs_observer;

VSSS_API void vs_observer_init(vs_observer *observer, const int *adversary_order /* or NULL */);
VSSS_API void
vs_observer_restart(vs_observer *observer); // after a (re)start of play: keeps the order, forgets the frames
VSSS_API void vs_observer_push(vs_observer *observer, const vs_world *view, const vs_game *game,
                               const float *last_action);
VSSS_API void vs_observer_write(const vs_observer *observer,
                                float *out /* [VS_TEAM_SIZE][VS_OBS_SIZE], oldest frame first */);

// The symmetries of one robot's observation: the field mirrored left to right (y, sines and angles change their sign,
// the wheels change places), the two allies exchanged, the three adversaries in any order. The canonical one of the 24
// versions, judged by the newest frame, shows the ball at y >= 0, the ally nearer to the ball first and the adversaries
// by their distance. A policy of canonical observations plays every situation as it plays its mirror image.
#define VS_SYMMETRIES (2 * 2 * 6)
typedef struct vs_symmetry_table {
  // Version s of a frame: value k is sign[s][k] times value index[s][k] of the original.
  int index[VS_SYMMETRIES][VS_OBS_FRAME];
  float sign[VS_SYMMETRIES][VS_OBS_FRAME];
} vs_symmetry_table;

// Versions are numbered (mirrored * 2 + allies exchanged) * 6 + order of the adversaries.
VSSS_API void vs_symmetry_table_init(vs_symmetry_table *table);
VSSS_API int vs_symmetry_canonical(const float *observation /* [VS_OBS_SIZE] */); // the version that is canonical
VSSS_API void vs_symmetry_apply(const vs_symmetry_table *table, int version, const float *observation, float *out);
static inline int vs_symmetry_mirrored(int version) { return version / 12; } // 1: left and right wheel change places

// A robot's front and back are alike: the same robot seen by its other end heads the other way, and its wheels are
// exchanged and turn the other way. Whether the newest frame shows a robot that heads away from their goal (cos < 0), and
// its observation as the other end sees it (out may not be observation). Seen by the end that faces their goal, the
// heading stays within 90 degrees, away from the jump of theta/pi at 180.
VSSS_API int vs_observation_faces_back(const float *observation /* [VS_OBS_SIZE] */); // 0 or 1
VSSS_API void vs_observation_reverse(const float *observation, float *out);

// Action in [-1, 1] <-> rad/s. A value that is not finite is VS_FAIL naming robot and wheel; others are clamped.
VSSS_API vs_status vs_action_to_wheels(const float *action /* [3][2] */, vs_wheels out[VS_TEAM_SIZE], vs_error *err);
VSSS_API void vs_action_from_wheels(const vs_wheels wheels[VS_TEAM_SIZE], float *action);

#ifdef __cplusplus
}
#endif
#endif
