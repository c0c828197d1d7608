// One match: place the pieces, step frame by frame, read the true world.
#include "drive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mujoco_call.h"
#include "vsss/field.h"
#include "vsss/geom.h"

vs_sim_params vs_sim_params_default(void) {
  vs_sim_params params = {.wheel_limit_scale = 1,
                          .floor_friction_scale = 1,
                          .robot_mass_scale = 1,
                          .ball_mass_scale = 1,
                          .ball_rolling_scale = 1,
                          .ball_restitution = NOMINAL_RESTITUTION,
                          .servo_scale = 1};
  for (int i = 0; i < ROBOTS_MOST; i++) {
    int team = i / VS_TEAM_MOST, index = i % VS_TEAM_MOST;
    params.wheel_gain[team][index][LEFT] = params.wheel_gain[team][index][RIGHT] = 1;
    params.wheel_radius_scale[team][index] = params.track_scale[team][index] = 1;
  }
  return params;
}

static void make_data(void *context) {
  vs_sim *sim = context;
  sim->data = mj_makeData(sim->mj);
}

vs_status vs_sim_new(const vs_model *model, vs_sim **out, vs_error *err) {
  vs_sim *sim = calloc(1, sizeof *sim);
  if (!sim) return vs_fail(err, VS_FAIL, "out of memory");
  sim->model = model;
  sim->mj = model->mj;
  vs_status status = vs_mujoco_call(make_data, sim, err);
  if (status == VS_OK && (!sim->data || !vs_nearby_new(sim))) status = vs_fail(err, VS_FAIL, "out of memory");
  if (status != VS_OK) {
    vs_sim_free(sim);
    return status;
  }
  vs_sim_reset(sim, NULL);
  *out = sim;
  return VS_OK;
}

void vs_sim_free(vs_sim *sim) {
  if (!sim) return;
  if (sim->data) mj_deleteData(sim->data);
  if (sim->own) mj_deleteModel(sim->own);
  free(sim->view_numbers);
  free(sim);
}

// mj_step computes everything else in mjData from qpos, qvel, ctrl, the applied forces and qacc_warmstart.
static void stop_everything(vs_sim *sim) {
  mjData *d = sim->data;
  memset(d->qvel, 0, sizeof(double) * sim->mj->nv);
  memset(d->qacc_warmstart, 0, sizeof(double) * sim->mj->nv);
  memset(d->qfrc_applied, 0, sizeof(double) * sim->mj->nv);
  memset(d->qfrc_constraint, 0, sizeof(double) * sim->mj->nv);
  memset(d->ctrl, 0, sizeof(double) * sim->mj->nu);
  memset(d->warning, 0, sizeof d->warning);
  memset(sim->wheel, 0, sizeof sim->wheel);
}

// Where a reset leaves the pieces; the referee places them by its own rules. On any field, those of 3 against 3 first.
static void place_at_first(vs_sim *sim) {
  static const vs_pose blue[VS_TEAM_MOST] = {
      {-0.65, 0, 0}, {-0.375, 0.2, 0}, {-0.375, -0.2, 0}, {-0.375, 0.4, 0}, {-0.375, -0.4, 0}};
  vs_world first = {.division = sim->model->division};
  for (int i = 0; i < sim->model->field->team_size; i++) {
    vs_pose yellow = {-blue[i].x_m, -blue[i].y_m, VS_PI};
    first.robot[VS_BLUE][i].pose = blue[i];
    first.robot[VS_YELLOW][i].pose = yellow;
  }
  vs_sim_place(sim, &first);
}

void vs_sim_reset(vs_sim *sim, const vs_sim_params *params) {
  sim->params = params ? *params : vs_sim_params_default();
  double tau = sim->params.motor_tau_s;
  sim->lag = tau > 0 ? 1 - exp(-sim->mj->opt.timestep / tau) : 1;
  sim->push_rng = vs_rng_make(sim->params.push_seed, 0);
  sim->out_of_memory = !vs_randomize_apply(sim);
  vs_nearby_reset(sim);
  sim->data->time = 0;
  sim->frame = 0;
  place_at_first(sim);
}

// How far a standing robot's wheels sink into MuJoCo's soft floor: placed there it is at rest from the first step on.
#define SETTLED_Z_M (-1.16e-4)

static void set_upright(double *qpos, vs_pose pose) {
  const double free_joint[7] = {
      pose.x_m, pose.y_m, SETTLED_Z_M, cos(pose.theta_rad / 2), 0, 0, sin(pose.theta_rad / 2)};
  memcpy(qpos, free_joint, sizeof free_joint);
}

static void set_robot(vs_sim *sim, int robot, vs_pose pose) {
  double *qpos = sim->data->qpos + sim->model->robot[robot].qpos;
  if (sim->model->drive == VS_DRIVE_CONTACT) {
    set_upright(qpos, pose);
  } else {
    qpos[0] = pose.x_m;
    qpos[1] = pose.y_m;
    qpos[2] = pose.theta_rad;
  }
}

void vs_sim_put_beside(vs_sim *sim, vs_team team, int robot) {
  int i = (int)team * sim->model->field->team_size + robot;
  bool contact = sim->model->drive == VS_DRIVE_CONTACT;
  const robot_address *address = &sim->model->robot[i];
  int first = address->qvel, n = contact ? 6 : 3;
  set_robot(sim, i, vs_world_beside(sim->model->division, team, robot));
  memset(sim->data->qvel + first, 0, sizeof(double) * (size_t)n);
  memset(sim->data->qacc_warmstart + first, 0, sizeof(double) * (size_t)n);
  for (int side = 0; side < SIDES && contact; side++) sim->data->qvel[address->wheel_qvel[side]] = 0;
  memset(sim->wheel[i], 0, sizeof sim->wheel[i]);
}

void vs_sim_place(vs_sim *sim, const vs_world *world) {
  stop_everything(sim);
  memcpy(sim->data->qpos, sim->mj->qpos0, sizeof(double) * sim->mj->nq); // the wheels' angles too
  for (int i = 0; i < sim->model->robots; i++)
    set_robot(sim, i, world->robot[team_of(sim->model, i)][index_in_team(sim->model, i)].pose);
  double *ball = sim->data->qpos + sim->model->ball_qpos;
  const double contact[7] = {world->ball.x_m, world->ball.y_m, VS_BALL_RADIUS_M, 1, 0, 0, 0};
  const double planar[6] = {world->ball.x_m, world->ball.y_m, 1, 0, 0, 0};
  if (sim->model->drive == VS_DRIVE_CONTACT) memcpy(ball, contact, sizeof contact);
  if (sim->model->drive == VS_DRIVE_PLANAR) memcpy(ball, planar, sizeof planar);
  // It rolls without slipping: its spin about the floor's axes goes with its way.
  double *speed = sim->data->qvel + sim->model->ball_qvel;
  double *spin = speed + (sim->model->drive == VS_DRIVE_CONTACT ? 3 : 2);
  speed[0] = world->ball.vx_mps;
  speed[1] = world->ball.vy_mps;
  spin[0] = -world->ball.vy_mps / VS_BALL_RADIUS_M;
  spin[1] = world->ball.vx_mps / VS_BALL_RADIUS_M;
}

static vs_status check_warnings(const vs_sim *sim, vs_error *err) {
  for (int i = 0; i < mjNWARNING; i++) {
    const mjWarningStat *warning = &sim->data->warning[i];
    if (!warning->number) continue;
    return vs_fail(err, VS_FAIL, "the simulator broke down at %.2f s: %s", sim->frame / (double)sim->model->frame_hz,
                   mju_warningText(i, warning->lastinfo));
  }
  return VS_OK;
}

typedef struct frame_work {
  vs_sim *sim;
  double target[ROBOTS_MOST][SIDES];
} frame_work;

static void step_frame(void *context) {
  frame_work *work = context;
  vs_sim *sim = work->sim;
  for (int i = 0; i < sim->model->substeps; i++) {
    vs_drive_step(sim, work->target);
    mj_step(vs_nearby_view(sim), sim->data);
  }
}

// Shoves: as if something had bumped into a robot between two frames.
static void shove(vs_sim *sim) {
  if (sim->params.push_per_s <= 0) return;
  for (int i = 0; i < sim->model->robots; i++) {
    if (vs_rng_uniform(&sim->push_rng) >= sim->params.push_per_s / sim->model->frame_hz) continue;
    double *v = sim->data->qvel + sim->model->robot[i].qvel;
    v[0] += vs_rng_range(&sim->push_rng, -sim->params.push_mps, sim->params.push_mps);
    v[1] += vs_rng_range(&sim->push_rng, -sim->params.push_mps, sim->params.push_mps);
  }
}

vs_status vs_sim_frame(vs_sim *sim, const vs_wheels command[VS_TEAMS][VS_TEAM_MOST], vs_error *err) {
  if (sim->out_of_memory) return vs_fail(err, VS_FAIL, "out of memory for this episode's randomised model");
  frame_work work = {.sim = sim};
  for (int i = 0; i < sim->model->robots; i++) {
    int team = team_of(sim->model, i), index = index_in_team(sim->model, i);
    vs_wheels wheels = command[team][index];
    if (!isfinite(wheels.left_radps) || !isfinite(wheels.right_radps)) {
      return vs_fail(err, VS_FAIL, "wheel command of %s robot %d is not a number (%g, %g rad/s): mend its player",
                     vs_team_name((vs_team)team), index, wheels.left_radps, wheels.right_radps);
    }
    work.target[i][LEFT] = vs_drive_target(&sim->params, team, index, LEFT, wheels.left_radps);
    work.target[i][RIGHT] = vs_drive_target(&sim->params, team, index, RIGHT, wheels.right_radps);
  }
  shove(sim);
  vs_status status = vs_mujoco_call(step_frame, &work, err);
  if (status != VS_OK) return status;
  sim->frame++;
  return check_warnings(sim, err);
}

static void read_contact_robot(const vs_sim *sim, const robot_address *address, vs_robot *robot) {
  const double *q = sim->data->qpos + address->qpos, *v = sim->data->qvel + address->qvel;
  double w = q[3], x = q[4], y = q[5], z = q[6];
  robot->pose = (vs_pose){q[0], q[1], atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
  robot->vx_mps = v[0];
  robot->vy_mps = v[1];
  robot->omega_radps = v[5]; // about the robot's own vertical
  robot->left_radps = sim->data->qvel[address->wheel_qvel[LEFT]];
  robot->right_radps = sim->data->qvel[address->wheel_qvel[RIGHT]];
}

static void read_planar_robot(const vs_sim *sim, const robot_address *address, const wheel_state *wheel,
                              vs_robot *robot) {
  const double *q = sim->data->qpos + address->qpos, *v = sim->data->qvel + address->qvel;
  robot->pose = (vs_pose){q[0], q[1], vs_wrap_rad(q[2])};
  robot->vx_mps = v[0];
  robot->vy_mps = v[1];
  robot->omega_radps = v[2];
  robot->left_radps = wheel[LEFT].speed_radps;
  robot->right_radps = wheel[RIGHT].speed_radps;
}

void vs_sim_world(const vs_sim *sim, vs_world *out) {
  out->time_us = (int64_t)sim->frame * 1000000 / sim->model->frame_hz;
  out->seq = sim->frame;
  out->division = sim->model->division;
  int n = sim->model->field->team_size;
  for (int t = 0; t < VS_TEAMS && n < VS_TEAM_MOST; t++)
    memset(&out->robot[t][n], 0, sizeof(vs_robot) * (size_t)(VS_TEAM_MOST - n));
  for (int i = 0; i < sim->model->robots; i++) {
    vs_robot *robot = &out->robot[team_of(sim->model, i)][index_in_team(sim->model, i)];
    if (sim->model->drive == VS_DRIVE_CONTACT) {
      read_contact_robot(sim, &sim->model->robot[i], robot);
    } else {
      read_planar_robot(sim, &sim->model->robot[i], sim->wheel[i], robot);
    }
    robot->valid = true;
  }
  const double *q = sim->data->qpos + sim->model->ball_qpos, *v = sim->data->qvel + sim->model->ball_qvel;
  bool contact = sim->model->drive == VS_DRIVE_CONTACT;
  out->ball = (vs_ball){q[0], q[1], contact ? q[2] : VS_BALL_RADIUS_M, v[0], v[1], contact ? v[2] : 0, true};
}

void *vs_sim_mjdata(vs_sim *sim) { return sim->data; }
