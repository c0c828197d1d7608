// A league of clubs: who plays, what was played, and the pages that tell it.
#ifndef VSSS_CLI_LEAGUE_H
#define VSSS_CLI_LEAGUE_H

#include <stdio.h>

#include "vsss/serve.h"

enum { LEAGUE_CLUBS = 16, LEAGUE_TEXT = 256, LEAGUE_FORFEIT_GOALS = 10, LEAGUE_GROUPS = 4 };

// Round robin of all; a knockout from the start; or round robins in groups, whose first ones go on to a knockout.
typedef enum league_format { LEAGUE_ROUND_ROBIN, LEAGUE_KNOCKOUT, LEAGUE_IN_GROUPS } league_format;

typedef struct league_club {
  char name[48];
  char player[LEAGUE_TEXT];  // URI; empty: a program of its own
  char command[LEAGUE_TEXT]; // started with sh for each match
} league_club;

typedef struct league_file {
  league_club club[LEAGUE_CLUBS];
  int clubs;
  league_format format;
  int groups, advance; // LEAGUE_IN_GROUPS; club i plays in group i % groups; so many of each go on
  int rounds;          // each pair meets so often, half of them... both ways
  double seconds, pause_s, wait_s, silence_s; // silence_s: silent for longer in all, a club has lost
  char rules_name[32], folder[LEAGUE_TEXT];
  vs_division division;
  vs_rules rules;
  vs_drive drive;
  vs_dialect dialect;
  vs_ports ports;
  const vs_robot_preset *robot;
  bool realtime, record, own_network;
  uint64_t seed;
} league_file;
// VS_USAGE: names file, line and key; also for a club without a name, with none or both of player and command, or whose
// name another has.
vs_status league_file_load(const char *path, league_file *out, vs_error *err);

typedef struct league_result {
  int round, club[VS_TEAMS];    // blue, yellow; the knockout's rounds follow those of the round robin
  int score[VS_TEAMS];          // as it counts: a forfeit is 0 : LEAGUE_FORFEIT_GOALS
  int shoot_out[VS_TEAMS], lot; // of a knockout match, as in eval.h
  int forfeits;                 // bit t: that team lost by the rules
  char why[160];                // of a forfeit, else ""
} league_result;

// league_plan.c: who meets whom.
int league_group(const league_file *file, int club);  // 0, 1 ...; 0 without groups
int league_last_group_round(const league_file *file); // 0: a knockout from the start
int league_rounds(const league_file *file);           // with the knockout's
bool league_is_knockout(const league_file *file, const league_result *match);
int league_winner(const league_result *match); // its club; -1: a draw, or both lost by the rules
int league_of(const league_file *file);        // matches in all, if no two clubs lose the same one
// The next match to play after results[n]; false: all are played. VS_FAIL: never.
bool league_next(const league_file *file, const league_result *results, int n, league_result *out);
int league_champion(const league_file *file, const league_result *results, int n); // of a knockout; -1: none yet
const char *league_round_name(const league_file *file, int round); // "final", "semi-final", "round of 8"

typedef struct league_standing {
  int club, played, won, drawn, lost, goals, against, points;
} league_standing;
// One group's table, best first: points, goals' difference, goals, then the file's order. Returns its clubs.
int league_standings(const league_file *file, const league_result *results, int n, int group,
                     league_standing out[LEAGUE_CLUBS]);

// Plays one match. VS_FAIL: something that is no club's fault (ports, disk).
vs_status league_match_play(const league_file *file, league_result *match, const char *log, vs_error *err);

// results[n] of all played so far into FOLDER/results.csv, .json and index.html, each replaced as a whole.
vs_status league_save(const league_file *file, const league_result *results, int n, int of, vs_error *err);
// What is in FOLDER/results.csv; n = 0 where there is none. VS_FAIL: a line that is no result of this league.
vs_status league_load_results(const league_file *file, league_result *results, int most, int *n, vs_error *err);
void league_print_table(const league_file *file, const league_result *results, int n);
void league_log_name(const league_file *file, const league_result *match, char *out, size_t size);

#endif
