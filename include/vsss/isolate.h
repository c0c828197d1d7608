// A player in a process of its own, for where nothing may end the program (the field): what it does to itself, such as a
// crash, a hang or a leak, it does to nobody else.
#ifndef VSSS_ISOLATE_H
#define VSSS_ISOLATE_H

#include "vsss/policy.h"

#ifdef __cplusplus
extern "C" {
#endif

// As vs_player_open. A player that fails, crashes or has not answered after patience_ms is ended, started anew and reset
// with its last seed; meanwhile every call is VS_FAIL, at once. Called before the program starts threads: it forks. Such a
// player cannot be snapshotted.
vs_status vs_player_open_isolated(const char *uri, int patience_ms, vs_player **out, vs_error *err);
int64_t vs_player_failures(const vs_player *player); // of an isolated player so far; of any other 0

// For a run that is computed again: in this process, as vs_player_open, but to be told where it failed. After
// vs_player_fail_next its next call is VS_FAIL, and it goes on as one started anew and reset with its last seed.
vs_status vs_player_open_rerun(const char *uri, vs_player **out, vs_error *err);
void vs_player_fail_next(vs_player *player); // does nothing to any other

#ifdef __cplusplus
}
#endif
#endif
