// Writes a policy network as an ONNX file (contract.h: observation -> action, on request alpha and beta).
#ifndef VSSS_LEARN_ONNX_WRITER_H
#define VSSS_LEARN_ONNX_WRITER_H

#include <stdbool.h>

#include "policy_io.h"
#include "vsss/status.h"

// One fully connected layer, y = x W + b. weight float[in][stride], of which the first `out` columns count; bias
// float[out]. Borrowed while writing.
typedef struct vs_onnx_layer {
  int in, out, stride;
  const float *weight, *bias;
} vs_onnx_layer;

// A line of the file's metadata.
typedef struct vs_onnx_note {
  const char *key, *value;
} vs_onnx_note;

// Tanh after every layer but the last, whose 2 * VS_ACTION_SIZE outputs o become alpha, beta = 1 + softplus(o); the
// action is io.action_gain (2 alpha/(alpha+beta) - 1), clipped to [-1, 1]. with_spread makes alpha and beta outputs of the model too.
typedef struct vs_onnx_policy {
  const char *name;
  int layers;
  const vs_onnx_layer *layer;
  vs_policy_io io;
  bool with_spread;
  int notes; // beside "contract" (the hash) and "layout", which are always written
  const vs_onnx_note *note;
} vs_onnx_policy;

vs_status vs_onnx_write(const char *path, const vs_onnx_policy *policy, vs_error *err);

#endif
