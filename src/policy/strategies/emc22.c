// EMC-2022: one tick (referee, roles, behaviour, wheels) and the player emc22:.
#include "emc22.h"

#include <string.h>

#include "policy/policy_internal.h"
#include "vsss/field.h"

static const vs_point our_goal = {0.08, EMC22_CENTRE_Y_M}, their_goal_back = {EMC22_LENGTH_M, EMC22_CENTRE_Y_M},
                      their_goal_front = {1.62, EMC22_CENTRE_Y_M};

void emc22_init(emc22_state *s) {
  memset(s, 0, sizeof *s);
  for (int r = 0; r < EMC22_ROLES; r++) s->role[r] = r;
}

bool emc22_fresh(const emc22_state *s) { return s->now_s - s->command_s < 1.0; }

bool emc22_penalty_against(const emc22_state *s) { return s->foul == EMC22_PENALTY && !s->foul_ours && emc22_fresh(s); }

vs_point emc22_ball_at(const emc22_state *s, double time_s) {
  return (vs_point){s->ball.x + s->velocity_mps.x * time_s, s->ball.y + s->velocity_mps.y * time_s};
}

bool emc22_our_area(vs_point p) { return p.x <= 0.23 && p.y >= 0.325 && p.y <= 0.975; }

bool emc22_any_goal(vs_point p) { return p.x <= 0.11 || p.x >= 1.59; }

void emc22_spin_kick(emc22_state *s, emc22_robot *r) {
  double a = vs_wrap_rad(vs_point_angle(s->ball, their_goal_front) - vs_point_angle(s->ball, r->at));
  emc_spin(&r->command, a > 0.0 ? -EMC_SPIN_RADPS : EMC_SPIN_RADPS);
}

void emc22_go_stop(emc22_robot *r, double x, double y) {
  emc_go_stop(&r->command, r->at, (vs_point){x, y}, EMC22_SPEED_MPS, EMC22_ARRIVAL_M);
}

static void read_input(emc22_state *s, const emc22_input *in) {
  s->now_s = in->now_s;
  s->ball = in->ball;
  s->velocity_mps = in->velocity_mps;
  s->adversaries = in->adversaries;
  memcpy(s->adversary, in->adversary, sizeof s->adversary);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    s->robot[i].at = in->at[i];
    s->robot[i].theta_rad = in->theta_rad[i];
    s->robot[i].omega_radps = in->omega_radps[i];
  }
  if (in->command == EMC22_NO_FOUL) return;
  s->command_s = in->now_s;
  if (in->command == EMC22_OTHER) return;
  s->foul = in->command;
  s->foul_ours = in->command_ours;
}

static double attack_cost(const emc22_state *s, vs_point p) {
  double turn = vs_wrap_rad(vs_point_angle(p, s->ball) - vs_point_angle(s->ball, their_goal_back));
  return 0.85 * vs_point_distance(p, s->ball) + 0.15 * fabs(turn);
}

static double keeper_cost(vs_point p) { return 0.2 * vs_point_distance(p, our_goal) + 0.8 * (p.x - our_goal.x); }

// The cheapest of the six assignments, the first of equals in the order of (attacker, keeper, defender).
static void choose_roles(emc22_state *s) {
  double keeper_weight = 1.0;
  if (s->foul == EMC22_PENALTY && !s->foul_ours) keeper_weight = 5.0;
  if (s->foul == EMC22_GOAL_KICK && s->foul_ours) keeper_weight = 0.1;
  double best = INFINITY;
  for (int a = 0; a < VS_TEAM_SIZE; a++) {
    for (int g = 0; g < VS_TEAM_SIZE; g++) {
      if (g == a) continue;
      double cost = 0.3 * attack_cost(s, s->robot[a].at) + 0.7 * keeper_weight * keeper_cost(s->robot[g].at);
      if (!(cost < best)) continue;
      best = cost;
      s->role[EMC22_ATTACKER] = a;
      s->role[EMC22_KEEPER] = g;
      s->role[EMC22_DEFENDER] = VS_TEAM_SIZE - a - g;
    }
  }
}

void emc22_tick(emc22_state *s, const emc22_input *in, double wheel_mps[VS_TEAM_SIZE][2]) {
  read_input(s, in);
  choose_roles(s);
  emc22_attack(s);
  emc22_defend(s);
  emc22_keep(s);
  emc22_control(s);
  for (int i = 0; i < VS_TEAM_SIZE; i++) memcpy(wheel_mps[i], s->robot[i].wheel_mps, sizeof wheel_mps[i]);
}

static vs_status emc22_player_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)seed; // nothing random in it
  static const vs_config_key no_options[] = {{0}};
  emc22_init(state);
  return vs_player_options("emc22:", options, no_options, err);
}

// What this program's referee says, in the words of theirs. A goal is followed by the other side's kick-off.
static emc22_foul foul_of(const vs_event *event, bool *ours) {
  *ours = event->team == VS_BLUE;
  switch (event->kind) {
  case VS_EVENT_KICK_OFF: return EMC22_KICKOFF;
  case VS_EVENT_GOAL: *ours = !*ours; return EMC22_KICKOFF;
  case VS_EVENT_PENALTY: return EMC22_PENALTY;
  case VS_EVENT_FREE_BALL: return EMC22_FREE_BALL;
  case VS_EVENT_GOAL_KICK: return EMC22_GOAL_KICK;
  case VS_EVENT_NONE: return EMC22_NO_FOUL;
  default: return EMC22_OTHER; // half time, end, halt
  }
}

static bool same_event(const vs_event *a, const vs_event *b) {
  return a->kind == b->kind && a->team == b->team && a->quadrant == b->quadrant && a->time_s == b->time_s;
}

static void read_world(const vs_world *world, emc22_input *in) {
  in->ball = (vs_point){world->ball.x_m + EMC22_CENTRE_X_M, world->ball.y_m + EMC22_CENTRE_Y_M};
  in->velocity_mps = (vs_point){world->ball.vx_mps, world->ball.vy_mps};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_robot *r = &world->robot[VS_OWN][i], *o = &world->robot[VS_ADVERSARY][i];
    in->at[i] = (vs_point){r->pose.x_m + EMC22_CENTRE_X_M, r->pose.y_m + EMC22_CENTRE_Y_M};
    in->theta_rad[i] = r->pose.theta_rad;
    in->omega_radps[i] = r->omega_radps;
    if (!o->valid) continue;
    in->adversary[in->adversaries++] = (vs_point){o->pose.x_m + EMC22_CENTRE_X_M, o->pose.y_m + EMC22_CENTRE_Y_M};
  }
}

static void emc22_player_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *wheels) {
  emc22_state *s = state;
  emc22_input in = {.now_s = s->now_s + dt_s};
  read_world(world, &in);
  if (!same_event(&game->last_event, &s->seen)) {
    in.command = foul_of(&game->last_event, &in.command_ours);
    s->seen = game->last_event;
  }
  double speed[VS_TEAM_SIZE][2];
  emc22_tick(s, &in, speed);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    wheels[i] = (vs_wheels){speed[i][0] / VS_WHEEL_RADIUS_M, speed[i][1] / VS_WHEEL_RADIUS_M};
}

const vsss_player_api vs_player_emc22 = {
    .version = VSSS_PLAYER_VERSION,
    .name = "EMC-2022",
    .rate_hz = VS_CAMERA_HZ,
    .state_size = sizeof(emc22_state),
    .init = emc22_player_init,
    .step = emc22_player_step,
};
