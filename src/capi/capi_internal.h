// What the files of the C interface for bindings share: who may use a handle now, texts of errors, arrays by name.
#ifndef VSSS_CAPI_INTERNAL_H
#define VSSS_CAPI_INTERNAL_H

#include <stdatomic.h>
#include <sys/types.h>

#include "vsss/capi.h"
#include "vsss/vecenv.h"

// Owner of a handle: one process, one call at a time.
typedef struct capi_guard {
  pid_t pid;
  atomic_flag busy;
} capi_guard;

void vs_capi_guard_init(capi_guard *guard);
// VS_USAGE: called from a fork, or within another call. Else vs_capi_leave must follow.
vs_status vs_capi_enter(capi_guard *guard, vs_error *err);
void vs_capi_leave(capi_guard *guard);

// Copies err's line where the caller wants it; returns status.
int vs_capi_told(vs_status status, const vs_error *err, char *error, size_t error_size);

// One array of the caller.
typedef struct capi_array {
  const char *name;
  void **slot;
  size_t bytes;
} capi_array;
vs_status vs_capi_bind_array(const capi_array *arrays, int n, const char *name, void *data, size_t bytes,
                             vs_error *err);
vs_status vs_capi_all_bound(const capi_array *arrays, int n, vs_error *err);

// settings.c: "key=value" texts.
enum { CAPI_SETTINGS_MAX = 40 };
typedef struct capi_settings {
  int envs, threads;
  uint64_t seed;
  char drive[32], rules[32], placement[32], predicts[16], realism[4096], reward[512], blue[512], yellow[512];
  double episode_s, still_low_s, still_high_s, start_open, start_penalty, start_free_ball;
  int goal_difference_stop, halves;
  bool end_at_first_goal, either_kicks_off, shuffle_adversaries, stay_over;
} capi_settings;
const char *vs_capi_setting(int index, bool help); // NULL past the end
vs_status vs_capi_settings_read(const char *const *texts, capi_settings *out, vs_error *err);
// Loads the model, which the caller frees, also after a failure where it is not NULL.
vs_status vs_capi_settings_open(const capi_settings *settings, vs_vecenv_def *def, vs_model **model,
                                vs_reward_weights *weights, vs_error *err);
// Of all that a snapshot depends on.
uint64_t vs_capi_settings_hash(const capi_settings *settings);
// A path, or the text of such a file where it has a line break; "" is the default. kept: a copy of value.
vs_status vs_capi_realism(const char *value, char *kept, size_t size, vs_realism *out, vs_error *err);
// Sets one key of a schema; the error names the setting alone.
vs_status vs_capi_set(const char *text, const void *schema, vs_error *err);

// What can be snapshotted, as a table. States are aligned to 64 bytes.
typedef struct capi_snapshot_kind {
  uint64_t (*settings)(const void *self); // hash of all that a snapshot depends on
  size_t (*state_size)(const void *self); // 0: some player cannot be copied
  void (*save)(const void *self, void *state);
  vs_status (*restore)(void *self, const void *state, vs_error *err);
} capi_snapshot_kind;
typedef struct capi_subject {
  const capi_snapshot_kind *kind;
  void *self;
  capi_guard *guard;
} capi_subject;
// The exported functions of each kind: a snapshot's size; one out of `from` or into `to`, the other NULL.
int vs_capi_snapshot_size(capi_subject subject, size_t *size, char *error, size_t error_size);
int vs_capi_snapshot_copy(capi_subject subject, const void *from, void *to, size_t size, char *error,
                          size_t error_size);

// The numbers of vs_capi_vec_world (VS_CAPI_WORLD doubles).
void vs_capi_write_world(const vs_world *world, const vs_game *game, double *out);

// For capi_render.c.
vs_status vs_capi_vec_picture(vs_capi_vec *vec, int env, vs_world *world, vs_game *game, vs_error *err);
vs_status vs_capi_vss_picture(vs_capi_vss *vss, int env, vs_world *world, vs_game *game, vs_error *err);
const char *vs_capi_vss_setting(int index, bool help);
const char *vs_capi_shaping(int index);
const char *vs_capi_summary(int index);
enum { CAPI_SUMMARY = 6 * 3 + 5, CAPI_SHAPING = 6, CAPI_VSS_OBSERVATION = 40, CAPI_VSS_ACTION = 2, CAPI_VSS_HZ = 40 };

#endif
