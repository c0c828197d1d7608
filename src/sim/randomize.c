// This episode's bodies and frictions: a copy of the constant model with a few numbers changed.
#include "sim_internal.h"

#include <math.h>
#include <string.h>

#include "mujoco_call.h"
#include "vsss/geom.h"

static bool nominal(const vs_model *model, const vs_sim_params *p) {
  if (p->floor_friction_scale != 1 || p->robot_mass_scale != 1 || p->ball_mass_scale != 1) return false;
  if (p->ball_rolling_scale != 1 || p->ball_restitution != NOMINAL_RESTITUTION || p->servo_scale != 1) return false;
  for (int i = 0; i < model->robots; i++) {
    int team = team_of(model, i), index = index_in_team(model, i);
    const double *com = p->com_offset_m[team][index];
    if (p->wheel_radius_scale[team][index] != 1 || p->track_scale[team][index] != 1) return false;
    if (com[0] != 0 || com[1] != 0) return false;
  }
  return true;
}

// Mass, inertia and what the contact solver derives from them.
static void scale_body(mjModel *own, const mjModel *from, int body, double scale) {
  own->body_mass[body] = from->body_mass[body] * scale;
  own->body_subtreemass[body] = from->body_subtreemass[body] * scale;
  for (int i = 0; i < 3; i++) own->body_inertia[3 * body + i] = from->body_inertia[3 * body + i] * scale;
  for (int i = 0; i < 2; i++) own->body_invweight0[2 * body + i] = from->body_invweight0[2 * body + i] / scale;
  for (int i = 0; i < from->body_dofnum[body]; i++) {
    int dof = from->body_dofadr[body] + i;
    own->dof_invweight0[dof] = from->dof_invweight0[dof] / scale;
    // The inertia of simple bodies is taken from here.
    own->dof_M0[dof] = (from->dof_M0[dof] - from->dof_armature[dof]) * scale + from->dof_armature[dof];
  }
}

// MuJoCo's damping ratio of a spring that rebounds with this restitution at the same swing: e = exp(-pi z/sqrt(1 - z2)).
static void set_restitution(double *to, const double *from, double restitution) {
  double swing = 1 / (from[0] * from[1]), decay = -log(vs_clamp(restitution, 0.01, 0.99));
  to[1] = decay / sqrt(VS_PI * VS_PI + decay * decay);
  to[0] = 1 / (swing * to[1]);
}

static void set_contacts(mjModel *own, const mjModel *from, const vs_sim_params *params) {
  int floor = mj_name2id(from, mjOBJ_GEOM, "floor"), ball = mj_name2id(from, mjOBJ_GEOM, "ball");
  int lid = mj_name2id(from, mjOBJ_GEOM, "lid");
  for (int pair = 0; pair < from->npair; pair++) {
    int a = from->pair_geom1[pair], b = from->pair_geom2[pair];
    const double *friction = from->pair_friction + 5 * pair, *spring = from->pair_solref + mjNREF * pair;
    bool of_ball = a == ball || b == ball, of_floor = a == floor || b == floor, of_wall = from->geom_bodyid[a] == 0;
    if (of_ball && of_floor) {
      for (int i = 3; i < 5; i++) own->pair_friction[5 * pair + i] = friction[i] * params->ball_rolling_scale;
    } else if (of_floor) {
      for (int i = 0; i < 2; i++) own->pair_friction[5 * pair + i] = friction[i] * params->floor_friction_scale;
    } else if (of_ball && a != lid) {
      double restitution = params->ball_restitution * (of_wall ? 1 : 2.0 / 3.0);
      set_restitution(own->pair_solref + mjNREF * pair, spring, restitution);
    }
  }
}

static void set_wheel(mjModel *own, const mjModel *from, int wheel_body, double radius_scale, double track_scale) {
  int geom = from->body_geomadr[wheel_body];
  own->body_pos[3 * wheel_body + 1] = from->body_pos[3 * wheel_body + 1] * track_scale;
  own->body_pos[3 * wheel_body + 2] = from->body_pos[3 * wheel_body + 2] * radius_scale; // it still meets the floor
  own->geom_size[3 * geom] = from->geom_size[3 * geom] * radius_scale;
  own->geom_rbound[geom] = from->geom_rbound[geom] * radius_scale;
}

static void set_servo(mjModel *own, const mjModel *from, int servo, double scale) {
  own->actuator_gainprm[mjNGAIN * servo] = from->actuator_gainprm[mjNGAIN * servo] * scale;
  own->actuator_biasprm[mjNBIAS * servo + 2] = from->actuator_biasprm[mjNBIAS * servo + 2] * scale;
  for (int i = 0; i < 2; i++)
    own->actuator_forcerange[2 * servo + i] = from->actuator_forcerange[2 * servo + i] * scale;
}

static void set_robot(vs_sim *sim, int i) {
  const mjModel *from = sim->model->mj;
  const vs_sim_params *p = &sim->params;
  const robot_address *address = &sim->model->robot[i];
  int team = team_of(sim->model, i), index = index_in_team(sim->model, i), body = address->body;
  scale_body(sim->own, from, body, p->robot_mass_scale);
  if (sim->model->drive == VS_DRIVE_PLANAR) return; // drive.c reads the rest from params
  for (int axis = 0; axis < 2; axis++) {
    sim->own->body_ipos[3 * body + axis] = from->body_ipos[3 * body + axis] + p->com_offset_m[team][index][axis];
  }
  for (int side = LEFT; side < SIDES; side++) {
    int wheel = from->dof_bodyid[address->wheel_qvel[side]];
    scale_body(sim->own, from, wheel, p->robot_mass_scale);
    set_servo(sim->own, from, address->servo[side], p->servo_scale);
    set_wheel(sim->own, from, wheel, p->wheel_radius_scale[team][index], p->track_scale[team][index]);
  }
}

static void copy_model(void *context) {
  vs_sim *sim = context;
  sim->own = mj_copyModel(NULL, sim->model->mj);
}

bool vs_randomize_apply(vs_sim *sim) {
  sim->mj = sim->model->mj;
  if (nominal(sim->model, &sim->params)) return true;
  if (!sim->own && (vs_mujoco_call(copy_model, sim, NULL) != VS_OK || !sim->own)) return false;
  sim->mj = sim->own;
  scale_body(sim->own, sim->model->mj, sim->model->ball_body, sim->params.ball_mass_scale);
  set_contacts(sim->own, sim->model->mj, &sim->params);
  for (int i = 0; i < sim->model->robots; i++) set_robot(sim, i);
  return true;
}
