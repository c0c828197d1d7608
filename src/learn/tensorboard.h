// Event files of TensorBoard: records of length, checksum, data, checksum; the data is an Event message.
#ifndef VSSS_LEARN_TENSORBOARD_H
#define VSSS_LEARN_TENSORBOARD_H

#include "wire.h"

// CRC-32C (Castagnoli), as iSCSI and TFRecord use it.
uint32_t vs_crc32c(const void *data, size_t size);

// Appends the record every file begins with.
void vs_tensorboard_begin(vs_bytes *out, double wall_time_s);

// One event with any number of scalars: begin, add scalars to `summary` (zero-initialised), end.
void vs_tensorboard_scalar(vs_bytes *summary, const char *tag, double value);
void vs_tensorboard_event(vs_bytes *out, double wall_time_s, int64_t step, vs_bytes *summary);

#endif
