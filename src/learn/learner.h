// The PPO learner: parameters, Adam, and the update from one batch of transitions. The gradient of a minibatch comes
// from our own kernels, or from libtorch (gradient_torch.cpp) as their oracle.
#ifndef VSSS_LEARN_LEARNER_H
#define VSSS_LEARN_LEARNER_H

#include "blas.h"
#include "group.h"
#include "net.h"
#include "ppo.h"
#include "vsss/pool.h"
#include "vsss/rng.h"

// What the products of the backward pass are of. AUTO: bfloat16 where oneDNN and the processor have it.
typedef enum vs_precision { VS_PRECISION_FP32, VS_PRECISION_BF16, VS_PRECISION_AUTO } vs_precision;

typedef struct vs_learner_def {
  vs_net_shape shape; // with a critic
  vs_ppo_def ppo;
  double learning_rate, adam_beta1, adam_beta2, adam_epsilon, max_gradient_norm;
  double initial_concentration; // alpha = beta of the untrained policy
  int epochs, minibatch;
  int microbatches; // a minibatch is computed in this many parts, whatever the number of threads
  int block;        // a microbatch is computed in blocks of at most so many rows; 0: 192
  vs_precision precision;
} vs_learner_def;

// What an update did.
typedef struct vs_learner_stats {
  vs_ppo_stats last;         // sums over the last epoch
  double gradient_norm;      // mean before clipping, of the last epoch
  double explained_variance; // 1 - var(target - old value)/var(target)
} vs_learner_stats;

// Gradient of one minibatch by another library: same meaning as the kernels' (mean over total_rows), written to gradient.
typedef struct vs_gradient_engine {
  void *self;
  vs_status (*gradient)(void *self, const vs_net *net, const vs_ppo_def *def, const float *parameters,
                        const vs_ppo_batch *batch, double total_rows, float *gradient, vs_ppo_stats *stats,
                        vs_error *err);
  // The networks' outputs alone, as vs_net_forward has them.
  vs_status (*forward)(void *self, const vs_net *net, const float *parameters, const float *x, int rows, float *raw,
                       float *value, vs_error *err);
  void (*free)(void *self);
} vs_gradient_engine;

typedef struct vs_learner {
  vs_learner_def def;
  vs_net net;
  vs_blas blas;
  vs_pool *pool;                    // borrowed
  const vs_group *group;            // borrowed; NULL: alone
  const vs_gradient_engine *engine; // borrowed; NULL: our kernels
  float *parameters;                // [net.size]; with m, v and steps what a checkpoint keeps
  float *m, *v;                     // [net.size]: Adam's moments of the gradient, first and second, not corrected
  long long steps;                  // of Adam
  uint16_t *bf16;                   // [net.size]: weights for the backward pass; NULL: it multiplies floats
  struct vs_learner_part *part;     // [microbatches]: workspaces
  float *gradient;                  // [net.size]
  int *order;                       // permutation of the batch
  size_t order_size;
} vs_learner;

vs_status vs_learner_init(vs_learner *learner, const vs_learner_def *def, vs_pool *pool, uint64_t seed, vs_error *err);
void vs_learner_free(vs_learner *learner);

// epochs over the batch (the transitions of this rank, advantages not normalised) in random minibatches drawn from seed. With a group, the batch is the ranks' batches together
// (all of the same number of rows) and the update is that of one rank that held them all.
vs_status vs_learner_update(vs_learner *learner, const vs_ppo_batch *batch, uint64_t seed, vs_learner_stats *stats,
                            vs_error *err);

// This rank's rows of a minibatch, and what is the same for all ranks.
typedef struct vs_minibatch {
  const int *row; // [rows], in the batch; borrowed
  int rows;
  double total_rows;                      // of all ranks
  double advantage_mean, advantage_scale; // advantages are normalised as (a - mean) * scale
} vs_minibatch;

// The gradient of one minibatch into learner->gradient (summed over the group).
vs_status vs_learner_gradient(vs_learner *learner, const vs_ppo_batch *batch, const vs_minibatch *minibatch,
                              vs_ppo_stats *stats, vs_error *err);

// One step of Adam by learner->gradient, its norm limited; returns the norm before.
double vs_learner_step(vs_learner *learner);

#endif
