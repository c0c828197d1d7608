// Players by URI: the table of schemes, and what a caller sees of a player whatever stands behind it.
#include "vsss/policy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "policy_internal.h"
#include "vsss/field.h"
#include "vsss/isolate.h"

#define MAX_PROVIDERS 8

struct vs_player {
  char *uri, *rest; // rest: a copy of what follows the scheme, cut at "?"
  const char *options;
  const vsss_player_api *api;                // NULL: an observation player
  const char *(*failure)(const void *state); // of a registered player, or NULL
  vs_obs_player *learned;
  vs_plugin *plugin;
  const vs_player_remote *remote; // all of the above live elsewhere; handle says where
  void *handle;
  vs_player_about about; // what it said of itself
  void *state;           // api->state_size bytes
  bool fives;            // a strategy of three robots that fives.c helps with the rest
  bool started;
};

typedef struct scheme {
  const char *name, *help;
  vs_status (*open)(vs_player *player, const struct scheme *scheme, vs_error *err);
  const vsss_player_api *builtin;
  vs_player_provider provider;
  bool fives;
} scheme;

static vs_status open_builtin(vs_player *player, const scheme *s, vs_error *err) {
  if (*player->rest) return vs_fail(err, VS_USAGE, "%s: nothing but ?options may follow '%s'", player->uri, s->name);
  player->api = s->builtin;
  player->fives = s->fives;
  return VS_OK;
}

static vs_status open_plugin(vs_player *player, const scheme *s, vs_error *err) {
  (void)s;
  if (!*player->rest) return vs_fail(err, VS_USAGE, "plugin: needs a file, as in plugin:./team.so");
  vs_status status = vs_plugin_open(player->rest, &player->plugin, err);
  if (status == VS_OK) player->api = vs_plugin_api(player->plugin);
  return status;
}

static vs_status open_onnx(vs_player *player, const scheme *s, vs_error *err) {
  return vs_policy_onnx_open(player->uri + strlen(s->name), &player->learned, err);
}

static vs_status open_provided(vs_player *player, const scheme *s, vs_error *err) {
  vs_player_given given = {0};
  vs_status status = s->provider(player->uri + strlen(s->name), &given, err);
  player->api = given.api;
  player->failure = given.failure;
  if (given.options) player->options = given.options;
  return status;
}

// The program's table. Rows after the built-in ones are registered once at start, before any thread.
static scheme table[8 + MAX_PROVIDERS + 1] = {
    {"onnx:", "FILE, a trained policy; without a file the one that comes with vsss", open_onnx, NULL, NULL, false},
    {"emc:", "VSSS-EMC of 2019; ?pid=1: through its own wheel PID", open_builtin, &vs_player_emc, NULL, true},
    {"inf:", "PY-VSSS-INF", open_builtin, &vs_player_inf, NULL, true},
    {"emc22:", "VSSS-EMC of 2022", open_builtin, &vs_player_emc22, NULL, true},
    {"random:", "uniform wheel speeds", open_builtin, &vs_player_random, NULL, false},
    {"zero:", "stands still", open_builtin, &vs_player_zero, NULL, false},
    {"shake:", "swings each robot a little, to measure it (identify, latency)", open_builtin, &vs_player_shake, NULL,
     false},
    {"plugin:", "FILE.so, a team's own strategy (include/vsss/player.h)", open_plugin, NULL, NULL, false},
};

static scheme *table_end(void) {
  scheme *s = table;
  while (s->name) s++;
  return s;
}

void vs_player_register(const char *name, const char *help, vs_player_provider open) {
  for (scheme *s = table; s->name; s++)
    if (!strcmp(s->name, name)) return;
  scheme *end = table_end();
  if (end - table >= (long)(sizeof table / sizeof *table) - 1) return;
  *end = (scheme){name, help, open_provided, NULL, open, false};
}

bool vs_player_scheme(int index, const char **name, const char **help) {
  if (index < 0 || index >= table_end() - table) return false;
  *name = table[index].name;
  *help = table[index].help;
  return true;
}

void vs_player_schemes(char *out, size_t size) {
  out[0] = '\0';
  for (const scheme *s = table; s->name; s++) {
    size_t used = strlen(out);
    snprintf(out + used, size - used, "%s%s", used ? " " : "", s->name);
  }
}

static const scheme *find_scheme(const char *uri) {
  for (const scheme *s = table; s->name; s++)
    if (!strncmp(uri, s->name, strlen(s->name))) return s;
  return NULL;
}

static vs_status unknown_scheme(const char *uri, vs_error *err) {
  char known[256];
  vs_player_schemes(known, sizeof known);
  for (const scheme *s = table; s->name; s++) // "emc" for "emc:"
    if (strlen(uri) + 1 == strlen(s->name) && strncasecmp(uri, s->name, strlen(uri)) == 0)
      return vs_fail(err, VS_USAGE, "'%.120s' is no player: did you mean '%s'? known: %s", uri, s->name, known);
  const char *ending = strrchr(uri, '.');
  if (ending && (!strcmp(ending, ".onnx") || !strcmp(ending, ".so")))
    return vs_fail(err, VS_USAGE, "'%.120s' is no player: did you mean '%s:%.120s'?", uri,
                   ending[1] == 'o' ? "onnx" : "plugin", uri);
  return vs_fail(err, VS_USAGE, "'%.120s' is no player; known: %s", uri, known);
}

static char *copy_text(const char *text) {
  size_t size = strlen(text) + 1;
  char *copy = malloc(size);
  return copy ? memcpy(copy, text, size) : NULL;
}

static vs_status open_parts(vs_player *player, const scheme *s, const char *uri, vs_error *err) {
  player->uri = copy_text(uri);
  player->rest = copy_text(uri + strlen(s->name));
  if (!player->uri || !player->rest) return vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  char *question = strchr(player->rest, '?');
  player->options = question ? question + 1 : "";
  if (question) *question = '\0';

  vs_status status = s->open(player, s, err);
  if (status != VS_OK || !player->api) return status;
  size_t size = (player->api->state_size + 63) / 64 * 64;
  player->state = aligned_alloc(64, size ? size : 64);
  if (!player->state) return vs_fail(err, VS_FAIL, "%s: out of memory (%zu bytes of state)", uri, size);
  memset(player->state, 0, size ? size : 64);
  return vs_player_reset(player, 0, err); // so that wrong options are an error now, not at the first match
}

vs_status vs_player_open(const char *uri, vs_player **out, vs_error *err) {
  *out = NULL;
  const scheme *s = find_scheme(uri);
  if (!s) return unknown_scheme(uri, err);
  vs_player *player = calloc(1, sizeof *player);
  if (!player) return vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  vs_status status = open_parts(player, s, uri, err);
  if (status != VS_OK) {
    vs_player_close(player);
    return status;
  }
  *out = player;
  return VS_OK;
}

vs_status vs_player_of_remote(const char *uri, const vs_player_remote *calls, void *handle,
                              const vs_player_about *about, vs_player **out, vs_error *err) {
  *out = NULL;
  vs_player *player = calloc(1, sizeof *player);
  if (player) player->uri = copy_text(uri);
  if (!player || !player->uri) {
    free(player);
    return vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  }
  player->remote = calls;
  player->handle = handle;
  player->about = *about;
  *out = player;
  return VS_OK;
}

void *vs_player_handle(vs_player *player, const vs_player_remote *calls) {
  return player->remote == calls ? player->handle : NULL;
}

int64_t vs_player_failures(const vs_player *player) {
  return player->remote ? player->remote->failures(player->handle) : 0;
}

static void end_match(vs_player *player) {
  if (!player->started) return;
  player->started = false;
  if (player->plugin)
    vs_plugin_free_state(player->plugin, player->state, NULL);
  else if (player->api->free)
    player->api->free(player->state);
}

void vs_player_close(vs_player *player) {
  if (!player) return;
  if (player->remote) player->remote->close(player->handle);
  end_match(player);
  if (player->plugin) vs_plugin_close(player->plugin);
  if (player->learned) player->learned->close(player->learned);
  free(player->state);
  free(player->rest);
  free(player->uri);
  free(player);
}

vs_player_sees vs_player_kind(const vs_player *player) {
  if (player->remote) return player->about.sees;
  return player->api ? VS_SEES_WORLD : VS_SEES_OBSERVATION;
}

double vs_player_rate_hz(const vs_player *player) {
  if (player->remote) return player->about.rate_hz;
  return player->api ? player->api->rate_hz : VS_DECISION_HZ;
}

uint32_t vs_player_divisions(const vs_player *player) {
  if (player->remote) return player->about.divisions;
  if (!player->api) return VSSS_PLAYS(VS_3V3);
  if (player->fives) return VSSS_PLAYS(VS_3V3) | VSSS_PLAYS(VS_5V5);
  return player->api->divisions ? player->api->divisions : VSSS_PLAYS(VS_3V3);
}

vs_status vs_player_plays(const vs_player *player, vs_division division, vs_error *err) {
  if (vs_player_divisions(player) & VSSS_PLAYS(division)) return VS_OK;
  const char *name = vs_pitch_of(division)->name;
  if (vs_player_kind(player) == VS_SEES_OBSERVATION)
    return vs_fail(
        err, VS_USAGE,
        "player %s is a learned policy, which sees and commands three robots, not %s: use --division 3v3, or a "
        "scripted player (emc:, inf:, emc22:, random:)",
        player->uri, name);
  return vs_fail(err, VS_USAGE,
                 "player %s does not play %s: use --division 3v3, or another player (a plugin says what it plays in "
                 "vsss_player_api.divisions)",
                 player->uri, name);
}

const char *vs_player_uri(const vs_player *player) { return player->uri; }

const char *vs_player_name(const vs_player *player) {
  if (player->remote) return player->about.name;
  return player->api ? player->api->name : player->learned->name;
}

vs_status vs_player_reset(vs_player *player, uint64_t seed, vs_error *err) {
  if (player->remote) return player->remote->reset(player->handle, seed, err);
  if (!player->api) return VS_OK;
  end_match(player);
  vs_status status = player->plugin ? vs_plugin_init(player->plugin, player->state, seed, player->options, err)
                                    : player->api->init(player->state, seed, player->options, err);
  player->started = status == VS_OK;
  return status;
}

static vs_status check_speed(const vs_player *player, int robot, const char *wheel, double *radps, vs_error *err) {
  if (!isfinite(*radps))
    return vs_fail(err, VS_FAIL, "player %s, robot %d, %s wheel: %g rad/s is no command", player->uri, robot, wheel,
                   *radps);
  *radps = fmin(fmax(*radps, -VS_WHEEL_LIMIT_RADPS), VS_WHEEL_LIMIT_RADPS);
  return VS_OK;
}

vs_status vs_player_step(vs_player *player, const vs_world *view, const vs_game *game, double dt_s, vs_wheels *out,
                         vs_error *err) {
  if (vs_player_kind(player) != VS_SEES_WORLD)
    return vs_fail(err, VS_FAIL, "player %s acts on observations, not on a world", player->uri);
  if (view->division != VS_3V3) {
    vs_status status = vs_player_plays(player, view->division, err);
    if (status != VS_OK) return status;
  }
  if (player->remote) return player->remote->step(player->handle, view, game, dt_s, out, err);
  if (player->plugin) {
    vs_status status = vs_plugin_step(player->plugin, player->state, view, game, dt_s, out, err);
    if (status != VS_OK) return status;
  } else if (player->fives && view->division != VS_3V3) {
    vs_world three;
    vs_fives_show(view, &three);
    player->api->step(player->state, &three, game, dt_s, out);
    vs_fives_drive(view, out);
  } else {
    player->api->step(player->state, view, game, dt_s, out);
  }
  const char *why = player->failure ? player->failure(player->state) : NULL;
  if (why) return vs_fail(err, VS_FAIL, "%s: %s", player->uri, why);
  for (int i = 0, n = vs_team_size(view); i < n; i++) {
    vs_status status = check_speed(player, i, "left", &out[i].left_radps, err);
    if (status == VS_OK) status = check_speed(player, i, "right", &out[i].right_radps, err);
    if (status != VS_OK) return status;
  }
  return VS_OK;
}

static vs_status act_team(vs_player *player, int first_row, const float *obs, float *action, vs_error *err) {
  if (player->remote) return player->remote->act(player->handle, obs, action, err);
  vs_status status = player->learned->act(player->learned, obs, VS_TEAM_SIZE, action, err);
  if (status != VS_OK) return status;
  for (int i = 0; i < VS_TEAM_SIZE * VS_ACTION_SIZE; i++) {
    if (!isfinite(action[i]))
      return vs_fail(err, VS_FAIL, "player %s, row %d, %s wheel: action %g is no number", player->uri,
                     first_row + i / VS_ACTION_SIZE, i % VS_ACTION_SIZE ? "right" : "left", (double)action[i]);
    action[i] = fminf(fmaxf(action[i], -1.0f), 1.0f);
  }
  return VS_OK;
}

vs_status vs_player_act(vs_player *player, const float *obs, int rows, float *action, vs_error *err) {
  if (vs_player_kind(player) != VS_SEES_OBSERVATION)
    return vs_fail(err, VS_FAIL, "player %s acts on a world, not on observations", player->uri);
  int whole = rows / VS_TEAM_SIZE * VS_TEAM_SIZE;
  for (int r = 0; r < whole; r += VS_TEAM_SIZE) {
    vs_status status = act_team(player, r, obs + (size_t)r * VS_OBS_SIZE, action + (size_t)r * VS_ACTION_SIZE, err);
    if (status != VS_OK) return status;
  }
  if (whole == rows) return VS_OK;
  // A last team that is not whole: filled up with zeros, whose actions are dropped.
  float padded[VS_TEAM_SIZE * VS_OBS_SIZE] = {0}, result[VS_TEAM_SIZE * VS_ACTION_SIZE];
  size_t left = (size_t)(rows - whole);
  memcpy(padded, obs + (size_t)whole * VS_OBS_SIZE, left * VS_OBS_SIZE * sizeof *padded);
  vs_status status = act_team(player, whole, padded, result, err);
  if (status == VS_OK) memcpy(action + (size_t)whole * VS_ACTION_SIZE, result, left * VS_ACTION_SIZE * sizeof *result);
  return status;
}

// A memoryless player still answers 1, since 0 says "cannot".
size_t vs_player_state_size(const vs_player *player) {
  if (player->remote) return 0;
  return player->api ? player->api->state_size : 1;
}

void vs_player_save(const vs_player *player, void *state) {
  if (player->api)
    memcpy(state, player->state, player->api->state_size);
  else
    memset(state, 0, 1);
}

vs_status vs_player_restore(vs_player *player, const void *state, vs_error *err) {
  if (!player->api) return VS_OK;
  // Into aligned memory before anything of it is read.
  memcpy(player->state, state, player->api->state_size);
  if (vs_player_state_ok(player->api, player->state)) return VS_OK;
  vs_status reset = vs_player_reset(player, 0, err);
  return reset != VS_OK ? reset : vs_fail(err, VS_FAIL, "player %s: the snapshot is damaged", player->uri);
}
