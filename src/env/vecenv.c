// Many matches over threads. A match touches only its own state and its own rows, so the order in which matches are taken
// does not matter.
#include "vsss/vecenv.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/pool.h"

typedef vs_status (*job_fn)(vs_vecenv *vec, int index, vs_error *err);

struct vs_vecenv {
  int envs;
  vs_vecenv_teams teams;
  bool stay_over;
  vs_env **env;
  uint64_t *match_seed, *episode;                         // of each match; the number of the next episode
  bool (*external)[VS_TEAMS], (*next_external)[VS_TEAMS]; // now, from the next episode on
  vs_pool *pool;

  job_fn job;
  const vs_vecenv_buffers *buffers;
  const uint8_t *start; // vs_vecenv_start's
  pthread_mutex_t lock;
  int failed;     // lowest match that failed in this round, or envs
  vs_error error; // of that match
};

static void note_failure(vs_vecenv *vec, int index, const vs_error *error) {
  pthread_mutex_lock(&vec->lock);
  if (index < vec->failed) {
    vec->failed = index;
    vec->error = *error;
  }
  pthread_mutex_unlock(&vec->lock);
}

static void do_match(void *context, int index, int thread) {
  (void)thread;
  vs_vecenv *vec = context;
  vs_error error = {0};
  if (vec->job(vec, index, &error) != VS_OK) note_failure(vec, index, &error);
}

static vs_status run(vs_vecenv *vec, job_fn job, const vs_vecenv_buffers *buffers, vs_error *err) {
  vec->job = job;
  vec->buffers = buffers;
  vec->failed = vec->envs;
  vs_pool_run(vec->pool, vec->envs, do_match, vec);
  if (vec->failed == vec->envs) return VS_OK;
  return vs_fail(err, vec->error.status, "%s", vec->error.text);
}

static int rows_per_match(const vs_vecenv *vec) {
  return vec->teams == VS_ROWS_BOTH ? VS_TEAMS * VS_TEAM_SIZE : VS_TEAM_SIZE;
}

static bool has_rows(vs_vecenv_teams teams, int team) {
  return teams == VS_ROWS_BOTH || teams == (team == VS_BLUE ? VS_ROWS_BLUE : VS_ROWS_YELLOW);
}

// The first row of a team of a match; false: the team has none.
static bool first_row(const vs_vecenv *vec, int index, int team, size_t *row) {
  *row = (size_t)index * (size_t)rows_per_match(vec);
  if (vec->teams == VS_ROWS_BOTH) *row += (size_t)team * VS_TEAM_SIZE;
  return has_rows(vec->teams, team);
}

static void write_observation(const vs_vecenv *vec, int index, float *observation) {
  size_t row;
  for (int t = 0; t < VS_TEAMS; t++)
    if (first_row(vec, index, t, &row))
      vs_env_observation(vec->env[index], (vs_team)t, observation + row * VS_OBS_SIZE);
}

static vs_status begin(vs_vecenv *vec, int index, uint64_t seed, vs_error *err) {
  memcpy(vec->external[index], vec->next_external[index], sizeof vec->external[index]);
  vs_status s = vs_env_reset(vec->env[index], seed, err);
  if (s == VS_OK) write_observation(vec, index, vec->buffers->observation);
  return s;
}

static vs_status start_episode(vs_vecenv *vec, int index, vs_error *err) {
  return begin(vec, index, vs_seed_mix(vec->match_seed[index], vec->episode[index]++), err);
}

static vs_status reset_one(vs_vecenv *vec, int index, vs_error *err) {
  vec->episode[index] = 0;
  return start_episode(vec, index, err);
}

static vs_status start_one(vs_vecenv *vec, int index, vs_error *err) {
  return vec->start && !vec->start[index] ? VS_OK : start_episode(vec, index, err);
}

static vs_status end_episode(vs_vecenv *vec, int index, vs_error *err) {
  const vs_vecenv_buffers *b = vec->buffers;
  const vs_game *game = vs_env_game(vec->env[index]);
  for (int t = 0; t < VS_TEAMS; t++) b->score[index * VS_TEAMS + t] = game->score[t];
  b->episode_s[index] = (float)game->time_s;
  if (b->final_observation) write_observation(vec, index, b->final_observation);
  if (!vec->stay_over) return start_episode(vec, index, err);
  write_observation(vec, index, b->observation);
  return VS_OK;
}

static vs_status act(vs_vecenv *vec, int index, vs_error *err) {
  size_t row;
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!vec->external[index][t] || !first_row(vec, index, t, &row)) continue;
    vs_status s = vs_env_set_action(vec->env[index], (vs_team)t, vec->buffers->action + row * VS_ACTION_SIZE, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

static void write_result(vs_vecenv *vec, int index, const vs_env_result *result) {
  const vs_vecenv_buffers *b = vec->buffers;
  size_t row;
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!first_row(vec, index, t, &row)) continue;
    memcpy(b->reward_terms + row * VS_REWARD_TERMS, result->terms[t], sizeof result->terms[t]);
    if (!vec->external[index][t]) vs_env_mean_action(vec->env[index], (vs_team)t, b->action + row * VS_ACTION_SIZE);
  }
  b->done[index] = result->over;
  b->time_limit[index] = result->time_limit;
  if (!b->event) return;
  b->event[index * 2] = (int32_t)result->event.kind;
  b->event[index * 2 + 1] = result->event.kind == VS_EVENT_NONE ? -1 : (int32_t)result->event.team;
}

// A match that is over and waits for vs_vecenv_start.
static vs_status rest(vs_vecenv *vec, int index) {
  const vs_vecenv_buffers *b = vec->buffers;
  size_t values = (size_t)rows_per_match(vec) * VS_REWARD_TERMS;
  memset(b->reward_terms + (size_t)index * values, 0, values * sizeof *b->reward_terms);
  b->done[index] = true;
  if (b->event) {
    b->event[index * 2] = VS_EVENT_NONE;
    b->event[index * 2 + 1] = -1;
  }
  return VS_OK;
}

static vs_status step_one(vs_vecenv *vec, int index, vs_error *err) {
  if (vec->stay_over && vs_env_over(vec->env[index])) return rest(vec, index);
  vs_status s = act(vec, index, err);
  if (s != VS_OK) return s;
  vs_env_result result;
  s = vs_env_step(vec->env[index], &result, err);
  if (s != VS_OK) return s;
  write_result(vec, index, &result);
  if (result.over) return end_episode(vec, index, err);
  write_observation(vec, index, vec->buffers->observation);
  return VS_OK;
}

int vs_vecenv_rows(const vs_vecenv *vec) { return vec->envs * rows_per_match(vec); }

vs_env *vs_vecenv_env(vs_vecenv *vec, int env) { return env >= 0 && env < vec->envs ? vec->env[env] : NULL; }

void vs_vecenv_seed(vs_vecenv *vec, uint64_t seed) {
  for (int i = 0; i < vec->envs; i++) {
    vec->match_seed[i] = vs_seed_mix(seed, (uint64_t)i);
    vec->episode[i] = 0;
  }
}

static vs_status no_match(const vs_vecenv *vec, int env, vs_error *err) {
  return vs_fail(err, VS_USAGE, "match %d: there are %d", env, vec->envs);
}

vs_status vs_vecenv_seed_match(vs_vecenv *vec, int env, uint64_t match_seed, vs_error *err) {
  if (env < 0 || env >= vec->envs) return no_match(vec, env, err);
  vec->match_seed[env] = match_seed;
  vec->episode[env] = 0;
  return VS_OK;
}

vs_status vs_vecenv_start(vs_vecenv *vec, const uint8_t *start, const vs_vecenv_buffers *buffers, vs_error *err) {
  vec->start = start;
  return run(vec, start_one, buffers, err);
}

vs_status vs_vecenv_start_from(vs_vecenv *vec, int env, uint64_t seed, const vs_vecenv_buffers *buffers,
                               vs_error *err) {
  if (env < 0 || env >= vec->envs) return no_match(vec, env, err);
  vec->buffers = buffers;
  return begin(vec, env, seed, err);
}

vs_status vs_vecenv_reset(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err) {
  return run(vec, reset_one, buffers, err);
}

vs_status vs_vecenv_step(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err) {
  return run(vec, step_one, buffers, err);
}

static vs_status open_matches(vs_vecenv *vec, const vs_vecenv_def *def, vs_error *err) {
  vec->env = calloc((size_t)def->envs, sizeof *vec->env);
  vec->match_seed = calloc((size_t)def->envs, sizeof *vec->match_seed);
  vec->episode = calloc((size_t)def->envs, sizeof *vec->episode);
  vec->external = calloc((size_t)def->envs, sizeof *vec->external);
  vec->next_external = calloc((size_t)def->envs, sizeof *vec->next_external);
  if (!vec->env || !vec->match_seed || !vec->episode || !vec->external || !vec->next_external)
    return vs_fail(err, VS_FAIL, "out of memory for %d matches", def->envs);
  for (int i = 0; i < def->envs; i++) {
    vs_status s = vs_env_new(&def->env, &vec->env[i], err);
    if (s != VS_OK) return s;
    for (int t = 0; t < VS_TEAMS; t++) vec->external[i][t] = vec->next_external[i][t] = !def->env.player[t];
  }
  return VS_OK;
}

vs_status vs_vecenv_new(const vs_vecenv_def *def, vs_vecenv **out, vs_error *err) {
  if (def->envs < 1) return vs_fail(err, VS_USAGE, "envs %d: at least 1", def->envs);
  if (def->threads < 1) return vs_fail(err, VS_USAGE, "threads %d: at least 1", def->threads);
  for (int t = 0; t < VS_TEAMS; t++)
    if (!has_rows(def->teams, t) && !def->env.player[t])
      return vs_fail(err, VS_USAGE, "%s has no rows and no player: give it one", vs_team_name((vs_team)t));
  vs_vecenv *vec = calloc(1, sizeof *vec);
  if (!vec) return vs_fail(err, VS_FAIL, "out of memory for %d matches", def->envs);
  vec->envs = def->envs;
  vec->teams = def->teams;
  vec->stay_over = def->stay_over;
  pthread_mutex_init(&vec->lock, NULL);
  vs_status s = open_matches(vec, def, err);
  if (s == VS_OK) vs_vecenv_seed(vec, def->seed);
  if (s == VS_OK) s = vs_pool_new(def->threads, &vec->pool, err);
  if (s != VS_OK) {
    vs_vecenv_free(vec);
    return s;
  }
  *out = vec;
  return VS_OK;
}

void vs_vecenv_free(vs_vecenv *vec) {
  if (!vec) return;
  vs_pool_free(vec->pool);
  for (int i = 0; vec->env && i < vec->envs; i++) vs_env_free(vec->env[i]);
  pthread_mutex_destroy(&vec->lock);
  free(vec->env);
  free(vec->match_seed);
  free(vec->episode);
  free(vec->external);
  free(vec->next_external);
  free(vec);
}

vs_status vs_vecenv_set_player(vs_vecenv *vec, int env, vs_team team, const char *uri, vs_error *err) {
  if (env < 0 || env >= vec->envs) return no_match(vec, env, err);
  if (!uri && !has_rows(vec->teams, team))
    return vs_fail(err, VS_USAGE, "%s has no rows: give it a player", vs_team_name(team));
  vs_status s = vs_env_set_player(vec->env[env], team, uri, err);
  if (s == VS_OK) vec->next_external[env][team] = !uri;
  return s;
}

uint64_t vs_vecenv_hash(const vs_vecenv *vec) {
  uint64_t hash = VS_HASH_START;
  for (int i = 0; i < vec->envs; i++) {
    uint64_t one = vs_env_hash(vec->env[i]);
    hash = vs_hash_bytes(hash, &one, sizeof one);
    hash = vs_hash_bytes(hash, &vec->episode[i], sizeof vec->episode[i]);
  }
  return hash;
}

// A snapshot: the matches' seeds and episode numbers, padded to 64 bytes, then each match.
static size_t numbers_size(const vs_vecenv *vec) { return (2 * (size_t)vec->envs * sizeof(uint64_t) + 63) / 64 * 64; }

size_t vs_vecenv_state_size(const vs_vecenv *vec) {
  size_t total = numbers_size(vec);
  for (int i = 0; i < vec->envs; i++) {
    size_t size = vs_env_state_size(vec->env[i]);
    if (size == 0) return 0;
    total += size;
  }
  return total;
}

void vs_vecenv_save(const vs_vecenv *vec, void *state) {
  unsigned char *at = state;
  size_t size = (size_t)vec->envs * sizeof(uint64_t);
  memcpy(at, vec->match_seed, size);
  memcpy(at + size, vec->episode, size);
  at += numbers_size(vec);
  for (int i = 0; i < vec->envs; at += vs_env_state_size(vec->env[i]), i++) vs_env_save(vec->env[i], at);
}

vs_status vs_vecenv_restore(vs_vecenv *vec, const void *state, vs_error *err) {
  const unsigned char *at = state;
  size_t size = (size_t)vec->envs * sizeof(uint64_t);
  memcpy(vec->match_seed, at, size);
  memcpy(vec->episode, at + size, size);
  at += numbers_size(vec);
  for (int i = 0; i < vec->envs; at += vs_env_state_size(vec->env[i]), i++)
    if (vs_env_restore(vec->env[i], at, err) != VS_OK) return vs_fail_prefix(err, "match %d", i);
  return VS_OK;
}
