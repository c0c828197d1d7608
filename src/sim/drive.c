// Wheel command -> motor -> traction. The contact drive only needs the motor's command: its wheels roll in MuJoCo. The
// planar drive solves, per robot and step, for the friction forces of its two wheels on the floor: they stop the slip,
// forward at each wheel and sideways, as far as the wheels' loads allow.
#include "drive.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

// How fast gripping wheels lose slip, as MuJoCo's contacts do: 2 / (solimp solref) of class wheel_floor. Since its
// constraints leave out the turning of their axes, a curve is driven with a sideways slip of its acceleration / this.
#define SLIP_DECAY_PER_S (2 / (0.95 * 0.015))
#define SWEEPS           6 // of projected Gauss-Seidel, only for a robot that slips

double vs_drive_target(const vs_sim_params *params, int team, int index, int side, double command_radps) {
  if (fabs(command_radps) < params->dead_zone_radps) return 0;
  double limit = VS_WHEEL_LIMIT_RADPS * params->wheel_limit_scale;
  return vs_clamp(command_radps, -limit, limit) * params->wheel_gain[team][index][side];
}

// One robot's step, in its own axes: u forward, s to the left, w about the vertical.
typedef struct traction {
  double dt, mass, inertia, friction, radius, half_track;
  double u, s, w;                // velocities at the end of the step without friction: other forces included
  double com_u, com_s;           // centre of mass off the middle
  double push_u, push_s;         // contact forces of the last step, no more than the robot's weight
  double rim[SIDES];             // rim speeds at the end of the step without friction
  double keep[SIDES], keep_s;    // slip that may be left at the end of the step: forward at each wheel, sideways
  double along[SIDES], sideways; // friction forces on the robot, in newton; sideways: both wheels together
} traction;

// Slip of a wheel over the floor at the end of the step, more than what may be left.
static double slip(const traction *t, int side) {
  double sign = side == LEFT ? -1 : 1;
  double u = t->u + t->dt * (t->along[LEFT] + t->along[RIGHT]) / t->mass;
  double w = t->w + t->dt * t->half_track * (t->along[RIGHT] - t->along[LEFT]) / t->inertia;
  double rim = t->rim[side] - t->dt * t->radius * t->radius / WHEEL_INERTIA_KGM2 * t->along[side];
  return u + sign * t->half_track * w - rim - t->keep[side];
}

// Forces that stop the slip: two equations for the wheels, one sideways.
static void full_grip(traction *t) {
  double body = t->dt / t->mass, turn = t->dt * t->half_track * t->half_track / t->inertia;
  double a = body + turn + t->dt * t->radius * t->radius / WHEEL_INERTIA_KGM2, b = body - turn;
  t->along[LEFT] = t->along[RIGHT] = 0;
  double left = slip(t, LEFT), right = slip(t, RIGHT);
  t->along[LEFT] = (b * right - a * left) / (a * a - b * b);
  t->along[RIGHT] = (b * left - a * right) / (a * a - b * b);
  t->sideways = (t->keep_s - t->s) / body;
}

// Loads of the wheels under these forces: the skid takes some when the robot speeds up or brakes, the outer wheel takes
// from the inner one in a curve. Pushes meet the robot near the floor, as friction does: a robot rocks back from what it
// pushes until its lower edge touches.
static void wheel_loads(const traction *t, double load[SIDES]) {
  double weight = t->mass * GRAVITY_MPS2;
  double tip = (t->along[LEFT] + t->along[RIGHT] + t->push_u) * COM_HEIGHT_M - weight * t->com_u;
  double wheels = fmax(0, weight - fabs(tip) / SKID_DISTANCE_M);
  double roll = (t->sideways + t->push_s) * COM_HEIGHT_M - weight * t->com_s;
  double shift = vs_clamp(roll / (2 * t->half_track), -wheels / 2, wheels / 2);
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

// Sliding: each wheel's force is shortened to its friction circle in turn, the others answering. Starts from the forces
// of the last step, which change little while a robot slides.
static void slide(traction *t, wheel_state wheel[SIDES]) {
  double response =
      t->dt * (1 / t->mass + t->half_track * t->half_track / t->inertia + t->radius * t->radius / WHEEL_INERTIA_KGM2);
  double load[SIDES], side_force[SIDES], grip = t->sideways;
  for (int side = LEFT; side < SIDES; side++) t->along[side] = wheel[side].along_n;
  t->sideways = wheel[LEFT].sideways_n + wheel[RIGHT].sideways_n;
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

static double motor_torque(const wheel_state *wheel, double scale) {
  double limit = scale * VS_SERVO_LIMIT_NM;
  return vs_clamp(scale * VS_SERVO_GAIN_NMSPRAD * (wheel->target_radps - wheel->speed_radps), -limit, limit);
}

static void step_planar_robot(vs_sim *sim, int index) {
  const robot_address *address = &sim->model->robot[index];
  mjData *d = sim->data;
  const double *v = d->qvel + address->qvel, *push = d->qfrc_constraint + address->qvel; // contacts of the last step
  double *applied = d->qfrc_applied + address->qvel;
  wheel_state *wheel = sim->wheel[index];
  int team = team_of(sim->model, index), i = index_in_team(sim->model, index);
  traction t = {.dt = sim->mj->opt.timestep,
                .mass = sim->mj->body_mass[address->body],
                .inertia = sim->mj->body_inertia[3 * address->body + 2],
                .friction = WHEEL_FRICTION * sim->params.floor_friction_scale,
                .radius = VS_WHEEL_RADIUS_M * sim->params.wheel_radius_scale[team][i],
                .half_track = VS_HALF_TRACK_M * sim->params.track_scale[team][i],
                .com_u = sim->params.com_offset_m[team][i][0],
                .com_s = sim->params.com_offset_m[team][i][1]};
  // Half a step back: the velocity found is held while the robot turns on, and its mean slip should be right.
  double heading = d->qpos[address->qpos + 2] - 0.5 * t.dt * v[2];
  double c = cos(heading), n = sin(heading);
  double u = c * v[0] + n * v[1], sideways = -n * v[0] + c * v[1], keep = 1 - t.dt * SLIP_DECAY_PER_S;
  double push_u = c * push[0] + n * push[1], push_s = -n * push[0] + c * push[1], weight = t.mass * GRAVITY_MPS2;
  t.push_u = vs_clamp(push_u, -weight / 2, weight / 2);
  t.push_s = vs_clamp(push_s, -weight / 2, weight / 2);
  t.u = u + t.dt * push_u / t.mass;
  t.s = sideways + t.dt * push_s / t.mass;
  t.w = v[2] + t.dt * push[2] / t.inertia;
  t.keep_s = keep * sideways;
  for (int side = LEFT; side < SIDES; side++) {
    double rim = t.radius * wheel[side].speed_radps;
    t.rim[side] = rim + t.dt * t.radius * motor_torque(&wheel[side], sim->params.servo_scale) / WHEEL_INERTIA_KGM2;
    t.keep[side] = keep * (u + (side == LEFT ? -1 : 1) * t.half_track * v[2] - rim);
  }
  double load[SIDES];
  full_grip(&t);
  wheel_loads(&t, load);
  if (!holds(&t, load)) slide(&t, wheel);
  double forward = t.along[LEFT] + t.along[RIGHT];
  applied[0] = c * forward - n * t.sideways;
  applied[1] = n * forward + c * t.sideways;
  applied[2] = t.half_track * (t.along[RIGHT] - t.along[LEFT]);
  for (int side = LEFT; side < SIDES; side++) {
    wheel[side].speed_radps = t.rim[side] / t.radius - t.dt * t.radius / WHEEL_INERTIA_KGM2 * t.along[side];
    wheel[side].along_n = t.along[side];
    wheel[side].sideways_n = t.sideways * share(load, side);
  }
}

// The way to a target within the bounds of acceleration: away from 0 by at most up, towards it by at most down.
static double ramp(double from, double to, double up, double down) {
  bool brakes = from != 0 && (from > 0 ? to < from : to > from);
  if (!brakes) return vs_clamp(to, from - up, from + up);
  double slower = from > 0 ? fmax(from - down, fmax(to, 0)) : fmin(from + down, fmin(to, 0));
  return slower;
}

void vs_drive_step(vs_sim *sim, const double target[ROBOTS_MOST][SIDES]) {
  const vs_sim_params *p = &sim->params;
  double per_step = sim->mj->opt.timestep / VS_WHEEL_RADIUS_M;
  for (int i = 0; i < sim->model->robots; i++) {
    for (int side = LEFT; side < SIDES; side++) {
      wheel_state *wheel = &sim->wheel[i][side];
      double next = wheel->target_radps + sim->lag * (target[i][side] - wheel->target_radps);
      if (p->accelerate_mps2 > 0)
        next = ramp(wheel->target_radps, next, per_step * p->accelerate_mps2, per_step * p->brake_mps2);
      wheel->target_radps = next;
      if (sim->model->drive == VS_DRIVE_CONTACT) {
        sim->data->ctrl[sim->model->robot[i].servo[side]] = wheel->target_radps;
      }
    }
    if (sim->model->drive == VS_DRIVE_PLANAR) step_planar_robot(sim, i);
  }
  if (sim->model->drive == VS_DRIVE_PLANAR) vs_ball_step(sim);
}
