// Stable: part of libvsss (deploy/docs/library.md).
//
// One match: simulator + sensors + referee + two teams, frame by frame (1/30 s) or decision by decision (1/10 s).
#ifndef VSSS_ENV_H
#define VSSS_ENV_H

#include "vsss/api.h"
#include "vsss/control.h"
#include "vsss/referee.h"
#include "vsss/reward.h"
#include "vsss/sensor_model.h"
#include "vsss/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_env vs_env;

// What training episodes begin with and how long their ball may lie still, drawn for each episode. All zeros: a kick-off
// by referee.kick_off and referee.still_s, as in a match.
typedef struct vs_episode_def {
  double open_play, penalty, free_ball; // shares of episodes that begin so, for either team; the rest kick off
  double still_low_s, still_high_s;     // range of referee.still_s; high 0: as it is
  bool either_kicks_off;                // kick-offs by a team drawn at random
} vs_episode_def;

// Whose control knows the episode's latency and predicts the world to the moment its commands act
// (vs_control_set_latency): the software around a learned policy does, a scripted player is what its text says.
typedef enum vs_predicts { VS_PREDICTS_LEARNED = 0, VS_PREDICTS_NONE, VS_PREDICTS_ALL } vs_predicts;
VSSS_API vs_status vs_predicts_parse(const char *text, vs_predicts *out, vs_error *err); // learned, none, all

typedef struct vs_env_def {
  const vs_model *model;        // shared, outlives the env
  const char *player[VS_TEAMS]; // URI, or NULL: an external team whose actions the caller gives
  vs_referee_def referee;
  vs_realism realism;
  vs_predicts predicts;     // external teams count as learned
  bool shuffle_adversaries; // training
  vs_episode_def episode;   // training
  // Its commands come at the moment they act, through a radio of its own: realism's latency and lost radio frames are the
  // other team's alone. Such a team is external.
  bool own_radio[VS_TEAMS];
} vs_env_def;

VSSS_API vs_env_def vs_env_def_default(const vs_model *model); // paper rules, paper noise, 120 s, both teams external

VSSS_API vs_status vs_env_new(const vs_env_def *def, vs_env **out, vs_error *err);
VSSS_API void vs_env_free(vs_env *env);

// A new match from this seed: everything that follows is a function of the seed and of external actions.
VSSS_API vs_status vs_env_reset(vs_env *env, uint64_t seed, vs_error *err);

// One camera frame. event (may be NULL): what the referee said after it; the pieces have already been placed anew.
// VS_USAGE once the match is over. A failure names the match's seed and time. The model says the division: in others than
// 3 against 3 learned policies and external teams are refused (VS_USAGE), and so are decisions with their rewards
// (vs_env_step) - matches go frame by frame.
VSSS_API vs_status vs_env_frame(vs_env *env, vs_event *event, vs_error *err);

// One decision: frames until the next decision tick, at most three. A placement ends it early: the frame count starts
// anew there, so that the first frame after a placement is a decision. Rewards compare the truth at its start with the
// truth the referee judged, before any placement.
typedef struct vs_env_result {
  vs_event event;  // the most important of the decision (goal > penalty > others), absolute frame
  bool over;       // the match or episode ended
  bool time_limit; // ... by its clock, not by a goal: bootstrap the value
  double terms[VS_TEAMS][VS_TEAM_SIZE][VS_REWARD_TERMS];
} vs_env_result;
VSSS_API vs_status vs_env_step(vs_env *env, vs_env_result *result, vs_error *err);

// External teams: float[3][2] action, held until replaced. Any team: float[3][464] observation of the present decision
// tick, and float[3][2] what it commanded in the last decision, the mean over its frames (a 30 Hz player changes its
// mind within one). Zeros in other divisions.
VSSS_API vs_status vs_env_set_action(vs_env *env, vs_team team, const float *action, vs_error *err);
VSSS_API void vs_env_observation(const vs_env *env, vs_team team, float *out);
VSSS_API void vs_env_mean_action(const vs_env *env, vs_team team, float *out);
// Swap the player of a team; takes effect at the next reset.
VSSS_API vs_status vs_env_set_player(vs_env *env, vs_team team, const char *uri, vs_error *err);

VSSS_API void vs_env_set_episode(vs_env *env, const vs_episode_def *episode); // def.episode from the next reset on

VSSS_API bool vs_env_over(const vs_env *env);
VSSS_API void vs_env_truth(const vs_env *env, vs_world *out);
VSSS_API void vs_env_judged(const vs_env *env,
                            vs_world *out); // the truth at the end of the last frame, before a placement
VSSS_API void vs_env_measured(const vs_env *env, vs_world *out); // what both teams saw last
VSSS_API void vs_env_wheels(const vs_env *env, vs_wheels out[VS_TEAMS][VS_TEAM_MOST]);
VSSS_API bool vs_env_decided(const vs_env *env, vs_team team); // the last frame was a decision of this team's player
VSSS_API const vs_referee *vs_env_referee(const vs_env *env);
VSSS_API const vs_game *vs_env_game(const vs_env *env);
VSSS_API vs_control *vs_env_control(vs_env *env, vs_team team);
VSSS_API vs_sim *vs_env_sim(vs_env *env);
VSSS_API uint64_t vs_env_hash(const vs_env *env); // of all true worlds since the reset

// Snapshots, to be restored into an env of the same def and players.
VSSS_API size_t vs_env_state_size(const vs_env *env); // 0: a player that cannot be snapshotted
VSSS_API void vs_env_save(const vs_env *env, void *state);
// VS_FAIL: a number that cannot be, as in a damaged file; the env must then be reset.
VSSS_API vs_status vs_env_restore(vs_env *env, const void *state, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
