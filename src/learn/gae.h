// Generalised advantage estimation (Schulman et al. 2016; paper, equations 3 and 4).
#ifndef VSSS_LEARN_GAE_H
#define VSSS_LEARN_GAE_H

#include <stdint.h>

// How a transition ended: the episode goes on; it terminated (a goal: nothing follows); it was truncated (the clock ran
// out: something would have followed).
enum { VS_GOES_ON = 0, VS_TERMINATED = 1, VS_TRUNCATED = 2 };

// steps x rows transitions, step-major, [steps][rows] where not said otherwise. Values in reward units. Borrowed.
typedef struct vs_gae_batch {
  int steps, rows;
  double gamma, lambda;
  const float *reward;
  const float *value;           // [steps + 1][rows]: the last row is of the state after the last step
  const uint8_t *end;           // VS_GOES_ON, ...
  const float *truncated_value; // of the last state of a truncated episode; read only there
} vs_gae_batch;

// Writes [steps][rows]: the advantage, and the value target, which is the lambda-return: advantage + value. Neither flows
// back over the end of an episode.
void vs_gae(const vs_gae_batch *batch, float *advantage, float *target);

#endif
