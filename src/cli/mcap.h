// An MCAP file (mcap.dev, version 0) of JSON messages: unchunked, uncompressed, with the summary at its end.
#ifndef VSSS_CLI_MCAP_H
#define VSSS_CLI_MCAP_H

#include "vsss/status.h"

#include <stdint.h>
#include <stdio.h>

#define MCAP_CHANNELS 8

typedef struct mcap_topic {
  const char *name, *schema; // schema: JSON Schema of its messages
  const char *schema_name;   // such as one that tools know; NULL: name. All outlive the file
} mcap_topic;

typedef struct mcap_file {
  FILE *out;
  const char *path;
  const mcap_topic *topic;
  int n_topics;
  uint64_t at; // bytes written
  uint64_t messages[MCAP_CHANNELS], first_ns, last_ns;
} mcap_file;

// Topic i is channel i. n_topics up to MCAP_CHANNELS. An existing file is written over.
vs_status mcap_open(const char *path, const mcap_topic *topic, int n_topics, mcap_file *out, vs_error *err);
void mcap_message(mcap_file *file, int topic, uint64_t time_ns, const char *json);
// VS_FAIL: it could not be written, disk full perhaps.
vs_status mcap_close(mcap_file *file, vs_error *err);

#endif
