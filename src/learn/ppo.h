// The loss of proximal policy optimisation (Schulman et al. 2017) with a Beta policy, and its derivatives by the
// networks' outputs. Pure arithmetic over rows.
#ifndef VSSS_LEARN_PPO_H
#define VSSS_LEARN_PPO_H

#include <stdbool.h>

#include "vsss/contract.h"

typedef struct vs_ppo_def {
  double clip;         // of the probability ratio, and of the value where clip_value
  bool clip_value;     // value clipped around the old one like the policy's ratio (paper's preset)
  double entropy;      // weight of the entropy bonus
  double value_weight; // of 0.5 (value - target)^2
  bool imitate;        // the policy's part is -log p of the samples instead: cloning whoever acted
} vs_ppo_def;

// rows transitions; A = VS_ACTION_SIZE. Borrowed. Values and targets in the critic's own unit.
typedef struct vs_ppo_batch {
  int rows;
  const float *x;                              // [rows][inputs]
  const float *log_u, *log_1_u;                // [rows][A]: ln u, ln(1 - u) of the sampled u on [0, 1]
  const float *old_log_p;                      // [rows]: of the policy that sampled
  const float *advantage, *target, *old_value; // [rows]
} vs_ppo_batch;

// Sums over rows; divide by rows.
typedef struct vs_ppo_stats {
  double rows, policy_loss, value_loss, entropy, kl, clipped;
} vs_ppo_stats;

// The networks' outputs on the rows of a batch, and where the derivatives of the loss by them go. Borrowed.
typedef struct vs_ppo_outputs {
  const float *raw, *value; // [rows][2A], [rows]
  float *d_raw, *d_value;   // the same
} vs_ppo_outputs;

// Loss = mean over total_rows of: -min(ratio A, clip(ratio) A) (or -log p) - entropy H + value_weight 0.5 max(...)^2. Writes
// d_raw and d_value, the derivatives of the part that these rows contribute, and adds to stats.
void vs_ppo_loss(const vs_ppo_def *def, const vs_ppo_batch *batch, const vs_ppo_outputs *outputs, double total_rows,
                 vs_ppo_stats *stats);

// The loss itself from stats.
double vs_ppo_total(const vs_ppo_def *def, const vs_ppo_stats *stats);

#endif
