// Wheel command -> motor -> traction. The contact drive only needs the motor's command: its wheels roll in MuJoCo. The
// planar drive solves, per robot and step, for the friction forces of its two wheels on the floor: they stop the slip,
// forward at each wheel and sideways, as far as the wheels' loads allow.
#include "drive.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

#define GRAVITY_MPS2 9.81
#define SWEEPS       4 // of projected Gauss-Seidel, only for a robot that slips

double vs_drive_target(const vs_sim_params *params, int robot, int side, double command_radps) {
  if (fabs(command_radps) < params->dead_zone_radps) return 0;
  double limit = VS_WHEEL_LIMIT_RADPS * params->wheel_limit_scale;
  return vs_clamp(command_radps, -limit, limit) * params->wheel_gain[robot / VS_TEAM_SIZE][robot % VS_TEAM_SIZE][side];
}

// One robot's step, in its own axes: u forward, s to the left, w about the vertical.
typedef struct traction {
  double dt, mass, inertia, friction;
  double u, s, w;                // velocities at the end of the step without friction: MuJoCo's other forces included
  double rim[SIDES];             // wheel rim speed at the end of the step without friction
  double along[SIDES], sideways; // friction forces on the robot, in newton; sideways: both wheels together
} traction;

// Slip of a wheel over the floor at the end of the step.
static double slip(const traction *t, int side) {
  double sign = side == LEFT ? -1 : 1;
  double u = t->u + t->dt * (t->along[LEFT] + t->along[RIGHT]) / t->mass;
  double w = t->w + t->dt * VS_HALF_TRACK_M * (t->along[RIGHT] - t->along[LEFT]) / t->inertia;
  double rim = t->rim[side] - t->dt * VS_WHEEL_RADIUS_M * VS_WHEEL_RADIUS_M / WHEEL_INERTIA_KGM2 * t->along[side];
  return u + sign * VS_HALF_TRACK_M * w - rim;
}

// Forces that leave no slip at all: two equations for the wheels, one sideways.
static void full_grip(traction *t) {
  double body = t->dt / t->mass, turn = t->dt * VS_HALF_TRACK_M * VS_HALF_TRACK_M / t->inertia;
  double a = body + turn + t->dt * VS_WHEEL_RADIUS_M * VS_WHEEL_RADIUS_M / WHEEL_INERTIA_KGM2, b = body - turn;
  t->along[LEFT] = t->along[RIGHT] = 0;
  double left = slip(t, LEFT), right = slip(t, RIGHT);
  t->along[LEFT] = (b * right - a * left) / (a * a - b * b);
  t->along[RIGHT] = (b * left - a * right) / (a * a - b * b);
  t->sideways = -t->s / body;
}

// Loads of the wheels under these forces: the skid takes some when the robot speeds up or brakes, the outer wheel takes
// from the inner one in a curve.
static void wheel_loads(const traction *t, double load[SIDES]) {
  double skid = fabs(t->along[LEFT] + t->along[RIGHT]) * COM_HEIGHT_M / SKID_DISTANCE_M;
  double wheels = fmax(0, t->mass * GRAVITY_MPS2 - skid);
  double shift = vs_clamp(t->sideways * COM_HEIGHT_M / (2 * VS_HALF_TRACK_M), -wheels / 2, wheels / 2);
  load[LEFT] = wheels / 2 - shift;
  load[RIGHT] = wheels / 2 + shift;
}

// Share of the sideways force that a wheel carries: as its load.
static double share(const double load[SIDES], int side) {
  double sum = load[LEFT] + load[RIGHT];
  return sum > 0 ? load[side] / sum : 0.5;
}

static bool holds(const traction *t, const double load[SIDES]) {
  for (int side = LEFT; side < SIDES; side++) {
    double sideways = t->sideways * share(load, side), most = t->friction * load[side];
    if (t->along[side] * t->along[side] + sideways * sideways > most * most) return false;
  }
  return true;
}

// Sliding: each wheel's force is shortened to its friction circle in turn, the others answering.
static void slide(traction *t) {
  double response = t->dt * (1 / t->mass + VS_HALF_TRACK_M * VS_HALF_TRACK_M / t->inertia +
                             VS_WHEEL_RADIUS_M * VS_WHEEL_RADIUS_M / WHEEL_INERTIA_KGM2);
  double weight = t->mass * GRAVITY_MPS2, load[SIDES] = {weight / 2, weight / 2};
  double side_force[SIDES] = {0, 0};
  double most = t->friction * weight;
  double grip = t->sideways;
  t->sideways = vs_clamp(grip, -most, most);
  for (int side = LEFT; side < SIDES; side++) t->along[side] = vs_clamp(t->along[side], -most / 2, most / 2);
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    wheel_loads(t, load);
    for (int side = LEFT; side < SIDES; side++) {
      double along = t->along[side] - slip(t, side) / response, sideways = grip * share(load, side);
      double size = sqrt(along * along + sideways * sideways), limit = t->friction * load[side];
      double shorten = size > limit ? limit / size : 1;
      t->along[side] = along * shorten;
      side_force[side] = sideways * shorten;
    }
    t->sideways = side_force[LEFT] + side_force[RIGHT];
  }
}

static double motor_torque(const wheel_state *wheel) {
  return vs_clamp(SERVO_GAIN_NMSPRAD * (wheel->target_radps - wheel->speed_radps), -SERVO_LIMIT_NM, SERVO_LIMIT_NM);
}

static void step_planar_robot(vs_sim *sim, int index) {
  const robot_address *address = &sim->model->robot[index];
  mjData *d = sim->data;
  const double *v = d->qvel + address->qvel, *push = d->qfrc_constraint + address->qvel; // contacts of the last step
  double *applied = d->qfrc_applied + address->qvel;
  wheel_state *wheel = sim->wheel[index];
  traction t = {.dt = sim->mj->opt.timestep,
                .mass = sim->mj->body_mass[address->body],
                .inertia = sim->mj->body_inertia[3 * address->body + 2],
                .friction = WHEEL_FRICTION * sim->params.floor_friction_scale};
  double vx = v[0] + t.dt * push[0] / t.mass, vy = v[1] + t.dt * push[1] / t.mass;
  t.w = v[2] + t.dt * push[2] / t.inertia;
  double heading = d->qpos[address->qpos + 2] + t.dt * t.w; // at the end of the step
  double c = cos(heading), n = sin(heading);
  t.u = c * vx + n * vy;
  t.s = -n * vx + c * vy;
  for (int side = LEFT; side < SIDES; side++) {
    t.rim[side] =
        VS_WHEEL_RADIUS_M * (wheel[side].speed_radps + t.dt * motor_torque(&wheel[side]) / WHEEL_INERTIA_KGM2);
  }
  double load[SIDES];
  full_grip(&t);
  wheel_loads(&t, load);
  if (!holds(&t, load)) slide(&t);
  double forward = t.along[LEFT] + t.along[RIGHT];
  applied[0] = c * forward - n * t.sideways;
  applied[1] = n * forward + c * t.sideways;
  applied[2] = VS_HALF_TRACK_M * (t.along[RIGHT] - t.along[LEFT]);
  for (int side = LEFT; side < SIDES; side++) {
    wheel[side].speed_radps =
        t.rim[side] / VS_WHEEL_RADIUS_M - t.dt * VS_WHEEL_RADIUS_M / WHEEL_INERTIA_KGM2 * t.along[side];
  }
}

void vs_drive_step(vs_sim *sim, const double target[ROBOTS][SIDES]) {
  for (int i = 0; i < ROBOTS; i++) {
    for (int side = LEFT; side < SIDES; side++) {
      wheel_state *wheel = &sim->wheel[i][side];
      wheel->target_radps += sim->lag * (target[i][side] - wheel->target_radps);
      if (sim->model->drive == VS_DRIVE_CONTACT) {
        sim->data->ctrl[sim->model->robot[i].servo[side]] = wheel->target_radps;
      }
    }
    if (sim->model->drive == VS_DRIVE_PLANAR) step_planar_robot(sim, i);
  }
}
