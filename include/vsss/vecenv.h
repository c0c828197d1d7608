// Stable: part of libvsss (deploy/docs/library.md).
//
// Many matches over threads for a trainer: the caller owns the big arrays, rows are written in place, episodes restart
// by themselves, nothing is allocated after start, and results do not depend on the number of threads.
//
// The order within a step, for each match: the actions of external teams are read and held; the match is played to its
// next decision; reward_terms, event, done and time_limit are written, and the actions of scripted teams; where an episode
// ended, score, episode_s and final_observation are written and the next episode begins; last, observation is written.
// So done[i] tells that observation shows the first decision of another episode, and the rewards beside it belong to the
// old one.
#ifndef VSSS_VECENV_H
#define VSSS_VECENV_H

#include "vsss/api.h"
#include "vsss/env.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_vecenv vs_vecenv;

// Which teams have rows.
typedef enum vs_vecenv_teams { VS_ROWS_BOTH, VS_ROWS_BLUE, VS_ROWS_YELLOW } vs_vecenv_teams;

typedef struct vs_vecenv_def {
  vs_env_def env; // player[] NULL for external teams; each match opens its own players
  int envs;
  int threads;
  uint64_t seed;         // see vs_vecenv_seed
  vs_vecenv_teams teams; // an external team must have rows
  bool stay_over;        // a match that is over rests, done and without reward, until vs_vecenv_start
} vs_vecenv_def;

// Rows: env-major, then team, then robot: row (env * 2 + team) * 3 + robot, for both teams (rows of scripted teams are
// written too: their observation, action and reward, so that they can be imitated). With the rows of one team only: row
// env * 3 + robot.
#define VS_VECENV_ROWS(envs) ((envs)*VS_TEAMS * VS_TEAM_SIZE)
typedef struct vs_vecenv_buffers {
  float *observation;       // [rows][VS_OBS_SIZE]; after a step: of the new episode where one ended
  float *action;            // [rows][2]: read for external teams, written for others (vs_env_mean_action)
  double *reward_terms;     // [rows][VS_REWARD_TERMS], as vs_reward_sum takes them
  uint8_t *done;            // [envs]: an episode ended in this step
  uint8_t *time_limit;      // [envs]: ... by its clock
  float *final_observation; // [rows][VS_OBS_SIZE]: of the ended episode's last frame, only where done (may be NULL)
  int32_t *score;           // [envs][2]: of the ended episode, only where done
  float *episode_s;         // [envs]: length of the ended episode, only where done
  int32_t *event; // [envs][2]: kind and team of the step's event (vs_event), team -1 without one (may be NULL)
} vs_vecenv_buffers;

VSSS_API vs_status vs_vecenv_new(const vs_vecenv_def *def, vs_vecenv **out, vs_error *err);
VSSS_API void vs_vecenv_free(vs_vecenv *vec);
VSSS_API int vs_vecenv_rows(const vs_vecenv *vec);
// All matches at the start of episode 0; writes the observations.
VSSS_API vs_status vs_vecenv_reset(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err);
// Episode e of match i has the seed vs_seed_mix(match seed, e), and the match seed is vs_seed_mix(seed, i) unless it is
// given. In force from the match's next start on, which is episode 0.
VSSS_API void vs_vecenv_seed(vs_vecenv *vec, uint64_t seed);
VSSS_API vs_status vs_vecenv_seed_match(vs_vecenv *vec, int env, uint64_t match_seed, vs_error *err);
// The matches with start[env] != 0 (NULL: all) leave their episode and begin the next one; writes their observations.
VSSS_API vs_status vs_vecenv_start(vs_vecenv *vec, const uint8_t *start, const vs_vecenv_buffers *buffers,
                                   vs_error *err);
// One match begins an episode with exactly this seed (which is not counted); writes its observations.
VSSS_API vs_status vs_vecenv_start_from(vs_vecenv *vec, int env, uint64_t seed, const vs_vecenv_buffers *buffers,
                                        vs_error *err);
// One decision of every match. A failure is the one of the lowest match; the others have been stepped.
VSSS_API vs_status vs_vecenv_step(vs_vecenv *vec, const vs_vecenv_buffers *buffers, vs_error *err);

// The player of a team of one match from its next episode on (a frozen self, a scripted one); NULL: external.
VSSS_API vs_status vs_vecenv_set_player(vs_vecenv *vec, int env, vs_team team, const char *uri, vs_error *err);

VSSS_API vs_env *vs_vecenv_env(vs_vecenv *vec, int env); // to look at between two steps; NULL: no such match

VSSS_API uint64_t vs_vecenv_hash(const vs_vecenv *vec); // of all true worlds of the present episodes

// Snapshots, to be restored into a vecenv of the same def and players (any number of threads). Size 0: some player
// cannot be snapshotted. VS_VECENV_STATE is the version of these bytes: whoever changes what a match keeps between two
// steps (of simulator, sensors, referee, rewards or players) raises it, so that a checkpoint of before is refused by name.
// 5: room for five robots a team; 4: what is told of unseen objects; 3: the referee's idle rule, pushing and knockout.
#define VS_VECENV_STATE 5
VSSS_API size_t vs_vecenv_state_size(const vs_vecenv *vec);
VSSS_API void vs_vecenv_save(const vs_vecenv *vec, void *state);
// VS_FAIL: a number that cannot be, as in a damaged file; the vecenv must then be reset.
VSSS_API vs_status vs_vecenv_restore(vs_vecenv *vec, const void *state, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
