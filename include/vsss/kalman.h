// Stable: part of libvsss (deploy/docs/library.md).
//
// Kalman filter of one coordinate with constant velocity: the field's tracker and the simulated sensors' velocities.
#ifndef VSSS_KALMAN_H
#define VSSS_KALMAN_H

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

// Plain data. Units are the caller's: m and m/s, or rad and rad/s.
typedef struct vs_kalman {
  double value, rate;
  double p[3]; // variances: [0] value, [1] covariance, [2] rate
} vs_kalman;

// Deviations of the first value and of its unknown rate, which begins as 0.
VSSS_API void vs_kalman_start(vs_kalman *k, double value, double noise, double rate_deviation);
// dt_s later, disturbed by an acceleration that is constant within the step and has this deviation.
VSSS_API void vs_kalman_predict(vs_kalman *k, double dt_s, double acceleration);
// innovation: measured value less k->value (of an angle, wrapped); noise: its deviation.
VSSS_API void vs_kalman_update(vs_kalman *k, double innovation, double noise);

#ifdef __cplusplus
}
#endif
#endif
