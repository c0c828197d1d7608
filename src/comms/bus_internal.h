// Shared by the files of the bus.
#ifndef VSSS_COMMS_BUS_INTERNAL_H
#define VSSS_COMMS_BUS_INTERNAL_H

#include "vsss/bus.h"

// Checks url before LCM sees it, because LCM prints by itself what it does not like. VS_USAGE: wrong; VS_FAIL: no
// multicast route to its address.
vs_status vs_bus_url_check(const char *url, vs_error *err);

// Where the arrays of world_t (team_size 3) or world_5v5_t (5) lie, [team][robot] in one row.
typedef struct vs_wire_robots {
  int team_size;
  double *x_m, *y_m, *theta_rad, *vx_mps, *vy_mps, *omega_radps, *left_radps, *right_radps;
  int8_t *valid;
} vs_wire_robots;
#define VS_WIRE_ROBOTS(t, size_of_team)                                                                                \
  {                                                                                                                    \
    (size_of_team), &(t)->robot_x_m[0][0], &(t)->robot_y_m[0][0], &(t)->robot_theta_rad[0][0],                         \
        &(t)->robot_vx_mps[0][0], &(t)->robot_vy_mps[0][0], &(t)->robot_omega_radps[0][0],                             \
        &(t)->robot_left_radps[0][0], &(t)->robot_right_radps[0][0], &(t)->robot_valid[0][0]                           \
  }

// The error of a machine without a multicast route, with the commands that mend it.
vs_status vs_bus_no_route(const char *url, vs_error *err);

#endif
