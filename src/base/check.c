#include "vsss/check.h"

#include <math.h>

bool vs_all_finite(const double *numbers, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(numbers[i])) return false;
  return true;
}

bool vs_all_finite_floats(const float *numbers, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(numbers[i])) return false;
  return true;
}

bool vs_are_bools(const void *bools, size_t count) {
  const unsigned char *byte = bools;
  for (size_t i = 0; i < count * sizeof(bool); i++)
    if (byte[i] > 1) return false;
  return true;
}

bool vs_is_permutation(const int *numbers, int count) {
  for (int value = 0; value < count; value++) {
    int found = 0;
    for (int i = 0; i < count; i++) found += numbers[i] == value;
    if (found != 1) return false;
  }
  return true;
}
