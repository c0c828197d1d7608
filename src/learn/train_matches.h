// The simulator's matches as the rollout sees them.
#ifndef VSSS_LEARN_TRAIN_MATCHES_H
#define VSSS_LEARN_TRAIN_MATCHES_H

#include "rollout.h"
#include "vsss/learn.h"

// Opens model and matches for a run; teams that neither learn nor are frozen selves get their script. both: a player
// for both sides of every match instead (imitation), or NULL.
// rank: of the group, whose ranks play different episodes.
vs_status vs_train_matches_open(const vs_train_def *def, const vs_league *league, int rank, const char *both,
                                vs_matches *out, vs_error *err);

// The first setting in which the matches of two runs differ, so that a snapshot of one is none of the other; NULL: none.
const char *vs_train_matches_differ(const vs_train_def *a, const vs_train_def *b);

#endif
