// Saves and restores a training run, bit for bit.
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "archive.h"
#include "league_file.h"
#include "train_internal.h"
#include "train_matches.h"
#include "vsss/check.h"
#include "vsss/contract.h"

// What a checkpoint holds, and the versions of it (archive.h). The league's are in league_file.c. Adam's m and v are
// called mean and square in the file, as they always were.
static const vs_section contract_section = {"contract", 1, 1};
static const vs_section settings_section = {"settings", 1, 2}; // 2: names of before are read, not written
static const vs_section counters_section = {"counters", 1, 1};
static const vs_section parameters_section = {"parameters", 1, 1};
static const vs_section m_section = {"mean", 1, 1};
static const vs_section v_section = {"square", 1, 1};
static const vs_section actor_mean_section = {"actor_mean", 1, 1}; // not in a slim one, nor in those of before
static const vs_section observation_section = {"observation", 1, 1};
static const vs_section matches_section = {"matches", VS_VECENV_STATE, VS_VECENV_STATE};

enum { NOTE_SIZE = 256 }; // of vs_train_load

// The numbers of a run that are no arrays.
typedef struct counters {
  int64_t updates, transitions, adam_steps, decision;
  double wall_s;
  vs_value_scale scale;
} counters;

// What every checkpoint holds: settings, counters, networks, Adam.
static void save_learner(const vs_train *train, vs_bytes *out) {
  const vs_learner *l = &train->learner;
  char settings[VS_TRAIN_TEXT_MAX];
  counters numbers;
  memset(&numbers, 0, sizeof numbers);
  numbers.updates = train->updates, numbers.transitions = train->transitions;
  numbers.adam_steps = l->steps, numbers.decision = train->rollout.decision;
  numbers.wall_s = train->wall_s;
  numbers.scale = train->scale;
  vs_archive_begin(out);
  vs_archive_section(out, &contract_section, vs_contract_hash_hex(), 16);
  vs_archive_section(out, &settings_section, settings,
                     vs_train_def_text(&train->def, false, settings, sizeof settings));
  vs_archive_section(out, &counters_section, &numbers, sizeof numbers);
  vs_archive_section(out, &parameters_section, l->parameters, l->net.size * sizeof(float));
  vs_archive_section(out, &m_section, l->m, l->net.size * sizeof(float));
  vs_archive_section(out, &v_section, l->v, l->net.size * sizeof(float));
}

static vs_status add_matches(const vs_train *train, vs_bytes *out, vs_error *err) {
  vs_archive_section(out, &observation_section, train->rollout.io.observation,
                     (size_t)VS_VECENV_ROWS(train->def.envs) * VS_OBS_SIZE * sizeof(float));
  size_t size = train->matches.state_size(train->matches.self);
  if (size == 0) return vs_fail(err, VS_FAIL, "an opponent of this run cannot be saved");
  // Aligned as malloc'd memory is: the matches may keep doubles and vectors in it.
  void *state = aligned_alloc(64, (size + 63) / 64 * 64);
  if (!state) return vs_fail(err, VS_FAIL, "out of memory for a checkpoint");
  memset(state, 0, size);
  train->matches.save(train->matches.self, state);
  vs_archive_section(out, &matches_section, state, size);
  free(state);
  return VS_OK;
}

// All of a run. Before its first update there are no matches yet, and the networks alone are all.
static vs_status save_whole(const vs_train *train, vs_bytes *out, vs_error *err) {
  save_learner(train, out);
  if (!train->started) return VS_OK;
  if (train->actor_mean)
    vs_archive_section(out, &actor_mean_section, train->actor_mean, train->league.size * sizeof(float));
  vs_league_save(&train->league, out);
  return add_matches(train, out, err);
}

// Two threads may want to write a checkpoint: the one that trains, and the one that an interrupt woke.
static vs_status write_alone(vs_train *train, vs_bytes *archive, const char *path, vs_error *err) {
  pthread_mutex_lock(&train->kept.lock);
  vs_status s = vs_archive_write(archive, path, err);
  pthread_mutex_unlock(&train->kept.lock);
  return s;
}

vs_status vs_train_save_slim(vs_train *train, const char *path, vs_error *err) {
  vs_bytes out = {0};
  save_learner(train, &out);
  return write_alone(train, &out, path, err);
}

vs_status vs_train_save(vs_train *train, const char *path, vs_error *err) {
  vs_bytes out = {0};
  vs_status s = save_whole(train, &out, err);
  if (s == VS_OK) return write_alone(train, &out, path, err);
  vs_bytes_free(&out);
  return vs_fail_prefix(err, "%s", path);
}

vs_status vs_train_keep(vs_train *train, vs_error *err) {
  pthread_mutex_lock(&train->kept.lock);
  train->kept.state.size = 0; // what it holds is overwritten in place
  vs_status s = save_whole(train, &train->kept.state, err);
  if (s == VS_OK && train->kept.state.failed) s = vs_fail(err, VS_FAIL, "out of memory for a checkpoint");
  if (s != VS_OK) vs_bytes_free(&train->kept.state);
  train->kept.update = (double)train->updates;
  pthread_mutex_unlock(&train->kept.lock);
  return s;
}

vs_status vs_train_save_kept(vs_train *train, const char *path, double *update, vs_error *err) {
  pthread_mutex_lock(&train->kept.lock);
  vs_status s = train->kept.state.size ? vs_archive_write(&train->kept.state, path, err)
                                       : vs_fail(err, VS_FAIL, "%s: nothing to save yet", path);
  if (update) *update = train->kept.update;
  pthread_mutex_unlock(&train->kept.lock);
  return s;
}

// Opens path, or path.previous where path is damaged or missing; used gets the name of the one that was read.
static vs_status read_either(const char *path, vs_bytes *archive, char *used, size_t used_size, char *note,
                             vs_error *err) {
  vs_error first = {0};
  if (note) note[0] = '\0';
  snprintf(used, used_size, "%s", path);
  if (vs_archive_read(path, archive, &first) == VS_OK) return VS_OK;
  snprintf(used, used_size, "%s.previous", path);
  if (vs_archive_read(used, archive, NULL) != VS_OK) return vs_fail(err, VS_FAIL, "%s", first.text);
  if (note) snprintf(note, NOTE_SIZE, "%.150s; continuing from %.80s", first.text, used);
  return VS_OK;
}

static vs_status check_contract(const vs_bytes *archive, const char *path, vs_error *err) {
  vs_found found;
  vs_status s = vs_archive_find(archive, path, &contract_section, 16, &found, err);
  if (s == VS_OK && memcmp(found.data, vs_contract_hash_hex(), 16) != 0)
    return vs_fail(err, VS_FAIL, "%s: made for contract %.16s, this program's is %s: train anew", path,
                   (const char *)found.data, vs_contract_hash_hex());
  return s;
}

static vs_status load_def(const vs_bytes *archive, const char *path, vs_train_def *out, vs_error *err) {
  vs_found found;
  vs_status s = check_contract(archive, path, err);
  if (s == VS_OK) s = vs_archive_find(archive, path, &settings_section, 0, &found, err);
  if (s != VS_OK) return s;
  char text[VS_TRAIN_TEXT_MAX];
  int length = (int)(found.size < sizeof text ? found.size : sizeof text - 1);
  snprintf(text, sizeof text, "%.*s", length, (const char *)found.data);
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  *out = vs_train_def_default();
  vs_train_def_before(out);
  vs_train_schema(out, keys);
  s = vs_config_parse(path, text, keys, err);
  return s == VS_OK ? VS_OK : vs_fail_prefix(err, "a setting of a newer vsss");
}

vs_status vs_train_read_def(const char *path, vs_train_def *out, vs_error *err) {
  vs_bytes archive;
  char used[PATH_MAX];
  vs_status s = read_either(path, &archive, used, sizeof used, NULL, err);
  if (s != VS_OK) return s;
  s = load_def(&archive, used, out, err);
  vs_bytes_free(&archive);
  return s;
}

static vs_status load_floats(const vs_bytes *archive, const char *path, const vs_section *section, float *out,
                             size_t count, vs_error *err) {
  vs_found found;
  vs_status s = vs_archive_find(archive, path, section, count * sizeof *out, &found, err);
  if (s != VS_OK) return s;
  memcpy(out, found.data, count * sizeof *out);
  if (vs_all_finite_floats(out, count)) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: '%s' holds what is no number", path, section->name);
}

// Numbers that a run has. on is a bool: it is what the settings say, not what the file does.
static bool counters_ok(const counters *c) {
  const vs_value_scale *v = &c->scale;
  return c->updates >= 0 && c->transitions >= 0 && c->adam_steps >= 0 && c->decision >= 0 &&
         c->updates < INT64_C(1) << 53 && c->transitions < INT64_C(1) << 53 && isfinite(c->wall_s) &&
         c->wall_s >= 0.0 && vs_all_finite(&v->mean, 5) && v->deviation > 0.0 && v->weight >= 0.0;
}

static vs_status load_matches(vs_train *t, const vs_bytes *archive, const char *path, vs_error *err) {
  vs_found found;
  // Matches are restored into ones that have started (their players are there from then on), from aligned memory.
  vs_status s = t->matches.reset(t->matches.self, &t->rollout.io, err);
  if (s != VS_OK) return s;
  size_t size = t->matches.state_size(t->matches.self);
  s = vs_archive_find(archive, path, &matches_section, size, &found, err);
  if (s != VS_OK) return s;
  void *state = aligned_alloc(64, (size + 63) / 64 * 64);
  if (!state) s = vs_fail(err, VS_FAIL, "%s: out of memory", path);
  if (s == VS_OK) {
    memcpy(state, found.data, size);
    s = t->matches.restore(t->matches.self, state, err);
    if (s != VS_OK) vs_fail_prefix(err, "%s: 'matches'", path);
  }
  free(state);
  size_t observations = (size_t)VS_VECENV_ROWS(t->def.envs) * VS_OBS_SIZE;
  if (s == VS_OK) s = load_floats(archive, path, &observation_section, t->rollout.io.observation, observations, err);
  return s;
}

// The archive of rank 0, on all ranks. What rank 0 failed with, the others say too.
static vs_status share_archive(const vs_group *g, vs_status status, vs_bytes *archive, vs_error *err) {
  struct {
    uint64_t size;
    int32_t status;
    vs_error error;
  } head = {archive->size, (int32_t)status, err ? *err : (vs_error){0}};
  vs_status s = g->broadcast(g->self, &head, sizeof head, err);
  if (s != VS_OK) return s;
  if (head.status != VS_OK) return vs_fail(err, (vs_status)head.status, "%s", head.error.text);
  if (g->rank != 0 && !vs_bytes_room(archive, head.size)) return vs_fail(err, VS_FAIL, "out of memory");
  return g->broadcast(g->self, archive->data, archive->size, err);
}

// The league of the file, as far as the run's own settings are those of before: other matches share out its earlier selves
// anew, another mix of opponents begins with the networks as they are, as do the files without a league.
static vs_status load_league(vs_train *t, const vs_bytes *archive, const char *path, const vs_train_def *before,
                             vs_error *err) {
  vs_found found;
  if (vs_archive_has(archive, "league", &found) && strcmp(before->opponent, t->def.opponent) == 0)
    return vs_league_load(&t->league, archive, path, before->envs != t->def.envs, err);
  vs_train_hand_over(t);
  return VS_OK;
}

// Adds to the note of vs_train_load that matches begin anew, as setting is another, and whether the pool does too.
static void note_new_matches(char *note, const char *setting, bool pool) {
  size_t length = strlen(note);
  snprintf(note + length, NOTE_SIZE - length, "%s'%s' is not as before: matches%s begin anew", length ? "; " : "",
           setting, pool ? " and the pool of earlier selves" : "");
}

static vs_status load(vs_train *t, const vs_bytes *archive, const char *path, char *note, vs_error *err) {
  vs_found found;
  counters numbers;
  vs_train_def before;
  vs_learner *l = &t->learner;
  vs_status s = load_def(archive, path, &before, err);
  if (s == VS_OK) s = vs_archive_find(archive, path, &counters_section, sizeof numbers, &found, err);
  if (s != VS_OK) return s;
  memcpy(&numbers, found.data, sizeof numbers);
  if (!counters_ok(&numbers)) return vs_fail(err, VS_FAIL, "%s: 'counters' holds a number that no run has", path);
  numbers.scale.on = t->def.value_scale;
  s = load_floats(archive, path, &parameters_section, l->parameters, l->net.size, err);
  if (s == VS_OK) s = load_floats(archive, path, &m_section, l->m, l->net.size, err);
  if (s == VS_OK) s = load_floats(archive, path, &v_section, l->v, l->net.size, err);
  if (s == VS_OK) s = load_league(t, archive, path, &before, err);
  vs_actor_mean_restart(t);
  if (s == VS_OK && t->actor_mean && vs_archive_has(archive, actor_mean_section.name, &found))
    s = load_floats(archive, path, &actor_mean_section, t->actor_mean, t->league.size, err);
  // The file holds the matches of rank 0; other ranks start theirs anew, and their slots' episodes with them.
  const char *differ = vs_train_matches_differ(&before, &t->def);
  bool whole = vs_archive_has(archive, matches_section.name, &found), first = vs_group_rank(t->group) == 0;
  bool matches = whole && first && !differ;
  if (whole && first && differ && note) note_new_matches(note, differ, strcmp(before.opponent, t->def.opponent) != 0);
  if (s == VS_OK && matches) s = load_matches(t, archive, path, err);
  if (s != VS_OK) return s;
  t->updates = numbers.updates, t->transitions = numbers.transitions, t->wall_s = numbers.wall_s;
  t->scale = numbers.scale;
  l->steps = numbers.adam_steps;
  t->rollout.decision = numbers.decision;
  t->started = matches;
  return VS_OK;
}

// The archive at path (or the one before it) on every rank of the run's group.
static vs_status read_on_all(vs_train *train, const char *path, vs_bytes *archive, char *used, size_t used_size,
                             char *note, vs_error *err) {
  vs_status s = VS_OK;
  snprintf(used, used_size, "%s", path);
  if (note) note[0] = '\0';
  if (vs_group_rank(train->group) == 0) s = read_either(path, archive, used, used_size, note, err);
  return train->group ? share_archive(train->group, s, archive, err) : s;
}

vs_status vs_train_load(vs_train *train, const char *path, char *note, vs_error *err) {
  vs_bytes archive = {0};
  char used[PATH_MAX];
  vs_status s = read_on_all(train, path, &archive, used, sizeof used, note, err);
  if (s == VS_OK) s = load(train, &archive, used, note, err);
  vs_bytes_free(&archive);
  return s;
}

// One checkpoint's networks and moments, added to sum: [3][net.size], as the sections stand below.
static vs_status add_up(vs_train *train, const char *path, float *scratch, double *sum, vs_error *err) {
  vs_bytes archive = {0};
  char used[PATH_MAX];
  const size_t size = train->learner.net.size;
  vs_status s = read_on_all(train, path, &archive, used, sizeof used, NULL, err);
  if (s == VS_OK) s = check_contract(&archive, used, err);
  const vs_section *const sections[] = {&parameters_section, &m_section, &v_section};
  for (int k = 0; s == VS_OK && k < 3; k++) {
    s = load_floats(&archive, used, sections[k], scratch, size, err);
    for (size_t i = 0; s == VS_OK && i < size; i++) sum[(size_t)k * size + i] += (double)scratch[i];
  }
  vs_bytes_free(&archive);
  return s;
}

vs_status vs_train_average(vs_train *train, const char *const *paths, int count, vs_error *err) {
  if (count == 0) return VS_OK;
  vs_learner *l = &train->learner;
  const size_t size = l->net.size;
  float *own[] = {l->parameters, l->m, l->v};
  double *sum = calloc(3 * size, sizeof *sum);
  float *scratch = calloc(size, sizeof *scratch);
  vs_status s = sum && scratch ? VS_OK : vs_fail(err, VS_FAIL, "out of memory for the mean of checkpoints");
  for (int i = 0; s == VS_OK && i < count; i++) s = add_up(train, paths[i], scratch, sum, err);
  for (int k = 0; s == VS_OK && k < 3; k++)
    for (size_t i = 0; i < size; i++)
      own[k][i] = (float)((sum[(size_t)k * size + i] + (double)own[k][i]) / (count + 1));
  free(sum);
  free(scratch);
  if (s == VS_OK && !train->started) vs_train_hand_over(train);
  return s;
}
