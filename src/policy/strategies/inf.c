// PY-VSSS-INF: one tick (roles, state of play, tactics, commands, wheels) and the player inf:.
#include "inf.h"

#include <string.h>

#include "policy/policy_internal.h"

#define KICK_RANGE_PX 160.0
#define ROLE_PERIOD_S 1.0

void inf_init(inf_state *s) {
  memset(s, 0, sizeof *s);
  s->phase = INF_PUSH;
  s->unlock_sign = 1.0;
  for (int r = 0; r < INF_ROLES; r++) s->role[r] = r;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    s->robot[i].front = -1;
    s->robot[i].command.toward = (vs_point){INF_PAST_GOAL_X_PX, INF_MIDDLE_Y_PX};
  }
}

static void read_input(inf_state *s, const inf_input *in) {
  s->ball = in->ball;
  if (s->samples == INF_SAMPLES)
    memmove(s->sample, s->sample + 1, (INF_SAMPLES - 1) * sizeof *s->sample);
  else
    s->samples++;
  s->sample[s->samples - 1] = in->ball;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    s->robot[i].at = in->at[i];
    s->robot[i].o_rad = in->o_rad[i];
  }
}

// The robot stands so that driving at the ball sends it to the goal, and not too steeply.
bool inf_can_kick(const inf_state *s, int robot) {
  vs_point p = s->robot[robot].at, past_goal = {INF_PAST_GOAL_X_PX, INF_MIDDLE_Y_PX};
  double off = fabs(vs_wrap_rad(vs_point_angle(p, s->ball) - vs_point_angle(s->ball, past_goal)));
  double slope = fabs(vs_wrap_rad(atan2(past_goal.y - p.y, -(past_goal.x - p.x))));
  return off < vs_rad(45) && (slope < vs_rad(45) || slope > vs_rad(135));
}

static int nearest(const inf_state *s, vs_point to, unsigned taken) {
  int best = -1;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (taken & 1u << i) continue;
    if (best < 0 || vs_point_distance(s->robot[i].at, to) < vs_point_distance(s->robot[best].at, to)) best = i;
  }
  return best;
}

static void choose_roles(inf_state *s) {
  static const vs_point own_goal = {38.0, INF_MIDDLE_Y_PX};
  unsigned cannot = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (!(inf_can_kick(s, i) && inf_ball_distance(s, i) < KICK_RANGE_PX)) cannot |= 1u << i;
  int attacker = nearest(s, s->ball, cannot);
  if (attacker < 0) attacker = nearest(s, s->ball, 0);
  int keeper = nearest(s, own_goal, 1u << attacker);
  s->role[INF_ATTACKER] = attacker;
  s->role[INF_KEEPER] = keeper;
  s->role[INF_MIDFIELDER] = VS_TEAM_SIZE - attacker - keeper;
}

// By who of ours is behind the ball; kept when nobody is.
static void choose_phase(inf_state *s) {
  double x = s->ball.x;
  bool far = x > INF_MIDDLE_X_PX;
  bool mid_behind = x > s->robot[s->role[INF_MIDFIELDER]].at.x;
  if (x > s->robot[s->role[INF_ATTACKER]].at.x - INF_ROBOT_PX && mid_behind)
    s->phase = far ? INF_ADVANCE : INF_PUSH;
  else if (mid_behind)
    s->phase = far ? INF_RECOVER : INF_PASS;
  else if (x > s->robot[s->role[INF_KEEPER]].at.x)
    s->phase = far ? INF_RETURN : INF_DANGER;
}

void inf_tick(inf_state *s, const inf_input *in, double command[VS_TEAM_SIZE][2]) {
  read_input(s, in);
  if (s->role_timer_s <= 0.0) {
    choose_roles(s);
    s->role_timer_s = ROLE_PERIOD_S;
  } else {
    s->role_timer_s -= in->dt_s;
  }
  choose_phase(s);
  inf_choose_tactics(s, in->dt_s);
  for (int i = 0; i < VS_TEAM_SIZE; i++) inf_act(s, i);
  for (int i = 0; i < VS_TEAM_SIZE; i++) inf_control(s, i, command[i]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) s->robot[i].before = s->robot[i].at;
}

static vs_status inf_player_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)seed; // nothing random in it
  static const vs_config_key no_options[] = {{0}};
  inf_init(state);
  return vs_player_options("inf:", options, no_options, err);
}

// Metres from the field's centre to pixels: the scale of the authors' own simulator.
static vs_point pixels(double x_m, double y_m) {
  return (vs_point){(x_m + 0.80838742) * (INF_WIDTH_PX / 1.61677484),
                    (y_m + 0.58339083) * (INF_HEIGHT_PX / 1.16678166)};
}

static void inf_player_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *wheels) {
  (void)game; // it knows no referee
  const double full_radps = 30.0;
  inf_input in = {.ball = pixels(world->ball.x_m, world->ball.y_m), .dt_s = dt_s};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_pose *pose = &world->robot[VS_OWN][i].pose;
    in.at[i] = pixels(pose->x_m, pose->y_m);
    in.o_rad[i] = -pose->theta_rad;
  }
  double command[VS_TEAM_SIZE][2];
  inf_tick(state, &in, command);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    wheels[i] = (vs_wheels){full_radps * command[i][0], full_radps * command[i][1]};
}

const vsss_player_api vs_player_inf = {
    .version = VSSS_PLAYER_VERSION,
    .name = "INF",
    .rate_hz = VS_CAMERA_HZ,
    .state_size = sizeof(inf_state),
    .init = inf_player_init,
    .step = inf_player_step,
};
