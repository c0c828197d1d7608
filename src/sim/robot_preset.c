#include "vsss/robot_preset.h"

#include <stddef.h>

#include "base/word.h"
#include "drive.h"
#include "vsss/field.h"

static const vs_robot_preset presets[] = {
    {.name = "paper", .wheel_radius_m = VS_WHEEL_RADIUS_M, .ball_restitution = NOMINAL_RESTITUTION},
    {.name = "firasim",
     .wheel_radius_m = 0.02,
     .accelerate_mps2 = 1.19,
     .brake_mps2 = 5.07,
     .ball_deceleration_mps2 = 0.071,
     .ball_restitution = 0.5},
    {.name = "travesim", .wheel_radius_m = 0.025, .ball_restitution = NOMINAL_RESTITUTION},
};

vs_status vs_robot_preset_find(const char *name, const vs_robot_preset **out, vs_error *err) {
  enum { PRESETS = sizeof presets / sizeof *presets };
  const char *names[PRESETS + 1] = {NULL};
  for (int i = 0; i < PRESETS; i++) names[i] = presets[i].name;
  int place;
  vs_status s = vs_word_parse("robot", name, names, &place, err);
  if (s == VS_OK) *out = &presets[place];
  return s;
}

vs_sim_params vs_robot_preset_params(const vs_robot_preset *preset) {
  vs_sim_params params = vs_sim_params_default();
  params.ball_restitution = preset->ball_restitution;
  if (preset->ball_deceleration_mps2 > 0)
    params.ball_rolling_scale = preset->ball_deceleration_mps2 / VS_BALL_DECELERATION_MPS2;
  if (preset->accelerate_mps2 <= 0) return params;
  params.accelerate_mps2 = preset->accelerate_mps2;
  params.brake_mps2 = preset->brake_mps2;
  // Motors and grip that follow those bounds: ours brake at 4.2 m/s2, and our wheels' grip ends there too.
  params.servo_scale = 3;
  params.floor_friction_scale = 2;
  return params;
}

vs_wheels vs_robot_preset_wheels(const vs_robot_preset *preset, vs_wheels command) {
  double scale = preset->wheel_radius_m / VS_WHEEL_RADIUS_M;
  return (vs_wheels){command.left_radps * scale, command.right_radps * scale};
}
