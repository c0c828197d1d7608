// Both drives opened side by side, and small helpers, for the tests of the simulator.
#ifndef VSSS_TESTS_SIM_ARENA_H
#define VSSS_TESTS_SIM_ARENA_H

#include <mujoco/mujoco.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/sim.h"

typedef vs_wheels arena_commands[VS_TEAMS][VS_TEAM_MOST];

static vs_model *arena_model[2]; // by vs_drive
static vs_sim *arena_sim[2];

static inline int arena_open(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_model_def def = vs_model_def_default((vs_drive)drive);
    vs_error err = {0};
    if (vs_model_load(&def, &arena_model[drive], &err) != VS_OK ||
        vs_sim_new(arena_model[drive], &arena_sim[drive], &err) != VS_OK) {
      print_error("%s\n", err.text);
      return -1;
    }
  }
  return 0;
}

static inline int arena_close(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_free(arena_sim[drive]);
    vs_model_free(arena_model[drive]);
  }
  return 0;
}

// Blue 0 at (x, y, theta), the ball at (ball_x, ball_y), everybody else in a row along the upper wall.
static inline void arena_place(vs_sim *sim, vs_pose blue0, double ball_x, double ball_y) {
  vs_world world = {0};
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) world.robot[i / 3][i % 3].pose = (vs_pose){-0.5 + 0.2 * i, 0.6, 0};
  world.robot[VS_BLUE][0].pose = blue0;
  world.ball.x_m = ball_x;
  world.ball.y_m = ball_y;
  vs_sim_place(sim, &world);
}

static inline void arena_frames(vs_sim *sim, int n, const arena_commands command) {
  for (int i = 0; i < n; i++) assert_ok(vs_sim_frame(sim, command, err));
}

static inline vs_robot arena_blue0(const vs_sim *sim) {
  vs_world world;
  vs_sim_world(sim, &world);
  return world.robot[VS_BLUE][0];
}

static inline vs_ball arena_ball(const vs_sim *sim) {
  vs_world world;
  vs_sim_world(sim, &world);
  return world.ball;
}

static inline double *arena_qvel(vs_sim *sim, int drive, const char *joint) {
  const mjModel *m = vs_model_mjmodel(arena_model[drive]);
  int id = mj_name2id(m, mjOBJ_JOINT, joint);
  assert_true(id >= 0);
  return ((mjData *)vs_sim_mjdata(sim))->qvel + m->jnt_dofadr[id];
}

// The placed ball moves with (vx, vy), its spin times that of rolling: 0 slides, 1 rolls.
static inline void arena_roll(vs_sim *sim, int drive, double vx, double vy, double spin) {
  double *v = arena_qvel(sim, drive, drive == VS_DRIVE_CONTACT ? "ball" : "ball_x");
  double *w = v + (drive == VS_DRIVE_CONTACT ? 3 : 2);
  v[0] = vx;
  v[1] = vy;
  w[0] = -spin * vy / VS_BALL_RADIUS_M;
  w[1] = spin * vx / VS_BALL_RADIUS_M;
}

static inline double arena_kinetic_energy_j(vs_sim *sim, int drive) {
  const mjModel *m = vs_model_mjmodel(arena_model[drive]);
  mjData *d = vs_sim_mjdata(sim);
  double momentum[64], sum = 0;
  assert_true(m->nv <= 64);
  mj_forward(m, d); // the inertia matrix of this posture
  mj_mulM(m, d, momentum, d->qvel);
  for (int i = 0; i < m->nv; i++) sum += 0.5 * momentum[i] * d->qvel[i];
  return sum;
}

#endif
