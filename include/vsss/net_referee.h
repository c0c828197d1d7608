// The league's network referee (VSSReferee) as a team obeys it: a table of states, and the sockets that hear its calls and
// tell it where our robots want to stand. deploy/docs/network_referee.md is the same for people.
#ifndef VSSS_NET_REFEREE_H
#define VSSS_NET_REFEREE_H

#include "vsss/league_messages.h"
#include "vsss/udp.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_net_state {
  VS_NET_WAITING, // no call was heard yet
  VS_NET_PLAY,    // GAME ON
  VS_NET_PLACING, // a foul or kick-off is called: say where we want to stand
  VS_NET_STOPPED, // STOP
  VS_NET_HALTED,  // HALT
  VS_NET_STATES
} vs_net_state;
const char *vs_net_state_name(vs_net_state state);
vs_net_state vs_net_next(vs_foul foul); // whatever the state was

// The operator's word beside it.
typedef enum vs_net_word { VS_NET_UNSAID, VS_NET_GO, VS_NET_STOP } vs_net_word;
// What the robots do: GAME ON is the go, the operator's where no call was heard; the operator's STOP outlives every call.
typedef enum vs_net_task { VS_NET_STAND, VS_NET_TO_PLACES, VS_NET_AT_PLAY } vs_net_task;
vs_net_task vs_net_task_of(vs_net_state state, vs_net_word word);
// Robots may move: after GO, and after any call where the operator said nothing.
bool vs_net_released(vs_net_state state, vs_net_word word);

// A call as an event of ours: NONE where play just stops or goes on.
vs_event vs_net_event(const vs_ref_command *call, double time_s);

typedef struct vs_net_referee {
  vs_udp calls, places;
  vs_net_state state;
  vs_ref_command call; // the newest; foul VS_FOULS: none yet
  int64_t heard, garbage;
} vs_net_referee;

// placement_port 0: our places are told to nobody. interface NULL: loopback.
vs_status vs_net_referee_open(int port, int placement_port, const char *interface, vs_net_referee *out, vs_error *err);
void vs_net_referee_close(vs_net_referee *referee);
// True: there was a new call, call and state are its; ask again, more may wait. Repeats of a call are none.
bool vs_net_referee_hear(vs_net_referee *referee);
bool vs_net_referee_tell(const vs_net_referee *referee, const vs_ref_placement *placement); // false: not sent

#ifdef __cplusplus
}
#endif
#endif
