// A league of clubs: who plays, what was played, and the pages that tell it.
#ifndef VSSS_CLI_LEAGUE_H
#define VSSS_CLI_LEAGUE_H

#include <stdio.h>

#include "vsss/serve.h"

enum { LEAGUE_CLUBS = 16, LEAGUE_TEXT = 256, LEAGUE_FORFEIT_GOALS = 10 };

typedef struct league_club {
  char name[48];
  char player[LEAGUE_TEXT];  // URI; empty: a program of its own
  char command[LEAGUE_TEXT]; // started with sh for each match
} league_club;

typedef struct league_file {
  league_club club[LEAGUE_CLUBS];
  int clubs;
  int rounds;                                 // each pair meets so often, half of them... both ways
  double seconds, pause_s, wait_s, silence_s; // silence_s: silent for longer in all, a club has lost
  char rules[32], dialect[16], robot[16], drive[16], folder[LEAGUE_TEXT], ports[64];
  bool realtime, record;
  uint64_t seed;
} league_file;
// VS_USAGE: names file, line and key; also for a club without a name, with none or both of player and command, or whose
// name another has.
vs_status league_file_load(const char *path, league_file *out, vs_error *err);

typedef struct league_result {
  int round, club[VS_TEAMS]; // blue, yellow
  int score[VS_TEAMS];       // as it counts: a forfeit is 0 : LEAGUE_FORFEIT_GOALS
  int forfeits;              // bit t: that team lost by the rules
  char why[160];             // of a forfeit, else ""
} league_result;

// Plays one match. VS_FAIL: something that is no club's fault (ports, disk).
vs_status league_match_play(const league_file *file, league_result *match, const char *log, vs_error *err);

// results[n] of all played so far into FOLDER/results.csv, .json and index.html, each replaced as a whole.
vs_status league_save(const league_file *file, const league_result *results, int n, int of, vs_error *err);
// What is in FOLDER/results.csv; n = 0 where there is none. VS_FAIL: a line that is no result of this league.
vs_status league_load_results(const league_file *file, league_result *results, int most, int *n, vs_error *err);
void league_print_table(const league_file *file, const league_result *results, int n);
void league_log_name(const league_file *file, const league_result *match, char *out, size_t size);

#endif
