// What train.c, train_update.c, imitate.c, checkpoint.c and train_def.c share.
#ifndef VSSS_LEARN_TRAIN_INTERNAL_H
#define VSSS_LEARN_TRAIN_INTERNAL_H

#include <pthread.h>

#include "rollout.h"
#include "wire.h"
#include "vsss/learn.h"

struct vs_train {
  vs_train_def def;
  vs_matches matches;
  vs_pool *pool;
  vs_learner learner;
  vs_league league;
  vs_rollout rollout;
  vs_value_scale scale;
  vs_reward_weights reward_start, reward_end;
  float *actor;                           // [rollout.actor.size]: the present actor, for the league
  float *actor_mean;                      // [rollout.actor.size]: what is exported; NULL: the present actor is
  const vs_group *group;                  // NULL: alone
  vs_gradient_engine engine;              // gradient NULL: our kernels
  char products[128], products_times[80]; // what multiplies the matrices, and how fast it was where it was chosen
  long long updates, transitions;
  double wall_s;
  bool started; // the matches were reset or restored
  struct {
    pthread_mutex_t lock; // over state, and over all writing of checkpoints
    vs_bytes state;       // a checkpoint, or empty
    double update;
  } kept; // vs_train_keep
};

// A run over other matches than the simulator's (tests); takes them over, also on failure.
vs_status vs_train_new_over(const vs_train_def *def, const vs_matches *matches, const vs_group *group, vs_train **out,
                            vs_error *err);

// Plays one batch; adds the time spent in the simulator and in the networks.
vs_status vs_train_collect(vs_train *train, const vs_reward_weights *weights, double *simulate_s, double *infer_s,
                           vs_error *err);
// What the collected batch teaches: advantages, and value targets in the critic's unit, which follows the returns.
vs_status vs_train_targets(vs_train *train, vs_ppo_batch *out, vs_error *err);
// Sums over all ranks, in place; the structs are doubles throughout.
vs_status vs_train_sum_up(const vs_train *train, vs_rollout_stats *played, vs_ppo_stats *ppo, vs_error *err);
// Every frozen self becomes the present policy.
void vs_train_hand_over(vs_train *train);
// The exponentially weighted mean of the actors over export_horizon_m (actor_mean.c). Restart: the present actor alone.
vs_status vs_actor_mean_open(vs_train *train, vs_error *err);
void vs_actor_mean_restart(vs_train *train);
void vs_actor_mean_follow(vs_train *train, const float *actor,
                          long long rows); // after an update of so many transitions
// Clones who plays both sides of `matches` (taken over): the loop of imitate.c over any matches.
vs_status vs_train_imitate_over(vs_train *train, const vs_matches *matches, int updates,
                                bool (*progress)(void *context, double part, double loss), void *context,
                                vs_error *err);

// Settings that older checkpoints lack, as those runs had them.
void vs_train_def_before(vs_train_def *def);
// At so many transitions.
double vs_train_learning_rate(const vs_train_def *def, double transitions);
vs_status vs_train_precision(const vs_train_def *def, vs_precision *out, vs_error *err);
vs_status vs_train_hidden(const vs_train_def *def, vs_net_shape *shape, vs_error *err);

#endif
