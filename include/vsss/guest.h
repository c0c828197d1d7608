// Our team as a guest in another simulator of the league (FIRASim, TraveSim, `vsss serve`) or in a hall with a shared vision
// (SSL-Vision's messages): world from there, wheel commands to the simulator's radio or to our own robots', moved by the network referee: GAME ON is the go. The same control and safety as on the field; the simulator's
// vision needs no tracker.
#ifndef VSSS_GUEST_H
#define VSSS_GUEST_H

#include "vsss/net_referee.h"
#include "vsss/safety.h"
#include "vsss/sender.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_guest_def {
  const char *policy; // player URI
  vs_team team;       // blue attacks +x
  uint64_t seed;
  double duration_s;                       // of the match, for the policy's clock
  double wheel_radius_m;                   // of the simulator's robots: 0.02 in FIRASim, 0.025 in TraveSim
  double step_s;                           // what the vision's step counts: 0.001 in FIRASim, 0.01 in TraveSim
  int vision, command, referee, placement; // ports
  bool ssl;                                // the vision is SSL-Vision's; step_s is not used
  bool unicast;                            // and comes to this machine's port, not to a group
  const vs_sender_def *radio;              // commands to robots of our own; NULL: to the simulator
  bool go;                                 // play before any call was heard, as where there is no referee
  bool dry;                                // send nothing
  const char *interface;                   // NULL: loopback
} vs_guest_def;

typedef struct vs_guest_tick_result {
  bool seen; // a world came; the rest is valid then
  vs_world world;
  vs_game game;
  vs_net_state state; // by the referee's calls
  vs_safety_state safety;
  vs_wheels wheels[VS_TEAM_SIZE]; // rad/s of our wheels
} vs_guest_tick_result;

typedef struct vs_guest_stats {
  int64_t worlds, decisions, calls, placements, garbage;
} vs_guest_stats;

typedef struct vs_guest vs_guest;
vs_status vs_guest_new(const vs_guest_def *def, vs_guest **out, vs_error *err);
void vs_guest_free(vs_guest *guest); // the robots stop; NULL is allowed
// The operator's word: go plays where no call was heard; a stop holds whatever the referee calls, until the next go.
void vs_guest_arm(vs_guest *guest, bool go);
// Waits up to 100 ms for the newest world and answers it.
vs_status vs_guest_tick(vs_guest *guest, vs_guest_tick_result *out, vs_error *err);
const vs_guest_stats *vs_guest_get_stats(vs_guest *guest);

#ifdef __cplusplus
}
#endif
#endif
