// Players that are functions of the caller, and the table of a series of matches.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capi_internal.h"
#include "vsss/eval.h"
#include "vsss/field.h"

static struct {
  char scheme[32];
  vs_capi_begin begin;
  vs_capi_think think;
  vs_capi_end end;
} callers;

static _Atomic uint64_t instances;

// In the block of 64 bytes that a player gets which cannot be copied.
typedef struct caller_state {
  int64_t player;
  uint64_t instance; // 0: none begun
  int failed;
} caller_state;

static void end_instance(caller_state *s) {
  if (s->instance && callers.end) callers.end(s->player, s->instance);
  s->instance = 0;
}

static vs_status begin(void *state, uint64_t seed, const char *options, vs_error *err) {
  caller_state *s = state;
  char *end;
  end_instance(s);
  s->player = strtoll(options, &end, 10);
  if (end == options || *end) return vs_fail(err, VS_USAGE, "player '%s': expected a number", options);
  s->instance = atomic_fetch_add(&instances, 1) + 1;
  s->failed = 0;
  if (callers.begin && callers.begin(s->player, s->instance, seed) != 0)
    return vs_fail(err, VS_FAIL, "the player's function failed at the start of a match");
  return VS_OK;
}

static void think(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels out[VS_TEAM_SIZE]) {
  caller_state *s = state;
  double numbers[VS_CAPI_WORLD], wheels[VS_TEAM_SIZE][2] = {{0}};
  vs_capi_write_world(world, game, numbers);
  if (!s->failed) s->failed = callers.think(s->player, s->instance, numbers, dt_s, wheels[0]);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    out[i] = s->failed ? (vs_wheels){0, 0} : (vs_wheels){wheels[i][0], wheels[i][1]};
}

static void end(void *state) { end_instance(state); }

static const char *failure(const void *state) {
  return ((const caller_state *)state)->failed ? "the player's function failed" : NULL;
}

static vs_status provide(const char *rest, vs_player_given *out, vs_error *err) {
  static const vsss_player_api api = {.version = VSSS_PLAYER_VERSION,
                                      .name = "function",
                                      .rate_hz = VS_CAMERA_HZ,
                                      .init = begin,
                                      .step = think,
                                      .free = end};
  (void)err;
  *out = (vs_player_given){.api = &api, .options = rest, .failure = failure};
  return VS_OK;
}

int vs_capi_players(const char *scheme, vs_capi_begin begin_fn, vs_capi_think think_fn, vs_capi_end end_fn, char *error,
                    size_t error_size) {
  vs_error err = {0};
  if (callers.think)
    return vs_capi_told(vs_fail(&err, VS_USAGE, "functions are registered already, as %s", callers.scheme), &err, error,
                        error_size);
  if (!think_fn || strlen(scheme) + 2 > sizeof callers.scheme)
    return vs_capi_told(vs_fail(&err, VS_USAGE, "scheme '%s': too long, or no function", scheme), &err, error,
                        error_size);
  snprintf(callers.scheme, sizeof callers.scheme, "%s:", scheme);
  callers.begin = begin_fn;
  callers.think = think_fn;
  callers.end = end_fn;
  vs_player_register(callers.scheme, "a function of the program that loaded libvsss", provide);
  return vs_capi_told(VS_OK, &err, error, error_size);
}

static const char *const summary_names[] = {
    "win",           "win_low",           "win_high",           "draw",       "draw_low",      "draw_high",
    "loss",          "loss_low",          "loss_high",          "goals_for",  "goals_for_low", "goals_for_high",
    "goals_against", "goals_against_low", "goals_against_high", "score",      "score_low",     "score_high",
    "penalties_for", "penalties_against", "free_balls",         "goal_kicks", "mean_time_s"};
_Static_assert(sizeof summary_names / sizeof *summary_names == CAPI_SUMMARY, "name every number");

const char *vs_capi_summary(int index) { return index < CAPI_SUMMARY ? summary_names[index] : NULL; }

int vs_capi_sum_up(int n, const double *time_s, const int32_t *score, const int32_t *events, double *summary,
                   char *error, size_t error_size) {
  vs_error err = {0};
  if (n < 1) return vs_capi_told(vs_fail(&err, VS_USAGE, "%d matches: at least 1", n), &err, error, error_size);
  vs_match_result *results = calloc((size_t)n, sizeof *results);
  if (!results) return vs_capi_told(vs_fail(&err, VS_FAIL, "out of memory"), &err, error, error_size);
  for (int i = 0; i < n; i++) {
    results[i].played = true;
    results[i].time_s = time_s[i];
    for (int t = 0; t < VS_TEAMS; t++) {
      results[i].score[t] = score[i * VS_TEAMS + t];
      for (int k = 0; k < VS_EVENT_KINDS; k++)
        results[i].events[t][k] = events[(i * VS_TEAMS + t) * VS_EVENT_KINDS + k];
    }
  }
  vs_series_summary sum;
  vs_status s = vs_series_sum_up(results, n, &sum, &err);
  free(results);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  const vs_estimate estimate[] = {sum.win, sum.draw, sum.loss, sum.goals_for, sum.goals_against, sum.score};
  for (int i = 0; i < 6; i++) {
    summary[3 * i] = estimate[i].mean;
    summary[3 * i + 1] = estimate[i].low;
    summary[3 * i + 2] = estimate[i].high;
  }
  const double rest[5] = {sum.penalties_for, sum.penalties_against, sum.free_balls, sum.goal_kicks, sum.mean_time_s};
  memcpy(summary + 18, rest, sizeof rest);
  return vs_capi_told(VS_OK, &err, error, error_size);
}
