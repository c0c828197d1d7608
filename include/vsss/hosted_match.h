// A match in which teams of other programs play: simulator, referee with its pauses, local players and what came from
// outside, one vision frame at a time. Pure: no sockets, no clock; serve.h carries its messages.
//
// How a restart goes with our own referee: the foul is called; for pause_s teams may drive to their places or send a
// placement; then STOP, and ball and robots are put where they belong (a legal placement that was sent, legal places
// that the team drove to, or the defaults); after pause_s again GAME_ON. The match's clock runs during GAME_ON only. Local
// players stand still but during GAME_ON.
// A team's people may ask for a time-out: the protocol has no message for it, a person tells the referee. It is HALT on the
// network, its team named; then the foul is called anew, since robots were carried about.
#ifndef VSSS_HOSTED_MATCH_H
#define VSSS_HOSTED_MATCH_H

#include "vsss/league_messages.h"
#include "vsss/referee.h"
#include "vsss/robot_preset.h"
#include "vsss/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vs_phase {
  VS_PHASE_WAIT,
  VS_PHASE_CALLED,
  VS_PHASE_STOPPED,
  VS_PHASE_PLAY,
  VS_PHASE_TIME_OUT,
  VS_PHASE_OVER
} vs_phase;
const char *vs_phase_name(vs_phase phase); // "waiting", "called", ...

// OWN: our rules. NONE: open play without end, goals are counted, who may place places. EXTERNAL: a referee on the
// network calls and places; goals are counted.
typedef enum vs_referee_mode { VS_REFEREE_OWN, VS_REFEREE_NONE, VS_REFEREE_EXTERNAL } vs_referee_mode;

typedef struct vs_hosted_def {
  const vs_model *model;        // its frame_hz is the vision's, its division the match's; shared, outlives the match
  const char *player[VS_TEAMS]; // URI, or NULL: from outside
  const vs_robot_preset *robot;
  vs_referee_def referee;
  vs_referee_mode mode;
  double pause_s; // 0: restarts happen at once
  uint64_t seed;
} vs_hosted_def;

// What a frame brought.
#define VS_HOSTED_CALLS 4
typedef struct vs_hosted_said {
  vs_event event; // NONE mostly
  int calls;      // new words of our referee, in order
  vs_ref_command call[VS_HOSTED_CALLS];
} vs_hosted_said;

typedef struct vs_hosted vs_hosted;
vs_status vs_hosted_new(const vs_hosted_def *def, vs_hosted **out, vs_error *err); // in VS_PHASE_WAIT; NONE: in PLAY
void vs_hosted_free(vs_hosted *match);                                             // NULL is allowed

// From outside, at any time. Commands are rad/s of the preset's wheel, held until the next; those of a local team's
// robots, and of robots that the division has not, are ignored (false). Replacements are obeyed but while our own referee is in charge (false). A placement that
// is not legal at the present restart is VS_FAIL with the reason; outside VS_PHASE_CALLED it is ignored.
bool vs_hosted_command(vs_hosted *match, vs_team team, int robot, vs_wheels wheels);
bool vs_hosted_replace(vs_hosted *match, const vs_fira_packet *packet);
vs_status vs_hosted_place(vs_hosted *match, const vs_ref_placement *placement, vs_error *err);
void vs_hosted_hear(vs_hosted *match, const vs_ref_command *call); // EXTERNAL only
void vs_hosted_begin(vs_hosted *match);                            // ends VS_PHASE_WAIT: the first kick-off is called

// A time-out (vs_time_outs_by says how many, how long): at once where play is stopped, else at its next stop. VS_FAIL with
// the reason: none left, asked for already, the match has not begun or is over, another referee is in charge.
vs_status vs_hosted_time_out(vs_hosted *match, vs_team team, vs_error *err);
bool vs_hosted_ready(vs_hosted *match, vs_team team); // ends the team's own before its time; false: has none
int vs_hosted_time_outs_taken(const vs_hosted *match, vs_team team); // the present one too, one that is waited for not

// One frame of 1 / frame_hz. VS_FAIL: a local player or the simulator broke.
vs_status vs_hosted_frame(vs_hosted *match, vs_hosted_said *said, vs_error *err);
int vs_hosted_broken(const vs_hosted *match); // the team whose local player broke; -1: none

const vs_world *vs_hosted_world(const vs_hosted *match); // the truth; everybody sees it
const vs_referee *vs_hosted_referee(const vs_hosted *match);
const vs_game *vs_hosted_game(const vs_hosted *match);
vs_phase vs_hosted_phase(const vs_hosted *match);
const vs_ref_command *vs_hosted_call(const vs_hosted *match);                         // the referee's present word
void vs_hosted_wheels(const vs_hosted *match, vs_wheels out[VS_TEAMS][VS_TEAM_MOST]); // rad/s of our wheels
uint64_t vs_hosted_hash(const vs_hosted *match);
// Simulated time since a team from outside last sent a command; 0 for a local one.
double vs_hosted_silence_s(const vs_hosted *match, vs_team team);

#ifdef __cplusplus
}
#endif
#endif
