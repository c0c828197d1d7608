// A match on the league's network: hosted_match.h behind sockets. Sends the world to a multicast group once a frame,
// takes commands, replacements and placements, and speaks as the referee or obeys one.
#ifndef VSSS_SERVE_H
#define VSSS_SERVE_H

#include "vsss/histogram.h"
#include "vsss/hosted_match.h"
#include "vsss/league_log.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_VISION_GROUP     "224.0.0.1"
#define VS_REFEREE_GROUP    "224.5.23.2"
#define VS_SILENCE_REPORT_S 0.5 // simulated, in play
#define VS_REFEREE_REPEATS  10  // of each of the referee's calls

// FIRASim: 60 Hz, steps count ms, all packets come to one port, replacements turn in degrees. TraveSim: 100 Hz, steps
// count 10 ms, replacements come to the command port and a team's commands to a port of its own, radians everywhere.
typedef enum vs_dialect { VS_DIALECT_FIRASIM, VS_DIALECT_TRAVESIM } vs_dialect;
vs_status vs_dialect_parse(const char *name, vs_dialect *out, vs_error *err);
const char *vs_dialect_name(vs_dialect dialect); // also that of its robot preset
int vs_dialect_hz(vs_dialect dialect);

typedef struct vs_ports {
  int vision;          // 10002
  int command;         // 20011: everything; TraveSim: replacements
  int team[VS_TEAMS];  // TraveSim: blue 20013, yellow 20012
  int referee, placer; // 10003 to the teams, 10004 from them
} vs_ports;
vs_ports vs_ports_default(void);
// "+10" adds to all; "vision=10012,command=20021" sets some: vision, command, blue, yellow, referee, placement.
vs_status vs_ports_parse(const char *text, vs_ports *out, vs_error *err);

typedef struct vs_serve_def {
  vs_hosted_def match; // model and robot from the caller
  vs_dialect dialect;
  vs_ports ports;
  const char *interface; // NULL: loopback only
  bool sync;             // a frame as soon as all teams have answered the last, instead of at real time
  double answer_s;       // sync: a team that takes longer is no longer waited for until it is heard again
  vs_league_log *log;    // what is sent to vision's and referee's groups goes there too; the caller's; NULL: none
  bool (*ends)(void);    // asked while it waits for answers: true ends the waiting; NULL: never
} vs_serve_def;
vs_serve_def vs_serve_def_default(void);

typedef struct vs_team_traffic {
  bool heard;        // ever
  int64_t packets;   // with commands of this team
  int64_t commands;  // rows
  int64_t saturated; // wheels that were commanded faster than they go
  int64_t placements, illegal_placements;
  int64_t silences; // times it was silent for more than VS_SILENCE_REPORT_S in play
  double silent_s;  // in all, beyond that
} vs_team_traffic;

typedef struct vs_serve_stats {
  int64_t frames;
  int64_t unsent;               // datagrams the system refused
  int64_t garbage;              // datagrams that were no message, or too long
  int64_t dropped;              // rows of messages with a number, robot or place that cannot be
  int64_t refused_replacements; // while our referee was in charge
  int64_t foreign;              // commands for a team that is not on the network, or on the other's port
  vs_team_traffic team[VS_TEAMS];
  vs_histogram late; // us between when a frame was due and when it was sent; real time only
} vs_serve_stats;

typedef struct vs_serve vs_serve;
// Opens the match and all sockets. VS_FAIL: a port in use, with its holder.
vs_status vs_serve_new(const vs_serve_def *def, vs_serve **out, vs_error *err);
void vs_serve_free(vs_serve *server); // NULL is allowed

// One frame: listens until the frame is due (or answered), plays it, sends it. note (may be NULL): one line worth showing
// (a team appeared, fell silent, placed illegally), else "".
vs_status vs_serve_frame(vs_serve *server, vs_hosted_said *said, char *note, size_t note_size, vs_error *err);

vs_hosted *vs_serve_match(vs_serve *server);
const vs_serve_stats *vs_serve_get_stats(vs_serve *server); // up to now; the server's, until the next call
bool vs_serve_everybody_here(const vs_serve *server);       // all teams of the network were heard

#ifdef __cplusplus
}
#endif
#endif
