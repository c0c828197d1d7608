// Wheel command -> motor -> traction.
#include "sim_internal.h"

#include <math.h>

#include "vsss/field.h"
#include "vsss/geom.h"

// Field.md 6.3: the motor goes to sat(command) * gain; commands inside the dead zone do nothing.
double vs_drive_target(const vs_sim_params *params, int robot, int side, double command_radps) {
  if (fabs(command_radps) < params->dead_zone_radps) return 0;
  double limit = VS_WHEEL_LIMIT_RADPS * params->wheel_limit_scale;
  return vs_clamp(command_radps, -limit, limit) * params->wheel_gain[robot / VS_TEAM_SIZE][robot % VS_TEAM_SIZE][side];
}

void vs_drive_step(vs_sim *sim, const double target[ROBOTS][SIDES]) {
  for (int i = 0; i < ROBOTS; i++) {
    for (int side = LEFT; side < SIDES; side++) {
      wheel_state *wheel = &sim->wheel[i][side];
      wheel->target_radps += sim->lag * (target[i][side] - wheel->target_radps);
      sim->data->ctrl[sim->model->robot[i].servo[side]] = wheel->target_radps;
    }
  }
}
