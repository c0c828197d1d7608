// A league's log on the network again, as it was recorded.
#ifndef VSSS_CLI_SERVE_REPLAY_H
#define VSSS_CLI_SERVE_REPLAY_H

#include "vsss/serve.h"

// Every datagram to the group and port of its kind when it was then, until the end or Ctrl-C. VS_FAIL: no such log, or the ports'
// name is held by another server.
vs_status serve_replay(const char *path, const vs_ports *ports, const char *interface, vs_error *err);

#endif
