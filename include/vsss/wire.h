// What goes over the serial line to robots that speak other teams' protocols: a table of encoders. The formats are facts from
// those teams' published code; each is a one-way street, so what it lacks beside our own (radio_codec.h) is told. Pure.
#ifndef VSSS_WIRE_H
#define VSSS_WIRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_WIRE_BYTES_MAX 96 // of one round for all robots

// encode NULL: our own protocol, with checks, STOP, watchdog and telemetry.
typedef struct vs_wire {
  const char *name, *format;
  const char *lacks; // for the operator; NULL: nothing
  int max_id;        // numbers on the air are 0 to this
  // Writes one round and returns its size. Numbers that are none must not come here.
  size_t (*encode)(const uint8_t id[VS_TEAM_SIZE], const vs_wheels wheels[VS_TEAM_SIZE],
                   uint8_t out[VS_WIRE_BYTES_MAX]);
} vs_wire;

const vs_wire *vs_wire_vsss(void);                                            // the first of the table
vs_status vs_wire_find(const char *name, const vs_wire **out, vs_error *err); // VS_USAGE lists the known ones
const vs_wire *vs_wire_at(int index);                                         // NULL: past the last

#ifdef __cplusplus
}
#endif
#endif
