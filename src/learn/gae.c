#include "gae.h"

#include <stddef.h>

void vs_gae(int steps, int rows, double gamma, double lambda, const float *reward, const float *value,
            const uint8_t *end, const float *cut_value, float *advantage, float *target) {
  for (int row = 0; row < rows; row++) {
    double following = 0.0; // advantage of the next step
    for (int t = steps - 1; t >= 0; t--) {
      size_t i = (size_t)t * (size_t)rows + (size_t)row;
      double next = value[i + (size_t)rows];
      if (end[i] == VS_ENDED) next = 0.0;
      if (end[i] == VS_CUT) next = cut_value[i];
      if (end[i] != VS_GOES_ON) following = 0.0;
      double surprise = reward[i] + gamma * next - value[i];
      following = surprise + gamma * lambda * following;
      advantage[i] = (float)following;
      target[i] = (float)(following + value[i]);
    }
  }
}
