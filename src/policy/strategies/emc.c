// EMC-2019: one tick (roles, ball estimate, swaps, behaviour, wheels) and the player emc:.
#include "emc.h"

#include <string.h>

#include "policy/policy_internal.h"
#include "vsss/field.h"

#define COLLISION_M   0.12
#define SWAP_PERIOD_S 2.0

void emc_init(emc_state *s) {
  memset(s, 0, sizeof *s);
  for (int r = 0; r < EMC_ROLES; r++) s->role[r].robot = r;
}

static void read_poses(emc_state *s, const emc_input *in) {
  s->ball = in->ball;
  for (int r = 0; r < EMC_ROLES; r++) {
    s->role[r].at = in->at[s->role[r].robot];
    s->role[r].theta_rad = in->theta_rad[s->role[r].robot];
  }
}

// Straight line through the last 15 samples (least squares), read off 11 samples ahead. The samples start as zeros.
static void estimate_ball(emc_state *s) {
  memmove(s->sample, s->sample + 1, (EMC_SAMPLES - 1) * sizeof *s->sample);
  s->sample[EMC_SAMPLES - 1] = s->ball;
  s->ahead = (vs_point){0.0, 0.0};
  for (int i = 0; i < EMC_SAMPLES; i++) {
    double weight = 1.0 / 15.0 + 18.0 * (i - 7) / 280.0;
    s->ahead.x += s->sample[i].x * weight;
    s->ahead.y += s->sample[i].y * weight;
  }
}

static void swap_roles(emc_role *a, emc_role *b) {
  emc_role old = *a;
  a->robot = b->robot, a->at = b->at, a->theta_rad = b->theta_rad;
  b->robot = old.robot, b->at = old.at, b->theta_rad = old.theta_rad;
}

// Where the command of the last tick makes the robot drive, if anywhere.
static bool command_direction(const emc_role *r, double *direction_rad) {
  const emc_command *c = &r->command;
  if (c->kind == EMC_NONE || c->kind == EMC_SPIN || c->speed_mps <= 0.0) return false;
  *direction_rad = c->kind == EMC_POSITION ? vs_point_angle(r->at, c->target) : c->angle_rad;
  return true;
}

static bool drives_at(const emc_role *r, const emc_role *other, double direction_rad) {
  return fabs(vs_wrap_rad(vs_point_angle(r->at, other->at) - direction_rad)) < VS_PI / 2;
}

// The first pair that touches; swapped if one of them pushes towards the other.
static bool swap_colliding(emc_state *s) {
  static const emc_role_name pair[][2] = {
      {EMC_KEEPER, EMC_DEFENDER}, {EMC_DEFENDER, EMC_ATTACKER}, {EMC_KEEPER, EMC_ATTACKER}};
  for (int i = 0; i < 3; i++) {
    emc_role *a = &s->role[pair[i][0]], *b = &s->role[pair[i][1]];
    if (!(vs_point_distance(a->at, b->at) < COLLISION_M)) continue;
    double direction;
    bool opposite = false;
    if (command_direction(a, &direction))
      opposite = drives_at(a, b, direction);
    else if (command_direction(b, &direction))
      opposite = drives_at(b, a, direction);
    if (opposite) swap_roles(a, b);
    return true;
  }
  return false;
}

static bool in_their_box(vs_point p) { return p.x >= 1.39 && p.x <= 1.54 && p.y >= 0.30 && p.y <= 0.95; }

static bool swap_attacker(emc_state *s) {
  emc_role *a = &s->role[EMC_ATTACKER], *d = &s->role[EMC_DEFENDER];
  bool farther = vs_point_distance(a->at, s->ball) > vs_point_distance(d->at, s->ball);
  bool passed = fabs(a->at.x - s->ball.x) > 0.30 && s->ball.x < a->at.x;
  bool corner = emc_their_corner(a->at);
  if (!((in_their_box(s->ball) && farther) || (passed && !corner) || (farther && !corner))) return false;
  swap_roles(a, d);
  return true;
}

static void transitions(emc_state *s) {
  // A nanosecond of slack: sixty ticks of 1/30 s must not count as more than two seconds by rounding.
  if (!(s->clock_s - s->swap_s > SWAP_PERIOD_S + 1e-9)) return;
  bool collided = swap_colliding(s);
  bool swapped = swap_attacker(s);
  if (collided || swapped) s->swap_s = s->clock_s;
}

void emc_tick(emc_state *s, const emc_input *in, emc_output *out) {
  if (s->running) s->clock_s += in->dt_s;
  s->running = true;
  read_poses(s, in);
  estimate_ball(s);
  // The original sends by the roles of before the swaps: for one tick, swapped robots carry each other's commands.
  int receiver[EMC_ROLES];
  for (int r = 0; r < EMC_ROLES; r++) receiver[r] = s->role[r].robot;
  transitions(s);
  emc_behave(s);
  for (int r = 0; r < EMC_ROLES; r++) {
    double *target = out->target_mps[receiver[r]];
    emc_control(&s->role[r], target);
    for (int w = 0; w < 2; w++)
      out->pid_mps[receiver[r]][w] =
          emc_pid_step(&s->role[r].pid[w], target[w], in->wheel_mps[receiver[r]][w], in->dt_s);
  }
}

static vs_status emc_player_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)seed; // nothing random in it
  emc_state *s = state;
  bool use_pid = false;
  const vs_config_key schema[] = {
      {"pid", VS_CONFIG_BOOL, &use_pid, 0, 0, 0, "drive through the strategy's own wheel PID"},
      {0},
  };
  vs_status status = vs_player_options("emc:", options, schema, err);
  emc_init(s);
  s->use_pid = use_pid;
  return status;
}

// Measured wheel speeds where the world has them, else what the robot's motion implies.
static void measured_wheels(const vs_robot *r, double wheel_mps[2]) {
  double forward = r->vx_mps * cos(r->pose.theta_rad) + r->vy_mps * sin(r->pose.theta_rad);
  bool known = r->left_radps != 0.0 || r->right_radps != 0.0;
  wheel_mps[0] = known ? r->left_radps * VS_WHEEL_RADIUS_M : forward - VS_HALF_TRACK_M * r->omega_radps;
  wheel_mps[1] = known ? r->right_radps * VS_WHEEL_RADIUS_M : forward + VS_HALF_TRACK_M * r->omega_radps;
}

static void emc_player_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *wheels) {
  (void)game; // it knows no referee
  emc_state *s = state;
  emc_input in = {.ball = {world->ball.x_m + EMC_CENTRE_X_M, world->ball.y_m + EMC_CENTRE_Y_M},
                  .dt_s = dt_s > 0.0 ? dt_s : 1.0 / VS_CAMERA_HZ};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_robot *r = &world->robot[VS_OWN][i];
    in.at[i] = (vs_point){r->pose.x_m + EMC_CENTRE_X_M, r->pose.y_m + EMC_CENTRE_Y_M};
    in.theta_rad[i] = r->pose.theta_rad;
    measured_wheels(r, in.wheel_mps[i]);
  }
  emc_output out = {0};
  emc_tick(s, &in, &out);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const double *speed = s->use_pid ? out.pid_mps[i] : out.target_mps[i];
    wheels[i] = (vs_wheels){speed[0] / VS_WHEEL_RADIUS_M, speed[1] / VS_WHEEL_RADIUS_M};
  }
}

const vsss_player_api vs_player_emc = {
    .version = VSSS_PLAYER_VERSION,
    .name = "EMC-2019",
    .rate_hz = VS_CAMERA_HZ, // its ball estimate counts samples
    .state_size = sizeof(emc_state),
    .init = emc_player_init,
    .step = emc_player_step,
};
