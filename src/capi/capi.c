// The handshake, the lists of names, and what every handle shares.
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "capi_internal.h"
#include "learn/reward_mix.h"
#include "vsss/field.h"
#include "vsss/paths.h"
#include "vsss/version.h"

int vs_capi_told(vs_status status, const vs_error *err, char *error, size_t error_size) {
  if (error && error_size) snprintf(error, error_size, "%s", status == VS_OK ? "" : err->text);
  return (int)status;
}

int vs_capi_hello(uint32_t version, uint32_t size, vs_capi_about *about, char *error, size_t error_size) {
  vs_error err = {0};
  if (version != VS_CAPI_VERSION || size != sizeof *about) {
    vs_fail(
        &err, VS_USAGE,
        "libvsss speaks version %d of its interface (%zu bytes), the caller version %u (%u bytes): install both from "
        "one release",
        VS_CAPI_VERSION, sizeof *about, version, size);
    return vs_capi_told(VS_USAGE, &err, error, error_size);
  }
  *about = (vs_capi_about){.size = sizeof *about,
                           .version = VS_CAPI_VERSION,
                           .team_size = VS_TEAM_SIZE,
                           .observation = VS_OBS_SIZE,
                           .frame = VS_OBS_FRAME,
                           .action = VS_ACTION_SIZE,
                           .reward_terms = VS_REWARD_TERMS,
                           .event_kinds = VS_EVENT_KINDS,
                           .world = VS_CAPI_WORLD,
                           .vss_observation = CAPI_VSS_OBSERVATION,
                           .vss_action = CAPI_VSS_ACTION,
                           .vss_shaping = CAPI_SHAPING,
                           .summary = CAPI_SUMMARY,
                           .decision_hz = VS_DECISION_HZ,
                           .vss_hz = CAPI_VSS_HZ,
                           .wheel_limit_radps = VS_WHEEL_LIMIT_RADPS};
  snprintf(about->contract, sizeof about->contract, "%s", vs_contract_hash_hex());
  snprintf(about->release, sizeof about->release, "%s", vs_version());
  return vs_capi_told(VS_OK, &err, error, error_size);
}

static const char *player_scheme(int index) {
  const char *scheme, *help;
  return vs_player_scheme(index, &scheme, &help) ? scheme : NULL;
}

const char *vs_capi_name(const char *list, int index) {
  if (index < 0) return NULL;
  if (!strcmp(list, "reward")) return index < VS_REWARD_TERMS ? vs_reward_name((vs_reward_term)index) : NULL;
  if (!strcmp(list, "event")) return index < VS_EVENT_KINDS ? vs_event_name((vs_event_kind)index) : NULL;
  if (!strcmp(list, "observation")) return index < VS_OBS_FRAME ? vs_obs_name(index) : NULL;
  if (!strcmp(list, "setting")) return vs_capi_setting(index, false);
  if (!strcmp(list, "setting_help")) return vs_capi_setting(index, true);
  if (!strcmp(list, "vss_setting")) return vs_capi_vss_setting(index, false);
  if (!strcmp(list, "vss_setting_help")) return vs_capi_vss_setting(index, true);
  if (!strcmp(list, "shaping")) return vs_capi_shaping(index);
  if (!strcmp(list, "summary")) return vs_capi_summary(index);
  if (!strcmp(list, "player")) return player_scheme(index);
  if (!strcmp(list, "release")) return index == 0 ? vs_version() : NULL;
  return NULL;
}

uint64_t vs_capi_seed(uint64_t seed, uint64_t part) { return vs_seed_mix(seed, part); }

int vs_capi_find(const char *relative, char *path, size_t path_size, char *error, size_t error_size) {
  vs_error err = {0};
  return vs_capi_told(vs_path_find(relative, path, path_size, &err), &err, error, error_size);
}

int vs_capi_reward(const char *text, double *weights, char *error, size_t error_size) {
  vs_error err = {0};
  vs_reward_weights mix;
  vs_status s = vs_reward_mix_parse(text, &mix, &err);
  if (s == VS_OK) memcpy(weights, mix.weight, sizeof mix.weight);
  return vs_capi_told(s, &err, error, error_size);
}

void vs_capi_guard_init(capi_guard *guard) {
  guard->pid = getpid();
  atomic_flag_clear(&guard->busy);
}

vs_status vs_capi_enter(capi_guard *guard, vs_error *err) {
  if (guard->pid != getpid())
    return vs_fail(err, VS_USAGE,
                   "made in process %d, used in its fork %d, where its threads are not: make it anew after the fork",
                   (int)guard->pid, (int)getpid());
  if (atomic_flag_test_and_set(&guard->busy))
    return vs_fail(err, VS_USAGE, "called while another call on it (a step, say) has not returned");
  return VS_OK;
}

void vs_capi_leave(capi_guard *guard) { atomic_flag_clear(&guard->busy); }

vs_status vs_capi_bind_array(const capi_array *arrays, int n, const char *name, void *data, size_t bytes,
                             vs_error *err) {
  for (int i = 0; i < n; i++) {
    if (strcmp(arrays[i].name, name) != 0) continue;
    if (bytes != arrays[i].bytes)
      return vs_fail(err, VS_USAGE, "array '%s' has %zu bytes, %zu are needed", name, bytes, arrays[i].bytes);
    *arrays[i].slot = data;
    return VS_OK;
  }
  return vs_fail(err, VS_USAGE, "no array is named '%s'", name);
}

vs_status vs_capi_all_bound(const capi_array *arrays, int n, vs_error *err) {
  for (int i = 0; i < n; i++)
    if (!*arrays[i].slot) return vs_fail(err, VS_USAGE, "array '%s' is not bound", arrays[i].name);
  return VS_OK;
}

void vs_capi_write_world(const vs_world *world, const vs_game *game, double *out) {
  const vs_ball *ball = &world->ball;
  const double head[8] = {game->time_s, game->duration_s, game->score[0], game->score[1],
                          ball->x_m,    ball->y_m,        ball->vx_mps,   ball->vy_mps};
  memcpy(out, head, sizeof head);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    const vs_robot *r = &world->robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    const double six[6] = {r->pose.x_m, r->pose.y_m, r->pose.theta_rad, r->vx_mps, r->vy_mps, r->omega_radps};
    memcpy(out + 8 + 6 * i, six, sizeof six);
  }
}
