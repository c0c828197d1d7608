// Means with bootstrap intervals, and the summary of a series.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/eval.h"

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double mean_of(const double *values, int n) {
  double sum = 0.0;
  for (int i = 0; i < n; i++) sum += values[i];
  return sum / n;
}

vs_estimate vs_bootstrap(const double *values, int n, uint64_t seed) {
  if (n == 0) return (vs_estimate){NAN, NAN, NAN};
  double means[VS_BOOTSTRAP_RESAMPLES];
  vs_rng rng = vs_rng_make(seed, 0);
  for (int k = 0; k < VS_BOOTSTRAP_RESAMPLES; k++) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += values[vs_rng_below(&rng, (uint32_t)n)];
    means[k] = sum / n;
  }
  qsort(means, VS_BOOTSTRAP_RESAMPLES, sizeof *means, by_value);
  // 2.5 % of the resamples lie below low and 2.5 % above high.
  const int tail = VS_BOOTSTRAP_RESAMPLES / 40;
  return (vs_estimate){mean_of(values, n), means[tail], means[VS_BOOTSTRAP_RESAMPLES - 1 - tail]};
}

vs_estimate vs_rate(int count, int n) {
  if (n == 0) return (vs_estimate){NAN, NAN, NAN};
  const double z = 1.959963984540054; // 97.5 % of the normal distribution
  double p = (double)count / n, middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  double half = z / (1.0 + z * z / n) * sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return (vs_estimate){p, count == 0 ? 0.0 : middle - half, count == n ? 1.0 : middle + half};
}

void vs_match_mirror(const vs_match_result *match, vs_match_result *out) {
  *out = *match;
  for (int t = 0; t < VS_TEAMS; t++) {
    out->score[t] = match->score[!t];
    memcpy(out->events[t], match->events[!t], sizeof out->events[t]);
    out->idle_warnings[t] = match->idle_warnings[!t];
    out->idle_sent_off[t] = match->idle_sent_off[!t];
    out->shoot_out[t] = match->shoot_out[!t];
    memcpy(out->goals_from[t], match->goals_from[!t], sizeof out->goals_from[t]);
  }
  if (match->lot) out->lot = VS_TEAMS + 1 - match->lot;
}

typedef double (*measure_fn)(const vs_match_result *match);

static double goals_for(const vs_match_result *m) { return m->score[VS_BLUE]; }
static double goals_against(const vs_match_result *m) { return m->score[VS_YELLOW]; }
static double difference(const vs_match_result *m) { return goals_for(m) - goals_against(m); }
static vs_estimate estimate(const vs_match_result *const *played, int n, measure_fn measure, double *scratch) {
  for (int i = 0; i < n; i++) scratch[i] = measure(played[i]);
  return vs_bootstrap(scratch, n, 0);
}

static double mean_events(const vs_match_result *const *played, int n, int team, vs_event_kind kind) {
  double sum = 0.0;
  for (int i = 0; i < n; i++) sum += played[i]->events[team][kind];
  return n > 0 ? sum / n : NAN;
}

static double mean_goals_from(const vs_match_result *const *played, int n, int team, vs_event_kind kind) {
  double sum = 0.0;
  for (int i = 0; i < n; i++) sum += played[i]->goals_from[team][kind];
  return n > 0 ? sum / n : NAN;
}

static void sum_up_played(const vs_match_result *const *played, int n, double *scratch, vs_series_summary *out) {
  out->matches = n;
  int won = 0, lost = 0;
  for (int i = 0; i < n; i++)
    won += vs_match_winner(played[i]) == VS_BLUE, lost += vs_match_winner(played[i]) == VS_YELLOW;
  out->win = vs_rate(won, n);
  out->draw = vs_rate(n - won - lost, n);
  out->loss = vs_rate(lost, n);
  out->goals_for = estimate(played, n, goals_for, scratch);
  out->goals_against = estimate(played, n, goals_against, scratch);
  out->score = estimate(played, n, difference, scratch);
  out->penalties_for = mean_events(played, n, VS_BLUE, VS_EVENT_PENALTY);
  out->penalties_against = mean_events(played, n, VS_YELLOW, VS_EVENT_PENALTY);
  out->free_balls =
      mean_events(played, n, VS_BLUE, VS_EVENT_FREE_BALL) + mean_events(played, n, VS_YELLOW, VS_EVENT_FREE_BALL);
  out->goal_kicks =
      mean_events(played, n, VS_BLUE, VS_EVENT_GOAL_KICK) + mean_events(played, n, VS_YELLOW, VS_EVENT_GOAL_KICK);
  out->free_kicks =
      mean_events(played, n, VS_BLUE, VS_EVENT_FREE_KICK) + mean_events(played, n, VS_YELLOW, VS_EVENT_FREE_KICK);
  out->penalty_goals_for = mean_goals_from(played, n, VS_BLUE, VS_EVENT_PENALTY);
  out->penalty_goals_against = mean_goals_from(played, n, VS_YELLOW, VS_EVENT_PENALTY);
  out->free_ball_goals_for = mean_goals_from(played, n, VS_BLUE, VS_EVENT_FREE_BALL);
  out->free_ball_goals_against = mean_goals_from(played, n, VS_YELLOW, VS_EVENT_FREE_BALL);
  double still_s = 0.0;
  for (int i = 0; i < n; i++) {
    out->mean_time_s += played[i]->time_s / n;
    out->extra_time += (played[i]->half >= VS_HALF_EXTRA_1) / (double)n;
    out->shoot_out += (played[i]->half == VS_HALF_SHOOT_OUT) / (double)n;
    out->lot += (played[i]->lot != 0) / (double)n;
    still_s += played[i]->still_s / n;
    for (int t = 0; t < VS_TEAMS; t++) {
      out->idle_warnings[t] += (double)played[i]->idle_warnings[t] / n;
      out->idle_sent_off[t] += (double)played[i]->idle_sent_off[t] / n;
    }
  }
  out->still_share = out->mean_time_s > 0.0 ? still_s / out->mean_time_s : 0.0;
}

vs_status vs_series_sum_up(const vs_match_result *results, int n, vs_series_summary *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  const vs_match_result **played = calloc((size_t)n + 1, sizeof *played);
  double *scratch = calloc((size_t)n + 1, sizeof *scratch);
  vs_status s = played && scratch ? VS_OK : vs_fail(err, VS_FAIL, "out of memory for %d results", n);
  if (s == VS_OK) {
    int count = 0;
    for (int i = 0; i < n; i++)
      if (results[i].played) played[count++] = &results[i];
    sum_up_played(played, count, scratch, out);
  }
  free(played);
  free(scratch);
  return s;
}
