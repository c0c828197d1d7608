// What a log of the field says of its robots: what they were told, when, and where the camera saw them.
#ifndef VSSS_CLI_MOTION_LOG_H
#define VSSS_CLI_MOTION_LOG_H

#include "cli.h"
#include "vsss/identify.h"

typedef struct vs_motion_robot {
  vs_motion_command *command;
  vs_motion_sight *sight;
  int commands, sights;
} vs_motion_robot;

typedef struct vs_motion_log {
  vs_motion_robot robot[VS_TEAM_SIZE];
  double *age_ms; // of each command: from mid-exposure of its frame to its bytes
  int ages;
  vs_team team;
  int capacity;
} vs_motion_log;

// From a command's words, which must be one log. config NULL: the log's own, or where it has none deploy/config/field.ini. VS_FAIL: no commands or no detections in it.
vs_status vs_motion_log_read(const vs_flag_list *words, const char *config, vs_motion_log *out, vs_error *err);
void vs_motion_log_free(vs_motion_log *log);

// p of 0..1 of n values, which it sorts; 0 where there are none.
double vs_motion_quantile(double *value, int n, double p);

#endif
