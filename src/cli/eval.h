// `vsss eval`: what is played, and how it is told.
#ifndef VSSS_CLI_EVAL_H
#define VSSS_CLI_EVAL_H

#include "report.h"

enum { EVAL_MAX_PLAYERS = 32 };

// One row of the table: blue against yellow.
typedef struct eval_pairing {
  const char *uri[VS_TEAMS];
  int player[VS_TEAMS]; // in the list; -1: --blue
  bool swapped;         // --swap: the measured player is yellow, the pairing before has it as blue
  vs_match_result *results;
  vs_series_summary summary;
} eval_pairing;

typedef struct eval_command {
  vs_match_flags match;
  const char *blue, *against, *round_robin, *json, *csv;
  int matches;
  bool swap;
  vs_flag_list name;

  char *names; // the split list
  const char *player[EVAL_MAX_PLAYERS];
  int players;
  eval_pairing *pairings;
  int count, current; // pairings, the one being played
  vs_match_result *results;
  int done; // matches of all pairings
  vs_progress progress;
} eval_command;

// What a player is called: by --name, in the order of --blue (-1, if it plays) and the list, else its URI.
const char *eval_name(const eval_command *c, int player);

void eval_print_head(const eval_command *c);
// What stands below the rows (of a round robin, the table whole) once all is played or stopped.
void eval_print_tables(const eval_command *c);

void eval_write_csv(const eval_command *c, FILE *out);
void eval_write_json(const eval_command *c, FILE *out);

#endif
