// The commands that both generations of the EMC strategy give to a robot. A command keeps what it does not set: a
// target point that an older command left stays readable, and the strategies' overrides do read it.
#ifndef VSSS_STRATEGIES_COMMAND_H
#define VSSS_STRATEGIES_COMMAND_H

#include "point.h"

typedef enum emc_kind { EMC_NONE, EMC_POSITION, EMC_VECTOR, EMC_ORIENTATION, EMC_UVF, EMC_SPIN } emc_kind;

// Metres from the lower left corner of the strategy's field, radians, m/s, rad/s.
typedef struct emc_command {
  emc_kind kind;
  vs_point target;
  double angle_rad; // VECTOR, ORIENTATION: where to; UVF: direction of arrival
  double speed_mps;
  double spin_radps;
} emc_command;

#define EMC_SPIN_RADPS 35.0

void emc_go_to(emc_command *c, vs_point robot, vs_point target, double speed_mps);
void emc_go_pose(emc_command *c, vs_point target, double arrival_rad, double speed_mps);
// Position command; nearer than arrival_m: stands still, and the stored target stays what it was.
void emc_go_stop(emc_command *c, vs_point robot, vs_point target, double speed_mps, double arrival_m);
void emc_heading(emc_command *c, double angle_rad, double speed_mps);
void emc_face(emc_command *c, vs_point robot, vs_point at, double speed_mps);
void emc_spin(emc_command *c, double spin_radps);
void emc_stop(emc_command *c);

// The angle from which a UVF command steers: towards the target, bent by n times the angle between it and a
// reference point 0.1 m beyond it in the direction of arrival.
double emc_uvf_angle(vs_point robot, vs_point target, double arrival_rad, double n);

#endif
