// The mean of a run's actors over time, which is what a run exports.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "train_internal.h"

// A young run's networks of long ago play nothing yet: the mean reaches back over a fifth of it at the most.
#define YOUNG_SHARE 0.2

vs_status vs_actor_mean_open(vs_train *t, vs_error *err) {
  if (t->def.export_horizon_m <= 0.0) return VS_OK;
  t->actor_mean = malloc(t->league.size * sizeof *t->actor_mean);
  if (!t->actor_mean) return vs_fail(err, VS_FAIL, "out of memory");
  vs_actor_mean_restart(t);
  return VS_OK;
}

void vs_actor_mean_restart(vs_train *t) {
  if (t->actor_mean) vs_net_extract_actor(&t->learner.net, t->learner.parameters, &t->rollout.actor, t->actor_mean);
}

void vs_actor_mean_follow(vs_train *t, const float *actor, long long rows) {
  if (!t->actor_mean) return;
  double horizon = fmin(t->def.export_horizon_m * 1e6, YOUNG_SHARE * (double)t->transitions);
  float weight = (float)fmin(1.0, (double)rows / horizon);
  for (size_t i = 0; i < t->league.size; i++) t->actor_mean[i] += weight * (actor[i] - t->actor_mean[i]);
}
