// Trained networks as ONNX files.
#ifndef VSSS_LEARN_EXPORT_H
#define VSSS_LEARN_EXPORT_H

#include "net.h"
#include "onnx_writer.h"

// What to say of a network in its file.
typedef struct vs_export_def {
  const char *name;
  vs_policy_io io;
  bool with_spread; // alpha and beta are outputs too
  const vs_onnx_note *note;
  int notes;
} vs_export_def;

// Writes the actor of a net (with or without critic) whose inputs and actions are the contract's.
vs_status vs_export_actor(const char *path, const vs_net *net, const float *parameters, const vs_export_def *def,
                          vs_error *err);

#endif
