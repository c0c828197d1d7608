// Plane geometry of the scripted strategies, each in its own frame and unit (EMC: metres, INF: pixels).
#ifndef VSSS_STRATEGIES_POINT_H
#define VSSS_STRATEGIES_POINT_H

#include <math.h>
#include <stdbool.h>

#include "vsss/geom.h"

typedef struct vs_point {
  double x, y;
} vs_point;

static inline double vs_point_distance(vs_point a, vs_point b) { return vs_distance_m(a.x, a.y, b.x, b.y); }

static inline double vs_point_angle(vs_point from, vs_point to) { return atan2(to.y - from.y, to.x - from.x); }

static inline double vs_rad(double degrees) { return degrees * (VS_PI / 180.0); }

#endif
