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
  uint64_t seed;
  vs_env **env;
  uint64_t *episode;                                      // of each match
  bool (*external)[VS_TEAMS], (*next_external)[VS_TEAMS]; // now, from the next episode on
  vs_pool *pool;

  job_fn job;
  const vs_vecenv_buffers *buffers;
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

static size_t first_row(int index) { return (size_t)index * VS_TEAMS * VS_TEAM_SIZE; }

static void write_observation(const vs_vecenv *vec, int index, float *observation) {
  for (int t = 0; t < VS_TEAMS; t++)
    vs_env_observation(vec->env[index], (vs_team)t,
                       observation + (first_row(index) + (size_t)t * VS_TEAM_SIZE) * VS_OBS_SIZE);
}

static vs_status start_episode(vs_vecenv *vec, int index, vs_error *err) {
  uint64_t seed = vs_seed_mix(vs_seed_mix(vec->seed, (uint64_t)index), vec->episode[index]);
  vec->episode[index]++;
  memcpy(vec->external[index], vec->next_external[index], sizeof vec->external[index]);
  vs_status s = vs_env_reset(vec->env[index], seed, err);
  if (s == VS_OK) write_observation(vec, index, vec->buffers->observation);
  return s;
}

static vs_status reset_one(vs_vecenv *vec, int index, vs_error *err) {
  vec->episode[index] = 0;
  return start_episode(vec, index, err);
}

static vs_status end_episode(vs_vecenv *vec, int index, const vs_env_result *result, vs_error *err) {
  const vs_vecenv_buffers *b = vec->buffers;
  const vs_game *game = vs_env_game(vec->env[index]);
  for (int t = 0; t < VS_TEAMS; t++) b->score[index * VS_TEAMS + t] = game->score[t];
  b->episode_s[index] = (float)game->time_s;
  if (result->time_limit && b->final_observation) write_observation(vec, index, b->final_observation);
  return start_episode(vec, index, err);
}

static vs_status step_one(vs_vecenv *vec, int index, vs_error *err) {
  const vs_vecenv_buffers *b = vec->buffers;
  vs_env *env = vec->env[index];
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!vec->external[index][t]) continue;
    const float *action = b->action + (first_row(index) + (size_t)t * VS_TEAM_SIZE) * VS_ACTION_SIZE;
    vs_status s = vs_env_set_action(env, (vs_team)t, action, err);
    if (s != VS_OK) return s;
  }
  vs_env_result result;
  vs_status s = vs_env_step(env, &result, err);
  if (s != VS_OK) return s;

  const double *term = &result.terms[0][0][0];
  float *row = b->reward_terms + first_row(index) * VS_REWARD_TERMS;
  for (int k = 0; k < VS_TEAMS * VS_TEAM_SIZE * VS_REWARD_TERMS; k++) row[k] = (float)term[k];
  for (int t = 0; t < VS_TEAMS; t++)
    if (!vec->external[index][t])
      vs_env_mean_action(env, (vs_team)t, b->action + (first_row(index) + (size_t)t * VS_TEAM_SIZE) * VS_ACTION_SIZE);
  b->done[index] = result.over;
  b->time_limit[index] = result.time_limit;
  if (result.over) return end_episode(vec, index, &result, err);
  write_observation(vec, index, b->observation);
  return VS_OK;
}

vs_status vs_vecenv_reset(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err) {
  return run(vec, reset_one, buffers, err);
}

vs_status vs_vecenv_step(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err) {
  return run(vec, step_one, buffers, err);
}

static vs_status open_matches(vs_vecenv *vec, const vs_vecenv_def *def, vs_error *err) {
  vec->env = calloc((size_t)def->envs, sizeof *vec->env);
  vec->episode = calloc((size_t)def->envs, sizeof *vec->episode);
  vec->external = calloc((size_t)def->envs, sizeof *vec->external);
  vec->next_external = calloc((size_t)def->envs, sizeof *vec->next_external);
  if (!vec->env || !vec->episode || !vec->external || !vec->next_external)
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
  vs_vecenv *vec = calloc(1, sizeof *vec);
  if (!vec) return vs_fail(err, VS_FAIL, "out of memory for %d matches", def->envs);
  vec->seed = def->seed;
  vec->envs = def->envs;
  pthread_mutex_init(&vec->lock, NULL);
  vs_status s = open_matches(vec, def, err);
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
  free(vec->episode);
  free(vec->external);
  free(vec->next_external);
  free(vec);
}

vs_status vs_vecenv_set_player(vs_vecenv *vec, int env, vs_team team, const char *uri, vs_error *err) {
  if (env < 0 || env >= vec->envs) return vs_fail(err, VS_USAGE, "match %d: there are %d", env, vec->envs);
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

// A snapshot: the episode numbers, padded to 64 bytes, then each match.
static size_t episodes_size(const vs_vecenv *vec) { return ((size_t)vec->envs * sizeof *vec->episode + 63) / 64 * 64; }

size_t vs_vecenv_state_size(const vs_vecenv *vec) {
  size_t total = episodes_size(vec);
  for (int i = 0; i < vec->envs; i++) {
    size_t size = vs_env_state_size(vec->env[i]);
    if (size == 0) return 0;
    total += size;
  }
  return total;
}

void vs_vecenv_save(const vs_vecenv *vec, void *state) {
  unsigned char *at = state;
  memcpy(at, vec->episode, (size_t)vec->envs * sizeof *vec->episode);
  at += episodes_size(vec);
  for (int i = 0; i < vec->envs; at += vs_env_state_size(vec->env[i]), i++) vs_env_save(vec->env[i], at);
}

void vs_vecenv_restore(vs_vecenv *vec, const void *state) {
  const unsigned char *at = state;
  memcpy(vec->episode, at, (size_t)vec->envs * sizeof *vec->episode);
  at += episodes_size(vec);
  for (int i = 0; i < vec->envs; at += vs_env_state_size(vec->env[i]), i++) vs_env_restore(vec->env[i], at);
}
