// `vsss field --publish firasim:`: the world it sees as FIRASim's Environment, for the league's other tools.
#ifndef VSSS_CLI_FIELD_PUBLISH_H
#define VSSS_CLI_FIELD_PUBLISH_H

#include "vsss/serve.h"
#include "vsss/udp.h"

typedef struct field_publish {
  vs_udp to, claim;
  vs_dialect dialect;
  int port;
  int64_t start_us; // of the first world; 0: none yet
} field_publish;

// where: "firasim:[PORTS]" or "travesim:[PORTS]"; NULL: nothing is published. interface NULL: this machine alone hears it.
// VS_FAIL: somebody publishes there, with the holder.
vs_status field_publish_open(const char *where, const char *interface, field_publish *out, vs_error *err);
void field_publish_close(field_publish *publish);
// Robots that are not valid are left out.
void field_publish_world(field_publish *publish, const vs_world *world, const vs_game *game);

#endif
