// Which numbers the backward pass multiplies, where the settings leave it open: those it is faster with here.
#ifndef VSSS_LEARN_PRECISION_H
#define VSSS_LEARN_PRECISION_H

#include "learner.h"

// Seconds of one minibatch's gradient in each, the best of several tries; bf16_s is HUGE_VAL where it cannot be.
typedef struct vs_precision_times {
  double fp32_s, bf16_s;
} vs_precision_times;

// Times def (its precision is not looked at) on this machine with the pool's threads, in less than a second.
vs_status vs_precision_time(const vs_learner_def *def, vs_pool *pool, vs_precision_times *out, vs_error *err);

#endif
