#include "vsss/siphash.h"

static uint64_t read_u64(const uint8_t *p, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; i++) value |= (uint64_t)p[i] << (8 * i);
  return value;
}

static uint64_t rotate(uint64_t x, int bits) { return x << bits | x >> (64 - bits); }

static void mix(uint64_t v[4], int rounds) {
  while (rounds--) {
    v[0] += v[1];
    v[2] += v[3];
    v[1] = rotate(v[1], 13) ^ v[0];
    v[3] = rotate(v[3], 16) ^ v[2];
    v[0] = rotate(v[0], 32);
    v[2] += v[1];
    v[0] += v[3];
    v[1] = rotate(v[1], 17) ^ v[2];
    v[3] = rotate(v[3], 21) ^ v[0];
    v[2] = rotate(v[2], 32);
  }
}

static void absorb(uint64_t v[4], uint64_t word) {
  v[3] ^= word;
  mix(v, 2);
  v[0] ^= word;
}

uint64_t vs_siphash(const uint8_t key[VS_SIPHASH_KEY], const uint8_t *bytes, size_t size) {
  uint64_t k0 = read_u64(key, 8), k1 = read_u64(key + 8, 8);
  // The constants spell "somepseudorandomlygeneratedbytes".
  uint64_t v[4] = {k0 ^ 0x736f6d6570736575u, k1 ^ 0x646f72616e646f6du, k0 ^ 0x6c7967656e657261u,
                   k1 ^ 0x7465646279746573u};
  size_t whole = size & ~(size_t)7;
  for (size_t i = 0; i < whole; i += 8) absorb(v, read_u64(bytes + i, 8));
  absorb(v, read_u64(bytes + whole, size - whole) | (uint64_t)size << 56);
  v[2] ^= 0xff;
  mix(v, 4);
  return v[0] ^ v[1] ^ v[2] ^ v[3];
}
