#include "tensorboard.h"

uint32_t vs_crc32c(const void *data, size_t size) {
  const uint8_t *byte = data;
  uint32_t crc = 0xffffffffu;
  for (size_t i = 0; i < size; i++) {
    crc ^= byte[i];
    for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0x82f63b78u : 0); // the polynomial, reflected
  }
  return ~crc;
}

// TFRecord stores checksums rotated and shifted, so that a checksum over data with checksums does not cancel out.
static uint32_t masked(uint32_t crc) { return ((crc >> 15) | (crc << 17)) + 0xa282ead8u; }

static void record(vs_bytes *out, vs_bytes *event) {
  uint64_t size = event->size;
  uint32_t size_crc = masked(vs_crc32c(&size, sizeof size)), data_crc = masked(vs_crc32c(event->data, event->size));
  vs_bytes_append(out, &size, sizeof size);
  vs_bytes_append(out, &size_crc, sizeof size_crc);
  vs_bytes_append(out, event->data, event->size);
  vs_bytes_append(out, &data_crc, sizeof data_crc);
  if (event->failed) out->failed = true;
  vs_bytes_free(event);
}

void vs_tensorboard_begin(vs_bytes *out, double wall_time_s) {
  vs_bytes event = {0};
  vs_wire_double(&event, 1, wall_time_s);
  vs_wire_text(&event, 3, "brain.Event:2"); // the format's version
  record(out, &event);
}

void vs_tensorboard_scalar(vs_bytes *summary, const char *tag, double value) {
  vs_bytes entry = {0};
  vs_wire_text(&entry, 1, tag);
  vs_wire_float(&entry, 2, (float)value);
  vs_wire_message(summary, 1, &entry);
}

void vs_tensorboard_event(vs_bytes *out, double wall_time_s, int64_t step, vs_bytes *summary) {
  vs_bytes event = {0};
  vs_wire_double(&event, 1, wall_time_s);
  vs_wire_int(&event, 2, step);
  vs_wire_message(&event, 5, summary);
  record(out, &event);
}
