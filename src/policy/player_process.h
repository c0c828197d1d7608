// A player in a process of its own: what it does to itself (crash, hang, memory) it does to nobody else. A keeper, forked
// while this process is still simple, forks the worker that opens and runs the player, and the next one when that ends.
#ifndef VSSS_POLICY_PLAYER_PROCESS_H
#define VSSS_POLICY_PLAYER_PROCESS_H

#include "vsss/policy.h"

typedef struct vs_player_process vs_player_process;

// What the worker says of its player.
typedef struct vs_player_about {
  vs_player_sees sees;
  double rate_hz;
  char name[128];
} vs_player_about;

// Starts the worker and waits until it has opened uri. VS_FAIL, VS_USAGE: as vs_player_open said there.
vs_status vs_player_process_open(const char *uri, int patience_ms, vs_player_process **out, vs_player_about *about,
                                 vs_error *err);
void vs_player_process_close(vs_player_process *process); // NULL is allowed

// As those of policy.h. VS_FAIL: failed, crashed or took longer than the patience; then a new worker is being started
// and every call is VS_FAIL, at once, until it is there. It is reset with the last seed.
vs_status vs_player_process_reset(vs_player_process *process, uint64_t seed, vs_error *err);
vs_status vs_player_process_step(vs_player_process *process, const vs_world *view, const vs_game *game, double dt_s,
                                 vs_wheels out[VS_TEAM_SIZE], vs_error *err);
vs_status vs_player_process_act(vs_player_process *process, const float *obs, float *action, vs_error *err);

int64_t vs_player_process_failures(const vs_player_process *process);

#endif
