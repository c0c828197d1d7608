// Many matches for a binding: a vs_vecenv, its model, its rewards' weights and the caller's arrays.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "capi_internal.h"

typedef struct array_set {
  vs_vecenv_buffers io;
  float *reward;
  uint8_t *terminated, *truncated;
} array_set;

struct vs_capi_vec {
  capi_guard guard;
  capi_settings settings;
  vs_model *model;
  vs_vecenv *vec;
  vs_vecenv_def def;
  vs_reward_weights weights;
  int rows;
  array_set set[VS_CAPI_SETS];
};

enum { ARRAYS = 11 };

static void arrays_of(vs_capi_vec *v, int set, capi_array out[ARRAYS]) {
  array_set *a = &v->set[set];
  size_t rows = (size_t)v->rows, envs = (size_t)v->def.envs;
  const capi_array list[ARRAYS] = {
      {"observation", (void **)&a->io.observation, rows * VS_OBS_SIZE * sizeof(float)},
      {"final_observation", (void **)&a->io.final_observation, rows * VS_OBS_SIZE * sizeof(float)},
      {"action", (void **)&a->io.action, rows * VS_ACTION_SIZE * sizeof(float)},
      {"reward", (void **)&a->reward, rows * sizeof(float)},
      {"reward_terms", (void **)&a->io.reward_terms, rows * VS_REWARD_TERMS * sizeof(double)},
      {"terminated", (void **)&a->terminated, rows},
      {"truncated", (void **)&a->truncated, rows},
      {"done", (void **)&a->io.done, envs},
      {"score", (void **)&a->io.score, envs * VS_TEAMS * sizeof(int32_t)},
      {"episode_s", (void **)&a->io.episode_s, envs * sizeof(float)},
      {"event", (void **)&a->io.event, envs * 2 * sizeof(int32_t)},
  };
  memcpy(out, list, sizeof list);
}

static void free_vec(vs_capi_vec *v) {
  if (!v) return;
  vs_vecenv_free(v->vec);
  if (v->model) vs_model_free(v->model);
  for (int i = 0; i < VS_CAPI_SETS; i++) free(v->set[i].io.time_limit);
  free(v);
}

int vs_capi_vec_new(const char *const *settings, vs_capi_vec **out, char *error, size_t error_size) {
  vs_error err = {0};
  vs_capi_vec *v = calloc(1, sizeof *v);
  if (!v) return vs_capi_told(vs_fail(&err, VS_FAIL, "out of memory"), &err, error, error_size);
  vs_capi_guard_init(&v->guard);
  vs_status s = vs_capi_settings_read(settings, &v->settings, &err);
  if (s == VS_OK) s = vs_capi_settings_open(&v->settings, &v->def, &v->model, &v->weights, &err);
  if (s == VS_OK) s = vs_vecenv_new(&v->def, &v->vec, &err);
  for (int i = 0; s == VS_OK && i < VS_CAPI_SETS; i++) {
    v->set[i].io.time_limit = calloc((size_t)v->def.envs, 1);
    if (!v->set[i].io.time_limit) s = vs_fail(&err, VS_FAIL, "out of memory");
  }
  if (s != VS_OK) {
    free_vec(v);
    return vs_capi_told(s, &err, error, error_size);
  }
  v->rows = vs_vecenv_rows(v->vec);
  *out = v;
  return vs_capi_told(VS_OK, &err, error, error_size);
}

// In a fork the threads to be joined are not there: what they share is left to the end of the process.
int vs_capi_vec_free(vs_capi_vec *v, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = v ? vs_capi_enter(&v->guard, &err) : VS_OK;
  if (s == VS_OK) free_vec(v);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vec_envs(const vs_capi_vec *v) { return v->def.envs; }
int vs_capi_vec_rows(const vs_capi_vec *v) { return v->rows; }

int vs_capi_vec_duration(const vs_capi_vec *v, double *duration_s) {
  *duration_s = v->def.env.referee.duration_s;
  return VS_OK;
}

static vs_status check_set(int set, vs_error *err) {
  if (set >= 0 && set < VS_CAPI_SETS) return VS_OK;
  return vs_fail(err, VS_USAGE, "set %d: there are %d", set, VS_CAPI_SETS);
}

static vs_status check_env(const vs_capi_vec *v, int env, vs_error *err) {
  if (env >= 0 && env < v->def.envs) return VS_OK;
  return vs_fail(err, VS_USAGE, "match %d: there are %d", env, v->def.envs);
}

static vs_status check_bound(vs_capi_vec *v, int set, vs_error *err) {
  vs_status s = check_set(set, err);
  if (s != VS_OK) return s;
  capi_array arrays[ARRAYS];
  arrays_of(v, set, arrays);
  return vs_capi_all_bound(arrays, ARRAYS, err);
}

int vs_capi_vec_bind(vs_capi_vec *v, int set, const char *name, void *data, size_t bytes, char *error,
                     size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = check_set(set, &err);
  if (s == VS_OK) {
    capi_array arrays[ARRAYS];
    arrays_of(v, set, arrays);
    s = vs_capi_bind_array(arrays, ARRAYS, name, data, bytes, &err);
  }
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

static vs_status reset(vs_capi_vec *v, int set, const uint64_t *seed, int seeds, const uint8_t *start, vs_error *err) {
  vs_status s = check_bound(v, set, err);
  if (s == VS_OK && seed && seeds != 1 && seeds != v->def.envs)
    s = vs_fail(err, VS_USAGE, "%d seeds: give one, or one for each of the %d matches", seeds, v->def.envs);
  if (s != VS_OK) return s;
  for (int i = 0; seed && i < v->def.envs && s == VS_OK; i++) {
    if (start && !start[i]) continue;
    uint64_t of_match = seeds == v->def.envs && seeds > 1 ? seed[i] : vs_seed_mix(seed[0], (uint64_t)i);
    s = vs_vecenv_seed_match(v->vec, i, of_match, err);
  }
  if (s == VS_OK) s = vs_vecenv_start(v->vec, start, &v->set[set].io, err);
  return s;
}

int vs_capi_vec_reset(vs_capi_vec *v, int set, const uint64_t *seed, int seeds, const uint8_t *start, char *error,
                      size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = reset(v, set, seed, seeds, start, &err);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vec_start(vs_capi_vec *v, int set, int env, uint64_t seed, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = check_bound(v, set, &err);
  if (s == VS_OK) s = vs_vecenv_start_from(v->vec, env, seed, &v->set[set].io, &err);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

// Before any match has moved.
static vs_status check_actions(const vs_capi_vec *v, const float *action, vs_error *err) {
  for (int i = 0; i < v->rows * VS_ACTION_SIZE; i++)
    if (!isfinite(action[i]))
      return vs_fail(err, VS_USAGE, "action of row %d, wheel %d, is %g: give numbers in [-1, 1]", i / VS_ACTION_SIZE,
                     i % VS_ACTION_SIZE, (double)action[i]);
  return VS_OK;
}

static void write_rewards(const vs_capi_vec *v, array_set *a) {
  int per_match = v->rows / v->def.envs;
  for (int row = 0; row < v->rows; row += VS_TEAM_SIZE)
    vs_reward_sum((const double(*)[VS_REWARD_TERMS])(a->io.reward_terms + (size_t)row * VS_REWARD_TERMS), &v->weights,
                  a->reward + row);
  for (int env = 0; env < v->def.envs; env++) {
    size_t first = (size_t)(env * per_match);
    bool done = a->io.done[env], by_clock = done && a->io.time_limit[env];
    memset(a->terminated + first, done && !by_clock, (size_t)per_match);
    memset(a->truncated + first, by_clock, (size_t)per_match);
  }
}

int vs_capi_vec_step(vs_capi_vec *v, int set, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = check_bound(v, set, &err);
  if (s == VS_OK) s = check_actions(v, v->set[set].io.action, &err);
  if (s == VS_OK) s = vs_vecenv_step(v->vec, &v->set[set].io, &err);
  if (s == VS_OK) write_rewards(v, &v->set[set]);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vec_player(vs_capi_vec *v, int env, int team, const char *uri, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  if (team != VS_BLUE && team != VS_YELLOW) s = vs_fail(&err, VS_USAGE, "team %d: 0 is blue, 1 yellow", team);
  if (s == VS_OK) s = vs_vecenv_set_player(v->vec, env, (vs_team)team, uri[0] ? uri : NULL, &err);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vec_hash(vs_capi_vec *v, uint64_t *hash, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  *hash = vs_vecenv_hash(v->vec);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

static uint64_t settings_hash(const void *v) { return vs_capi_settings_hash(&((const vs_capi_vec *)v)->settings); }
static size_t state_size(const void *v) { return vs_vecenv_state_size(((const vs_capi_vec *)v)->vec); }
static void save(const void *v, void *state) { vs_vecenv_save(((const vs_capi_vec *)v)->vec, state); }
static vs_status restore(void *v, const void *state, vs_error *err) {
  return vs_vecenv_restore(((vs_capi_vec *)v)->vec, state, err);
}
static capi_subject subject(vs_capi_vec *v) {
  static const capi_snapshot_kind kind = {settings_hash, state_size, save, restore};
  return (capi_subject){&kind, v, &v->guard};
}

int vs_capi_vec_state_size(vs_capi_vec *v, size_t *size, char *error, size_t error_size) {
  return vs_capi_snapshot_size(subject(v), size, error, error_size);
}

int vs_capi_vec_save(vs_capi_vec *v, void *state, size_t size, char *error, size_t error_size) {
  return vs_capi_snapshot_copy(subject(v), NULL, state, size, error, error_size);
}

int vs_capi_vec_restore(vs_capi_vec *v, const void *state, size_t size, char *error, size_t error_size) {
  return vs_capi_snapshot_copy(subject(v), state, NULL, size, error, error_size);
}

int vs_capi_vec_world(vs_capi_vec *v, int env, int team, int measured, double *out, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = check_env(v, env, &err);
  if (s == VS_OK && (team < -1 || team >= VS_TEAMS))
    s = vs_fail(&err, VS_USAGE, "team %d: -1 absolute, 0 blue, 1 yellow", team);
  if (s == VS_OK) {
    const vs_env *match = vs_vecenv_env(v->vec, env);
    vs_world world;
    vs_game game = *vs_env_game(match);
    if (measured)
      vs_env_measured(match, &world);
    else
      vs_env_truth(match, &world);
    if (team == VS_YELLOW) {
      vs_world absolute = world;
      vs_game as_played = game;
      vs_world_for_team(&absolute, VS_YELLOW, &world);
      vs_game_for_team(&as_played, VS_YELLOW, &game);
    }
    vs_capi_write_world(&world, &game, out);
  }
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

vs_status vs_capi_vec_picture(vs_capi_vec *v, int env, vs_world *world, vs_game *game, vs_error *err) {
  vs_status s = vs_capi_enter(&v->guard, err);
  if (s != VS_OK) return s;
  s = check_env(v, env, err);
  if (s == VS_OK) {
    vs_env_truth(vs_vecenv_env(v->vec, env), world);
    *game = *vs_env_game(vs_vecenv_env(v->vec, env));
  }
  vs_capi_leave(&v->guard);
  return s;
}
