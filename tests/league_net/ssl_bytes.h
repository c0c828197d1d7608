// A sender of SSL-Vision's wrapper, written byte by byte from the description of its fields: protobuf's wire format.
#ifndef VSSS_TESTS_LEAGUE_NET_SSL_BYTES_H
#define VSSS_TESTS_LEAGUE_NET_SSL_BYTES_H

#include <stdint.h>
#include <string.h>

typedef struct ssl_bytes {
  uint8_t data[1400];
  size_t size;
} ssl_bytes;

static inline void put_key(ssl_bytes *b, int field, int wire) { b->data[b->size++] = (uint8_t)(field << 3 | wire); }
static inline void put_varint(ssl_bytes *b, int field, uint32_t value) {
  put_key(b, field, 0);
  for (; value > 127; value >>= 7) b->data[b->size++] = (uint8_t)(value | 128);
  b->data[b->size++] = (uint8_t)value;
}
static inline void put_float(ssl_bytes *b, int field, float value) { // little-endian, as every machine we run on
  put_key(b, field, 5);
  memcpy(b->data + b->size, &value, 4);
  b->size += 4;
}
static inline void put_double(ssl_bytes *b, int field, double value) {
  put_key(b, field, 1);
  memcpy(b->data + b->size, &value, 8);
  b->size += 8;
}
static inline void put_message(ssl_bytes *b, int field, const ssl_bytes *inner) {
  put_key(b, field, 2);
  size_t size = inner->size;
  for (; size > 127; size >>= 7) b->data[b->size++] = (uint8_t)(size | 128);
  b->data[b->size++] = (uint8_t)size;
  memcpy(b->data + b->size, inner->data, inner->size);
  b->size += inner->size;
}

// confidence 1, x 3, y 4, pixel_x 6, pixel_y 7.
static inline void put_ball(ssl_bytes *detection, float confidence, double x_m, double y_m) {
  ssl_bytes b = {.size = 0};
  put_float(&b, 1, confidence);
  put_varint(&b, 2, 60);
  put_float(&b, 3, (float)(1000 * x_m));
  put_float(&b, 4, (float)(1000 * y_m));
  put_float(&b, 6, 320);
  put_float(&b, 7, 240);
  put_message(detection, 5, &b);
}

// confidence 1, robot_id 2, x 3, y 4, orientation 5, pixel_x 6, pixel_y 7, height 8. field: 6 yellow, 7 blue.
static inline void put_robot(ssl_bytes *detection, int field, uint32_t id, double x_m, double y_m, double theta_rad) {
  ssl_bytes b = {.size = 0};
  put_float(&b, 1, 0.9F);
  put_varint(&b, 2, id);
  put_float(&b, 3, (float)(1000 * x_m));
  put_float(&b, 4, (float)(1000 * y_m));
  put_float(&b, 5, (float)theta_rad);
  put_float(&b, 6, 100);
  put_float(&b, 7, 100);
  put_float(&b, 8, 80);
  put_message(detection, field, &b);
}

// frame_number 1, t_capture 2, t_sent 3, camera_id 4: before the objects.
static inline void put_head(ssl_bytes *detection, uint32_t number, double capture_s) {
  put_varint(detection, 1, number);
  put_double(detection, 2, capture_s);
  put_double(detection, 3, capture_s);
  put_varint(detection, 4, 0);
}

// The datagram: detection 1; with geometry 2, which is skipped: field 1, its length 1 and width 2.
static inline ssl_bytes wrap(const ssl_bytes *detection, int geometry) {
  ssl_bytes b = {.size = 0}, field = {.size = 0}, outer = {.size = 0};
  if (detection) put_message(&b, 1, detection);
  if (!geometry) return b;
  put_varint(&field, 1, 1500);
  put_varint(&field, 2, 1300);
  put_message(&outer, 1, &field);
  put_message(&b, 2, &outer);
  return b;
}

#endif
