// The two ways of vsss spy.
#ifndef VSSS_CLI_SPY_H
#define VSSS_CLI_SPY_H

#include "vsss/status.h"

// A table in the terminal, renewed every second, for seconds (0: until Ctrl-C).
vs_status spy_print(const char *url, double seconds, vs_error *err);

// Becomes the program lcm-spy with our types; returns only on failure.
vs_status spy_window(const char *url, vs_error *err);

#endif
