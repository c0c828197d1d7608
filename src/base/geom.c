#include "vsss/geom.h"

#include <math.h>

double vs_wrap_rad(double angle_rad) {
  // The common cases without a division; one turn less is exact there, so the result is remainder's to the bit.
  if (angle_rad > -VS_PI && angle_rad <= VS_PI) return angle_rad;
  if (angle_rad > VS_PI && angle_rad <= 3.0 * VS_PI) return angle_rad - 2.0 * VS_PI;
  if (angle_rad <= -VS_PI && angle_rad > -3.0 * VS_PI) return angle_rad + 2.0 * VS_PI;
  double a = remainder(angle_rad, 2.0 * VS_PI);
  return a <= -VS_PI ? a + 2.0 * VS_PI : a;
}

double vs_clamp(double value, double low, double high) { return value < low ? low : value > high ? high : value; }

double vs_distance_m(double ax_m, double ay_m, double bx_m, double by_m) {
  double dx = bx_m - ax_m, dy = by_m - ay_m;
  return sqrt(dx * dx + dy * dy);
}
