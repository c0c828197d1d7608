// Trained networks as ONNX files.
#ifndef VSSS_LEARN_EXPORT_H
#define VSSS_LEARN_EXPORT_H

#include "net.h"
#include "onnx_writer.h"

// Writes the actor of a net (with or without critic) whose inputs and actions are the contract's.
vs_status vs_export_actor(const char *path, const vs_net *net, const float *parameters, const char *name,
                          bool with_spread, const vs_onnx_note *notes, int note_count, vs_error *err);

#endif
