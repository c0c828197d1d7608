// Statistics over many matches: played over threads, each from its own seed, summed up with bootstrap intervals and
// Elo ratings (paper, section VIII: win, draw and loss rate, mean goals for and against, score (17), 95 % intervals).
#ifndef VSSS_EVAL_H
#define VSSS_EVAL_H

#include "vsss/env.h"
#include "vsss/idle.h"

#ifdef __cplusplus
extern "C" {
#endif

// What is kept of one match. Blue is the first player and defends -x throughout; it also has the first kick-off.
typedef struct vs_match_result {
  bool played;
  uint64_t seed, hash; // hash: of all true worlds
  double time_s;       // played
  int score[VS_TEAMS];
  int half;                             // it ended in: 0, 1, or referee.h's VS_HALF_
  int shoot_out[VS_TEAMS];              // kicks scored
  int lot;                              // referee.h
  int events[VS_TEAMS][VS_EVENT_KINDS]; // by the team the event names: goals scored, penalties and goal kicks taken
  int idle_warnings[VS_TEAMS], idle_sent_off[VS_TEAMS]; // idle.h, whatever the match's rules
  int goals_from[VS_TEAMS][VS_EVENT_KINDS]; // goals within VS_SET_PLAY_S of a restart, by its kind; NONE: open play
  double still_s;                           // the ball was slower than VS_LEAGUE_STUCK_MPS
  vs_event_kind set_play;                   // the restart before and its time; NONE: the first kick-off
  double set_play_s;
} vs_match_result;

// A goal this soon after a kick-off, penalty, free ball or goal kick came of it.
#define VS_SET_PLAY_S 5.0

typedef struct vs_series_def {
  vs_env_def env;
  int matches, threads;
  uint64_t seed; // match i has the seed vs_seed_mix(seed, i)
  // Called after each match, one call at a time, from any of the threads. False stops the series: no new match begins
  // and those under way are left.
  bool (*progress)(void *context, int index, const vs_match_result *result);
  // Asked now and then while a match goes on (every simulated second); false stops the series likewise. May be NULL.
  bool (*go_on)(void *context);
  void *context;
} vs_series_def;

// Plays def->matches matches into results[def->matches]. Results do not depend on the number of threads. A match that
// was not finished has played == false.
vs_status vs_series_play(const vs_series_def *def, vs_match_result *results, vs_error *err);

// Plays one match to its end in an env that was made for it.
vs_status vs_match_play(vs_env *env, uint64_t seed, bool (*go_on)(void *context), void *context, vs_match_result *out,
                        vs_error *err);
// What the referee has in the end.
void vs_match_end(const vs_env *env, vs_match_result *result);
int vs_match_winner(const vs_match_result *result); // -1: a draw
// Adds one event of the match to its counts, a goal to those of the restart it came of.
void vs_match_count(vs_match_result *result, const vs_event *event);
// The same for all that a frame brought. idle: all zero at the start of the match.
void vs_match_watch(vs_match_result *result, vs_idle *idle, const vs_env *env, const vs_event *event);

// A mean with the bounds of its 95 % interval: percentiles of the means of VS_BOOTSTRAP_RESAMPLES samples drawn with
// replacement.
#define VS_BOOTSTRAP_RESAMPLES 10000
typedef struct vs_estimate {
  double mean, low, high;
} vs_estimate;
vs_estimate vs_bootstrap(const double *values, int n, uint64_t seed); // n == 0: all NaN
// A rate with the bounds of Wilson's 95 % score interval, which is no point at 0 or 1 (E. B. Wilson, Journal of the
// American Statistical Association 22, 1927). n == 0: all NaN.
vs_estimate vs_rate(int count, int n);

// Seen from blue. Rates in [0, 1], with vs_rate's intervals; the others with the bootstrap's. Goals, score and restarts are per match.
typedef struct vs_series_summary {
  int matches; // played
  vs_estimate win, draw, loss, goals_for, goals_against;
  vs_estimate score; // paper (17): (goals for - goals against) / matches
  double penalties_for, penalties_against, free_balls, goal_kicks, free_kicks;
  double idle_warnings[VS_TEAMS], idle_sent_off[VS_TEAMS];
  double penalty_goals_for, penalty_goals_against, free_ball_goals_for, free_ball_goals_against;
  double still_share; // of the time played
  double mean_time_s;
  double extra_time, shoot_out, lot; // shares of the matches that went so far
} vs_series_summary;
vs_status vs_series_sum_up(const vs_match_result *results, int n, vs_series_summary *out, vs_error *err);

// Elo ratings of n players from points[i * n + j] = matches i won against j plus half the draws, games[i * n + j] =
// matches between them (symmetric). Maximum likelihood with one virtual draw for each pair that played, so that a
// player who always wins stays finite; mean 0; 400 points are odds of 10.
void vs_elo(int n, const double *points, const int *games, double *rating);
// Standard deviations of these ratings, from the curvature of the likelihood; a draw counts as half a win and half a
// loss, so they are rather too large. 95 %: 1.96 of them to either side. VS_FAIL: out of memory.
vs_status vs_elo_deviations(int n, const int *games, const double *rating, double *deviation, vs_error *err);
// The match as the other team saw it: what is blue's becomes yellow's.
void vs_match_mirror(const vs_match_result *match, vs_match_result *out);

#ifdef __cplusplus
}
#endif
#endif
