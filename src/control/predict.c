#include "predict.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

#define STEP_S       (1.0 / 120)
#define HALF_ROBOT_M (VS_ROBOT_SIZE_M / 2)
#define REBOUND      0.6 // of the ball's speed into a wall is left

// What a robot's wheels move, their geared rotors included (sim/drive.h, models/vsss_contact.xml).
#define MOVED_KG    0.48
#define TURNED_KGM2 4.33e-4

void vs_predictor_command(vs_predictor *predictor, int64_t time_us, const vs_wheels wheels[VS_TEAM_MOST]) {
  vs_commands *c = &predictor->commands;
  if (c->count > 0 && !memcmp(c->wheels[c->count - 1], wheels, sizeof c->wheels[0])) return;
  if (c->count == VS_COMMANDS_KEPT) {
    c->count--;
    memmove(c->time_us, c->time_us + 1, (size_t)c->count * sizeof *c->time_us);
    memmove(c->wheels, c->wheels + 1, (size_t)c->count * sizeof *c->wheels);
  }
  c->time_us[c->count] = time_us;
  memcpy(c->wheels[c->count++], wheels, sizeof c->wheels[0]);
}

// The command that acts when what was sent at sent_us arrives; NULL: none, the robots stand.
static const vs_wheels *acting(const vs_commands *c, double sent_us) {
  const vs_wheels *found = NULL;
  for (int i = 0; i < c->count && (double)c->time_us[i] <= sent_us + 1.0; i++) found = c->wheels[i];
  return found;
}

static double inside(double value, double half, double size) { return vs_clamp(value, -(half - size), half - size); }

// Keeps a robot inside the walls; where it meets one it stops towards it.
static void keep_in(const vs_pitch *field, vs_robot *robot) {
  bool in_goal = fabs(robot->pose.y_m) < field->goal_half_width_m;
  double half_m = field->half_length_m + (in_goal ? field->goal_depth_m : 0.0);
  double x_m = inside(robot->pose.x_m, half_m, HALF_ROBOT_M);
  double y_m = inside(robot->pose.y_m, field->half_width_m, HALF_ROBOT_M);
  if (x_m != robot->pose.x_m) robot->vx_mps = 0;
  if (y_m != robot->pose.y_m) robot->vy_mps = 0;
  robot->pose.x_m = x_m;
  robot->pose.y_m = y_m;
}

// What a wheel whose rim goes at rim_mps pulls with, in newton; an implicit step, so that it does not overshoot.
static double pull(double command_radps, double rim_mps, double dt_s) {
  double limit = VS_WHEEL_LIMIT_RADPS, r = VS_WHEEL_RADIUS_M;
  double gap_radps = vs_clamp(command_radps, -limit, limit) - rim_mps / r;
  double damping = VS_SERVO_GAIN_NMSPRAD / (1.0 + dt_s * 2 * VS_SERVO_GAIN_NMSPRAD / (MOVED_KG * r * r));
  return vs_clamp(damping * gap_radps, -VS_SERVO_LIMIT_NM, VS_SERVO_LIMIT_NM) / r;
}

static void drive(vs_robot *robot, const vs_wheels *wheels, double dt_s) {
  double c = cos(robot->pose.theta_rad), s = sin(robot->pose.theta_rad);
  double forward = c * robot->vx_mps + s * robot->vy_mps;
  double left_n = pull(wheels->left_radps, forward - VS_HALF_TRACK_M * robot->omega_radps, dt_s);
  double right_n = pull(wheels->right_radps, forward + VS_HALF_TRACK_M * robot->omega_radps, dt_s);
  forward += dt_s * (left_n + right_n) / MOVED_KG;
  robot->omega_radps += dt_s * VS_HALF_TRACK_M * (right_n - left_n) / TURNED_KGM2;
  double theta = robot->pose.theta_rad + 0.5 * robot->omega_radps * dt_s;
  robot->vx_mps = cos(theta) * forward;
  robot->vy_mps = sin(theta) * forward;
}

// The velocity of a robot nobody knows the commands of turns with the robot.
static void coast(vs_robot *robot, double dt_s) {
  double c = cos(robot->omega_radps * dt_s), s = sin(robot->omega_radps * dt_s), vx = robot->vx_mps;
  robot->vx_mps = c * vx - s * robot->vy_mps;
  robot->vy_mps = s * vx + c * robot->vy_mps;
}

static void move(const vs_pitch *field, vs_robot *robot, double dt_s) {
  robot->pose.x_m += robot->vx_mps * dt_s;
  robot->pose.y_m += robot->vy_mps * dt_s;
  robot->pose.theta_rad = vs_wrap_rad(robot->pose.theta_rad + robot->omega_radps * dt_s);
  keep_in(field, robot);
}

// Along one axis: the ball leaves a wall it has run into.
static void rebound(double *place, double *speed, double half) {
  double limit = half - VS_BALL_RADIUS_M, over = fabs(*place) - limit;
  if (over <= 0) return;
  *place = copysign(limit, *place);
  if (*speed * *place > 0) *speed *= -REBOUND;
}

static void roll(const vs_pitch *field, vs_ball *ball, double dt_s) {
  double speed = hypot(ball->vx_mps, ball->vy_mps), slower = speed - VS_BALL_DECELERATION_MPS2 * dt_s;
  double scale = speed > 0 && slower > 0 ? slower / speed : 0;
  ball->vx_mps *= scale;
  ball->vy_mps *= scale;
  ball->x_m += ball->vx_mps * dt_s;
  ball->y_m += ball->vy_mps * dt_s;
  if (fabs(ball->y_m) > field->goal_half_width_m) rebound(&ball->x_m, &ball->vx_mps, field->half_length_m);
  rebound(&ball->y_m, &ball->vy_mps, field->half_width_m);
}

// A ball inside a robot leaves it through the nearest side and goes at least as fast as this side does.
static void push(const vs_robot *robot, vs_ball *ball) {
  const double reach = HALF_ROBOT_M + VS_BALL_RADIUS_M;
  double dx = ball->x_m - robot->pose.x_m, dy = ball->y_m - robot->pose.y_m;
  if (dx * dx + dy * dy >= 2 * reach * reach) return;
  double c = cos(robot->pose.theta_rad), s = sin(robot->pose.theta_rad);
  double along = c * dx + s * dy, across = -s * dx + c * dy;
  double deep_along = reach - fabs(along), deep_across = reach - fabs(across);
  if (deep_along <= 0 || deep_across <= 0) return;
  bool side = deep_across < deep_along;
  double out = copysign(1.0, side ? across : along), deep = side ? deep_across : deep_along;
  double nx = side ? -s * out : c * out, ny = side ? c * out : s * out;
  ball->x_m += deep * nx;
  ball->y_m += deep * ny;
  double robot_mps = (robot->vx_mps - robot->omega_radps * dy) * nx + (robot->vy_mps + robot->omega_radps * dx) * ny;
  double slip = robot_mps - (ball->vx_mps * nx + ball->vy_mps * ny);
  if (slip <= 0) return;
  ball->vx_mps += slip * nx;
  ball->vy_mps += slip * ny;
}

static void step(const vs_wheels *wheels, vs_team team, double dt_s, vs_world *world) {
  static const vs_wheels stand[VS_TEAM_MOST] = {{0}};
  const vs_pitch *field = vs_pitch_of(world->division);
  const int team_size = field->team_size;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < team_size; i++) {
      vs_robot *robot = &world->robot[t][i];
      if (!robot->valid) continue;
      if (t == (int)team)
        drive(robot, wheels ? &wheels[i] : &stand[i], dt_s);
      else
        coast(robot, dt_s);
      move(field, robot, dt_s);
    }
  if (!world->ball.valid) return;
  roll(field, &world->ball, dt_s);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < team_size; i++)
      if (world->robot[t][i].valid) push(&world->robot[t][i], &world->ball);
}

// Moves a world on by span_s.
static void go_on(const vs_commands *commands, vs_team team, double latency_s, double span_s, vs_world *world) {
  int steps = (int)ceil(span_s / STEP_S - 1e-9);
  double dt_s = steps > 0 ? span_s / steps : 0;
  for (int k = 0; k < steps; k++) {
    double sent_us = (double)world->time_us + 1e6 * ((k + 0.5) * dt_s - latency_s);
    step(acting(commands, sent_us), team, dt_s, world);
  }
}

// What one frame's measurement corrects: shares of its difference to what was expected, given to the place and, divided by
// the time, to the rate. For 30 frames a second; others are converted.
typedef struct gains {
  double place, rate;
} gains;

// Tuned by random search on 8 minutes of the shipped policy against emc: and inf:, contact drive, paper's noise, 67 ms:
// mean errors of the prediction 8 mm and 8 degrees of own robots, 7 mm of the others, 6 mm of the ball; 8, 9, 10 and 15
// with the Kalman filter's velocities, 18, 38, 13 and 14 without a prediction.
static const gains own_place = {0.53, 1.0}, own_heading = {0.62, 0.94};
static const gains their_place = {0.60, 0.56}, their_heading = {0.59, 1.0};
static const gains ball_alone = {0.42, 0.16}, ball_near_robot = {0.82, 0.46};
#define NEAR_M       0.136 // the ball to a robot's centre
#define ROBOT_JUMP_M 0.05  // further from what was expected: put there by hand, or mistaken before
#define BALL_JUMP_M  0.127

static void correct(double *place, double *rate, double difference, gains g, double dt_s) {
  double frames = dt_s * VS_CAMERA_HZ;
  *place += (1.0 - pow(1.0 - g.place, frames)) * difference;
  *rate += g.rate * difference * (frames < 1.0 ? frames * VS_CAMERA_HZ : 1.0 / dt_s);
}

static void correct_robot(vs_robot *robot, const vs_robot *seen, gains place, gains heading, double dt_s) {
  double dx = seen->pose.x_m - robot->pose.x_m, dy = seen->pose.y_m - robot->pose.y_m;
  if (!robot->valid || !seen->valid || hypot(dx, dy) > ROBOT_JUMP_M) {
    *robot = *seen;
    return;
  }
  double turn = vs_wrap_rad(seen->pose.theta_rad - robot->pose.theta_rad);
  correct(&robot->pose.x_m, &robot->vx_mps, dx, place, dt_s);
  correct(&robot->pose.y_m, &robot->vy_mps, dy, place, dt_s);
  correct(&robot->pose.theta_rad, &robot->omega_radps, turn, heading, dt_s);
  robot->pose.theta_rad = vs_wrap_rad(robot->pose.theta_rad);
}

static bool near_robot(const vs_world *world) {
  for (int i = 0, n = vs_team_size(world); i < VS_TEAMS * n; i++) {
    const vs_pose *p = &world->robot[i / n][i % n].pose;
    if (vs_distance_m(p->x_m, p->y_m, world->ball.x_m, world->ball.y_m) < NEAR_M) return true;
  }
  return false;
}

static void correct_ball(vs_ball *ball, const vs_ball *seen, bool near, double dt_s) {
  double dx = seen->x_m - ball->x_m, dy = seen->y_m - ball->y_m;
  if (!ball->valid || !seen->valid || hypot(dx, dy) > BALL_JUMP_M) {
    *ball = *seen;
    return;
  }
  gains g = near ? ball_near_robot : ball_alone;
  correct(&ball->x_m, &ball->vx_mps, dx, g, dt_s);
  correct(&ball->y_m, &ball->vy_mps, dy, g, dt_s);
}

void vs_predictor_see(vs_predictor *p, vs_team team, double latency_s, const vs_world *measured) {
  double dt_s = 1e-6 * (double)(measured->time_us - p->now.time_us);
  if (p->started && dt_s <= 0) return;
  if (!p->started || dt_s > 0.5) {
    p->now = *measured;
    p->started = true;
    return;
  }
  go_on(&p->commands, team, latency_s, dt_s, &p->now);
  p->now.time_us = measured->time_us;
  p->now.seq = measured->seq;
  for (int i = 0, n = vs_team_size(measured); i < n; i++) {
    correct_robot(&p->now.robot[team][i], &measured->robot[team][i], own_place, own_heading, dt_s);
    correct_robot(&p->now.robot[!team][i], &measured->robot[!team][i], their_place, their_heading, dt_s);
  }
  correct_ball(&p->now.ball, &measured->ball, near_robot(measured), dt_s);
}

void vs_predictor_ahead(const vs_predictor *p, vs_team team, double latency_s, vs_world *out) {
  *out = p->now;
  go_on(&p->commands, team, latency_s, latency_s, out);
}
