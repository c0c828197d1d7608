// The unit of the critic: deviations of the returns from their mean, so that its loss has the same size whatever the reward
// (Pop-Art, van Hasselt et al. 2016). The only file that converts between it and reward units.
#ifndef VSSS_LEARN_VALUE_SCALE_H
#define VSSS_LEARN_VALUE_SCALE_H

#include <stdbool.h>

#include "group.h"
#include "net.h"

// In reward units. Off: mean 0 and deviation 1 for good, and the critic speaks in reward units.
typedef struct vs_value_scale {
  bool on;
  double mean, deviation;
  double weight, sum, squares; // decayed sums over the value targets: how many, theirs, of their squares
} vs_value_scale;

vs_value_scale vs_value_scale_make(bool on);

// A critic's output in reward units.
float vs_value_in_reward(const vs_value_scale *scale, float value);

// What a batch has of values.
typedef struct vs_value_batch {
  int rows;
  float *target;      // [rows]: in reward units before, in the critic's unit after
  float *old_value;   // [rows], written: `value` in the critic's unit
  const float *value; // [rows]: what the critic said when it played, in reward units
} vs_value_batch;

// The scale follows the targets of all ranks; the critic's last layer follows the scale, so that what it says in reward
// units stays the same; targets and old values follow into the critic's unit. group NULL: alone.
vs_status vs_value_scale_follow(vs_value_scale *scale, const vs_group *group, const vs_value_batch *batch,
                                const vs_net *net, float *parameters, vs_error *err);

// Its two halves, for tests. Off: update does nothing.
void vs_value_scale_update(vs_value_scale *scale, double count, double sum, double squares);
void vs_value_scale_fit(const vs_value_scale *from, const vs_value_scale *to, const vs_net *net, float *parameters);

#endif
