#include "vsss/rng.h"

#include <math.h>

#include "vsss/geom.h"

// The finaliser of SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): a bijection of 64 bits with full avalanche.
static uint64_t mix(uint64_t z) {
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

#define GOLDEN UINT64_C(0x9e3779b97f4a7c15)

vs_rng vs_rng_make(uint64_t seed, uint64_t stream) {
  vs_rng rng = {{mix(seed + GOLDEN), mix(mix(stream + 2 * GOLDEN) ^ seed)}, 0};
  return rng;
}

uint64_t vs_rng_u64(vs_rng *rng) {
  uint64_t k = ++rng->counter;
  return mix(mix(k * GOLDEN + rng->key[0]) ^ rng->key[1]);
}

uint32_t vs_rng_below(vs_rng *rng, uint32_t n) {
  // Lemire's multiplication; values of the short first interval are drawn again so that all are equally likely.
  uint32_t threshold = (uint32_t)(-n) % n;
  for (;;) {
    uint64_t product = (vs_rng_u64(rng) >> 32) * n;
    if ((uint32_t)product >= threshold) return (uint32_t)(product >> 32);
  }
}

double vs_rng_uniform(vs_rng *rng) { return (double)(vs_rng_u64(rng) >> 11) * 0x1p-53; }

double vs_rng_range(vs_rng *rng, double low, double high) { return low + (high - low) * vs_rng_uniform(rng); }

double vs_rng_normal(vs_rng *rng) {
  // Box-Muller; the second value is not kept, so that the state stays a plain counter.
  double u = 1.0 - vs_rng_uniform(rng);
  double v = vs_rng_uniform(rng);
  return sqrt(-2.0 * log(u)) * cos(2.0 * VS_PI * v);
}

void vs_rng_shuffle(vs_rng *rng, int *items, int n) {
  for (int i = n - 1; i > 0; i--) {
    int j = (int)vs_rng_below(rng, (uint32_t)i + 1);
    int kept = items[i];
    items[i] = items[j];
    items[j] = kept;
  }
}

uint64_t vs_seed_mix(uint64_t seed, uint64_t part) { return mix(mix(seed + GOLDEN) + part * GOLDEN + 1); }
