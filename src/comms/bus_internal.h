// Shared by the files of the bus.
#ifndef VSSS_COMMS_BUS_INTERNAL_H
#define VSSS_COMMS_BUS_INTERNAL_H

#include "vsss/bus.h"

// Checks url before LCM sees it, because LCM prints by itself what it does not like. VS_USAGE: wrong; VS_FAIL: no
// multicast route to its address.
vs_status vs_bus_url_check(const char *url, vs_error *err);

// The error of a machine without a multicast route, with the commands that mend it.
vs_status vs_bus_no_route(const char *url, vs_error *err);

#endif
