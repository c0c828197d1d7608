// Files of points, a line each: what both kinds check of a line before they read it.
#ifndef VSSS_VISION_POINT_LINE_H
#define VSSS_VISION_POINT_LINE_H

#include <stdio.h>
#include <string.h>

#include "vsss/status.h"

// line has just been read by fgets into `size` bytes; what did not fit would be taken for a line of its own.
static inline vs_status vs_point_line_check(FILE *f, const char *path, int number, const char *line, size_t size,
                                            vs_error *err) {
  if (strchr(line, '\n') || feof(f)) return VS_OK;
  return vs_fail(err, VS_USAGE, "%s:%d: line longer than %zu characters", path, number, size - 2);
}

#endif
