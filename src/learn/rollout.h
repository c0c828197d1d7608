// Collects transitions: many matches, step after step, the present policy and its frozen opponents sampled, rewards
// summed, episodes' ends sorted into terminated (a goal) and truncated (the clock). Reads no clock; train_update.c times it.
#ifndef VSSS_LEARN_ROLLOUT_H
#define VSSS_LEARN_ROLLOUT_H

#include "league.h"
#include "learner.h"
#include "policy_io.h"
#include "value_scale.h"
#include "vsss/observe.h"
#include "vsss/reward.h"
#include "vsss/vecenv.h"

// The matches, as a table of functions: vs_vecenv in training, a tiny task in the tests.
typedef struct vs_matches {
  void *self;
  // What has been learnt so far, in millions of transitions, before each batch: episodes may begin otherwise from there
  // on. NULL: they do not.
  void (*learnt)(void *self, double transitions_m);
  vs_status (*reset)(void *self, const vs_vecenv_buffers *buffers, vs_error *err);
  vs_status (*step)(void *self, const vs_vecenv_buffers *buffers, vs_error *err);
  size_t (*state_size)(const void *self);
  void (*save)(const void *self, void *state);
  vs_status (*restore)(void *self, const void *state, vs_error *err);
  void (*free)(void *self);
} vs_matches;

// How earlier selves drive, drawn for each episode: strangers are slower, faster or bolder than the policy is.
typedef struct vs_opponent_style {
  double gain_low, gain_high; // in place of io.action_gain; high 0: io.action_gain
  double mean;                // share of episodes in which they do not sample, but take the mean, as policy files do
} vs_opponent_style;

typedef struct vs_rollout_def {
  int envs, steps;
  double gamma, lambda;
  uint64_t seed;
  vs_policy_io io;
  vs_opponent_style opponent;
} vs_rollout_def;

// Sums over a batch (all learning rows of all steps).
typedef struct vs_rollout_stats {
  double transitions, terms[VS_REWARD_TERMS], reward;
  double episodes, episode_s, goals_for, goals_against; // of matches with one learning side
} vs_rollout_stats;

typedef struct vs_rollout {
  vs_rollout_def def;
  const vs_net *net;           // borrowed, of the learner
  vs_net actor;                // of the frozen selves
  const vs_blas *blas;         // borrowed
  vs_pool *pool;               // borrowed
  vs_league *league;           // borrowed
  const vs_value_scale *scale; // borrowed: of the critic's outputs
  bool watch;                  // imitation: scripts play, this policy only values what they see
  vs_vecenv_buffers io;        // [rows of all matches], owned
  vs_symmetry_table symmetry;
  int rows;           // that learn
  int *row;           // [rows]: their rows in io
  long long decision; // steps since the start of the run: numbers the random draws
  // Step-major, [steps][rows], as the network sees and draws them (policy_io.h); value [steps + 1][rows] in reward units.
  float *x, *log_u, *log_1_u, *log_p, *advantage, *target, *value, *reward, *truncated_value, *old_value;
  uint8_t *end;
  uint8_t *turn;          // [rows]: what the network saw of this step's observation (rollout.c)
  vs_rollout_stats stats; // of the present batch
  struct vs_rollout_scratch *scratch;
} vs_rollout;

vs_status vs_rollout_init(vs_rollout *rollout, const vs_rollout_def *def, const vs_learner *learner,
                          const vs_value_scale *scale, vs_league *league, vs_error *err);
void vs_rollout_free(vs_rollout *rollout);

void vs_rollout_begin(vs_rollout *rollout); // a new batch: forgets the sums
// Step t: values and sampled actions of everybody who is no script, from io.observation into io.action.
void vs_rollout_act(vs_rollout *rollout, int t, const float *parameters);
// After the matches stepped: rewards, ends, the league's results.
void vs_rollout_record(vs_rollout *rollout, int t, const float *parameters, const vs_reward_weights *weights);
// After the last step: value[steps], of the states that followed it.
void vs_rollout_bootstrap(vs_rollout *rollout, const float *parameters);
// Then advantages and value targets (gae.h), both in reward units.
void vs_rollout_advantages(vs_rollout *rollout);
// The batch for the learner, once value_scale.h has taken its targets and old values into the critic's unit.
vs_ppo_batch vs_rollout_batch(const vs_rollout *rollout);

#endif
