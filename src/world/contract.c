#include "vsss/contract.h"

#include <inttypes.h>
#include <stdio.h>

#include "vsss/field.h"
#include "vsss/number.h"
#include "vsss/world.h"

static const char *const frame_names[VS_OBS_FRAME] = {
    "own_x",
    "own_y",
    "ally0_x",
    "ally0_y",
    "ally1_x",
    "ally1_y",
    "adversary0_x",
    "adversary0_y",
    "adversary1_x",
    "adversary1_y",
    "adversary2_x",
    "adversary2_y",
    "ball_x",
    "ball_y",
    "own_sin",
    "own_cos",
    "own_theta",
    "robot_ball_sin",
    "robot_ball_cos",
    "robot_ball_angle",
    "own_goal_ball_sin",
    "own_goal_ball_cos",
    "own_goal_ball_angle",
    "their_goal_ball_sin",
    "their_goal_ball_cos",
    "their_goal_ball_angle",
    "robot_ally0_sin",
    "robot_ally0_cos",
    "robot_ally0_angle",
    "robot_ally1_sin",
    "robot_ally1_cos",
    "robot_ally1_angle",
    "robot_adversary0_sin",
    "robot_adversary0_cos",
    "robot_adversary0_angle",
    "robot_adversary1_sin",
    "robot_adversary1_cos",
    "robot_adversary1_angle",
    "robot_adversary2_sin",
    "robot_adversary2_cos",
    "robot_adversary2_angle",
    "ally0_ball_distance",
    "ally1_ball_distance",
    "own_ball_distance",
    "ball_own_goal_distance",
    "ball_their_goal_distance",
    "ally0_distance",
    "ally1_distance",
    "adversary0_distance",
    "adversary1_distance",
    "adversary2_distance",
    "own_left",
    "own_right",
    "ally0_left",
    "ally0_right",
    "ally1_left",
    "ally1_right",
    "time_left",
};

const char *vs_obs_name(int index) { return index >= 0 && index < VS_OBS_FRAME ? frame_names[index] : "out of range"; }

const char *vs_contract_text(void) {
  static _Thread_local char text[2048];
  int n = snprintf(text, sizeof text,
                   "vsss contract %d; observation %d frames x %d, oldest first; x/%s y/%s distance/%s goal_distance/%s "
                   "goal_x %s; action 2, left right in [-1,1] x %s rad/s, mean of Beta; decisions %d Hz; frame:",
                   VS_CONTRACT_VERSION, VS_OBS_STACK, VS_OBS_FRAME, vs_real_text(VS_OBS_SCALE_X_M).text,
                   vs_real_text(VS_OBS_SCALE_Y_M).text, vs_real_text(VS_OBS_SCALE_DISTANCE_M).text,
                   vs_real_text(VS_OBS_SCALE_GOAL_DISTANCE_M).text, vs_real_text(VS_OBS_GOAL_X_M).text,
                   vs_real_text(VS_WHEEL_LIMIT_RADPS).text, VS_DECISION_HZ);
  for (int i = 0; i < VS_OBS_FRAME; i++) n += snprintf(text + n, sizeof text - (size_t)n, " %s", frame_names[i]);
  return text;
}

uint64_t vs_contract_hash(void) {
  const char *text = vs_contract_text();
  uint64_t hash = VS_HASH_START;
  for (; *text; text++) hash = vs_hash_bytes(hash, text, 1);
  return hash;
}

const char *vs_contract_hash_hex(void) {
  static _Thread_local char hex[17];
  snprintf(hex, sizeof hex, "%016" PRIx64, vs_contract_hash());
  return hex;
}
