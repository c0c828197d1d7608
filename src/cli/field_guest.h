// `vsss field --camera firasim:`: our team in another simulator of the league; `--camera ssl:`: in a hall with a shared
// vision.
#ifndef VSSS_CLI_FIELD_GUEST_H
#define VSSS_CLI_FIELD_GUEST_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/status.h"
#include "vsss/sender.h"
#include "vsss/serve.h"
#include "vsss/world.h"

typedef struct field_guest {
  // "firasim:[PORTS]", "travesim:[PORTS]", "ssl:[PORT]" or "vss-vision:PORT"; radio: of the simulator, or beside a shared
  // vision also our own (sender); neither: a dry run
  const char *camera, *radio;
  const vs_sender_def *sender;
  const char *policy;
  vs_team team;
  uint64_t seed;
  double duration_s, seconds; // of the match; then stop (0: until Ctrl-C)
  const char *record;         // CSV, may be NULL
  bool go;                    // play before the network referee has called anything
  const char *interface;      // of the hall's network; NULL: this machine alone
  const char *publish;        // where what is seen goes (field_publish.h); NULL: nowhere
  const char *words;          // a file that says go and stop beside the keys (operator.h); NULL: none
} field_guest;

bool field_guest_is(const char *source); // a simulator's, or a shared vision
// What follows the name and its colon, the ports; NULL: not a simulator's.
const char *field_guest_rest(const char *source, vs_dialect *dialect);
vs_status field_guest_play(const field_guest *guest, vs_error *err);

#endif
