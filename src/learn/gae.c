#include "gae.h"

#include <stddef.h>

void vs_gae(const vs_gae_batch *b, float *advantage, float *target) {
  for (int row = 0; row < b->rows; row++) {
    double following = 0.0; // advantage of the next step
    for (int t = b->steps - 1; t >= 0; t--) {
      size_t i = (size_t)t * (size_t)b->rows + (size_t)row;
      double next = b->value[i + (size_t)b->rows];
      if (b->end[i] == VS_TERMINATED) next = 0.0;
      if (b->end[i] == VS_TRUNCATED) next = b->truncated_value[i];
      if (b->end[i] != VS_GOES_ON) following = 0.0;
      double td_error = b->reward[i] + b->gamma * next - b->value[i];
      following = td_error + b->gamma * b->lambda * following;
      advantage[i] = (float)following;
      target[i] = (float)(following + b->value[i]);
    }
  }
}
