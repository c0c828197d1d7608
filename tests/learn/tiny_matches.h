// A tiny task with the shape of a match, for the tests: each robot sees a random sign s at input 0 (and 1 at input 1);
// its reward is s * (left wheel) - (right wheel)^2 through the progress term. The best policy drives left = s, right =
// 0. Episodes last `length` steps: by the clock, or, every third one, by a goal of blue. Everything follows from seed,
// match and step, so that a copy of the counters is a snapshot.
#ifndef VSSS_TESTS_TINY_MATCHES_H
#define VSSS_TESTS_TINY_MATCHES_H

#include <stdlib.h>
#include <string.h>

#include "learn/rollout.h"

typedef struct tiny {
  int envs, length;
  uint64_t seed;
  int *step, *episode; // [envs]
  bool scripted;       // all robots drive left = s/2, right = -1/2
} tiny;

static double tiny_sign(const tiny *t, int row, int step, int episode) {
  vs_rng rng = vs_rng_make(vs_seed_mix(t->seed, (uint64_t)row), (uint64_t)(episode * 1000 + step));
  return vs_rng_uniform(&rng) < 0.5 ? -1.0 : 1.0;
}

static void tiny_observe(const tiny *t, int env, float *observation) {
  for (int k = 0; k < VS_TEAMS * VS_TEAM_SIZE; k++) {
    int row = env * VS_TEAMS * VS_TEAM_SIZE + k;
    float *x = observation + (size_t)row * VS_OBS_SIZE;
    memset(x, 0, VS_OBS_SIZE * sizeof *x);
    x[0] = (float)tiny_sign(t, row, t->step[env], t->episode[env]);
    x[1] = 1.0f;
  }
}

static vs_status tiny_reset(void *self, const vs_vecenv_buffers *b, vs_error *err) {
  (void)err;
  tiny *t = self;
  for (int env = 0; env < t->envs; env++) {
    t->step[env] = t->episode[env] = 0;
    tiny_observe(t, env, b->observation);
  }
  return VS_OK;
}

static vs_status tiny_step(void *self, const vs_vecenv_buffers *b, vs_error *err) {
  (void)err;
  tiny *t = self;
  for (int row = 0; t->scripted && row < VS_VECENV_ROWS(t->envs); row++) {
    b->action[2 * row] = 0.5f * b->observation[(size_t)row * VS_OBS_SIZE];
    b->action[2 * row + 1] = -0.5f;
  }
  memset(b->reward_terms, 0, (size_t)VS_VECENV_ROWS(t->envs) * VS_REWARD_TERMS * sizeof *b->reward_terms);
  for (int row = 0; row < VS_VECENV_ROWS(t->envs); row++) {
    float left = b->action[2 * row], right = b->action[2 * row + 1];
    b->reward_terms[row * VS_REWARD_TERMS + VS_REWARD_PROGRESS] =
        b->observation[(size_t)row * VS_OBS_SIZE] * left - right * right;
  }
  for (int env = 0; env < t->envs; env++) {
    t->step[env]++;
    b->done[env] = t->step[env] == t->length;
    b->time_limit[env] = b->done[env] && t->episode[env] % 3 != 0;
    if (b->done[env]) {
      size_t rows = VS_TEAMS * VS_TEAM_SIZE, first = (size_t)env * rows;
      tiny_observe(t, env, b->observation);
      memcpy(b->final_observation + first * VS_OBS_SIZE, b->observation + first * VS_OBS_SIZE,
             rows * VS_OBS_SIZE * sizeof(float));
      b->score[2 * env] = !b->time_limit[env];
      b->score[2 * env + 1] = 0;
      b->episode_s[env] = (float)t->step[env] * 0.1f;
      t->step[env] = 0;
      t->episode[env]++;
    }
    tiny_observe(t, env, b->observation);
  }
  return VS_OK;
}

static size_t tiny_size(const void *self) { return 2 * (size_t)((const tiny *)self)->envs * sizeof(int); }

static void tiny_save(const void *self, void *state) {
  const tiny *t = self;
  size_t bytes = (size_t)t->envs * sizeof(int);
  memcpy(state, t->step, bytes);
  memcpy((char *)state + bytes, t->episode, bytes);
}

static vs_status tiny_restore(void *self, const void *state, vs_error *err) {
  (void)err;
  tiny *t = self;
  size_t bytes = (size_t)t->envs * sizeof(int);
  memcpy(t->step, state, bytes);
  memcpy(t->episode, (const char *)state + bytes, bytes);
  return VS_OK;
}

static void tiny_free(void *self) {
  tiny *t = self;
  free(t->step);
  free(t->episode);
  free(t);
}

static vs_matches tiny_matches(int envs, int length, uint64_t seed) {
  tiny *t = malloc(sizeof *t);
  *t = (tiny){envs, length, seed, calloc((size_t)envs, sizeof(int)), calloc((size_t)envs, sizeof(int)), false};
  return (vs_matches){t, NULL, tiny_reset, tiny_step, tiny_size, tiny_save, tiny_restore, tiny_free};
}

#endif
