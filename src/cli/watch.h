// Who looks on while a match is played: called after every camera frame, and once at the start of each match with a
// kick-off event. The match does not depend on its watchers.
#ifndef VSSS_CLI_WATCH_H
#define VSSS_CLI_WATCH_H

#include "vsss/env.h"

typedef struct vs_watch_view {
  vs_env *env;           // to be read only
  int match;             // 0, 1, ...
  const vs_event *event; // VS_EVENT_NONE mostly
} vs_watch_view;

typedef struct vs_watcher {
  void *state;
  vs_status (*frame)(void *state, const vs_watch_view *view, vs_error *err);
  vs_status (*close)(void *state, vs_error *err); // once, also after an error; NULL: nothing to do
} vs_watcher;

// Publishes truth, measured state, commands, decisions of learned players and the referee over LCM. url NULL: default.
vs_status vs_watch_bus(const char *url, const char *const uri[VS_TEAMS], vs_watcher *out, vs_error *err);

// Writes an MP4 of the matches, off screen.
vs_status vs_watch_video(const char *path, const char *title, vs_division division, vs_watcher *out, vs_error *err);

#endif
