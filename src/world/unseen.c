#include "vsss/unseen.h"

static double ahead_s(int64_t estimate_us, int64_t since_us) {
  int64_t until_us = since_us < VS_UNSEEN_HOLD_US ? since_us : VS_UNSEEN_HOLD_US;
  return 1e-6 * (double)(until_us - estimate_us);
}

void vs_unseen_robot(const vs_robot *estimate, int64_t estimate_us, int64_t since_us, vs_robot *out) {
  double dt_s = ahead_s(estimate_us, since_us);
  *out = *estimate;
  out->pose.x_m = estimate->pose.x_m + dt_s * estimate->vx_mps;
  out->pose.y_m = estimate->pose.y_m + dt_s * estimate->vy_mps;
  out->pose.theta_rad = estimate->pose.theta_rad + dt_s * estimate->omega_radps;
  out->valid = since_us <= VS_UNSEEN_HOLD_US;
  if (!out->valid) out->vx_mps = out->vy_mps = out->omega_radps = 0;
}

void vs_unseen_ball(const vs_ball *estimate, int64_t estimate_us, int64_t since_us, vs_ball *out) {
  double dt_s = ahead_s(estimate_us, since_us);
  *out = *estimate;
  out->x_m = estimate->x_m + dt_s * estimate->vx_mps;
  out->y_m = estimate->y_m + dt_s * estimate->vy_mps;
  out->valid = since_us <= VS_UNSEEN_HOLD_US;
  if (!out->valid) out->vx_mps = out->vy_mps = 0;
}
