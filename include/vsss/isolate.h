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

#ifdef __cplusplus
}
#endif
#endif
