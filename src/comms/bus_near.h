// Messages that this machine sent. LCM's C library hands messages on without saying where they come from, and hears the
// whole network; so what moves robots comes through a socket of our own on the same group, which knows the sender.
#ifndef VSSS_COMMS_BUS_NEAR_H
#define VSSS_COMMS_BUS_NEAR_H

#include <stdint.h>

#include "vsss/bus.h"

#define VS_NEAR_MAX 2048 // longer messages are none of those that move robots

typedef struct vs_near {
  int fd;                // 0: not open
  int64_t far;           // messages of our channels from other machines
  uint32_t last_address; // the sender of the last message, network order; 0: none yet
  bool last_near;        // what was found of it ...
  int64_t last_us;       // ... and when
  uint8_t bytes[VS_NEAR_MAX];
} vs_near;

#define VS_NEAR_KNOWN_US 1000000 // for so long a sender's address stays this machine's, or another's

// url: a checked udpm:// one. VS_FAIL: the group cannot be joined.
vs_status vs_near_open(vs_near *near, const char *url, vs_error *err);
void vs_near_close(vs_near *near);

// The next message that waits; false: none does. It lies in near->bytes until the next call.
bool vs_near_read(vs_near *near, const char **channel, const uint8_t **data, size_t *size);

#endif
