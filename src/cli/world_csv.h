// Worlds as a table: one row a frame, to compare what was tracked with what was so, or to plot.
#ifndef VSSS_CLI_WORLD_CSV_H
#define VSSS_CLI_WORLD_CSV_H

#include <stdio.h>

#include "vsss/world.h"

typedef struct vs_world_csv {
  FILE *file; // NULL: nothing is written
  char path[512];
} vs_world_csv;

// path NULL: every call does nothing. Columns: time_us of the measurement, seq, the event's name, then per robot
// (blue0 ... yellow2) valid, x_m, y_m, theta_rad, then the ball's valid, x_m, y_m.
vs_status vs_world_csv_open(const char *path, vs_world_csv *out, vs_error *err);
void vs_world_csv_write(vs_world_csv *csv, const vs_world *world, vs_event_kind event);
vs_status vs_world_csv_close(vs_world_csv *csv, vs_error *err); // VS_FAIL: the disk is full

#endif
