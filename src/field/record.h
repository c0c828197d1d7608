// What a run needs to be computed again, in a log of LCM: how it was started, then every turn of the loop, and between
// them what goes out on the bus.
#ifndef VSSS_FIELD_RECORD_H
#define VSSS_FIELD_RECORD_H

#include "vsss/detect.h"
#include "vsss/field_loop.h"
#include "vsss/tick.h"

typedef struct vs_record {
  vs_bus *bus; // a file; NULL: no record
  int32_t seq;
  int64_t lost; // messages that could not be written
  uint8_t bytes[VS_TICK_BYTES];
} vs_record;

// Begins the file and writes the setup, def->config_file and def->calib into it. start: of this run.
vs_status vs_record_open(vs_record *record, const vs_field_def *def, const vs_field_rerun *start, vs_error *err);
void vs_record_close(vs_record *record);
void vs_record_tick(vs_record *record, vs_tick *tick);

// Detections into a tick, and back.
void vs_record_seen(const vs_detections *seen, vs_tick *tick);
void vs_record_see_again(const vs_tick *tick, vs_detections *seen);

#endif
