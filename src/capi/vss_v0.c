#include "vss_v0.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

enum { ROBOTS = VS_TEAMS * VS_TEAM_SIZE };
enum { GOAL_SCORE, MOVE, BALL_GRAD, ENERGY, GOALS_BLUE, GOALS_YELLOW };

static const char *const shaping_names[CAPI_SHAPING] = {"goal_score", "move",       "ball_grad",
                                                        "energy",     "goals_blue", "goals_yellow"};

const char *vs_capi_shaping(int index) { return index < CAPI_SHAPING ? shaping_names[index] : NULL; }

static bool is_near(const vs_world *w, int placed, double x_m, double y_m, bool ball_placed) {
  if (ball_placed && vs_distance_m(x_m, y_m, w->ball.x_m, w->ball.y_m) < VSS_V0_APART_M) return true;
  for (int i = 0; i < placed; i++) {
    vs_pose other = w->robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].pose;
    if (vs_distance_m(x_m, y_m, other.x_m, other.y_m) < VSS_V0_APART_M) return true;
  }
  return false;
}

// Anywhere 10 cm off the walls.
static void somewhere(vs_rng *rng, double *x_m, double *y_m) {
  *x_m = vs_rng_range(rng, 0.1 - VS_FIELD_HALF_LENGTH_M, VS_FIELD_HALF_LENGTH_M - 0.1);
  *y_m = vs_rng_range(rng, 0.1 - VS_FIELD_HALF_WIDTH_M, VS_FIELD_HALF_WIDTH_M - 0.1);
}

void vss_v0_reset(vss_v0 *e, vs_sim *sim, const vs_realism *realism) {
  uint64_t seed = vs_seed_mix(e->seed, e->episode++);
  vs_sim_params params = vs_realism_draw(realism, vs_seed_mix(seed, 1));
  e->rng = vs_rng_make(seed, 0);
  vs_world w = {0};
  somewhere(&e->rng, &w.ball.x_m, &w.ball.y_m);
  for (int i = 0; i < ROBOTS; i++) {
    vs_pose *pose = &w.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].pose;
    double x_m, y_m;
    do somewhere(&e->rng, &x_m, &y_m);
    while (is_near(&w, i, x_m, y_m, true));
    *pose = (vs_pose){x_m, y_m, vs_rng_range(&e->rng, -VS_PI, VS_PI)};
  }
  vs_sim_reset(sim, &params);
  vs_sim_place(sim, &w);
  vs_sim_world(sim, &e->world);
  memset(e->driver, 0, sizeof e->driver);
  memset(e->shaping, 0, sizeof e->shaping);
  e->has_potential = false;
  e->steps = 0;
}

static float scaled(double value, double scale) { return (float)vs_clamp(value / scale, -VSS_V0_BOUND, VSS_V0_BOUND); }

void vss_v0_observe(const vss_v0 *e, float out[CAPI_VSS_OBSERVATION]) {
  const vs_ball *ball = &e->world.ball;
  *out++ = scaled(ball->x_m, VSS_V0_MAX_POS_M);
  *out++ = scaled(ball->y_m, VSS_V0_MAX_POS_M);
  *out++ = scaled(ball->vx_mps, VSS_V0_MAX_MPS);
  *out++ = scaled(ball->vy_mps, VSS_V0_MAX_MPS);
  for (int i = 0; i < ROBOTS; i++) {
    const vs_robot *r = &e->world.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    *out++ = scaled(r->pose.x_m, VSS_V0_MAX_POS_M);
    *out++ = scaled(r->pose.y_m, VSS_V0_MAX_POS_M);
    if (i / VS_TEAM_SIZE == VS_BLUE) {
      *out++ = (float)sin(r->pose.theta_rad);
      *out++ = (float)cos(r->pose.theta_rad);
    }
    *out++ = scaled(r->vx_mps, VSS_V0_MAX_MPS);
    *out++ = scaled(r->vy_mps, VSS_V0_MAX_MPS);
    *out++ = scaled(r->omega_radps * 180.0 / VS_PI, VSS_V0_MAX_DEGPS);
  }
}

// Rim speed of one wheel in m/s.
static double rim_mps(double action) {
  double v = vs_clamp(action * VSS_V0_MAX_MPS, -VSS_V0_MAX_MPS, VSS_V0_MAX_MPS);
  return fabs(v) < VSS_V0_DEAD_ZONE ? 0.0 : v;
}

// An Ornstein-Uhlenbeck process around standing still.
static void drive_at_random(vss_v0 *e, double driver[2]) {
  const double dt_s = 1.0 / CAPI_VSS_HZ;
  for (int k = 0; k < 2; k++)
    driver[k] += -VSS_V0_OU_THETA * driver[k] * dt_s + VSS_V0_OU_SIGMA * sqrt(dt_s) * vs_rng_normal(&e->rng);
}

// How far the ball is on its way between the goals' backs: -1 in blue's, 0 in yellow's.
static double ball_potential(const vs_ball *ball) {
  const double half_m = VS_FIELD_HALF_LENGTH_M + VS_GOAL_DEPTH_M, length_m = 2 * VS_FIELD_HALF_LENGTH_M;
  double to_defend_m = half_m + ball->x_m, to_attack_m = half_m - ball->x_m, aside = 2 * ball->y_m * ball->y_m;
  return ((sqrt(to_defend_m * to_defend_m + aside) - sqrt(to_attack_m * to_attack_m + aside)) / length_m - 1) / 2;
}

static double ball_reward(vss_v0 *e) {
  double potential = ball_potential(&e->world.ball), gain = 0;
  if (e->has_potential) gain = vs_clamp((potential - e->potential) * 3 * CAPI_VSS_HZ, -5, 5);
  e->potential = potential;
  e->has_potential = true;
  return gain;
}

// Blue 0's speed towards the ball, in units of 0.4 m/s.
static double move_reward(const vss_v0 *e) {
  const vs_robot *r = &e->world.robot[VS_BLUE][0];
  double dx = e->world.ball.x_m - r->pose.x_m, dy = e->world.ball.y_m - r->pose.y_m, away = sqrt(dx * dx + dy * dy);
  if (away <= 0) return 0;
  return vs_clamp((dx * r->vx_mps + dy * r->vy_mps) / away / 0.4, -5, 5);
}

static double judge(vss_v0 *e, double rims_mps, bool *goal) {
  double x_m = e->world.ball.x_m, line_m = VS_FIELD_HALF_LENGTH_M;
  *goal = fabs(x_m) > line_m;
  if (*goal) {
    e->shaping[GOAL_SCORE] += x_m > 0 ? 1 : -1;
    e->shaping[x_m > 0 ? GOALS_BLUE : GOALS_YELLOW] += 1;
    return x_m > 0 ? VSS_V0_GOAL : -VSS_V0_GOAL;
  }
  double move = VSS_V0_MOVE * move_reward(e), ball = VSS_V0_BALL * ball_reward(e);
  double energy = -VSS_V0_ENERGY * rims_mps / VSS_V0_WHEEL_M;
  e->shaping[MOVE] += move;
  e->shaping[BALL_GRAD] += ball;
  e->shaping[ENERGY] += energy;
  return move + ball + energy;
}

vs_status vss_v0_step(vss_v0 *e, vs_sim *sim, const float action[CAPI_VSS_ACTION], float *reward, bool *goal,
                      vs_error *err) {
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  for (int i = 0; i < ROBOTS; i++) {
    if (i > 0) drive_at_random(e, e->driver[i]);
    double left_mps = rim_mps(i == 0 ? action[0] : e->driver[i][0]);
    double right_mps = rim_mps(i == 0 ? action[1] : e->driver[i][1]);
    command[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE] =
        (vs_wheels){left_mps / VS_WHEEL_RADIUS_M, right_mps / VS_WHEEL_RADIUS_M};
  }
  vs_status s = vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])command, err);
  if (s != VS_OK)
    return vs_fail_prefix(err, "episode %llu of seed %llu", (unsigned long long)(e->episode - 1),
                          (unsigned long long)e->seed);
  vs_sim_world(sim, &e->world);
  e->steps++;
  *reward = (float)judge(e, fabs(rim_mps(action[0])) + fabs(rim_mps(action[1])), goal);
  return VS_OK;
}
