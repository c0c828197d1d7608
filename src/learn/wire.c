#include "wire.h"

#include <stdlib.h>
#include <string.h>

void vs_bytes_free(vs_bytes *bytes) {
  free(bytes->data);
  *bytes = (vs_bytes){0};
}

void *vs_bytes_room(vs_bytes *bytes, size_t size) {
  if (bytes->failed) return NULL;
  if (!bytes->data || bytes->size + size > bytes->capacity) {
    size_t capacity = 2 * bytes->capacity > bytes->size + size ? 2 * bytes->capacity : bytes->size + size + 64;
    uint8_t *grown = realloc(bytes->data, capacity);
    if (!grown) {
      bytes->failed = true;
      return NULL;
    }
    bytes->data = grown;
    bytes->capacity = capacity;
  }
  bytes->size += size;
  return bytes->data + bytes->size - size;
}

void vs_bytes_append(vs_bytes *bytes, const void *data, size_t size) {
  void *room = vs_bytes_room(bytes, size);
  if (room && size) memcpy(room, data, size);
}

// Wire types: 0 varint, 1 eight bytes, 2 length-delimited, 5 four bytes.
static void key(vs_bytes *out, int field, int wire_type) { vs_wire_varint(out, (uint64_t)field << 3 | wire_type); }

void vs_wire_varint(vs_bytes *out, uint64_t value) {
  uint8_t byte[10];
  size_t n = 0;
  do {
    byte[n] = (uint8_t)(value & 0x7f) | (value > 0x7f ? 0x80 : 0);
    value >>= 7;
    n++;
  } while (value);
  vs_bytes_append(out, byte, n);
}

void vs_wire_int(vs_bytes *out, int field, int64_t value) {
  key(out, field, 0);
  vs_wire_varint(out, (uint64_t)value);
}

void vs_wire_double(vs_bytes *out, int field, double value) {
  key(out, field, 1);
  vs_bytes_append(out, &value, sizeof value);
}

void vs_wire_float(vs_bytes *out, int field, float value) {
  key(out, field, 5);
  vs_bytes_append(out, &value, sizeof value);
}

void vs_wire_bytes(vs_bytes *out, int field, const void *data, size_t size) {
  key(out, field, 2);
  vs_wire_varint(out, size);
  vs_bytes_append(out, data, size);
}

void vs_wire_text(vs_bytes *out, int field, const char *text) { vs_wire_bytes(out, field, text, strlen(text)); }

void vs_wire_message(vs_bytes *out, int field, vs_bytes *inner) {
  if (inner->failed) out->failed = true;
  vs_wire_bytes(out, field, inner->data, inner->size);
  vs_bytes_free(inner);
}
