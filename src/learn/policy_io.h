// What lies between the contract's observation and action and the network's: the same in training and in a file.
#ifndef VSSS_LEARN_POLICY_IO_H
#define VSSS_LEARN_POLICY_IO_H

#include <stdbool.h>

typedef struct vs_policy_io {
  bool reversible; // the network sees a robot by the end that faces their goal (vsss/observe.h), before the symmetries
  bool canonical;  // the network sees the canonical one of the symmetric versions (vsss/observe.h)
  int augment;     // training only: ... a version drawn at random after so many decisions; 0: the observation itself
  // Files only: the network is asked about all symmetric versions, and the mean of its answers is the action.
  bool average;
  // action = action_gain (2 u - 1), clipped to [-1, 1]: above 1 full speed is no edge of the density.
  double action_gain;
} vs_policy_io;

#endif
