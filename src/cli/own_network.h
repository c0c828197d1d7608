// A network of its own for a command and the programs it starts (Linux network namespaces).
#ifndef VSSS_CLI_OWN_NETWORK_H
#define VSSS_CLI_OWN_NETWORK_H

#include "vsss/status.h"

// For the calling thread and all it starts from here on: nothing outside hears them or is heard. Before any thread is
// made. VS_FAIL: the system does not allow it, nothing has changed; or its loopback cannot be opened, see why.
vs_status own_network_enter(vs_error *err);

#endif
