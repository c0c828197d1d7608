// Reads what lcm-logger wrote. Our own reader of that simple format, because LCM's takes a cut or damaged file for one
// that ends there; here it is an error with the byte where the damage is.
#ifndef VSSS_BUS_LOG_H
#define VSSS_BUS_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_bus_log vs_bus_log;

typedef struct vs_log_event {
  int64_t number;   // counts from 0
  int64_t utime_us; // since the epoch, when the logger received it
  char channel[64];
  const uint8_t *data; // valid until the next call
  size_t size;
} vs_log_event;

// VS_FAIL: missing, empty, or no log of LCM.
vs_status vs_bus_log_open(const char *path, vs_bus_log **out, vs_error *err);
void vs_bus_log_close(vs_bus_log *log); // NULL is allowed

// Reads the next event; *end: there was none. VS_FAIL: cut off or damaged, with the byte where it starts; all events
// before it were good.
vs_status vs_bus_log_next(vs_bus_log *log, vs_log_event *event, bool *end, vs_error *err);
double vs_bus_log_fraction(const vs_bus_log *log); // of the file's bytes that are read, 0..1
void vs_bus_log_rewind(vs_bus_log *log);

#ifdef __cplusplus
}
#endif
#endif
