// What the files of this module share. policy.c turns a URI into one of two things: a player that is code
// (vsss_player_api, player.h) or one that maps observations to actions (vs_obs_player, below).
#ifndef VSSS_POLICY_INTERNAL_H
#define VSSS_POLICY_INTERNAL_H

#include "vsss/config.h"
#include "vsss/policy.h"

// A learned player. Memoryless: the same observation gives the same action, so it needs no snapshot.
typedef struct vs_obs_player vs_obs_player;
struct vs_obs_player {
  // obs float[VS_TEAM_SIZE][VS_OBS_SIZE] -> action float[VS_TEAM_SIZE][VS_ACTION_SIZE]. policy.c always asks for rows
  // == VS_TEAM_SIZE (it splits larger calls and pads the last) and checks that the result is finite and in [-1, 1].
  vs_status (*act)(vs_obs_player *self, const float *obs, int rows, float *action, vs_error *err);
  void (*close)(vs_obs_player *self);
  const char *name; // for tables, such as the model's own name; lives as long as the player
};

// policy_onnx.c; policy_onnx_stub.c where ONNX Runtime is missing (deploy/features.mk chooses). rest: what follows
// "onnx:", a file name, perhaps with "?options"; no name: the policy that comes with vsss.
vs_status vs_policy_onnx_open(const char *rest, vs_obs_player **out, vs_error *err);

// A player elsewhere, of which this process holds only a handle (player_process.c). Calls as in policy.h.
typedef struct vs_player_about {
  vs_player_sees sees;
  uint32_t divisions; // VSSS_PLAYS of each that it plays
  double rate_hz;
  char name[128];
} vs_player_about;
typedef struct vs_player_remote {
  vs_status (*reset)(void *handle, uint64_t seed, vs_error *err);
  vs_status (*step)(void *handle, const vs_world *view, const vs_game *game, double dt_s, vs_wheels *out,
                    vs_error *err);
  vs_status (*act)(void *handle, const float *obs, float *action, vs_error *err); // VS_TEAM_SIZE rows
  int64_t (*failures)(const void *handle);
  void (*close)(void *handle);
} vs_player_remote;
// Takes handle over where it succeeds.
vs_status vs_player_of_remote(const char *uri, const vs_player_remote *calls, void *handle,
                              const vs_player_about *about, vs_player **out, vs_error *err);

uint32_t vs_player_divisions(const vs_player *player);                    // VSSS_PLAYS of each
void *vs_player_handle(vs_player *player, const vs_player_remote *calls); // NULL: not one of these calls

// Built-in players.
extern const vsss_player_api vs_player_emc, vs_player_inf, vs_player_emc22, vs_player_random, vs_player_zero,
    vs_player_shake;

// Reads "key=value&key=value" by a schema (config.h); an empty schema allows none. Errors name scheme, key and the
// known keys.
vs_status vs_player_options(const char *scheme, const char *options, const vs_config_key *schema, vs_error *err);

// plugin.c: a team's shared object. Every call into it is guarded: a crash (SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGABRT)
// comes back as VS_FAIL with the plugin's name; after one no further call is made.
typedef struct vs_plugin vs_plugin;
vs_status vs_plugin_open(const char *file, vs_plugin **out, vs_error *err);
const vsss_player_api *vs_plugin_api(const vs_plugin *plugin);
vs_status vs_plugin_init(vs_plugin *plugin, void *state, uint64_t seed, const char *options, vs_error *err);
vs_status vs_plugin_step(vs_plugin *plugin, void *state, const vs_world *world, const vs_game *game, double dt_s,
                         vs_wheels *out, vs_error *err);
vs_status vs_plugin_free_state(vs_plugin *plugin, void *state, vs_error *err);
void vs_plugin_close(vs_plugin *plugin);

// fives.c: how a strategy of three robots plays 5 against 5.
// What it is shown: robots 0 to 2 of each team on a field of 3 against 3. In the view of the team.
void vs_fives_show(const vs_world *view, vs_world *three);
// What the others do: robots 3 and 4. wheels: [5], the first three are left.
void vs_fives_drive(const vs_world *view, vs_wheels *wheels);

// state_check.c: whether a built-in player can go on from a snapshot that came from a file.
bool vs_player_state_ok(const vsss_player_api *api, const void *state);

// plugin_guard.c: runs call(argument); 0, or the number of the fatal signal that ended it.
int vs_guard_run(void (*call)(void *argument), void *argument);

#endif
