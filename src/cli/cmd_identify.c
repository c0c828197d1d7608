// vsss identify: what each robot makes of its commands, from a log of the field.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "motion_log.h"
#include "vsss/field.h"
#include "vsss/file.h"

typedef struct robots {
  bool known[VS_TEAM_SIZE];
  vs_identified is[VS_TEAM_SIZE];
} robots;

static void widen(double value, double *low, double *high) {
  *low = fmin(*low, value);
  *high = fmax(*high, value);
}

// A realism file holds ranges: from the least to the most of the robots.
static vs_status write_realism(const char *path, const robots *r, double to_bytes_s, vs_error *err) {
  double latency[2] = {INFINITY, -INFINITY}, tau[2] = {INFINITY, -INFINITY}, gain[2] = {INFINITY, -INFINITY};
  char text[1024];
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (!r->known[i]) continue;
    widen(fmin(to_bytes_s + r->is[i].delay_s, 0.2), &latency[0], &latency[1]);
    // Beyond the simulator's own servo (field.md, Ranges).
    widen(fmax(0, r->is[i].tau_straight_s - VS_SERVO_TAU_S), &tau[0], &tau[1]);
    widen(r->is[i].gain_left, &gain[0], &gain[1]);
    widen(r->is[i].gain_right, &gain[0], &gain[1]);
  }
  int n = snprintf(text, sizeof text,
                   "# Of measured robots, by `vsss identify`. Latency: mid-exposure to wheel; motor_tau_s: beyond the "
                   "servo's own %.0f ms.\nnoise = true\n\n[latency_s]\nlow = %.4f\nhigh = %.4f\n\n[motor_tau_s]\nlow = "
                   "%.4f\nhigh = %.4f\n\n[wheel_gain]\nlow = %.4f\nhigh = %.4f\n",
                   1e3 * VS_SERVO_TAU_S, latency[0], latency[1], tau[0], tau[1], gain[0], gain[1]);
  return vs_file_replace(path, text, (size_t)n, err);
}

static void print_table(const robots *r) {
  printf("%-6s %10s %14s %12s %10s %10s %12s %8s %10s %10s\n", "robot", "delay ms", "straight ms", "turning ms",
         "gain left", "gain right", "limit rad/s", "frames", "left mm", "left deg");
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_identified *k = &r->is[i];
    if (r->known[i])
      printf("%-6d %10.1f %14.1f %12.1f %10.3f %10.3f %12.1f %8d %10.2f %10.2f\n", i, 1e3 * k->delay_s,
             1e3 * k->tau_straight_s, 1e3 * k->tau_turn_s, k->gain_left, k->gain_right, k->limit_radps, k->samples,
             1e3 * k->error_m, k->error_rad * 180 / M_PI);
  }
}

static void print_json(const robots *r, double to_bytes_s) {
  printf("{\"exposure_to_bytes_s\": %.6f, \"robots\": [", to_bytes_s);
  bool first = true;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_identified *k = &r->is[i];
    if (!r->known[i]) continue;
    printf("%s{\"robot\": %d, \"delay_s\": %.6f, \"tau_straight_s\": %.6f, \"tau_turn_s\": %.6f, \"gain_left\": %.5f, "
           "\"gain_right\": %.5f, \"limit_radps\": %.4f, \"frames\": %d, \"error_m\": %.6f, \"error_rad\": %.6f}",
           first ? "" : ", ", i, k->delay_s, k->tau_straight_s, k->tau_turn_s, k->gain_left, k->gain_right,
           k->limit_radps, k->samples, k->error_m, k->error_rad);
    first = false;
  }
  printf("]}\n");
}

static vs_status identify(const vs_motion_log *log, robots *out, vs_error *err) {
  int known = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_motion_robot *r = &log->robot[i];
    vs_error why = {0};
    out->known[i] = vs_identify(r->command, r->commands, r->sight, r->sights, &out->is[i], &why) == VS_OK;
    known += out->known[i];
    if (!out->known[i]) fprintf(stderr, "robot %d: %s\n", i, why.text);
  }
  return known ? VS_OK : vs_fail(err, VS_FAIL, "no robot can be told from this log");
}

int cmd_identify(int argc, char **argv) {
  const char *config = NULL, *out = NULL;
  bool json = false, help;
  const vs_flag flags[] = {
      {"out", VS_FLAG_TEXT, &out, "FILE", "write a realism file for sim, eval and train", 0, 0},
      {"config", VS_FLAG_TEXT, &config, "FILE", "a field.ini with the robots' marks; default: the record's own", 0, 0},
      {"json", VS_FLAG_SWITCH, &json, NULL, "one JSON object", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_flag_list words = {0};
  vs_error err = {0};
  vs_status s =
      vs_args_parse(argc, argv, "identify LOG [flags]",
                    "Delay, time constants and wheel gains of each robot from what it was told and where it was\n"
                    "seen. Record the log with 'vsss field --policy shake: --go --seconds 60 --record LOG'.",
                    flags, &words, &help, &err);
  if (s == VS_OK && help) return 0;
  vs_motion_log log = {0};
  robots found = {0};
  if (s == VS_OK) s = vs_motion_log_read(&words, config, &log, &err);
  if (s == VS_OK) s = identify(&log, &found, &err);
  if (s == VS_OK) {
    double to_bytes_s = 1e-3 * vs_motion_quantile(log.age_ms, log.ages, 0.5);
    if (json)
      print_json(&found, to_bytes_s);
    else
      print_table(&found);
    if (out) s = write_realism(out, &found, to_bytes_s, &err);
    if (out && s == VS_OK && !json) printf("%s: for --realism\n", out);
  }
  vs_motion_log_free(&log);
  return s == VS_OK ? 0 : vs_cli_error("identify", &err);
}
