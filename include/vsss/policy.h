// Stable: part of libvsss (deploy/docs/library.md).
//
// Players by URI: `emc:`, `inf:`, `emc22:`, `random:`, `zero:`, `onnx:FILE`, `onnx:` (the policy that comes with vsss),
// `plugin:FILE.so`, and what the program registers (`lcm:`). A player either sees the world (scripted) or an
// observation (learned).
#ifndef VSSS_POLICY_H
#define VSSS_POLICY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/api.h"
#include "vsss/contract.h"
#include "vsss/player.h"
#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_player vs_player;

typedef enum vs_player_sees { VS_SEES_WORLD, VS_SEES_OBSERVATION } vs_player_sees;

// Opens a player: SCHEME:[FILE][?key=value&...]. VS_USAGE: unknown scheme (the text lists the known ones) or option;
// VS_FAIL: its file cannot be used. A plugin that crashes is a VS_FAIL of the call in which it does; it is not called
// again, and the program should end.
VSSS_API vs_status vs_player_open(const char *uri, vs_player **out, vs_error *err);
VSSS_API void vs_player_close(vs_player *player); // NULL is allowed

VSSS_API vs_player_sees vs_player_kind(const vs_player *player);
VSSS_API double vs_player_rate_hz(const vs_player *player);
VSSS_API const char *vs_player_uri(const vs_player *player);
VSSS_API const char *vs_player_name(const vs_player *player);

// VS_USAGE with the reason where it cannot play a division.
VSSS_API vs_status vs_player_plays(const vs_player *player, vs_division division, vs_error *err);

// Start of a match: forget everything, draw from this seed.
VSSS_API vs_status vs_player_reset(vs_player *player, uint64_t seed, vs_error *err);

// VS_SEES_WORLD players. out: [the view's team_size]. A command that is not finite is VS_FAIL, naming player, robot and value.
VSSS_API vs_status vs_player_step(vs_player *player, const vs_world *view, const vs_game *game, double dt_s,
                                  vs_wheels *out, vs_error *err);

// VS_SEES_OBSERVATION players: obs float[rows][VS_OBS_SIZE] -> action float[rows][VS_ACTION_SIZE] in [-1, 1].
// Always evaluated in batches of VS_TEAM_SIZE rows, so that a result never depends on how many matches share a call.
VSSS_API vs_status vs_player_act(vs_player *player, const float *obs, int rows, float *action, vs_error *err);

// Snapshots: state is a block of vs_player_state_size bytes of the caller. Size 0: this player cannot be snapshotted.
VSSS_API size_t vs_player_state_size(const vs_player *player);
VSSS_API void vs_player_save(const vs_player *player, void *state);
// VS_FAIL: no snapshot of such a player (an index or an enumeration out of its range); the player is then reset.
VSSS_API vs_status vs_player_restore(vs_player *player, const void *state, vs_error *err);

// A scheme that needs another module (lcm:), registered once at start, before any thread; a scheme that is known
// already is left as it is. open gets the text after the colon (valid as long as the player) and fills out, which comes
// zeroed. state_size 0 in its api says that it cannot be snapshotted; its state is then a zeroed block of 64 bytes.
typedef struct vs_player_given {
  const vsss_player_api *api;
  const char *options;                       // for its init; NULL: what follows "?"; else it outlives the player
  const char *(*failure)(const void *state); // may be NULL; why the last step failed, or NULL if it did not
} vs_player_given;
typedef vs_status (*vs_player_provider)(const char *rest, vs_player_given *out, vs_error *err);
VSSS_API void vs_player_register(const char *scheme, const char *help, vs_player_provider open);

// The known schemes, for --help: false where index is past the last. vs_player_schemes: "onnx: emc: ..." in one line.
VSSS_API bool vs_player_scheme(int index, const char **scheme, const char **help);
VSSS_API void vs_player_schemes(char *out, size_t size);

// ONNX Runtime of Debian 13 writes 1,100 harmless lines to standard error with the first session of a process. A program
// that owns its standard error may look away meanwhile: before and after (NULL: nothing) are called around the making of
// the first session, by the thread that makes it. Set before any player is opened; does nothing without ONNX Runtime.
VSSS_API void vs_player_first_session(void (*before)(void), void (*after)(void));

VSSS_API const char *vs_onnxruntime_version(void); // of the ONNX Runtime that a player would run in; NULL: none found

#ifdef __cplusplus
}
#endif
#endif
