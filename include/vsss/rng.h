// Stable: part of libvsss (deploy/docs/library.md).
//
// Counter-based random numbers: number k of stream s of seed x is a pure function of (x, s, k), so that a match
// draws the same numbers whatever thread plays it, and a snapshot is a copy of this struct.
#ifndef VSSS_RNG_H
#define VSSS_RNG_H

#include <stdint.h>

#include "vsss/api.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_rng {
  uint64_t key[2];  // from seed and stream
  uint64_t counter; // numbers drawn so far
} vs_rng;

VSSS_API vs_rng vs_rng_make(uint64_t seed, uint64_t stream);
VSSS_API uint64_t vs_rng_u64(vs_rng *rng);
VSSS_API uint32_t vs_rng_below(vs_rng *rng, uint32_t n);            // [0, n), n >= 1, unbiased
VSSS_API double vs_rng_uniform(vs_rng *rng);                        // [0, 1)
VSSS_API double vs_rng_range(vs_rng *rng, double low, double high); // [low, high)
VSSS_API double vs_rng_normal(vs_rng *rng);                         // mean 0, deviation 1; consumes two numbers
VSSS_API void vs_rng_shuffle(vs_rng *rng, int *items, int n);       // Fisher-Yates

// A seed for a part of a larger whole (match i of a run, robot j of a match).
VSSS_API uint64_t vs_seed_mix(uint64_t seed, uint64_t part);

#ifdef __cplusplus
}
#endif
#endif
