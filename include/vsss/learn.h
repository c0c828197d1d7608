// Training: PPO self-play (paper, section VII), and the policy files it makes.
#ifndef VSSS_LEARN_H
#define VSSS_LEARN_H

#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// A policy nobody trained (464-256-256-4 from this seed, outputs action, alpha and beta) as an ONNX file: a real
// player for tests and first tries.
vs_status vs_learn_write_untrained(const char *path, uint64_t seed, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
