// The Beta distribution of one wheel on [0, 1]: densities, entropies, their derivatives, samples.
#ifndef VSSS_LEARN_BETA_H
#define VSSS_LEARN_BETA_H

#include "vsss/rng.h"

// ln Gamma(x) and its first two derivatives, x >= 1. Absolute error below 1e-10 (x <= 1e6: relative).
typedef struct vs_gamma_values {
  double log_gamma, digamma, trigamma;
} vs_gamma_values;
vs_gamma_values vs_gamma_at(double x);

// A sample u is kept this far from 0 and 1, so that its logarithms are finite (paper.md, Action).
#define VS_BETA_EDGE 1e-7

// alpha, beta = 1 + softplus(raw), and d alpha/d raw.
double vs_softplus(double x);
double vs_sigmoid(double x);

// Log-density of u (given ln u and ln(1-u)) and entropy, in nats on [0, 1], with their derivatives.
typedef struct vs_beta_terms {
  double log_p, log_p_alpha, log_p_beta;
  double entropy, entropy_alpha, entropy_beta;
} vs_beta_terms;
vs_beta_terms vs_beta_evaluate(double alpha, double beta, double log_u, double log_1_u);
double vs_beta_log_density(double alpha, double beta, double log_u, double log_1_u);

// u in [VS_BETA_EDGE, 1 - VS_BETA_EDGE]; alpha, beta >= 1.
double vs_beta_sample(double alpha, double beta, vs_rng *rng);

#endif
