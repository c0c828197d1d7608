// Bytes that grow, and the three encodings of protocol buffers that ONNX and TensorBoard files need: varint, fixed
// width, length-delimited.
#ifndef VSSS_LEARN_WIRE_H
#define VSSS_LEARN_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Zero-initialised is empty. After a failed allocation `failed` stays set and further writes do nothing: check once.
typedef struct vs_bytes {
  uint8_t *data; // owned
  size_t size, capacity;
  bool failed;
} vs_bytes;

void vs_bytes_free(vs_bytes *bytes);
void vs_bytes_append(vs_bytes *bytes, const void *data, size_t size);
// The next size bytes, for the caller to fill in before anything else is appended; NULL out of memory.
void *vs_bytes_room(vs_bytes *bytes, size_t size);

void vs_wire_varint(vs_bytes *out, uint64_t value);
void vs_wire_int(vs_bytes *out, int field, int64_t value);
void vs_wire_double(vs_bytes *out, int field, double value);
void vs_wire_float(vs_bytes *out, int field, float value);
void vs_wire_bytes(vs_bytes *out, int field, const void *data, size_t size);
void vs_wire_text(vs_bytes *out, int field, const char *text);
// Appends inner as a nested message and frees it.
void vs_wire_message(vs_bytes *out, int field, vs_bytes *inner);

#endif
