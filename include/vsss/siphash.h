// SipHash-2-4, the keyed hash for short messages of J.-P. Aumasson and D. J. Bernstein (2012). Freestanding: also part of a
// robot's firmware.
#ifndef VSSS_SIPHASH_H
#define VSSS_SIPHASH_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define VS_SIPHASH_KEY 16

// Without the key nobody computes it, and one of the message's bits changes half of its own.
uint64_t vs_siphash(const uint8_t key[VS_SIPHASH_KEY], const uint8_t *bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
