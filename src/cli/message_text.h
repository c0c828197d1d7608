// A message of the bus as one line, for people and as JSON: what replay and spy show.
#ifndef VSSS_CLI_MESSAGE_TEXT_H
#define VSSS_CLI_MESSAGE_TEXT_H

#include "vsss/bus.h"

// Without newline, cut to fit. JSON: one object with the stamps and every field; numbers that JSON lacks become null.
void vs_message_text(const vs_message *message, char *out, size_t size);
void vs_message_json(const vs_message *message, double time_s, char *out, size_t size);
#define VS_MESSAGE_JSON_MAX 65536

// Replaces in place what a terminal would obey: control characters, also those of UTF-8, become "?". For all that came
// from elsewhere.
void vs_text_clean(char *text);

// "goal by yellow", "free ball in quadrant 2", ...
void vs_event_text(const vs_event *event, char *out, size_t size);

#endif
