#include "ppo.h"

#include <math.h>
#include <stddef.h>

#include "beta.h"
#include "vsss/geom.h"

enum { A = VS_ACTION_SIZE };

// The clipped loss of one row given ln p; returns its derivative by ln p.
static double clipped_surrogate(const vs_ppo_def *def, const vs_ppo_batch *batch, int row, double log_p,
                                vs_ppo_stats *stats) {
  double advantage = batch->advantage[row], log_ratio = log_p - batch->old_log_p[row];
  double ratio = exp(vs_clamp(log_ratio, -20.0, 20.0)), clipped = vs_clamp(ratio, 1.0 - def->clip, 1.0 + def->clip);
  double plain = ratio * advantage, limited = clipped * advantage;
  stats->policy_loss -= fmin(plain, limited);
  stats->kl += ratio - 1.0 - log_ratio; // Schulman's estimator, never negative
  stats->clipped += ratio != clipped;
  return plain > limited ? 0.0 : -plain; // the clipped branch is flat; NaN stays NaN
}

// The policy's part of one row: writes the derivatives by the 2A raw outputs.
static void policy_row(const vs_ppo_def *def, const vs_ppo_batch *batch, int row, const float *raw, double scale,
                       float *d_raw, vs_ppo_stats *stats) {
  vs_beta_terms terms[A];
  double log_p = 0.0;
  for (int k = 0; k < A; k++) {
    terms[k] = vs_beta_evaluate(1.0 + vs_softplus(raw[k]), 1.0 + vs_softplus(raw[A + k]), batch->log_u[row * A + k],
                                batch->log_1_u[row * A + k]);
    log_p += terms[k].log_p;
    stats->entropy += terms[k].entropy;
  }
  double by_log_p;
  if (def->imitate) {
    stats->policy_loss -= log_p;
    by_log_p = -1.0;
  } else {
    by_log_p = clipped_surrogate(def, batch, row, log_p, stats);
  }
  for (int k = 0; k < A; k++) {
    double by_alpha = by_log_p * terms[k].log_p_alpha - def->entropy * terms[k].entropy_alpha;
    double by_beta = by_log_p * terms[k].log_p_beta - def->entropy * terms[k].entropy_beta;
    d_raw[k] = (float)(scale * by_alpha * vs_sigmoid(raw[k]));
    d_raw[A + k] = (float)(scale * by_beta * vs_sigmoid(raw[A + k]));
  }
}

// 0.5 max((v - R)^2, (v_clipped - R)^2) and its derivative by v.
static double value_row(const vs_ppo_def *def, double value, double target, double old, double *by_value) {
  double off = value - target, loss = 0.5 * off * off;
  *by_value = off;
  if (!def->clip_value) return loss;
  double moved = vs_clamp(value - old, -def->clip, def->clip), off_clipped = old + moved - target;
  double loss_clipped = 0.5 * off_clipped * off_clipped;
  if (loss_clipped <= loss) return loss;
  *by_value = moved == value - old ? off_clipped : 0.0;
  return loss_clipped;
}

void vs_ppo_loss(const vs_ppo_def *def, const vs_ppo_batch *batch, const vs_ppo_outputs *outputs, double total_rows,
                 vs_ppo_stats *stats) {
  double scale = 1.0 / total_rows;
  for (int row = 0; row < batch->rows; row++) {
    policy_row(def, batch, row, outputs->raw + row * 2 * A, scale, outputs->d_raw + row * 2 * A, stats);
    double by_value;
    stats->value_loss += value_row(def, outputs->value[row], batch->target[row], batch->old_value[row], &by_value);
    outputs->d_value[row] = (float)(scale * def->value_weight * by_value);
  }
  stats->rows += batch->rows;
}

double vs_ppo_total(const vs_ppo_def *def, const vs_ppo_stats *stats) {
  return (stats->policy_loss - def->entropy * stats->entropy + def->value_weight * stats->value_loss) / stats->rows;
}
