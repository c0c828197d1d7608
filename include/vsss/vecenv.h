// Many matches over threads for a trainer: the caller owns the big arrays, rows are written in place, episodes restart
// by themselves, nothing is allocated after start, and results do not depend on the number of threads.
#ifndef VSSS_VECENV_H
#define VSSS_VECENV_H

#include "vsss/env.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_vecenv vs_vecenv;

typedef struct vs_vecenv_def {
  vs_env_def env; // player[] NULL for external teams; each match opens its own players
  int envs;
  int threads;
  uint64_t seed; // episode e of match i has the seed vs_seed_mix(vs_seed_mix(seed, i), e)
} vs_vecenv_def;

// Rows: env-major, then team, then robot: row (env * 2 + team) * 3 + robot, for both teams (rows of scripted teams are
// written too: their observation, action and reward, so that they can be imitated).
#define VS_VECENV_ROWS(envs) ((envs)*VS_TEAMS * VS_TEAM_SIZE)
typedef struct vs_vecenv_buffers {
  float *observation;  // [rows][VS_OBS_SIZE]; after a step: of the new episode where one ended
  float *action;       // [rows][2]: read for external teams, written for others (vs_env_mean_action)
  float *reward_terms; // [rows][VS_REWARD_TERMS]
  uint8_t *done;       // [envs]: an episode ended in this step
  uint8_t *time_limit; // [envs]: ... by its clock
  float
      *final_observation; // [rows][VS_OBS_SIZE]: of the ended episode's last tick, only where time_limit (may be NULL)
  int32_t *score;         // [envs][2]: of the ended episode, only where done
  float *episode_s;       // [envs]: length of the ended episode, only where done
} vs_vecenv_buffers;

vs_status vs_vecenv_new(const vs_vecenv_def *def, vs_vecenv **out, vs_error *err);
void vs_vecenv_free(vs_vecenv *vec);
// All matches at the start of episode 0; writes the observations.
vs_status vs_vecenv_reset(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err);
// One decision of every match. A failure is the one of the lowest match; the others have been stepped.
vs_status vs_vecenv_step(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err);

// The player of a team of one match from its next episode on (a frozen self, a scripted one); NULL: external.
vs_status vs_vecenv_set_player(vs_vecenv *vec, int env, vs_team team, const char *uri, vs_error *err);

uint64_t vs_vecenv_hash(const vs_vecenv *vec); // of all true worlds of the present episodes

// Snapshots, to be restored into a vecenv of the same def and players (any number of threads). Size 0: some player
// cannot be snapshotted.
size_t vs_vecenv_state_size(const vs_vecenv *vec);
void vs_vecenv_save(const vs_vecenv *vec, void *state);
void vs_vecenv_restore(vs_vecenv *vec, const void *state);

#ifdef __cplusplus
}
#endif
#endif
