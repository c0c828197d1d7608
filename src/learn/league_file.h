// The league as sections of a checkpoint.
#ifndef VSSS_LEARN_LEAGUE_FILE_H
#define VSSS_LEARN_LEAGUE_FILE_H

#include "archive.h"
#include "league.h"

void vs_league_save(const vs_league *league, vs_bytes *out);
// Into a league of the same settings; new_slots: but for how many slots it has, whose episodes begin anew against the selves of
// the file. VS_FAIL names path and what is wrong; the league must then not be used.
vs_status vs_league_load(vs_league *league, const vs_bytes *archive, const char *path, bool new_slots, vs_error *err);

#endif
