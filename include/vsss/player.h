// Stable: part of libvsss (deploy/docs/library.md).
//
// The interface of a player that is code: built-in strategies and teams' own plugins alike. A plugin is a shared
// object that exports one function, `const vsss_player_api *vsss_player(void)`, and is opened as plugin:FILE.so.
//
// A player keeps all it remembers in one flat block of state_size bytes that the caller allocates (aligned to 64
// bytes): copying the block is a snapshot. No pointers into itself. One state per match; a player never shares state.
#ifndef VSSS_PLAYER_H
#define VSSS_PLAYER_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// 2: worlds with room for five robots a team, and divisions; 1 goes on to be played, 3 against 3.
#define VSSS_PLAYER_VERSION 2

#define VSSS_PLAYS(division) (UINT32_C(1) << (division))

typedef struct vsss_player_api {
  uint32_t version;  // VSSS_PLAYER_VERSION
  const char *name;  // for tables and messages
  double rate_hz;    // how often step is called: VS_CAMERA_HZ or a divisor of it
  size_t state_size; // at least 1

  // Start of a match; the block is zeroed once, when it is made. options is what followed "?" in the URI ("pid=1&x=2",
  // "" if nothing). Returns VS_OK, or fills err->text and returns VS_FAIL or VS_USAGE.
  vs_status (*init)(void *state, uint64_t seed, const char *options, vs_error *err);

  // One call: the measured world and game as this team sees them (it attacks +x, robot[0] is its own team), dt_s since
  // the last call; writes a wheel command in rad/s for each of its robots (vs_team_size(world): three, or what its divisions
  // say; clamped by the caller to +-VS_WHEEL_LIMIT_RADPS).
  void (*step)(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels out[VS_TEAM_MOST]);

  void (*free)(void *state); // may be NULL: nothing beyond the block to release

  uint32_t divisions; // 0: it plays 3 against 3 alone; else VSSS_PLAYS of each that it plays, or-ed
} vsss_player_api;

typedef const vsss_player_api *(*vsss_player_entry)(void); // the type of `vsss_player`

#ifdef __cplusplus
}
#endif
#endif
