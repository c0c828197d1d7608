#include "command.h"

void emc_go_to(emc_command *c, vs_point robot, vs_point target, double speed_mps) {
  c->kind = EMC_VECTOR;
  c->target = target;
  c->angle_rad = vs_point_angle(robot, target);
  c->speed_mps = speed_mps;
}

void emc_go_pose(emc_command *c, vs_point target, double arrival_rad, double speed_mps) {
  c->kind = EMC_UVF;
  c->target = target;
  c->angle_rad = arrival_rad;
  c->speed_mps = speed_mps;
}

void emc_go_stop(emc_command *c, vs_point robot, vs_point target, double speed_mps, double arrival_m) {
  if (vs_point_distance(target, robot) < arrival_m) {
    emc_stop(c);
    return;
  }
  c->kind = EMC_POSITION;
  c->target = target;
  c->speed_mps = speed_mps;
}

void emc_heading(emc_command *c, double angle_rad, double speed_mps) {
  c->kind = EMC_VECTOR;
  c->angle_rad = angle_rad;
  c->speed_mps = speed_mps;
}

void emc_face(emc_command *c, vs_point robot, vs_point at, double speed_mps) {
  c->kind = EMC_ORIENTATION;
  c->angle_rad = vs_point_angle(robot, at);
  c->speed_mps = speed_mps;
}

void emc_spin(emc_command *c, double spin_radps) {
  c->kind = EMC_SPIN;
  c->speed_mps = 0.0;
  c->spin_radps = spin_radps;
}

void emc_stop(emc_command *c) { emc_spin(c, 0.0); }

double emc_uvf_angle(vs_point robot, vs_point target, double arrival_rad, double n) {
  vs_point beyond = {target.x + 0.1 * cos(arrival_rad), target.y + 0.1 * sin(arrival_rad)};
  double to_target = vs_point_angle(robot, target);
  double bend = vs_wrap_rad(vs_point_angle(robot, beyond) - to_target);
  return vs_wrap_rad(to_target - n * bend);
}
