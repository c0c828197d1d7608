// The wheel servo and the wheels' grip, one set of numbers for both drives: the planar drive computes with them, the
// contact drive's MJCF is checked against them at load.
#ifndef VSSS_SIM_DRIVE_H
#define VSSS_SIM_DRIVE_H

#include "sim_internal.h"
#include "vsss/field.h"

// The servo (field.h): its limit accelerates 0.48 kg (0.425 kg and the wheels' inertia) at 4.2 m/s2; its gain makes the
// last 0.23 m/s a first-order approach with 55 ms: 0 to 1.4 m/s in 0.35 s.

// A wheel about its axle: 12 g disc of 3 cm, 5.4e-6, and a geared rotor of 2e-5.
#define ROTOR_INERTIA_KGM2 2e-5
#define WHEEL_INERTIA_KGM2 (5.4e-6 + ROTOR_INERTIA_KGM2)
#define WHEEL_FRICTION     0.9 // rubber on a matte board, field.md, Ranges
// Both skids are this far from the axle; they carry what acceleration takes off the wheels.
#define SKID_DISTANCE_M 0.033
#define COM_HEIGHT_M    0.0348 // Table 1: block from 0.5 to 6.5 cm, axles at 3 cm

#define GRAVITY_MPS2   9.81
#define BALL_FRICTION  0.3    // sliding; sources in models/vsss_contact.xml, class ball_floor
#define BALL_ROLLING_M 6.1e-4 // rolling: 5/7 g times this over the radius

// sat(command) * gain, nothing inside the dead zone (field.md, Ranges).
double vs_drive_target(const vs_sim_params *params, int team, int index, int side, double command_radps);

// Once a step, before mj_step: motors one step on, and their effect into ctrl (contact) or qfrc_applied (planar).
void vs_drive_step(vs_sim *sim, const double target[ROBOTS_MOST][SIDES]);

// Planar drive, once a step before mj_step: the floor's friction on the ball into qfrc_applied.
void vs_ball_step(vs_sim *sim);

#endif
