// Training: PPO self-play (paper, section VII), and the policy files it makes.
#ifndef VSSS_LEARN_H
#define VSSS_LEARN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/config.h"
#include "vsss/reward.h"
#include "vsss/sim.h"
#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Everything a run depends on. Settings of the command line and of INI files by the names of vs_train_schema.
typedef struct vs_train_def {
  // Matches.
  char drive[16];     // planar or contact
  char realism[256];  // INI file of sensors and dynamics; empty: the paper's noise only
  char placement[16]; // random, paper or mixed
  double episode_s;
  double still_distance_m;                           // a ball that stays within it lies still; 0.02 by the rules
  char predicts[16];                                 // who sees the world moved on by the delay (vsss/env.h)
  double still_low_s, still_high_s;                  // how long the ball may lie still, drawn for each episode
  double start_open, start_penalty, start_free_ball; // shares of episodes that begin so; the rest kick off
  double start_from_m; // millions of transitions before which all kick off and still_high_s holds
  int envs, steps;     // matches side by side; decisions of each per update
  int threads;
  uint64_t seed;
  // Opponents (src/learn/league.h).
  char opponent[256]; // mix, such as "self=0.6,pool=0.4"
  double replace_score;
  bool score_window_zero_filled; // the paper's window of results: zeros at first, never cleared
  int pool_size, pool_every;
  // Earlier selves drive at a gain drawn for each episode, the team's or each robot's own (high 0: at action_gain), and in
  // this share of the episodes take the mean of what the policy draws from, as policy files do.
  double opponent_gain_low, opponent_gain_high, opponent_mean;
  // Reward: a preset (dense, goals, paper) and changes, such as "dense,approach=0.3"; shifts linearly from the first to
  // the second between the two numbers of transitions.
  char reward[192], reward_end[192];
  double anneal_from_m, anneal_to_m; // millions of transitions
  double gamma, lambda;
  // PPO.
  double clip, entropy, value_weight;
  bool clip_value, value_scale;            // value_scale: the critic works in units of the returns' deviation
  double learning_rate, learning_rate_end; // from the first to the second over transitions_m
  char learning_rate_decay[16];            // ... linear or exponential
  double learning_rate_hold_m;             // ... after so many millions at the first
  double adam_epsilon, max_gradient_norm;
  int epochs, minibatch, microbatches;
  // The networks see another of an observation's 24 symmetric versions (vsss/observe.h), drawn anew after so many decisions
  // for each robot; 0: always the observation itself.
  int augment;
  bool reversible; // front and back are alike: the networks see the end that faces their goal (vsss/observe.h)
  bool canonical;  // the networks see one of the 24 symmetric versions of an observation (vsss/observe.h)
  // ONNX files: the mean over all 24 versions in place of one answer, and another gain (0: action_gain). An average is
  // smaller than what it is the average of.
  bool export_average;
  double export_gain;
  double
      export_horizon_m; // of the exponentially weighted mean of the run's networks that is exported; 0: the newest one
  double action_gain;   // action = action_gain times what the policy draws from [-1, 1], clipped
  char hidden[64];      // layer sizes, such as "256,256"
  double initial_concentration; // alpha = beta of the untrained policy's Beta distributions; > 1
  char learner[16];             // own or torch
  // Of the products in the own learner's backward pass: fp32, bf16 (needs oneDNN and AVX512-BF16), or auto: both are
  // timed when the run begins and the faster one becomes its setting.
  char precision[16];
  // How long.
  double transitions_m; // millions; 0: until stopped
} vs_train_def;

vs_train_def vs_train_def_default(void); // our best recipe
// "default", or "paper" (Table 2 and what paper.md adds). VS_USAGE lists the presets.
vs_status vs_train_def_preset(const char *name, vs_train_def *out, vs_error *err);

// One row per setting, with its allowed range, and one per name that a setting had before, targets inside def; ended by a NULL name.
#define VS_TRAIN_KEYS_MAX 64
void vs_train_schema(vs_train_def *def, vs_config_key keys[VS_TRAIN_KEYS_MAX]);
// All settings as lines "key = value", as an INI file, with a comment over each if asked for; returns the length it would
// need. VS_TRAIN_TEXT_MAX is enough for any.
#define VS_TRAIN_TEXT_MAX 16384
size_t vs_train_def_text(const vs_train_def *def, bool comments, char *out, size_t size);
// What ranges cannot say: text fields, minibatch against batch.
vs_status vs_train_def_check(const vs_train_def *def, vs_error *err);

// What one update did: everything a double, so that CSV, TensorBoard and the status line read one table. NaN: not
// measured in this update (no episode ended, no such opponent).
typedef struct vs_train_report {
  double update, transitions;           // so far
  double wall_s;                        // training time so far, over all resumes
  double transitions_per_s;             // of this update
  double simulate_s, infer_s, learn_s;  // of this update
  double reward, term[VS_REWARD_TERMS]; // means per transition (terms unweighted)
  double weight[VS_REWARD_TERMS];       // of the terms in the reward of this update
  double entropy, kl, clip_fraction, explained_variance, policy_loss, value_loss, gradient_norm, learning_rate;
  double episodes, episode_s, goals_for, goals_against;            // ended in this update; means per episode
  double frozen_score, replacements, pool, self_score, pool_score; // league; scores: mean goal difference lately
} vs_train_report;

// Result of matches against one opponent: shares of them, and means per match with the 95 % interval of the score.
typedef struct vs_train_score {
  const char *opponent; // borrowed
  double matches, win, draw, loss, goals_for, goals_against, score, score_low, score_high;
} vs_train_score;

// Matches of 120 s by the paper's rules: a policy file against any player. The same seed, the same matches.
typedef struct vs_train_eval_def {
  const char *policy_file, *opponent;
  vs_drive drive; // contact is the reference
  int matches, threads;
  uint64_t seed;
  bool (*go_on)(void *context); // may be NULL; false ends it: score.matches is then how many were played
  void *context;
} vs_train_eval_def;
vs_status vs_train_evaluate(const vs_train_eval_def *def, vs_train_score *out, vs_error *err);

typedef struct vs_train_column {
  const char *name; // of the CSV
  const char *tag;  // of TensorBoard
  size_t offset;    // of a double in vs_train_report
} vs_train_column;
const vs_train_column *vs_train_columns(int *count);
double vs_train_value(const vs_train_report *report, const vs_train_column *column);

// For a program, before its first thread: sets the environment variables that the libraries of training read when they
// load, where the user has not: OPENBLAS_NUM_THREADS, OPENBLAS_CORETYPE, OMPI_MCA_pml. Nothing else in this module
// touches its host's environment; without this call it is the same training, slower over OpenBLAS on new processors, and
// under mpirun with the transport that Open MPI picks.
void vs_learn_environment(void);

// Ranks that train together: under `mpirun -n K` the program's processes share the gradients. Collective: every rank
// makes the same calls. NULL: alone.
typedef struct vs_group vs_group;
vs_status vs_group_open(vs_group **out, vs_error *err); // *out stays NULL where mpirun did not start the program
void vs_group_close(vs_group *group, bool failed);      // failed: ends the other ranks too
int vs_group_rank(const vs_group *group);
int vs_group_size(const vs_group *group);
vs_status vs_group_any(vs_group *group, bool *flag, vs_error *err); // true on all ranks where it was on one

// A training run. Each rank of a group (borrowed) plays its own def->envs matches; updates are those of one run with all
// of them. Reports count the whole group.
typedef struct vs_train vs_train;
vs_status vs_train_new(const vs_train_def *def, const vs_group *group, vs_train **out, vs_error *err);
void vs_train_free(vs_train *train);

// One batch of play and what is learnt from it.
vs_status vs_train_update(vs_train *train, vs_train_report *report, vs_error *err);
// Imitation start, before the first update: clones a scripted player's wheel commands (and learns the value of its
// play) from `updates` batches of it against itself; frozen selves become the clone. progress (may be NULL) hears of
// every batch, loss = -log p per transition, and stops it by returning false.
vs_status vs_train_imitate(vs_train *train, const char *uri, int updates,
                           bool (*progress)(void *context, double part, double loss), void *context, vs_error *err);

bool vs_train_done(const vs_train *train); // transitions_m reached
// Another limit for a run that has reached its own: goes on until then at the learning rate that it ended with.
void vs_train_go_on(vs_train *train, double transitions_m);
double vs_train_updates(const vs_train *train);
double vs_train_transitions(const vs_train *train);
double vs_train_wall_s(const vs_train *train);        // of training so far, over all resumes
const char *vs_train_products(const vs_train *train); // such as "gradients in bf16 by oneDNN (...)"
const vs_train_def *vs_train_settings(const vs_train *train);
// Results against kind k of the opponent mix: its name, episodes, win, draw, loss so far, recent mean goal difference.
typedef struct vs_train_opponent {
  const char *name;
  long long episodes, wins, draws, losses;
  double recent_score;
} vs_train_opponent;
int vs_train_opponents(const vs_train *train, vs_train_opponent *out, int max);

// Checkpoints. Written atomically; the one before is kept as FILE.previous. Before the first update they hold the networks
// alone. vs_train_load continues a run (its def is the one of vs_train_read_def, or that with changed settings: where the
// matches are not as before they start anew, and with another mix of opponents the pool of earlier selves too) and falls
// back to FILE.previous where FILE is damaged; note (may be NULL, 256 bytes) then says so, else it is empty. In a group
// rank 0 reads and all continue from its file; the other ranks' matches start anew.
vs_status vs_train_save(vs_train *train, const char *path, vs_error *err);
// Without matches and league (4.5 MB at 464-256-256): a run that continues from it meets itself as it is now first.
vs_status vs_train_save_slim(vs_train *train, const char *path, vs_error *err);
// For who cannot wait until an update is over: a copy of the state between two updates, kept in memory by the thread that
// trains; then written by any thread while that one goes on. update (may be NULL): how many it holds. VS_FAIL: none kept.
vs_status vs_train_keep(vs_train *train, vs_error *err);
vs_status vs_train_save_kept(vs_train *train, const char *path, double *update, vs_error *err);
vs_status vs_train_read_def(const char *path, vs_train_def *out, vs_error *err);
vs_status vs_train_load(vs_train *train, const char *path, char *note, vs_error *err);
// Between vs_train_load and the first update: networks and moments become the mean of the run's own and those of count
// checkpoints of networks of the same shape. Points of one run, or of runs that began from one point, lie in one basin,
// and their mean plays better than each (Izmailov et al. 2018, arXiv 1803.05407). The scale of values stays the run's. On
// failure the run is as it was.
vs_status vs_train_average(vs_train *train, const char *const *paths, int count, vs_error *err);

// The present policy as ONNX; notes in pairs (key, value), ended by NULL, are added to its metadata.
vs_status vs_train_export(const vs_train *train, const char *path, bool with_spread, const char *const *notes,
                          vs_error *err);

// A policy nobody trained (464-256-256-4 from this seed, outputs action, alpha and beta) as an ONNX file: a real
// player for tests and first tries.
vs_status vs_learn_write_untrained(const char *path, uint64_t seed, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
