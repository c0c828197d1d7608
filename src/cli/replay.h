// What cmd_replay.c, replay_scan.c and replay_video.c share: one pass over a log.
#ifndef VSSS_CLI_REPLAY_H
#define VSSS_CLI_REPLAY_H

#include "cli.h"
#include "field_config.h"
#include "vsss/bus.h"
#include "vsss/bus_log.h"

#define REPLAY_CHANNELS_MAX 64

typedef struct replay_channel {
  char name[64];
  int64_t messages, bytes, refused; // refused: of ours, but of another version or damaged
} replay_channel;

// What a log holds.
typedef struct replay_summary {
  int64_t events, bytes, first_us, last_us;
  int n_channels;
  replay_channel channel[REPLAY_CHANNELS_MAX];
  bool have_game, have_truth, have_state;
  vs_division division;               // of the last world
  bool found_wanted;                  // a message of a channel that was asked for
  int matches;                        // ends seen
  vs_game game;                       // the last known
  char player[VS_TEAMS][VS_BUS_TEXT]; // last source of each team's commands, "" where there was none
} replay_summary;

// One pass over log from its start. wanted: channels to show every message of; none: the referee's events.
// show: print at all.
typedef struct replay_def {
  vs_flag_list wanted;
  bool json, show;
} replay_def;
vs_status replay_scan(vs_bus_log *log, const replay_def *def, replay_summary *out, vs_error *err);
void replay_print_summary(const char *path, const replay_summary *s, bool json);
bool replay_wants(const vs_flag_list *wanted, const char *channel);

// What the run of such a record was started with.
vs_status replay_setup(vs_bus_log *log, const char *path, vs_field_config *config, vs_error *err);

// Computes a record of `vsss field --record` again and compares every turn. VS_FAIL: the first difference, or no such record.
vs_status replay_check(vs_bus_log *log, const char *path, vs_error *err);

// Draws the log's worlds into a video, in the time of the world.
vs_status replay_video(vs_bus_log *log, const replay_summary *s, const char *path, int fps, vs_error *err);

// Writes the log's worlds, commands and events into an MCAP file, at the times they were received.
vs_status replay_mcap(vs_bus_log *log, const replay_summary *s, const char *path, vs_error *err);

// Sends the log's messages again with the pauses they were received with, divided by speed.
vs_status replay_publish(vs_bus_log *log, const vs_flag_list *wanted, const char *url, double speed, vs_error *err);

#endif
