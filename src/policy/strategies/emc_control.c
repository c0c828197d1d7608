// EMC-2019: from a role's command to wheel speeds in m/s.
#include "emc.h"

#define HALF_TRACK_M 0.04 // the strategy's own constant, not this simulator's robot

static void set_wheels(double linear_mps, double angular_radps, double wheel_mps[2]) {
  wheel_mps[0] = linear_mps - HALF_TRACK_M * angular_radps;
  wheel_mps[1] = linear_mps + HALF_TRACK_M * angular_radps;
}

// Drives along an angle, forwards or backwards, whichever needs less turning.
static void drive(double theta_rad, double angle_rad, double speed_mps, double wheel_mps[2]) {
  double e = vs_wrap_rad(angle_rad - theta_rad);
  if (fabs(e) > VS_PI / 2) {
    double back = vs_wrap_rad(angle_rad - theta_rad - VS_PI);
    set_wheels(-speed_mps * cos(back), 10.0 * back, wheel_mps);
  } else {
    set_wheels(speed_mps * cos(e), 15.0 * e, wheel_mps);
  }
}

void emc_control(const emc_role *role, double wheel_mps[2]) {
  const emc_command *c = &role->command;
  double theta = role->theta_rad, distance = vs_point_distance(role->at, c->target);
  set_wheels(0.0, 0.0, wheel_mps);
  switch (c->kind) {
  case EMC_NONE: break;
  case EMC_POSITION:
    if (distance >= 0.02) drive(theta, vs_point_angle(role->at, c->target), c->speed_mps * sqrt(distance), wheel_mps);
    break;
  case EMC_VECTOR: drive(theta, c->angle_rad, c->speed_mps, wheel_mps); break;
  case EMC_ORIENTATION: drive(theta, c->angle_rad, 0.0, wheel_mps); break;
  case EMC_UVF: drive(theta, emc_uvf_angle(role->at, c->target, c->angle_rad, 1.8), c->speed_mps, wheel_mps); break;
  case EMC_SPIN: set_wheels(0.0, c->spin_radps, wheel_mps); break;
  }
}

double emc_pid_step(emc_pid *pid, double target_mps, double measured_mps, double dt_s) {
  if (target_mps == 0.0) {
    *pid = (emc_pid){0.0, 0.0};
    return 0.0;
  }
  double e = target_mps - measured_mps;
  pid->integral = vs_clamp(pid->integral + e * dt_s, -0.5, 0.5);
  double derivative = (e - pid->last_error) / dt_s;
  pid->last_error = e;
  return vs_clamp(2.5 * e + 2.5 * pid->integral + 0.001 * derivative, -2.0, 2.0);
}
