// vsss latency: where the time goes between a picture and what the robots make of it, from a log of the field.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "motion_log.h"

#define WINDOW_US 8000000 // a robot's delay is told once for so much of the log

enum { WINDOWS_MAX = 4096 };

// Of one robot, window by window. Returns how many.
static int delays_of(const vs_motion_robot *r, double *out_ms, int capacity) {
  int n = 0;
  for (int from = 0; from < r->sights && n < capacity;) {
    int to = from;
    while (to < r->sights && r->sight[to].time_us - r->sight[from].time_us < WINDOW_US) to++;
    vs_identified is;
    bool whole = to < r->sights || r->sight[to - 1].time_us - r->sight[from].time_us > WINDOW_US / 2;
    if (whole && vs_identify(r->command, r->commands, r->sight + from, to - from, &is, NULL) == VS_OK)
      out_ms[n++] = 1e3 * is.delay_s;
    from = to;
  }
  return n;
}

typedef struct row {
  const char *name;
  double *ms;
  int n;
} row;

static void print_row(const row *r, bool json, bool first) {
  double q[4], mean = 0;
  static const double p[4] = {0.5, 0.95, 0.99, 1};
  for (int i = 0; i < 4; i++) q[i] = vs_motion_quantile(r->ms, r->n, p[i]);
  for (int i = 0; i < r->n; i++) mean += r->ms[i] / r->n;
  if (json)
    printf("%s\"%s\": {\"count\": %d, \"mean_ms\": %.3f, \"p50_ms\": %.3f, \"p95_ms\": %.3f, \"p99_ms\": %.3f, "
           "\"max_ms\": %.3f}",
           first ? "{" : ", ", r->name, r->n, mean, q[0], q[1], q[2], q[3]);
  else
    printf("%-28s %8d %8.1f %8.1f %8.1f %8.1f %8.1f\n", r->name, r->n, mean, q[0], q[1], q[2], q[3]);
}

static vs_status report(const vs_motion_log *log, bool json, vs_error *err) {
  static double ms[VS_TEAM_SIZE][WINDOWS_MAX];
  static const char *const names[VS_TEAM_SIZE] = {"bytes to motion, robot 0", "bytes to motion, robot 1",
                                                  "bytes to motion, robot 2"};
  row rows[1 + VS_TEAM_SIZE] = {{"mid-exposure to bytes", log->age_ms, log->ages}};
  int n = 1;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int windows = delays_of(&log->robot[i], ms[i], WINDOWS_MAX);
    if (windows) rows[n++] = (row){names[i], ms[i], windows};
  }
  if (!json) printf("%-28s %8s %8s %8s %8s %8s %8s\n", "ms", "count", "mean", "p50", "p95", "p99", "max");
  for (int i = 0; i < n; i++) print_row(&rows[i], json, i == 0);
  if (json) printf("}\n");
  if (n == 1)
    return vs_fail(err, VS_FAIL,
                   "no robot moved enough to tell when; record with 'vsss field --policy shake:' for 20 s");
  return VS_OK;
}

int cmd_latency(int argc, char **argv) {
  const char *config = NULL;
  bool json = false, help;
  const vs_flag flags[] = {
      {"config", VS_FLAG_TEXT, &config, "FILE", "a field.ini with the robots' marks; default: the record's own", 0, 0},
      {"json", VS_FLAG_SWITCH, &json, NULL, "one JSON object", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_flag_list words = {0};
  vs_error err = {0};
  vs_status s =
      vs_args_parse(argc, argv, "latency LOG [flags]",
                    "From a picture's mid-exposure to the bytes on the radio, frame by frame, and from those bytes\n"
                    "until the camera sees the wheels act on them, told for each robot once in 8 s (without the\n"
                    "wheels' own time constant: that is 'vsss identify'). Record the log with\n"
                    "'vsss field --policy shake: --go --seconds 60 --record LOG'.",
                    flags, &words, &help, &err);
  if (s == VS_OK && help) return 0;
  vs_motion_log log = {0};
  if (s == VS_OK) s = vs_motion_log_read(&words, config, &log, &err);
  if (s == VS_OK) s = report(&log, json, &err);
  vs_motion_log_free(&log);
  return s == VS_OK ? 0 : vs_cli_error("latency", &err);
}
