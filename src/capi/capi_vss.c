// Many VSS-v0 environments over threads.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "capi_internal.h"
#include "vss_v0.h"
#include "vsss/config.h"
#include "vsss/pool.h"

#define SUBSTEPS 4 // of 6.25 ms: a step of 25 ms is a whole number of them

typedef struct array_set {
  float *observation, *final_observation, *action, *reward;
  uint8_t *terminated, *truncated;
  double *shaping, *final_shaping;
} array_set;

typedef struct vss_settings {
  int envs, threads, max_steps;
  uint64_t seed;
  char drive[32], realism[4096];
  bool autoreset;
} vss_settings;

struct vs_capi_vss {
  capi_guard guard;
  vss_settings settings;
  vs_realism realism;
  vs_model *model;
  vs_pool *pool;
  vs_sim **sim;
  vss_v0 *env;
  array_set set[VS_CAPI_SETS];
  // Of the call at work:
  array_set *to;
  const uint8_t *start;
  vs_error *failed; // [envs]
};

enum { ARRAYS = 8, SETTINGS = 7 };

static void arrays_of(vs_capi_vss *v, int set, capi_array out[ARRAYS]) {
  array_set *a = &v->set[set];
  size_t n = (size_t)v->settings.envs;
  const capi_array list[ARRAYS] = {
      {"observation", (void **)&a->observation, n * CAPI_VSS_OBSERVATION * sizeof(float)},
      {"final_observation", (void **)&a->final_observation, n * CAPI_VSS_OBSERVATION * sizeof(float)},
      {"action", (void **)&a->action, n * CAPI_VSS_ACTION * sizeof(float)},
      {"reward", (void **)&a->reward, n * sizeof(float)},
      {"terminated", (void **)&a->terminated, n},
      {"truncated", (void **)&a->truncated, n},
      {"shaping", (void **)&a->shaping, n * CAPI_SHAPING * sizeof(double)},
      {"final_shaping", (void **)&a->final_shaping, n * CAPI_SHAPING * sizeof(double)},
  };
  memcpy(out, list, sizeof list);
}

static void schema_of(vss_settings *s, vs_config_key keys[SETTINGS]) {
  const vs_config_key rows[SETTINGS] = {
      {"envs", VS_CONFIG_INT, &s->envs, 0, 1, 4096, "environments side by side"},
      {"threads", VS_CONFIG_INT, &s->threads, 0, 1, 256, "threads; results do not depend on them"},
      {"seed", VS_CONFIG_SEED, &s->seed, 0, 0, 0, "everything random follows from it"},
      {"max_steps", VS_CONFIG_INT, &s->max_steps, 0, 0, 1000000, "an episode is cut after so many steps; 0: never"},
      {"drive", VS_CONFIG_TEXT, s->drive, sizeof s->drive, 0, 0, "planar (fast) or contact (the reference)"},
      {"autoreset", VS_CONFIG_BOOL, &s->autoreset, 0, 0, 0, "an ended episode restarts within the step"},
      {.name = NULL},
  };
  memcpy(keys, rows, sizeof rows);
}

const char *vs_capi_vss_setting(int index, bool help) {
  vss_settings settings;
  vs_config_key keys[SETTINGS] = {{0}};
  schema_of(&settings, keys);
  if (index >= SETTINGS) return NULL;
  if (index == SETTINGS - 1)
    return help ? "dynamics drawn anew each episode, as of make_vec; noise is not used" : "realism";
  return help ? keys[index].help : keys[index].name;
}

static vs_status read_settings(const char *const *texts, vss_settings *out, vs_realism *realism, vs_error *err) {
  *out = (vss_settings){.envs = 1, .threads = 1, .seed = 1, .drive = "planar", .autoreset = true};
  *realism = vs_realism_default();
  vs_config_key schema[SETTINGS] = {{0}};
  schema_of(out, schema);
  for (; *texts; texts++) {
    vs_status s;
    if (!strncmp(*texts, "realism=", 8))
      s = vs_capi_realism(*texts + 8, out->realism, sizeof out->realism, realism, err);
    else
      s = vs_capi_set(*texts, schema, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

static void free_vss(vs_capi_vss *v) {
  if (!v) return;
  if (v->pool) vs_pool_free(v->pool);
  for (int i = 0; v->sim && i < v->settings.envs; i++)
    if (v->sim[i]) vs_sim_free(v->sim[i]);
  if (v->model) vs_model_free(v->model);
  free(v->sim);
  free(v->env);
  free(v->failed);
  free(v);
}

static vs_status open_vss(vs_capi_vss *v, vs_error *err) {
  const vss_settings *s = &v->settings;
  vs_drive drive;
  vs_status status = vs_drive_parse(s->drive, &drive, err);
  if (status != VS_OK) return status;
  vs_model_def def = vs_model_def_default(drive);
  def.frame_hz = CAPI_VSS_HZ;
  def.substeps_per_frame = SUBSTEPS;
  status = vs_model_load(&def, &v->model, err);
  if (status == VS_OK) status = vs_pool_new(s->threads < s->envs ? s->threads : s->envs, &v->pool, err);
  if (status != VS_OK) return status;
  v->sim = calloc((size_t)s->envs, sizeof *v->sim);
  v->env = calloc((size_t)s->envs, sizeof *v->env);
  v->failed = calloc((size_t)s->envs, sizeof *v->failed);
  if (!v->sim || !v->env || !v->failed) return vs_fail(err, VS_FAIL, "out of memory for %d environments", s->envs);
  for (int i = 0; i < s->envs && status == VS_OK; i++) {
    v->env[i].seed = vs_seed_mix(s->seed, (uint64_t)i);
    status = vs_sim_new(v->model, &v->sim[i], err);
    if (status == VS_OK) vss_v0_reset(&v->env[i], v->sim[i], &v->realism);
    v->env[i].episode = 0;
  }
  return status;
}

int vs_capi_vss_new(const char *const *settings, vs_capi_vss **out, char *error, size_t error_size) {
  vs_error err = {0};
  vs_capi_vss *v = calloc(1, sizeof *v);
  if (!v) return vs_capi_told(vs_fail(&err, VS_FAIL, "out of memory"), &err, error, error_size);
  vs_capi_guard_init(&v->guard);
  vs_status s = read_settings(settings, &v->settings, &v->realism, &err);
  if (s == VS_OK) s = open_vss(v, &err);
  if (s == VS_OK)
    *out = v;
  else
    free_vss(v);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vss_free(vs_capi_vss *v, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = v ? vs_capi_enter(&v->guard, &err) : VS_OK;
  if (s == VS_OK) free_vss(v);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_vss_envs(const vs_capi_vss *v) { return v->settings.envs; }

static vs_status check_set(int set, vs_error *err) {
  if (set >= 0 && set < VS_CAPI_SETS) return VS_OK;
  return vs_fail(err, VS_USAGE, "set %d: there are %d", set, VS_CAPI_SETS);
}

int vs_capi_vss_bind(vs_capi_vss *v, int set, const char *name, void *data, size_t bytes, char *error,
                     size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = check_set(set, &err);
  if (s == VS_OK) {
    capi_array arrays[ARRAYS];
    arrays_of(v, set, arrays);
    s = vs_capi_bind_array(arrays, ARRAYS, name, data, bytes, &err);
  }
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

static void write_state(vs_capi_vss *v, int i, float *observation, double *shaping) {
  vss_v0_observe(&v->env[i], observation + (size_t)i * CAPI_VSS_OBSERVATION);
  memcpy(shaping + (size_t)i * CAPI_SHAPING, v->env[i].shaping, sizeof v->env[i].shaping);
}

static void reset_one(void *context, int i, int thread) {
  vs_capi_vss *v = context;
  (void)thread;
  if (v->start && !v->start[i]) return;
  vss_v0_reset(&v->env[i], v->sim[i], &v->realism);
  write_state(v, i, v->to->observation, v->to->shaping);
}

static void step_one(void *context, int i, int thread) {
  vs_capi_vss *v = context;
  array_set *to = v->to;
  (void)thread;
  bool goal = false;
  vss_v0 *e = &v->env[i];
  v->failed[i].status = VS_OK;
  if (vss_v0_step(e, v->sim[i], to->action + (size_t)i * CAPI_VSS_ACTION, &to->reward[i], &goal, &v->failed[i]) !=
      VS_OK)
    return;
  to->terminated[i] = goal;
  to->truncated[i] = !goal && v->settings.max_steps && e->steps >= v->settings.max_steps;
  if ((to->terminated[i] || to->truncated[i]) && v->settings.autoreset) {
    write_state(v, i, to->final_observation, to->final_shaping);
    vss_v0_reset(e, v->sim[i], &v->realism);
  }
  write_state(v, i, to->observation, to->shaping);
}

static vs_status begin(vs_capi_vss *v, int set, vs_error *err) {
  vs_status s = check_set(set, err);
  if (s != VS_OK) return s;
  capi_array arrays[ARRAYS];
  arrays_of(v, set, arrays);
  v->to = &v->set[set];
  return vs_capi_all_bound(arrays, ARRAYS, err);
}

static vs_status reset(vs_capi_vss *v, int set, const uint64_t *seed, int seeds, const uint8_t *start, vs_error *err) {
  int n = v->settings.envs;
  vs_status s = begin(v, set, err);
  if (s == VS_OK && seed && seeds != 1 && seeds != n)
    s = vs_fail(err, VS_USAGE, "%d seeds: give one, or one for each of the %d environments", seeds, n);
  if (s != VS_OK) return s;
  for (int i = 0; seed && i < n; i++) {
    if (start && !start[i]) continue;
    v->env[i].seed = seeds == n && seeds > 1 ? seed[i] : vs_seed_mix(seed[0], (uint64_t)i);
    v->env[i].episode = 0;
  }
  v->start = start;
  vs_pool_run(v->pool, n, reset_one, v);
  return VS_OK;
}

int vs_capi_vss_reset(vs_capi_vss *v, int set, const uint64_t *seed, int seeds, const uint8_t *start, char *error,
                      size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = reset(v, set, seed, seeds, start, &err);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

static vs_status step(vs_capi_vss *v, int set, vs_error *err) {
  vs_status s = begin(v, set, err);
  if (s != VS_OK) return s;
  for (int i = 0; i < v->settings.envs * CAPI_VSS_ACTION; i++)
    if (!isfinite(v->to->action[i]))
      return vs_fail(err, VS_USAGE, "action of environment %d, wheel %d, is %g: give numbers in [-1, 1]",
                     i / CAPI_VSS_ACTION, i % CAPI_VSS_ACTION, (double)v->to->action[i]);
  vs_pool_run(v->pool, v->settings.envs, step_one, v);
  for (int i = 0; i < v->settings.envs; i++)
    if (v->failed[i].status != VS_OK) return vs_fail(err, v->failed[i].status, "%s", v->failed[i].text);
  return VS_OK;
}

int vs_capi_vss_step(vs_capi_vss *v, int set, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(&v->guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = step(v, set, &err);
  vs_capi_leave(&v->guard);
  return vs_capi_told(s, &err, error, error_size);
}

static uint64_t settings_hash(const void *self) {
  const vss_settings *s = &((const vs_capi_vss *)self)->settings;
  uint64_t hash = vs_hash_bytes(VS_HASH_START, s->drive, strlen(s->drive));
  hash = vs_hash_bytes(hash, s->realism, strlen(s->realism));
  hash = vs_hash_bytes(hash, &s->envs, sizeof s->envs);
  hash = vs_hash_bytes(hash, &s->max_steps, sizeof s->max_steps);
  return vs_hash_bytes(hash, "vss-v0 2", 8);
}

// A state: of each environment its own struct, then its simulator, each from an aligned place on.
static size_t aligned(size_t size) { return (size + 63) / 64 * 64; }

static size_t size_of_one(const vs_capi_vss *v) {
  return aligned(sizeof(vss_v0)) + aligned(vs_sim_state_size(v->sim[0]));
}

static size_t state_size(const void *self) {
  const vs_capi_vss *v = self;
  return (size_t)v->settings.envs * size_of_one(v);
}

static void save(const void *self, void *state) {
  const vs_capi_vss *v = self;
  char *at = state;
  for (int i = 0; i < v->settings.envs; i++, at += size_of_one(v)) {
    memcpy(at, &v->env[i], sizeof(vss_v0));
    vs_sim_save(v->sim[i], at + aligned(sizeof(vss_v0)));
  }
}

static vs_status restore(void *self, const void *state, vs_error *err) {
  vs_capi_vss *v = self;
  const char *at = state;
  vs_status s = VS_OK;
  for (int i = 0; i < v->settings.envs && s == VS_OK; i++, at += size_of_one(v)) {
    memcpy(&v->env[i], at, sizeof(vss_v0));
    s = vs_sim_restore(v->sim[i], at + aligned(sizeof(vss_v0)), err);
  }
  return s;
}

static capi_subject subject(vs_capi_vss *v) {
  static const capi_snapshot_kind kind = {settings_hash, state_size, save, restore};
  return (capi_subject){&kind, v, &v->guard};
}

int vs_capi_vss_state_size(vs_capi_vss *v, size_t *size, char *error, size_t error_size) {
  return vs_capi_snapshot_size(subject(v), size, error, error_size);
}

int vs_capi_vss_save(vs_capi_vss *v, void *state, size_t size, char *error, size_t error_size) {
  return vs_capi_snapshot_copy(subject(v), NULL, state, size, error, error_size);
}

int vs_capi_vss_restore(vs_capi_vss *v, const void *state, size_t size, char *error, size_t error_size) {
  return vs_capi_snapshot_copy(subject(v), state, NULL, size, error, error_size);
}

vs_status vs_capi_vss_picture(vs_capi_vss *v, int env, vs_world *world, vs_game *game, vs_error *err) {
  vs_status s = vs_capi_enter(&v->guard, err);
  if (s != VS_OK) return s;
  if (env < 0 || env >= v->settings.envs)
    s = vs_fail(err, VS_USAGE, "environment %d: there are %d", env, v->settings.envs);
  if (s == VS_OK) {
    const vss_v0 *e = &v->env[env];
    *world = e->world;
    *game = (vs_game){.time_s = e->steps / (double)CAPI_VSS_HZ, .duration_s = 1200.0 / CAPI_VSS_HZ};
  }
  vs_capi_leave(&v->guard);
  return s;
}
