#include "vsss/control.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "predict.h"
#include "vsss/check.h"
#include "vsss/geom.h"
#include "vsss/rng.h"

// Fires every period_s of the time it is told of, at the frame nearest to the tick.
typedef struct metronome {
  double period_s;
  double since_s; // since the last tick of the grid; a little below 0 when the frame came early
  bool fresh;     // the next frame fires
} metronome;

// Everything that changes, so that a snapshot is one copy.
typedef struct state {
  vs_observer observer;
  metronome decide, observe;
  double since_decision_s; // what the player is told as dt
  bool played;             // it has been called since the reset
  float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
  vs_wheels wheels[VS_TEAM_MOST];
  double latency_s;
  vs_predictor predictor; // of what comes of it; idle without latency
} state;

struct vs_control {
  vs_player *player; // owned; NULL: external team
  state now;
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE]; // scratch for the policy's input
};

static bool fires(metronome *m, double dt_s) {
  if (m->fresh) {
    m->fresh = false;
    m->since_s = 0;
    return true;
  }
  m->since_s += dt_s;
  if (m->since_s + 0.5 * dt_s < m->period_s) return false;
  m->since_s -= m->period_s;
  if (m->since_s > 0.5 * m->period_s) m->since_s = 0; // frames were lost: skip what was missed, no burst
  return true;
}

vs_status vs_control_new(vs_player *player, vs_control **out, vs_error *err) {
  double rate_hz = player ? vs_player_rate_hz(player) : VS_DECISION_HZ;
  double frames = rate_hz > 0 ? VS_CAMERA_HZ / rate_hz : 0;
  if (!(frames >= 1 && frames == floor(frames)))
    return vs_fail(err, VS_FAIL, "player %s: rate %g Hz; it must be %d Hz divided by 1, 2, 3 ...",
                   vs_player_uri(player), rate_hz, VS_CAMERA_HZ);
  vs_control *control = calloc(1, sizeof *control);
  if (!control) return vs_fail(err, VS_FAIL, "control: out of memory");
  control->player = player;
  control->now.decide.period_s = 1.0 / rate_hz;
  control->now.observe.period_s = 1.0 / VS_DECISION_HZ;
  vs_observer_init(&control->now.observer, NULL);
  vs_control_restart(control);
  *out = control;
  return VS_OK;
}

void vs_control_free(vs_control *control) {
  if (!control) return;
  vs_player_close(control->player);
  free(control);
}

vs_status vs_control_reset(vs_control *control, uint64_t seed, bool shuffle_adversaries, vs_error *err) {
  int order[VS_TEAM_SIZE] = {0, 1, 2};
  if (shuffle_adversaries) {
    vs_rng rng = vs_rng_make(seed, 0);
    vs_rng_shuffle(&rng, order, VS_TEAM_SIZE);
  }
  vs_observer_init(&control->now.observer, order);
  vs_control_restart(control);
  control->now.since_decision_s = 0;
  control->now.played = false;
  return control->player ? vs_player_reset(control->player, vs_seed_mix(seed, 1), err) : VS_OK;
}

void vs_control_restart(vs_control *control) {
  state *now = &control->now;
  vs_observer_restart(&now->observer);
  now->decide.fresh = now->observe.fresh = true;
  memset(now->action, 0, sizeof now->action);
  memset(now->wheels, 0, sizeof now->wheels);
  memset(&now->predictor, 0, sizeof now->predictor);
}

vs_status vs_control_set_latency(vs_control *control, double latency_s, vs_error *err) {
  if (!(latency_s >= 0 && latency_s <= VS_CONTROL_LATENCY_MAX_S))
    return vs_fail(err, VS_USAGE, "latency %g s: expected 0 to %g", latency_s, VS_CONTROL_LATENCY_MAX_S);
  control->now.latency_s = latency_s;
  return VS_OK;
}

// What the player is shown: the team's view of the world at the moment when its command will act.
static void move_on(vs_predictor *predictor, double latency_s, vs_team team, const vs_world *absolute, vs_world *out) {
  *out = *absolute;
  if (!(latency_s > 0)) return;
  vs_predictor_see(predictor, team, latency_s, absolute);
  vs_predictor_ahead(predictor, team, latency_s, out);
}

static void show(vs_predictor *predictor, double latency_s, vs_team team, const vs_world *absolute, const vs_game *game,
                 vs_world *view, vs_game *game_view) {
  vs_world ahead;
  move_on(predictor, latency_s, team, absolute, &ahead);
  vs_world_for_team(&ahead, team, view);
  vs_game_for_team(game, team, game_view);
}

void vs_control_ahead(const vs_control *control, vs_team team, const vs_world *absolute, vs_world *out) {
  vs_predictor predictor = control->now.predictor;
  move_on(&predictor, control->now.latency_s, team, absolute, out);
}

void vs_control_observe(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game) {
  state *now = &control->now;
  vs_world view;
  vs_game game_view;
  show(&now->predictor, now->latency_s, team, absolute, game, &view, &game_view);
  vs_observer_push(&now->observer, &view, &game_view, now->action);
}

void vs_control_peek(const vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game,
                     vs_observer *out) {
  const state *now = &control->now;
  vs_predictor predictor = now->predictor;
  vs_world view;
  vs_game game_view;
  show(&predictor, now->latency_s, team, absolute, game, &view, &game_view);
  *out = now->observer;
  vs_observer_push(out, &view, &game_view, now->action);
}

vs_status vs_control_plays(const vs_control *control, vs_division division, vs_error *err) {
  if (!control->player) return vs_division_wants_3v3(division, "a team that is commanded from outside", err);
  return vs_player_plays(control->player, division, err);
}

// A scripted team at its own rate. In 3 against 3 it is observed at the policy's rate all the same, so that it can be
// imitated.
static vs_status step_scripted(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game,
                               double dt_s, bool *decided, vs_error *err) {
  state *now = &control->now;
  bool threes = absolute->division == VS_3V3;
  if (threes && fires(&now->observe, dt_s)) vs_control_observe(control, team, absolute, game);
  *decided = fires(&now->decide, dt_s);
  if (!*decided) return VS_OK;
  vs_world view;
  vs_game game_view;
  show(&now->predictor, now->latency_s, team, absolute, game, &view, &game_view);
  double since_s = now->played ? now->since_decision_s : now->decide.period_s;
  vs_status status = vs_player_step(control->player, &view, &game_view, since_s, now->wheels, err);
  if (status == VS_OK && threes) vs_action_from_wheels(now->wheels, now->action);
  return status;
}

static vs_status step_learned(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game,
                              double dt_s, bool *decided, vs_error *err) {
  if (absolute->division != VS_3V3) return vs_player_plays(control->player, absolute->division, err);
  *decided = fires(&control->now.decide, dt_s);
  if (!*decided) return VS_OK;
  vs_control_observe(control, team, absolute, game);
  vs_observer_write(&control->now.observer, control->stack);
  float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
  vs_status status = vs_player_act(control->player, control->stack, VS_TEAM_SIZE, action, err);
  return status == VS_OK ? vs_control_set_action(control, action, err) : status;
}

vs_status vs_control_step(vs_control *control, vs_team team, const vs_world *absolute, const vs_game *game, double dt_s,
                          vs_wheels *out, bool *decided, vs_error *err) {
  state *now = &control->now;
  bool due = false;
  vs_status status = VS_OK;
  now->since_decision_s += dt_s;
  if (now->latency_s > 0) vs_predictor_see(&now->predictor, team, now->latency_s, absolute);
  if (control->player && vs_player_kind(control->player) == VS_SEES_WORLD)
    status = step_scripted(control, team, absolute, game, dt_s, &due, err);
  else if (control->player)
    status = step_learned(control, team, absolute, game, dt_s, &due, err);
  if (due) {
    now->played = true;
    now->since_decision_s = 0;
  }
  if (status != VS_OK) memset(now->wheels, 0, sizeof now->wheels);
  if (now->latency_s > 0) vs_predictor_command(&now->predictor, absolute->time_us, now->wheels);
  memcpy(out, now->wheels, sizeof *out * (size_t)vs_team_size(absolute));
  if (decided) *decided = due;
  return status;
}

vs_status vs_control_set_action(vs_control *control, const float *action, vs_error *err) {
  vs_wheels wheels[VS_TEAM_SIZE];
  vs_status status = vs_action_to_wheels(action, wheels, err);
  if (status != VS_OK) return status;
  memcpy(control->now.wheels, wheels, sizeof wheels);
  for (int i = 0; i < VS_TEAM_SIZE * VS_ACTION_SIZE; i++)
    control->now.action[i] = (float)vs_clamp((double)action[i], -1.0, 1.0);
  return VS_OK;
}

const vs_observer *vs_control_observer(const vs_control *control) { return &control->now.observer; }
const float *vs_control_action(const vs_control *control) { return control->now.action; }
vs_player *vs_control_player(vs_control *control) { return control->player; }

size_t vs_control_state_size(const vs_control *control) {
  if (!control->player) return sizeof(state);
  size_t player = vs_player_state_size(control->player);
  return player ? sizeof(state) + player : 0;
}

void vs_control_save(const vs_control *control, void *out) {
  memcpy(out, &control->now, sizeof control->now);
  if (control->player) vs_player_save(control->player, (char *)out + sizeof(state));
}

static bool metronome_ok(const metronome *m, const metronome *mine) {
  return m->period_s == mine->period_s && vs_all_finite(&m->since_s, 1) && vs_are_bools(&m->fresh, 1);
}

static bool predictor_ok(const vs_predictor *p) {
  return p->commands.count >= 0 && p->commands.count <= VS_COMMANDS_KEPT && vs_are_bools(&p->started, 1) &&
         vs_all_finite(&p->commands.wheels[0][0].left_radps, sizeof p->commands.wheels / sizeof(double)) &&
         vs_world_ok(&p->now);
}

// mine: of the same player.
static bool state_ok(const state *s, const state *mine) {
  const vs_observer *o = &s->observer;
  return o->newest >= 0 && o->newest < VS_OBS_STACK && (o->filled == 0 || o->filled == VS_OBS_STACK) &&
         vs_is_permutation(o->adversary_order, VS_TEAM_SIZE) &&
         vs_all_finite_floats(&o->frame[0][0][0], sizeof o->frame / sizeof(float)) &&
         metronome_ok(&s->decide, &mine->decide) && metronome_ok(&s->observe, &mine->observe) &&
         vs_all_finite(&s->since_decision_s, 1) && vs_are_bools(&s->played, 1) &&
         vs_all_finite_floats(s->action, VS_TEAM_SIZE * VS_ACTION_SIZE) &&
         vs_all_finite(&s->wheels[0].left_radps, 2 * VS_TEAM_MOST) && s->latency_s >= 0 &&
         s->latency_s <= VS_CONTROL_LATENCY_MAX_S && predictor_ok(&s->predictor);
}

vs_status vs_control_restore(vs_control *control, const void *in, vs_error *err) {
  state read;
  memcpy(&read, in, sizeof read);
  if (!state_ok(&read, &control->now)) return vs_fail(err, VS_FAIL, "the snapshot of a team is damaged");
  if (control->player) {
    vs_status status = vs_player_restore(control->player, (const char *)in + sizeof(state), err);
    if (status != VS_OK) return status;
  }
  control->now = read;
  return VS_OK;
}
