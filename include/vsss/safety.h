// The last word before the radio, on the field only: may the wheels' commands go out, or do the robots stop? A table of
// states and transitions, pure: the clock is passed in. Whatever is not known to be well is a stop.
//
// This watches over what the program decides. Behind it the radio link stops the robots when commands grow old, and
// behind that the robots stop themselves when the radio falls silent (radio_link.h, firmware.h).
#ifndef VSSS_SAFETY_H
#define VSSS_SAFETY_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/radio_link.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// A command from a frame older than this is none: one and a half decision periods, as long as the radio repeats one.
#define VS_SAFETY_STALE_US VS_RADIO_STALE_US

typedef enum vs_safety_state {
  VS_SAFETY_UNARMED,  // nobody has said that the robots may move
  VS_SAFETY_RUNNING,  // the only state in which commands go out
  VS_SAFETY_HALTED,   // by the referee
  VS_SAFETY_DARK,     // the camera is gone
  VS_SAFETY_BLIND,    // none of our robots is seen
  VS_SAFETY_NO_BALL,  // the ball was never seen, or not for too long
  VS_SAFETY_MINDLESS, // the player failed and is being started again
  VS_SAFETY_STALE,    // no command, or its frame is too old
  VS_SAFETY_FAULT,    // a number is none: until disarmed
  VS_SAFETY_SHUTDOWN, // the program ends: for good
  VS_SAFETY_STATES
} vs_safety_state;

// What holds now; the table's conditions.
enum {
  VS_SAFETY_IF_SHUTDOWN = 1,
  VS_SAFETY_IF_ARMED = 2,
  VS_SAFETY_IF_HALTED = 4,
  VS_SAFETY_IF_SANE = 8,   // all numbers of world and command are finite, positions are near the field
  VS_SAFETY_IF_SEEN = 16,  // at least one own robot is valid
  VS_SAFETY_IF_FRESH = 32, // the command is younger than VS_SAFETY_STALE_US and than the stop it would end
  VS_SAFETY_IF_CAMERA = 64,
  VS_SAFETY_IF_BALL = 128,
  VS_SAFETY_IF_PLAYER = 256,
  VS_SAFETY_CONDITIONS = 512,
};

typedef struct vs_safety_input {
  int64_t now_us; // monotonic, as are the others
  bool armed;     // the operator lets the robots move
  bool shutdown;
  bool no_camera, no_ball, no_player; // gone, lost, failed
  vs_event_kind referee;              // what it last said: HALT and END stop, everything else lets play
  vs_team team;
  const vs_world *world; // tracked, absolute frame; NULL: none yet
  bool seen_elsewhere;   // no world here: who commands sees the robots (a bridge)
  // Moment of the newest frame that control was stepped with, which decided or held the command on purpose; 0: none yet.
  int64_t command_us;
  vs_wheels wheels[VS_TEAM_SIZE]; // the command
} vs_safety_input;

// Plain data: a copy is a snapshot.
typedef struct vs_safety {
  vs_safety_state state;
  int64_t since_us;                   // when it came into this state
  uint64_t entered[VS_SAFETY_STATES]; // how often, for the report
} vs_safety;

void vs_safety_init(vs_safety *safety, int64_t now_us); // UNARMED
// Judges one moment: out gets what may be sent. In RUNNING the command, limited to +-VS_WHEEL_LIMIT_RADPS, zero for each
// robot that is not seen; in all other states zeros, to be sent as STOP. Returns the state.
vs_safety_state vs_safety_step(vs_safety *safety, const vs_safety_input *input, vs_wheels out[VS_TEAM_SIZE]);

// The table itself: the state after one look at conditions (bits above).
vs_safety_state vs_safety_next(vs_safety_state state, unsigned conditions);
const char *vs_safety_name(vs_safety_state state);   // "running", "halted", ...
const char *vs_safety_reason(vs_safety_state state); // a sentence for the operator: why the robots stand; "" in RUNNING

#ifdef __cplusplus
}
#endif
#endif
