// A player of a run that is computed again: it fails where the recorded one failed, and after that is the new one that was
// started then.
#include <stdio.h>
#include <stdlib.h>

#include "policy_internal.h"
#include "vsss/isolate.h"

typedef struct rerun {
  vs_player *player;
  bool fails; // the next call
  bool dead;  // since its last failure it has not been started anew
  uint64_t seed;
  int64_t failures;
} rerun;

static vs_status alive(rerun *r, vs_error *err) {
  if (r->fails) {
    r->failures += !r->dead;
    r->dead = true;
    r->fails = false;
    return vs_fail(err, VS_FAIL, "player %s: failed here in the record", vs_player_uri(r->player));
  }
  if (!r->dead) return VS_OK;
  r->dead = false;
  return vs_player_reset(r->player, r->seed, err);
}

static vs_status reset(void *handle, uint64_t seed, vs_error *err) {
  rerun *r = handle;
  r->seed = seed;
  vs_status s = alive(r, err);
  return s == VS_OK ? vs_player_reset(r->player, seed, err) : s;
}

static vs_status step(void *handle, const vs_world *view, const vs_game *game, double dt_s, vs_wheels *out,
                      vs_error *err) {
  rerun *r = handle;
  vs_status s = alive(r, err);
  return s == VS_OK ? vs_player_step(r->player, view, game, dt_s, out, err) : s;
}

static vs_status act(void *handle, const float *obs, float *action, vs_error *err) {
  rerun *r = handle;
  vs_status s = alive(r, err);
  return s == VS_OK ? vs_player_act(r->player, obs, VS_TEAM_SIZE, action, err) : s;
}

static int64_t failures(const void *handle) { return ((const rerun *)handle)->failures; }

static void close_rerun(void *handle) {
  rerun *r = handle;
  vs_player_close(r->player);
  free(r);
}

static const vs_player_remote calls = {reset, step, act, failures, close_rerun};

vs_status vs_player_open_rerun(const char *uri, vs_player **out, vs_error *err) {
  *out = NULL;
  rerun *r = calloc(1, sizeof *r);
  if (!r) return vs_fail(err, VS_FAIL, "%s: out of memory", uri);
  vs_status s = vs_player_open(uri, &r->player, err);
  vs_player_about about = {0};
  if (s == VS_OK) {
    about = (vs_player_about){.sees = vs_player_kind(r->player),
                              .rate_hz = vs_player_rate_hz(r->player),
                              .divisions = vs_player_divisions(r->player)};
    snprintf(about.name, sizeof about.name, "%s", vs_player_name(r->player));
    s = vs_player_of_remote(uri, &calls, r, &about, out, err);
  }
  if (s != VS_OK) close_rerun(r);
  return s;
}

void vs_player_fail_next(vs_player *player) {
  rerun *r = vs_player_handle(player, &calls);
  if (r) r->fails = true;
}
