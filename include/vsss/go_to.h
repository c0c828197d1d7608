// Drives a team's robots to poses without touching others: restarts that robots drive to by themselves (the league gives
// them 8 s). Worlds in, wheels out, pure but for what it remembers of arrivals. Each robot goes down the shortest way over
// a grid round the others, looks a third of a second ahead, and gives way to opponents and to own robots of a lower number.
#ifndef VSSS_GO_TO_H
#define VSSS_GO_TO_H

#include <stdbool.h>

#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Arrived: within these of the pose.
#define VS_GO_TO_M   0.02
#define VS_GO_TO_RAD 0.15

typedef struct vs_go_to {
  double delay_s;            // from the moment that a world shows until wheels act on it; set by the caller
  bool near[VS_TEAM_SIZE];   // at its place, turning or done; false at the start
  bool enters[VS_TEAM_SIZE]; // a place beside the ball: straight in from where it turned
} vs_go_to;

// One frame of the absolute world. target: absolute poses inside the field. A robot that is not valid stands.
void vs_go_to_step(vs_go_to *go, const vs_world *world, vs_team team, const vs_pose target[VS_TEAM_SIZE],
                   vs_wheels out[VS_TEAM_SIZE]);
bool vs_go_to_arrived(const vs_world *world, vs_team team, const vs_pose target[VS_TEAM_SIZE]); // all valid ones

#ifdef __cplusplus
}
#endif
#endif
