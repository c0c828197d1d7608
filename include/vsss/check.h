// What a number that came from a file must be before it is used.
#ifndef VSSS_CHECK_H
#define VSSS_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

bool vs_all_finite(const double *numbers, size_t count);
bool vs_all_finite_floats(const float *numbers, size_t count);
// A bool of another value than 0 or 1 must not be read as one.
bool vs_are_bools(const void *bools, size_t count);
// count integers, each of 0 .. count-1 once.
bool vs_is_permutation(const int *numbers, int count);

#ifdef __cplusplus
}
#endif
#endif
