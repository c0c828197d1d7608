// plugin:FILE.so. The file is checked before it is trusted, and each call into it is guarded.
#include <dlfcn.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "policy_internal.h"

#define ENTRY "vsss_player"

// A plugin's own functions win over the program's of the same name. (The sanitizers cannot load that way.)
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LOAD_FLAGS (RTLD_NOW | RTLD_LOCAL)
#else
#define LOAD_FLAGS (RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND)
#endif

struct vs_plugin {
  char file[512];
  char name[128]; // the api's own name, copied: readable after a crash
  void *handle;
  vsss_player_api own; // what it exports, copied
  const vsss_player_api *api;
  bool crashed;
};

// Of interface 1: three robots a team, and no divisions after `free`.
typedef struct world_v1 {
  int64_t time_us;
  uint32_t seq;
  vs_robot robot[VS_TEAMS][VS_TEAM_SIZE];
  vs_ball ball;
} world_v1;
#define SIZE_V1 offsetof(vsss_player_api, divisions)

static const char *signal_text(int number) {
  switch (number) {
  case 4: return "SIGILL, illegal instruction";
  case 6: return "SIGABRT, abort";
  case 7: return "SIGBUS, bad memory access";
  case 8: return "SIGFPE, arithmetic such as a division by zero";
  default: return "SIGSEGV, bad memory access or stack overflow";
  }
}

// One guarded call: a crash ends the plugin's life.
static vs_status guarded(vs_plugin *plugin, const char *what, void (*call)(void *), void *argument, vs_error *err) {
  if (plugin->crashed) return vs_fail(err, VS_FAIL, "plugin:%s: has crashed before", plugin->file);
  int number = vs_guard_run(call, argument);
  if (number == 0) return VS_OK;
  plugin->crashed = true;
  return vs_fail(err, VS_FAIL, "plugin:%s%s%s%s: crashed in %s (%s)", plugin->file, *plugin->name ? " (\"" : "",
                 plugin->name, *plugin->name ? "\")" : "", what, signal_text(number));
}

typedef struct load_call {
  const char *path;
  void *handle;
  vsss_player_entry entry;
  const vsss_player_api *api;
} load_call;

static void run_dlopen(void *argument) {
  load_call *c = argument;
  c->handle = dlopen(c->path, LOAD_FLAGS);
}

static void run_entry(void *argument) {
  load_call *c = argument;
  c->api = c->entry();
}

static vs_status check_api(vs_plugin *plugin, const vsss_player_api *api, vs_error *err) {
  const char *file = plugin->file;
  if (!api) return vs_fail(err, VS_FAIL, "plugin:%s: " ENTRY "() returned NULL", file);
  if (api->version != VSSS_PLAYER_VERSION && api->version != 1)
    return vs_fail(err, VS_FAIL,
                   "plugin:%s: built for player interface %u, this program speaks %u: rebuild it with this program's "
                   "vsss/player.h",
                   file, api->version, VSSS_PLAYER_VERSION);
  const char *missing = !api->name ? "name" : !api->init ? "init" : !api->step ? "step" : NULL;
  if (missing) return vs_fail(err, VS_FAIL, "plugin:%s: its vsss_player_api has no %s", file, missing);
  double frames = VS_CAMERA_HZ / api->rate_hz;
  if (!(api->rate_hz > 0.0 && api->rate_hz <= VS_CAMERA_HZ) || fabs(frames - round(frames)) > 1e-9)
    return vs_fail(err, VS_FAIL, "plugin:%s: rate_hz %g does not divide the camera's %d", file, api->rate_hz,
                   VS_CAMERA_HZ);
  if (api->state_size == 0)
    return vs_fail(err, VS_FAIL, "plugin:%s: state_size 0; a player without memory asks for 1 byte", file);
  return VS_OK;
}

static vs_status load(vs_plugin *plugin, vs_error *err) {
  load_call call = {0};
  // dlopen searches a name without a slash in the system's folders: the user means the file.
  char path[sizeof plugin->file + 2];
  snprintf(path, sizeof path, "%s%s", strchr(plugin->file, '/') ? "" : "./", plugin->file);
  call.path = path;
  vs_status status = guarded(plugin, "loading", run_dlopen, &call, err);
  if (status != VS_OK) return status;
  plugin->handle = call.handle;
  if (!call.handle) return vs_fail(err, VS_FAIL, "plugin:%s: cannot be loaded: %s", plugin->file, dlerror());
  void *symbol = dlsym(call.handle, ENTRY);
  if (!symbol)
    return vs_fail(err, VS_FAIL,
                   "plugin:%s: has no symbol " ENTRY "; it must export `const vsss_player_api *" ENTRY
                   "(void)` (extern \"C\" in C++)",
                   plugin->file);
  memcpy(&call.entry, &symbol, sizeof symbol);
  status = guarded(plugin, ENTRY "()", run_entry, &call, err);
  if (status != VS_OK) return status;
  status = check_api(plugin, call.api, err);
  if (status != VS_OK) return status;
  memcpy(&plugin->own, call.api, call.api->version == 1 ? SIZE_V1 : sizeof plugin->own);
  plugin->api = &plugin->own;
  snprintf(plugin->name, sizeof plugin->name, "%s", call.api->name);
  return VS_OK;
}

vs_status vs_plugin_open(const char *file, vs_plugin **out, vs_error *err) {
  *out = NULL;
  vs_plugin *plugin = calloc(1, sizeof *plugin);
  if (!plugin) return vs_fail(err, VS_FAIL, "plugin:%s: out of memory", file);
  snprintf(plugin->file, sizeof plugin->file, "%s", file);
  vs_status status = load(plugin, err);
  if (status != VS_OK) {
    vs_plugin_close(plugin);
    return status;
  }
  *out = plugin;
  return VS_OK;
}

const vsss_player_api *vs_plugin_api(const vs_plugin *plugin) { return plugin->api; }

typedef struct state_call {
  const vsss_player_api *api;
  void *state;
  uint64_t seed;
  const char *options;
  const vs_world *world;
  const vs_game *game;
  double dt_s;
  vs_wheels *out;
  vs_error *err;
  vs_status status;
} state_call;

static void run_init(void *argument) {
  state_call *c = argument;
  c->status = c->api->init(c->state, c->seed, c->options, c->err);
}

vs_status vs_plugin_init(vs_plugin *plugin, void *state, uint64_t seed, const char *options, vs_error *err) {
  vs_error said = {0};
  state_call call = {.api = plugin->api, .state = state, .seed = seed, .options = options, .err = &said};
  vs_status status = guarded(plugin, "init", run_init, &call, err);
  if (status != VS_OK || call.status == VS_OK) return status;
  said.text[sizeof said.text - 1] = '\0';
  return vs_fail(err, call.status == VS_USAGE ? VS_USAGE : VS_FAIL, "plugin:%s (\"%s\"): init: %s", plugin->file,
                 plugin->name, *said.text ? said.text : "failed without a reason");
}

static void run_step(void *argument) {
  state_call *c = argument;
  if (c->api->version > 1) {
    c->api->step(c->state, c->world, c->game, c->dt_s, c->out);
    return;
  }
  world_v1 world = {.time_us = c->world->time_us, .seq = c->world->seq, .ball = c->world->ball};
  for (int t = 0; t < VS_TEAMS; t++) memcpy(world.robot[t], c->world->robot[t], sizeof world.robot[t]);
  // Its step takes a pointer to what it was built with; all else of the call is the same.
  c->api->step(c->state, (const vs_world *)(const void *)&world, c->game, c->dt_s, c->out);
}

vs_status vs_plugin_step(vs_plugin *plugin, void *state, const vs_world *world, const vs_game *game, double dt_s,
                         vs_wheels *out, vs_error *err) {
  for (int i = 0, n = vs_team_size(world); i < n; i++)
    out[i] = (vs_wheels){0.0, 0.0}; // a wheel it does not set stands still
  state_call call = {.api = plugin->api, .state = state, .world = world, .game = game, .dt_s = dt_s, .out = out};
  return guarded(plugin, "step", run_step, &call, err);
}

static void run_free(void *argument) {
  state_call *c = argument;
  c->api->free(c->state);
}

vs_status vs_plugin_free_state(vs_plugin *plugin, void *state, vs_error *err) {
  if (plugin->crashed || !plugin->api->free) return VS_OK;
  state_call call = {.api = plugin->api, .state = state};
  return guarded(plugin, "free", run_free, &call, err);
}

void vs_plugin_close(vs_plugin *plugin) {
  if (!plugin) return;
  // After a crash its code may still hold locks: leave it in memory.
  if (plugin->handle && !plugin->crashed) dlclose(plugin->handle);
  free(plugin);
}
