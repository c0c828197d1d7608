// Stable: part of libvsss (deploy/docs/library.md).
//
// The contract between observation, network and wheels: the layout of a policy's input and output. Its hash is
// stored in every checkpoint and every ONNX file; a model with another hash is refused.
//
// Input "observation": float[N][464], 8 frames of 58 values, oldest frame first, all in [-1, 1]. Output "action":
// float[N][2], left and right wheel in [-1, 1] times VS_WHEEL_LIMIT_RADPS; optional outputs "alpha" and "beta",
// float[N][2], of the Beta distribution on [0, 1] with action = 2 u - 1, whose mean alpha/(alpha+beta) "action" is.
#ifndef VSSS_CONTRACT_H
#define VSSS_CONTRACT_H

#include <stdint.h>

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_OBS_FRAME        58
#define VS_OBS_STACK        8
#define VS_OBS_SIZE         (VS_OBS_FRAME * VS_OBS_STACK)
#define VS_ACTION_SIZE      2
#define VS_DECISION_HZ      10
#define VS_CONTRACT_VERSION 1

// Divisors of the observation (paper section VI; field code of the authors).
#define VS_OBS_SCALE_X_M             0.85
#define VS_OBS_SCALE_Y_M             0.65
#define VS_OBS_SCALE_DISTANCE_M      2.14
#define VS_OBS_SCALE_GOAL_DISTANCE_M 1.82
#define VS_OBS_GOAL_X_M              0.8

// Positions within one frame, 0-based.
enum {
  VS_OBS_OWN_XY = 0,
  VS_OBS_ALLIES_XY = 2,
  VS_OBS_ADVERSARIES_XY = 6,
  VS_OBS_BALL_XY = 12,
  VS_OBS_OWN_HEADING = 14, // sin, cos, theta/pi
  VS_OBS_ANGLES = 17,      // eight triplets sin, cos, angle/pi
  VS_OBS_ALLIES_BALL_DISTANCE = 41,
  VS_OBS_OWN_BALL_DISTANCE = 43,
  VS_OBS_BALL_GOAL_DISTANCES = 44, // own goal, their goal
  VS_OBS_ALLIES_DISTANCE = 46,
  VS_OBS_ADVERSARIES_DISTANCE = 48,
  VS_OBS_OWN_ACTION = 51,
  VS_OBS_ALLIES_ACTION = 53,
  VS_OBS_TIME_LEFT = 57,
};

VSSS_API const char *vs_contract_text(void); // the canonical description that is hashed: names, scales, rates, version
VSSS_API uint64_t vs_contract_hash(void);
VSSS_API const char *vs_contract_hash_hex(void); // 16 digits
VSSS_API const char *vs_obs_name(int index);     // of 0..57, such as "ball_x"

#ifdef __cplusplus
}
#endif
#endif
