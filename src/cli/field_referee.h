// The network referee beside a camera (`field --referee network`): its calls and the operator's word, together, into the
// field's loop.
#ifndef VSSS_CLI_FIELD_REFEREE_H
#define VSSS_CLI_FIELD_REFEREE_H

#include "operator.h"
#include "vsss/field_loop.h"
#include "vsss/net_referee.h"

typedef struct field_referee {
  bool on; // else the operator's word goes to the field as it is
  vs_net_referee net;
  vs_net_word word;
  bool has_places; // the last call named a restart that has some
} field_referee;

bool field_referee_is(const char *source); // "network", or "network:PORTS"
// source that is none: off. go: the operator's word at the start.
vs_status field_referee_open(const char *source, bool go, const char *interface, field_referee *out, vs_error *err);
void field_referee_close(field_referee *referee);

void field_referee_order(field_referee *referee, vs_field *field, vs_order order);
// Takes in what was called; false: nothing new. text: the newest call for people.
bool field_referee_hear(field_referee *referee, vs_field *field, char *text, size_t size);

#endif
