#include "vsss/kalman.h"

void vs_kalman_start(vs_kalman *k, double value, double noise, double rate_deviation) {
  *k = (vs_kalman){value, 0.0, {noise * noise, 0.0, rate_deviation * rate_deviation}};
}

void vs_kalman_predict(vs_kalman *k, double dt_s, double acceleration) {
  double q = acceleration * acceleration, dt2 = dt_s * dt_s;
  k->value += k->rate * dt_s;
  k->p[0] += dt_s * (2 * k->p[1] + dt_s * k->p[2]) + 0.25 * q * dt2 * dt2;
  k->p[1] += dt_s * k->p[2] + 0.5 * q * dt2 * dt_s;
  k->p[2] += q * dt2;
}

void vs_kalman_update(vs_kalman *k, double innovation, double noise) {
  double s = k->p[0] + noise * noise, g0 = k->p[0] / s, g1 = k->p[1] / s;
  k->value += g0 * innovation;
  k->rate += g1 * innovation;
  k->p[2] -= g1 * k->p[1];
  k->p[1] -= g0 * k->p[1];
  k->p[0] -= g0 * k->p[0];
}
