// One match, frame by frame: measure, decide, command, simulate, judge, place.
#include "vsss/env.h"

#include <stdlib.h>
#include <string.h>

#include "base/word.h"
#include "vsss/check.h"

#define FRAMES_PER_DECISION (VS_CAMERA_HZ / VS_DECISION_HZ)
#define FRAME_S             (1.0 / VS_CAMERA_HZ)

// Streams and parts of a match's seed, one for each thing that draws from it.
enum { SEED_SENSORS = 1, SEED_PLACEMENT, SEED_PLAYER, SEED_EPISODE = SEED_PLAYER + VS_TEAMS };

// All of a match that is plain data. Beside it stand the simulator's and the two controls' own states.
typedef struct match {
  uint64_t seed, hash;
  vs_referee referee;
  vs_sensors sensors;
  vs_rng placement;
  vs_world truth;    // now, after a placement
  vs_world judged;   // as the referee saw it, before a placement
  vs_world measured; // what both teams see now
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
  bool decided[VS_TEAMS];                                   // in the last frame
  double commanded[VS_TEAMS][VS_TEAM_SIZE][VS_ACTION_SIZE]; // summed over the frames of this decision
  int commanded_frames;
  int tick; // frames since the match began or play was restarted; a multiple of three is a decision
} match;

struct vs_env {
  vs_env_def def;
  vs_sim *sim;
  vs_control *control[VS_TEAMS];
  vs_control *next_control[VS_TEAMS];      // from vs_env_set_player, in force from the next reset on
  bool never[VS_TEAMS][VS_SENSOR_OBJECTS]; // what each team does not see in this match; follows from its seed
  match m;
};

vs_status vs_predicts_parse(const char *text, vs_predicts *out, vs_error *err) {
  static const char *const names[] = {"learned", "none", "all", NULL};
  int predicts;
  vs_status s = vs_word_parse("predicts", text, names, &predicts, err);
  if (s == VS_OK) *out = (vs_predicts)predicts;
  return s;
}

vs_env_def vs_env_def_default(const vs_model *model) {
  vs_env_def def = {.model = model,
                    .referee = vs_referee_def_default(VS_RULES_PAPER),
                    .realism = vs_realism_default(),
                    .shuffle_adversaries = false};
  return def;
}

static vs_status open_control(const char *uri, vs_division division, vs_control **out, vs_error *err) {
  vs_player *player = NULL;
  if (uri) {
    vs_status s = vs_player_open(uri, &player, err);
    if (s != VS_OK) return s;
  }
  vs_status s = vs_control_new(player, out, err);
  if (s != VS_OK) vs_player_close(player);
  if (s == VS_OK) s = vs_control_plays(*out, division, err);
  return s;
}

vs_status vs_env_new(const vs_env_def *def, vs_env **out, vs_error *err) {
  vs_env *env = calloc(1, sizeof *env);
  if (!env) return vs_fail(err, VS_FAIL, "out of memory for a match");
  env->def = *def;
  vs_status s = vs_referee_init(&env->m.referee, &def->referee, err);
  if (s == VS_OK) s = vs_sim_new(def->model, &env->sim, err);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++)
    s = open_control(def->player[t], vs_model_division(def->model), &env->control[t], err);
  if (s == VS_OK) s = vs_env_reset(env, 0, err);
  if (s != VS_OK) {
    vs_env_free(env);
    return s;
  }
  *out = env;
  return VS_OK;
}

void vs_env_free(vs_env *env) {
  if (!env) return;
  for (int t = 0; t < VS_TEAMS; t++) {
    if (env->control[t]) vs_control_free(env->control[t]);
    if (env->next_control[t]) vs_control_free(env->next_control[t]);
  }
  if (env->sim) vs_sim_free(env->sim);
  free(env);
}

static vs_status fail_in_match(const match *m, vs_error *err) {
  return vs_fail_prefix(err, "match with seed %llu at %.2f s", (unsigned long long)m->seed, m->referee.game.time_s);
}

static void draw_never(vs_env *env) {
  vs_sensors_never(&env->def.realism, vs_seed_mix(env->m.seed, SEED_SENSORS), env->never);
}

// What a team's camera tells it.
static vs_world view_of(const vs_env *env, int team) {
  vs_world view = env->m.measured;
  vs_sensors_hide(env->never[team], &view);
  return view;
}

static void measure(vs_env *env) {
  match *m = &env->m;
  vs_sensors_measure(&m->sensors, &m->truth, &m->measured);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_MOST; i++)
      if (vs_referee_off(&m->referee, (vs_team)t, i))
        m->measured.robot[t][i] = (vs_robot){.pose = vs_world_parked(m->truth.division, (vs_team)t, i)};
  if (m->tick % FRAMES_PER_DECISION != 0 && !m->referee.over) return;
  for (int t = 0; t < VS_TEAMS; t++)
    if (!vs_control_player(env->control[t])) {
      vs_world view = view_of(env, t);
      vs_control_observe(env->control[t], (vs_team)t, &view, &m->referee.game);
    }
}

// Puts the pieces where placed says; play goes on with a decision.
static void put(vs_env *env, const vs_world *placed) {
  match *m = &env->m;
  vs_sim_place(env->sim, placed);
  vs_sim_world(env->sim, &m->truth);
  vs_referee_restarted(&m->referee, &m->truth);
  vs_sensors_restart(&m->sensors);
  for (int t = 0; t < VS_TEAMS; t++) vs_control_restart(env->control[t]);
  memset(m->wheels, 0, sizeof m->wheels);
  m->tick = 0;
}

// Puts the pieces where the restart wants them.
static void place(vs_env *env, const vs_event *event) {
  match *m = &env->m;
  vs_world placed = m->truth;
  vs_place(m->referee.def.placement, event, &m->truth, &m->placement, &placed);
  vs_place_without(&m->referee, &placed);
  put(env, &placed);
}

// The episode's own rules and its first restart (kind NONE: open play).
static vs_event draw_episode(const vs_episode_def *def, uint64_t seed, vs_referee_def *referee) {
  vs_rng rng = vs_rng_make(seed, SEED_EPISODE);
  if (def->still_high_s > 0) referee->still_s = vs_rng_range(&rng, def->still_low_s, def->still_high_s);
  vs_event start = {.kind = VS_EVENT_KICK_OFF, .team = referee->kick_off};
  double at = vs_rng_uniform(&rng);
  vs_team either = vs_rng_below(&rng, VS_TEAMS) ? VS_YELLOW : VS_BLUE;
  int quadrant = 1 + (int)vs_rng_below(&rng, 4);
  if (def->either_kicks_off) start.team = referee->kick_off = either;
  if (at < def->open_play)
    start.kind = VS_EVENT_NONE;
  else if (at < def->open_play + def->penalty)
    start = (vs_event){.kind = VS_EVENT_PENALTY, .team = either};
  else if (at < def->open_play + def->penalty + def->free_ball)
    start = (vs_event){.kind = VS_EVENT_FREE_BALL, .quadrant = quadrant};
  return start;
}

static bool predicts(const vs_env *env, int team) {
  const vs_player *player = vs_control_player(env->control[team]);
  bool learned = !player || vs_player_kind(player) == VS_SEES_OBSERVATION;
  return env->def.predicts == VS_PREDICTS_ALL || (env->def.predicts == VS_PREDICTS_LEARNED && learned);
}

vs_status vs_env_reset(vs_env *env, uint64_t seed, vs_error *err) {
  match *m = &env->m;
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!env->next_control[t]) continue;
    vs_control_free(env->control[t]);
    env->control[t] = env->next_control[t];
    env->next_control[t] = NULL;
  }
  memset(m, 0, sizeof *m);
  m->seed = seed;
  m->hash = VS_HASH_START;
  m->placement = vs_rng_make(seed, SEED_PLACEMENT);
  vs_referee_def rules = env->def.referee;
  vs_event start = draw_episode(&env->def.episode, seed, &rules);
  vs_status s = vs_referee_init(&m->referee, &rules, err);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++)
    s = vs_control_reset(env->control[t], vs_seed_mix(seed, SEED_PLAYER + (uint64_t)t), env->def.shuffle_adversaries,
                         err);
  if (s != VS_OK) return fail_in_match(m, err);
  vs_sensors_reset(&m->sensors, &env->def.realism, vs_seed_mix(seed, SEED_SENSORS));
  draw_never(env);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++)
    s = vs_control_set_latency(env->control[t], predicts(env, t) ? m->sensors.latency_s : 0.0, err);
  if (s != VS_OK) return fail_in_match(m, err);
  vs_sim_reset(env->sim, &m->sensors.params);
  vs_sim_world(env->sim, &m->truth);
  if (start.kind == VS_EVENT_NONE) {
    vs_world open;
    vs_place_open_play(&m->truth, &m->placement, &open);
    put(env, &open);
  } else {
    place(env, &start);
  }
  m->judged = m->truth;
  measure(env);
  return VS_OK;
}

static vs_status decide(vs_env *env, vs_error *err) {
  match *m = &env->m;
  if (m->tick % FRAMES_PER_DECISION == 0) {
    memset(m->commanded, 0, sizeof m->commanded);
    m->commanded_frames = 0;
  }
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_world view = view_of(env, t);
    vs_status s = vs_control_step(env->control[t], (vs_team)t, &view, &m->referee.game, FRAME_S, m->wheels[t],
                                  &m->decided[t], err);
    if (s != VS_OK) {
      vs_fail_prefix(err, "%s", vs_team_name((vs_team)t));
      return fail_in_match(m, err);
    }
    const float *action = vs_control_action(env->control[t]);
    for (int k = 0; k < VS_TEAM_SIZE * VS_ACTION_SIZE; k++) (&m->commanded[t][0][0])[k] += action[k];
  }
  m->commanded_frames++;
  return VS_OK;
}

static bool wants_placement(vs_event_kind kind) {
  return kind == VS_EVENT_KICK_OFF || kind == VS_EVENT_GOAL || kind == VS_EVENT_PENALTY || kind == VS_EVENT_FREE_BALL ||
         kind == VS_EVENT_GOAL_KICK || kind == VS_EVENT_FREE_KICK || kind == VS_EVENT_HALF_TIME ||
         kind == VS_EVENT_EXTRA_TIME || kind == VS_EVENT_SHOOT_OUT;
}

// Robots that are off stand still beside the field, whatever their team commands.
static void send_off(vs_env *env, const vs_event *said) {
  match *m = &env->m;
  if (said->kind != VS_EVENT_SENT_OFF) return;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_MOST; i++)
      if (vs_referee_off(&m->referee, (vs_team)t, i)) vs_sim_put_beside(env->sim, (vs_team)t, i);
  vs_sim_world(env->sim, &m->truth);
}

vs_status vs_env_frame(vs_env *env, vs_event *event, vs_error *err) {
  match *m = &env->m;
  if (m->referee.over) return vs_fail(err, VS_USAGE, "the match is over; reset it first");
  vs_status s = decide(env, err);
  if (s != VS_OK) return s;

  vs_wheels arrived[VS_TEAMS][VS_TEAM_MOST];
  vs_sensors_command(&m->sensors, (const vs_wheels(*)[VS_TEAM_MOST])m->wheels, arrived);
  for (int t = 0; t < VS_TEAMS; t++)
    if (env->def.own_radio[t]) memcpy(arrived[t], m->wheels[t], sizeof arrived[t]);
  vs_referee_hold_off(&m->referee, arrived);
  s = vs_sim_frame(env->sim, (const vs_wheels(*)[VS_TEAM_MOST])arrived, err);
  if (s != VS_OK) return fail_in_match(m, err);
  vs_sim_world(env->sim, &m->truth);
  m->hash = vs_world_hash(m->hash, &m->truth);
  m->judged = m->truth;
  m->tick++;

  vs_event said = vs_referee_step(&m->referee, &m->truth, FRAME_S);
  if (!m->referee.over && wants_placement(said.kind)) place(env, &said);
  send_off(env, &said);
  measure(env);
  if (event) *event = said;
  return VS_OK;
}

static void reward(const vs_env *env, const vs_world *before, vs_env_result *result) {
  const match *m = &env->m;
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_world previous, view;
    vs_game game, said = {.last_event = result->event}, event;
    vs_world_for_team(before, (vs_team)t, &previous);
    vs_world_for_team(&m->judged, (vs_team)t, &view);
    vs_game_for_team(&m->referee.game, (vs_team)t, &game);
    vs_game_for_team(&said, (vs_team)t, &event);
    vs_reward_terms(&previous, &view, &event.last_event, &game, result->terms[t]);
  }
}

vs_status vs_env_step(vs_env *env, vs_env_result *result, vs_error *err) {
  match *m = &env->m;
  memset(result, 0, sizeof *result);
  vs_status plays = vs_division_wants_3v3(m->truth.division, "a step with rewards", err);
  if (plays != VS_OK) return plays;
  vs_world before = m->truth;
  do {
    vs_status s = vs_env_frame(env, &result->event, err);
    if (s != VS_OK) return s;
  } while (m->tick % FRAMES_PER_DECISION != 0 && !m->referee.over);
  result->over = m->referee.over;
  result->time_limit = result->over && result->event.kind == VS_EVENT_END;
  reward(env, &before, result);
  return VS_OK;
}

vs_status vs_env_set_action(vs_env *env, vs_team team, const float *action, vs_error *err) {
  vs_status s = vs_control_set_action(env->control[team], action, err);
  if (s == VS_OK) return s;
  vs_fail_prefix(err, "%s", vs_team_name(team));
  return fail_in_match(&env->m, err);
}

void vs_env_observation(const vs_env *env, vs_team team, float *out) {
  const match *m = &env->m;
  const vs_control *control = env->control[team];
  if (m->truth.division != VS_3V3) {
    memset(out, 0, VS_TEAM_SIZE * VS_OBS_SIZE * sizeof *out);
    return;
  }
  if (!vs_control_player(env->control[team])) {
    vs_observer_write(vs_control_observer(control), out);
    return;
  }
  // A player's control observes the present frame only when it is next stepped: show what it is about to see.
  vs_observer ahead;
  vs_world view = view_of(env, team);
  vs_control_peek(control, team, &view, &m->referee.game, &ahead);
  vs_observer_write(&ahead, out);
}

void vs_env_mean_action(const vs_env *env, vs_team team, float *out) {
  const match *m = &env->m;
  int frames = m->commanded_frames > 0 ? m->commanded_frames : 1;
  const double *sum = &m->commanded[team][0][0];
  for (int k = 0; k < VS_TEAM_SIZE * VS_ACTION_SIZE; k++) out[k] = (float)(sum[k] / frames);
}

void vs_env_set_episode(vs_env *env, const vs_episode_def *episode) { env->def.episode = *episode; }

vs_status vs_env_set_player(vs_env *env, vs_team team, const char *uri, vs_error *err) {
  vs_control *control = NULL;
  vs_status s = open_control(uri, vs_model_division(env->def.model), &control, err);
  if (s != VS_OK) {
    if (control) vs_control_free(control);
    return s;
  }
  if (env->next_control[team]) vs_control_free(env->next_control[team]);
  env->next_control[team] = control;
  return VS_OK;
}

bool vs_env_over(const vs_env *env) { return env->m.referee.over; }
void vs_env_truth(const vs_env *env, vs_world *out) { *out = env->m.truth; }
void vs_env_judged(const vs_env *env, vs_world *out) { *out = env->m.judged; }
void vs_env_measured(const vs_env *env, vs_world *out) { *out = env->m.measured; }
void vs_env_wheels(const vs_env *env, vs_wheels out[VS_TEAMS][VS_TEAM_MOST]) {
  memcpy(out, env->m.wheels, sizeof env->m.wheels);
}
bool vs_env_decided(const vs_env *env, vs_team team) { return env->m.decided[team]; }
const vs_referee *vs_env_referee(const vs_env *env) { return &env->m.referee; }
const vs_game *vs_env_game(const vs_env *env) { return &env->m.referee.game; }
vs_control *vs_env_control(vs_env *env, vs_team team) { return env->control[team]; }
vs_sim *vs_env_sim(vs_env *env) { return env->sim; }
uint64_t vs_env_hash(const vs_env *env) { return env->m.hash; }

// A snapshot: the plain data, then the simulator's, blue's and yellow's states, each on a 64 byte boundary.
static size_t aligned(size_t size) { return (size + 63) / 64 * 64; }

size_t vs_env_state_size(const vs_env *env) {
  size_t blue = vs_control_state_size(env->control[VS_BLUE]);
  size_t yellow = vs_control_state_size(env->control[VS_YELLOW]);
  if (blue == 0 || yellow == 0) return 0;
  return aligned(sizeof env->m) + aligned(vs_sim_state_size(env->sim)) + aligned(blue) + aligned(yellow);
}

void vs_env_save(const vs_env *env, void *state) {
  unsigned char *at = state;
  memcpy(at, &env->m, sizeof env->m);
  at += aligned(sizeof env->m);
  vs_sim_save(env->sim, at);
  at += aligned(vs_sim_state_size(env->sim));
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_control_save(env->control[t], at);
    at += aligned(vs_control_state_size(env->control[t]));
  }
}

static bool match_ok(const match *m, const vs_env_def *def) {
  vs_division division = vs_model_division(def->model);
  bool same = m->truth.division == division && m->judged.division == division && m->measured.division == division &&
              m->sensors.last.division == division;
  return same && vs_referee_ok(&m->referee, &def->referee) && vs_sensors_ok(&m->sensors) && vs_world_ok(&m->truth) &&
         vs_world_ok(&m->judged) && vs_world_ok(&m->measured) && vs_world_ok(&m->sensors.last) &&
         vs_all_finite(&m->wheels[0][0].left_radps, sizeof m->wheels / sizeof(double)) &&
         vs_are_bools(m->decided, VS_TEAMS) &&
         vs_all_finite(&m->commanded[0][0][0], sizeof m->commanded / sizeof(double)) && m->commanded_frames >= 0 &&
         m->commanded_frames <= FRAMES_PER_DECISION && m->tick >= 0 && m->tick < 1000000000;
}

vs_status vs_env_restore(vs_env *env, const void *state, vs_error *err) {
  const unsigned char *at = state;
  match read;
  memcpy(&read, at, sizeof read);
  if (!match_ok(&read, &env->def)) return vs_fail(err, VS_FAIL, "the snapshot of a match is damaged");
  at += aligned(sizeof env->m);
  vs_status s = vs_sim_restore(env->sim, at, err);
  at += aligned(vs_sim_state_size(env->sim));
  for (int t = 0; s == VS_OK && t < VS_TEAMS; t++) {
    s = vs_control_restore(env->control[t], at, err);
    at += aligned(vs_control_state_size(env->control[t]));
  }
  if (s != VS_OK) return s;
  env->m = read;
  draw_never(env);
  return VS_OK;
}
