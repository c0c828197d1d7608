// What travels on a frame stream's socket, in the byte order of the machine both ends share: one hello, then frames,
// each a head and width * height * 3 bytes, red first.
#ifndef VSSS_STREAM_FRAME_WIRE_H
#define VSSS_STREAM_FRAME_WIRE_H

#include <stdint.h>

#define VS_WIRE_HELLO 0x31465356u // "VSF1"
#define VS_WIRE_FRAME 0x52465356u // "VSFR"

typedef struct vs_wire_hello {
  uint32_t magic, width_px, height_px, unused;
  double fps;
} vs_wire_hello;

typedef struct vs_wire_frame {
  uint32_t magic, seq;
  int64_t capture_us; // monotonic clock
} vs_wire_frame;

#endif
