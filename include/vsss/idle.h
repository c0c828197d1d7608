// Stable: part of libvsss (deploy/docs/library.md).
//
// The idle rule (LARC 2026): a robot that stands still or spins on the spot for more than 10 s is warned; warned twice in
// a row, it is sent off until the half ends. A team's keeper may stand while the ball is outside its area. Counted for
// matches under any rules; who is off is told, the field is the caller's.
#ifndef VSSS_IDLE_H
#define VSSS_IDLE_H

#include "vsss/api.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_IDLE_S        10.0
#define VS_IDLE_RADIUS_M 0.03 // less than half a robot

// Plain data; all zero at the start of a match.
typedef struct vs_idle {
  struct {
    double x_m, y_m; // it has stayed within the radius of this point
    double stayed_s;
    bool warned, off;
  } robot[VS_TEAMS][VS_TEAM_MOST];
  int warnings[VS_TEAMS], sent_off[VS_TEAMS]; // so far
} vs_idle;

// One frame of play: the true world before any placement, and what the referee said after it.
VSSS_API void vs_idle_step(vs_idle *idle, const vs_world *world, const vs_event *event, double dt_s);

#ifdef __cplusplus
}
#endif
#endif
