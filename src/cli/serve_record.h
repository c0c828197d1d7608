// A served match as a log of LCM, in the channels of `vsss sim --lcm`: replay, view and lcm-logplayer read it.
#ifndef VSSS_CLI_SERVE_RECORD_H
#define VSSS_CLI_SERVE_RECORD_H

#include "vsss/serve.h"

typedef struct serve_record serve_record;

// uri: names of the teams, outlive the record.
vs_status serve_record_open(const char *path, const char *const uri[VS_TEAMS], serve_record **out, vs_error *err);
vs_status serve_record_frame(serve_record *record, const vs_hosted *match, const vs_hosted_said *said, vs_error *err);
void serve_record_close(serve_record *record); // NULL is allowed

#endif
