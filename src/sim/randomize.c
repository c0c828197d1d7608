// This episode's masses and frictions: a copy of the constant model with a few numbers changed.
#include "sim_internal.h"

#include <string.h>

// Scales every body of a robot or the ball: mass, inertia and what the contact solver derives from them.
static void scale_body(mjModel *own, const mjModel *nominal, int body, double scale) {
  own->body_mass[body] = nominal->body_mass[body] * scale;
  own->body_subtreemass[body] = nominal->body_subtreemass[body] * scale;
  for (int i = 0; i < 3; i++) own->body_inertia[3 * body + i] = nominal->body_inertia[3 * body + i] * scale;
  for (int i = 0; i < 2; i++) own->body_invweight0[2 * body + i] = nominal->body_invweight0[2 * body + i] / scale;
  for (int i = 0; i < nominal->body_dofnum[body]; i++) {
    int dof = nominal->body_dofadr[body] + i;
    own->dof_invweight0[dof] = nominal->dof_invweight0[dof] / scale;
  }
}

static void scale_friction(mjModel *own, const mjModel *nominal, const vs_sim_params *params) {
  int floor = mj_name2id(nominal, mjOBJ_GEOM, "floor"), ball = mj_name2id(nominal, mjOBJ_GEOM, "ball");
  for (int pair = 0; pair < nominal->npair; pair++) {
    int a = nominal->pair_geom1[pair], b = nominal->pair_geom2[pair];
    if (a != floor && b != floor) continue;
    const double *from = nominal->pair_friction + 5 * pair;
    double *to = own->pair_friction + 5 * pair;
    if (a == ball || b == ball) {
      for (int i = 3; i < 5; i++) to[i] = from[i] * params->ball_rolling_scale;
    } else {
      for (int i = 0; i < 2; i++) to[i] = from[i] * params->floor_friction_scale;
    }
  }
}

static bool nominal_body(const vs_sim_params *params) {
  return params->floor_friction_scale == 1 && params->robot_mass_scale == 1 && params->ball_mass_scale == 1 &&
         params->ball_rolling_scale == 1;
}

void vs_randomize_apply(vs_sim *sim) {
  const mjModel *nominal = sim->model->mj;
  sim->mj = nominal;
  if (nominal_body(&sim->params)) return;
  if (!sim->own) sim->own = mj_copyModel(NULL, nominal);
  sim->mj = sim->own;
  for (int body = 1; body < nominal->nbody; body++) {
    double scale = body == sim->model->ball_body ? sim->params.ball_mass_scale : sim->params.robot_mass_scale;
    scale_body(sim->own, nominal, body, scale);
  }
  scale_friction(sim->own, nominal, &sim->params);
}
