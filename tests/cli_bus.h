// For tests that talk to a running vsss over LCM: a bus of their own, and what to do where there is no multicast.
#ifndef VSSS_TESTS_CLI_BUS_H
#define VSSS_TESTS_CLI_BUS_H

#include <stdio.h>
#include <unistd.h>

#include "vsss/bus.h"

// A port of this test's own, so that tests and other programs of the machine do not hear each other. The first call
// fixes it, for children too.
static inline const char *test_bus_url(void) {
  static char url[64];
  if (!url[0]) snprintf(url, sizeof url, "udpm://239.255.76.67:%d?ttl=0", 20000 + (int)(getpid() % 20000));
  return url;
}

// NULL, after a note, where this machine has no multicast route or no LCM.
static inline vs_bus *test_bus_open(void) {
  vs_bus *bus;
  vs_error err = {0};
  if (vs_bus_open(test_bus_url(), &bus, &err) == VS_OK) return bus;
  print_message("note: %s\n", err.text);
  return NULL;
}

#endif
