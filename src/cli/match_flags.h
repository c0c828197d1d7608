// The flags that say what a match is, shared by the commands that play some.
#ifndef VSSS_CLI_MATCH_FLAGS_H
#define VSSS_CLI_MATCH_FLAGS_H

#include "cli.h"
#include "vsss/env.h"

typedef struct vs_match_flags {
  const char *division, *drive, *rules, *placement, *realism, *predicts;
  bool knockout;
  double seconds;
  uint64_t seed;
  int threads;
} vs_match_flags;

vs_match_flags
vs_match_flags_default(void); // contact drive, paper rules and their length, seed 1, a thread for each processor

// Rows for a command's flag table; m is a vs_match_flags.
#define VS_MATCH_FLAG_ROWS(m)                                                                                            \
  {"seconds", VS_FLAG_REAL, &(m).seconds, "S", "length of a match, simulated; 0: 120, or the league's 600", 0, 7200},    \
      {"seed", VS_FLAG_SEED, &(m).seed, "N", "same seed, same matches, for any number of threads", 0, 0},                \
      {"threads", VS_FLAG_INT, &(m).threads, "N", "matches played at a time", 1, 1024},                                  \
      {"division", VS_FLAG_TEXT, &(m).division, "NAME", "3v3, or 5v5: five robots a team on 2.2 x 1.8 m", 0, 0},         \
      {"drive", VS_FLAG_TEXT, &(m).drive, "NAME", "contact (the reference) or planar (the fast twin)", 0, 0},            \
      {"rules", VS_FLAG_TEXT, &(m).rules, "NAME", "paper, league (the network referee's), serie-a-2023 or larc-2026", 0, \
       0},                                                                                                               \
      {"knockout", VS_FLAG_SWITCH, &(m).knockout, NULL, "a tie is followed by extra time and a shoot-out", 0, 0},        \
      {"placement", VS_FLAG_TEXT, &(m).placement, "NAME", "of restarts: paper, random or mixed", 0, 0},                  \
      {"predicts",                                                                                                       \
       VS_FLAG_TEXT,                                                                                                     \
       &(m).predicts,                                                                                                    \
       "WHO",                                                                                                            \
       "sees the world moved on by --realism's latency: learned players, none or all",                                   \
       0,                                                                                                                \
       0},                                                                                                               \
  {                                                                                                                      \
    "realism", VS_FLAG_TEXT, &(m).realism, "FILE", "sensor and actuator model (INI); default: the paper's noise", 0, 0   \
  }

// Loads the model and fills env, whose players are left NULL, and flags->seconds where it was left to the rules. The
// caller frees the model.
vs_status vs_match_flags_open(vs_match_flags *flags, vs_model **model, vs_env_def *env, vs_error *err);

// about, then the schemes of player URIs with a line of help each, for --help.
void vs_match_flags_about(const char *about, char *out, size_t size);

// "contact drive, paper rules, 120 s, seed 1"
void vs_match_flags_describe(const vs_match_flags *flags, char *out, size_t size);

#endif
