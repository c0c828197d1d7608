// Where a frame's time went, for people and as JSON.
#ifndef VSSS_CLI_FIELD_REPORT_H
#define VSSS_CLI_FIELD_REPORT_H

#include "vsss/field_loop.h"

void vs_field_report_print(const vs_field_stats *stats);
vs_status vs_field_report_json(const char *path, const vs_field_stats *stats, vs_error *err);

#endif
