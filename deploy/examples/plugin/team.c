// A team of your own in one file: a keeper, a striker and a third robot in reserve.
//
//   make && ./vsss sim --blue plugin:deploy/examples/plugin/team.so --yellow random:
//
// The program calls step() rate_hz times a second with the world as this team sees it: metres and radians from the
// field's centre, this team attacks +x, its robots are world->robot[VS_OWN]. The answer is two wheel speeds in rad/s
// for each robot. All that the team remembers lies in the state block, which the program keeps, copies and zeroes.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/player.h"

#define PI 3.14159265358979323846

typedef struct team {
  double speed_mps; // top speed, from the URI: plugin:team.so?speed=0.8
  int striker;      // robot that went for the ball last
} team;

static vs_status init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)seed; // nothing random here
  team *t = state;
  *t = (team){.speed_mps = 1.0, .striker = 1};
  if (!*options) return VS_OK;
  t->speed_mps = strncmp(options, "speed=", 6) ? 0.0 : atof(options + 6);
  if (t->speed_mps > 0.0 && t->speed_mps <= 1.4) return VS_OK;
  snprintf(err->text, sizeof err->text, "the only option is speed=, more than 0 and at most 1.4 m/s");
  return VS_USAGE;
}

// Wheel speeds that drive a robot to a point: forwards or backwards, whichever end is nearer, slower when turning.
static vs_wheels drive_to(const vs_robot *r, double x_m, double y_m, double speed_mps) {
  double dx = x_m - r->pose.x_m, dy = y_m - r->pose.y_m;
  if (hypot(dx, dy) < 0.01) return (vs_wheels){0.0, 0.0};
  double error = remainder(atan2(dy, dx) - r->pose.theta_rad, 2.0 * PI);
  double end = 1.0;
  if (fabs(error) > PI / 2) {
    end = -1.0;
    error = remainder(error - PI, 2.0 * PI);
  }
  double forward_mps = end * speed_mps * cos(error) * fmin(1.0, hypot(dx, dy) / 0.15 + 0.3);
  double turn_mps = VS_HALF_TRACK_M * 8.0 * error;
  return (vs_wheels){(forward_mps - turn_mps) / VS_WHEEL_RADIUS_M, (forward_mps + turn_mps) / VS_WHEEL_RADIUS_M};
}

// In front of the goal, level with the ball.
static vs_wheels keep(const vs_robot *r, const vs_ball *ball, double speed_mps) {
  double y_m = fmax(-VS_GOAL_HALF_WIDTH_M, fmin(VS_GOAL_HALF_WIDTH_M, ball->y_m));
  return drive_to(r, -VS_FIELD_HALF_LENGTH_M + 0.06, y_m, speed_mps);
}

// Around the ball on the robot's own side of it, then behind it on its line to their goal, then through it.
static vs_wheels strike(const vs_robot *r, const vs_ball *ball, double speed_mps) {
  double gx = VS_FIELD_HALF_LENGTH_M - ball->x_m, gy = -ball->y_m, length = hypot(gx, gy) + 1e-9;
  gx /= length, gy /= length;
  double rx = r->pose.x_m - ball->x_m, ry = r->pose.y_m - ball->y_m;
  double behind_m = -(rx * gx + ry * gy), left_m = gx * ry - gy * rx; // of the robot, as seen along the shot
  double along_m = -0.12, aside_m = 0.0;
  if (behind_m < 0.05)
    aside_m = left_m > 0.0 ? 0.14 : -0.14;
  else if (fabs(left_m) < 0.03)
    along_m = 0.2;
  return drive_to(r, ball->x_m + along_m * gx - aside_m * gy, ball->y_m + along_m * gy + aside_m * gx, speed_mps);
}

// The ball in our goal area: two robots of ours in there would be a penalty, so only the keeper goes for it.
static bool ball_in_our_area(const vs_ball *ball) {
  return ball->x_m < -VS_FIELD_HALF_LENGTH_M + VS_AREA_DEPTH_M + 0.05 && fabs(ball->y_m) < VS_AREA_HALF_WIDTH_M + 0.05;
}

static double ball_distance(const vs_world *w, int robot) {
  const vs_pose *p = &w->robot[VS_OWN][robot].pose;
  return hypot(w->ball.x_m - p->x_m, w->ball.y_m - p->y_m);
}

static void step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels out[VS_TEAM_SIZE]) {
  (void)game, (void)dt_s;
  team *t = state;
  int reserve = 3 - t->striker; // robot 0 keeps; 1 and 2 take turns, with 5 cm of hesitation
  if (ball_distance(world, reserve) < ball_distance(world, t->striker) - 0.05) {
    t->striker = reserve;
    reserve = 3 - reserve;
  }
  const vs_robot *own = world->robot[VS_OWN];
  if (ball_in_our_area(&world->ball)) {
    out[0] = strike(&own[0], &world->ball, t->speed_mps);
    out[t->striker] = drive_to(&own[t->striker], -0.4, world->ball.y_m, t->speed_mps);
  } else {
    out[0] = keep(&own[0], &world->ball, t->speed_mps);
    out[t->striker] = strike(&own[t->striker], &world->ball, t->speed_mps);
  }
  out[reserve] = drive_to(&own[reserve], -0.3, world->ball.y_m > 0.0 ? -0.2 : 0.2, t->speed_mps);
}

static const vsss_player_api api = {
    .version = VSSS_PLAYER_VERSION,
    .name = "example team",
    .rate_hz = 30,
    .state_size = sizeof(team),
    .init = init,
    .step = step,
};

const vsss_player_api *vsss_player(void) { return &api; }
