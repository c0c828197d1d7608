// A log that is whole but holds no more than one command, for commands that want a record of the field.
#ifndef VSSS_TESTS_CLI_COMMAND_LOG_H
#define VSSS_TESTS_CLI_COMMAND_LOG_H

#include <stdio.h>

#include "assert_near.h"
#include "vsss/bus.h"

static inline void write_log_of_a_command(const char *path) {
  char url[160];
  snprintf(url, sizeof url, "file://%s?mode=w", path);
  vs_bus *log;
  assert_ok(vs_bus_open(url, &log, err));
  vs_message m = {.channel = VS_CH_CMD};
  assert_ok(vs_bus_publish(log, &m, err));
  vs_bus_close(log);
}

#endif
