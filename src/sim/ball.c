// The planar drive's ball on the floor: sliding and rolling friction by hand, for the ball's height is fixed there and
// MuJoCo has no contact to compute. Same coefficients as the contact drive's class ball_floor.
#include "drive.h"

#include <math.h>

#include "vsss/field.h"

// Speeds of the ball in the world's axes: the ball joint's are in the ball's own.
static void spin_in_world(const mjData *d, int qpos, int qvel, double spin[3]) {
  mju_rotVecQuat(spin, d->qvel + qvel + 2, d->qpos + qpos + 2);
}

void vs_ball_step(vs_sim *sim) {
  mjData *d = sim->data;
  int qpos = sim->model->ball_qpos, qvel = sim->model->ball_qvel;
  double mass = sim->mj->body_mass[sim->model->ball_body], dt = sim->mj->opt.timestep, r = VS_BALL_RADIUS_M;
  double inertia = 0.4 * mass * r * r, weight = mass * GRAVITY_MPS2;
  double spin[3];
  spin_in_world(d, qpos, qvel, spin);

  // Rolling: a torque against the spin about horizontal axes, which never turns it around.
  double size = sqrt(spin[0] * spin[0] + spin[1] * spin[1]);
  double most = BALL_ROLLING_M * sim->params.ball_rolling_scale * weight;
  double brake = size > 0 ? fmin(most, 1.4 * mass * r * r * size / dt) / size : 0;
  double torque[3] = {-brake * spin[0], -brake * spin[1], 0};

  // Sliding: the force at the floor that ends the slip there within this step, 2/7 m per unit of it, as far as it goes.
  double slip_x = d->qvel[qvel] - r * (spin[1] + dt * torque[1] / inertia);
  double slip_y = d->qvel[qvel + 1] + r * (spin[0] + dt * torque[0] / inertia);
  double needed = sqrt(slip_x * slip_x + slip_y * slip_y) * mass * 2 / 7 / dt, limit = BALL_FRICTION * weight;
  double gain = (needed > limit ? limit / needed : 1) * mass * 2 / 7 / dt;
  double force_x = -gain * slip_x, force_y = -gain * slip_y;
  torque[0] += r * force_y;
  torque[1] -= r * force_x;

  d->qfrc_applied[qvel] = force_x;
  d->qfrc_applied[qvel + 1] = force_y;
  double back[4];
  mju_negQuat(back, d->qpos + qpos + 2);
  mju_rotVecQuat(d->qfrc_applied + qvel + 2, torque, back);
}
