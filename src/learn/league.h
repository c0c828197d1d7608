// Who plays against whom. Every match ("slot") has one kind of opponent for the whole run; which frozen self it meets is
// chosen when an episode starts and stays until that episode ends. A result is credited only to the self that played
// the whole episode.
#ifndef VSSS_LEARN_LEAGUE_H
#define VSSS_LEARN_LEAGUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/rng.h"
#include "vsss/status.h"
#include "vsss/world.h"

// SELF: the current policy on both sides, both learn. FROZEN: the paper's rule, one earlier self that is replaced when
// it is beaten. POOL: one of many earlier selves, those that are hard to beat more often. SCRIPT: a player URI.
typedef enum vs_opponent_kind {
  VS_OPPONENT_SELF,
  VS_OPPONENT_FROZEN,
  VS_OPPONENT_POOL,
  VS_OPPONENT_SCRIPT
} vs_opponent_kind;

#define VS_LEAGUE_KINDS_MAX 8
#define VS_LEAGUE_WINDOW    100 // episodes over which the score of the frozen self is taken (paper, section VII-B)

typedef struct vs_league_share {
  vs_opponent_kind kind;
  char uri[96]; // SCRIPT only
  double weight;
} vs_league_share;

typedef struct vs_league_def {
  int shares;
  vs_league_share share[VS_LEAGUE_KINDS_MAX];
  double replace_score; // FROZEN: mean goal difference at which the current weights take its place (paper: 0.6)
  bool
      score_window_zero_filled; // paper's rule: the window starts as zeros and is never cleared; else it must fill first
  int pool_size;                // selves kept
  int pool_every;               // updates between two additions to the pool
} vs_league_def;

// "frozen", "self=0.5,pool=0.3,emc:=0.2": kinds or URIs with weights (1 where none is given).
vs_status vs_league_parse(const char *text, vs_league_def *def, vs_error *err);

// An earlier self: the actor's parameters.
typedef struct vs_frozen_self {
  int id; // counts from 1; 0: a free place
  bool in_pool;
  int users;         // slots whose present episode is against it
  double beaten;     // running mean of the learner's results against it: 1 win, 0.5 draw, 0 loss
  float *parameters; // [size], owned
} vs_frozen_self;

typedef struct vs_league_slot {
  int share;        // of def.share
  vs_team learner;  // the side that learns (SELF: both)
  int self;         // index of the frozen self of the present episode; -1: none
  uint32_t episode; // counts
} vs_league_slot;

// Results against one share of the mix, since the start of the run, and lately (running mean over about 100).
typedef struct vs_league_record {
  long long episodes, wins, draws, losses;
  double recent_score;
} vs_league_record;

typedef struct vs_league {
  vs_league_def def;
  int slots;
  size_t size; // parameters of a self
  uint64_t seed;
  vs_league_slot *slot;
  int selves; // places
  vs_frozen_self *self;
  int frozen; // index of the present one; -1: the mix has no FROZEN
  int next_id;
  int replacements;                // how often the frozen self was replaced
  double window[VS_LEAGUE_WINDOW]; // goal differences against the present frozen self
  int window_at, window_filled;
  vs_league_record record[VS_LEAGUE_KINDS_MAX];
} vs_league;

// actor: the parameters that the first frozen self gets.
vs_status vs_league_init(vs_league *league, const vs_league_def *def, int slots, size_t size, const float *actor,
                         uint64_t seed, vs_error *err);
void vs_league_free(vs_league *league);
void vs_league_begin_episodes(vs_league *league); // of all slots; those that were going on are forgotten

vs_opponent_kind vs_league_kind(const vs_league *league, int slot);
// An episode of a slot ended with these goals of the learner's side and the other: credit it and choose who comes next.
void vs_league_episode_over(vs_league *league, int slot, int goals_for, int goals_against);
// Results against the present frozen self.
typedef struct vs_league_window {
  double sum, count, room; // of goal differences; count == room: full
} vs_league_window;
vs_league_window vs_league_results(const vs_league *league);
double vs_league_window_score(const vs_league_window *window); // mean; 0 where empty
// Once an update, with the new actor and the results of all ranks: replaces the frozen self where it is beaten, adds to
// the pool where it is time. replaced (may be NULL) tells.
vs_status vs_league_after_update(vs_league *league, long long update, const float *actor,
                                 const vs_league_window *results, bool *replaced, vs_error *err);

#endif
