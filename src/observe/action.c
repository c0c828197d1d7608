#include <math.h>

#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/observe.h"

static double wheel_radps(float action) { return vs_clamp(action, -1.0, 1.0) * VS_WHEEL_LIMIT_RADPS; }

vs_status vs_action_to_wheels(const float *action, vs_wheels out[VS_TEAM_SIZE], vs_error *err) {
  for (int i = 0; i < VS_TEAM_SIZE * VS_ACTION_SIZE; i++)
    if (!isfinite(action[i]))
      return vs_fail(err, VS_FAIL, "robot %d, %s wheel: action %g is not a number in [-1, 1]; the policy is broken",
                     i / VS_ACTION_SIZE, i % VS_ACTION_SIZE ? "right" : "left", (double)action[i]);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    out[i] = (vs_wheels){wheel_radps(action[i * VS_ACTION_SIZE]), wheel_radps(action[i * VS_ACTION_SIZE + 1])};
  return VS_OK;
}

void vs_action_from_wheels(const vs_wheels wheels[VS_TEAM_SIZE], float *action) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    action[i * VS_ACTION_SIZE] = (float)vs_clamp(wheels[i].left_radps / VS_WHEEL_LIMIT_RADPS, -1.0, 1.0);
    action[i * VS_ACTION_SIZE + 1] = (float)vs_clamp(wheels[i].right_radps / VS_WHEEL_LIMIT_RADPS, -1.0, 1.0);
  }
}
