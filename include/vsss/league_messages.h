// The datagrams of the simulation league: FIRASim's (and TraveSim's) world and commands, VSSReferee's calls and
// placements. Structs <-> bytes, pure. Fields and numbers: src/league_net/*.proto. One message a datagram.
//
// Frame, units: world.h's absolute frame is theirs: origin in the centre, blue defends x < 0; m, rad, s, wheels in rad/s
// of a wheel whose radius the simulator and its clients agree on (robot_preset.h).
#ifndef VSSS_LEAGUE_MESSAGES_H
#define VSSS_LEAGUE_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Clients read no more: FIRASim's of 3 against 3 have buffers of 512 bytes, of 5 against 5 of 1024.
#define VS_LEAGUE_DATAGRAM_MAX     512
#define VS_LEAGUE_DATAGRAM_5V5_MAX 1024
// Nothing in the league is longer; a longer datagram is garbage.
#define VS_LEAGUE_RECEIVE_MAX 4096

// VS_FAIL where the program was built without protobuf-c: says what to install.
vs_status vs_league_supported(vs_error *err);

// What the teams see. step: FIRASim counts ms in it, TraveSim 10 ms.
typedef struct vs_fira_environment {
  uint32_t step;
  vs_world world; // a robot that is not valid is left out
  int goals[VS_TEAMS];
} vs_fira_environment;
// Size written; 0: does not fit. decode: robots that are not in it are not valid; time_us and seq are left at 0; the
// division is the one whose field is as long as it says (3 against 3 where it says none).
size_t vs_fira_environment_encode(const vs_fira_environment *environment, uint8_t *out, size_t out_size);
vs_status vs_fira_environment_decode(const uint8_t *data, size_t size, vs_fira_environment *out, vs_error *err);

// What a simulator is told. Rows with a number that is not finite, a robot that no division has (the match knows which it
// has) or a place outside the largest field are left out and counted in dropped.
#define VS_FIRA_ROWS 16
typedef struct vs_fira_packet {
  int commands;
  struct {
    vs_team team;
    int robot;
    vs_wheels wheels;
  } command[VS_FIRA_ROWS];
  bool places_ball;
  vs_ball ball;
  int robots;
  struct {
    vs_team team;
    int robot;
    vs_pose pose;
  } place[VS_FIRA_ROWS];
  int dropped;
} vs_fira_packet;
// degrees: replacements turn robots in degrees (FIRASim), not radians (TraveSim).
size_t vs_fira_packet_encode(const vs_fira_packet *packet, bool degrees, uint8_t *out, size_t out_size);
vs_status vs_fira_packet_decode(const uint8_t *data, size_t size, bool degrees, vs_fira_packet *out, vs_error *err);
// Leaves out, and counts as dropped, what a match of this division has not: its robots and its field.
void vs_fira_packet_fit(vs_fira_packet *packet, vs_division division);

// The referee's calls; the numbers are those of the wire.
typedef enum vs_foul {
  VS_FOUL_FREE_KICK = 0,
  VS_FOUL_PENALTY_KICK,
  VS_FOUL_GOAL_KICK,
  VS_FOUL_FREE_BALL,
  VS_FOUL_KICKOFF,
  VS_FOUL_STOP,
  VS_FOUL_GAME_ON,
  VS_FOUL_HALT,
  VS_FOULS
} vs_foul;
const char *vs_foul_name(vs_foul foul); // "kick-off", "game on", ...

typedef struct vs_ref_command {
  vs_foul foul;
  int team;           // vs_team; -1: nobody's
  int quadrant;       // 1 (+x +y) to 4, counter-clockwise; 0: none
  double timestamp_s; // of the match; 0 where it was no number
  int half;           // 1, 2; 3, 4: of extra time; 5: shoot-out; 0: none
} vs_ref_command;
size_t vs_ref_command_encode(const vs_ref_command *command, uint8_t *out, size_t out_size);
vs_status vs_ref_command_decode(const uint8_t *data, size_t size, vs_ref_command *out, vs_error *err);
// A referee sends each call ten times: whether this is the one before again. One that was corrected (the other team,
// another quadrant at the same second) is not.
bool vs_ref_command_repeats(const vs_ref_command *before, const vs_ref_command *now);

// Where a team wants its robots at a restart.
typedef struct vs_ref_placement {
  vs_team team;
  bool given[VS_TEAM_MOST];
  vs_pose pose[VS_TEAM_MOST];
} vs_ref_placement;
size_t vs_ref_placement_encode(const vs_ref_placement *placement, uint8_t *out, size_t out_size);
// VS_FAIL also for a pose that is not finite or outside the field, and for a team without colour.
vs_status vs_ref_placement_decode(const uint8_t *data, size_t size, vs_ref_placement *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
