#include "train_matches.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "vsss/paths.h"

typedef struct sim_matches {
  vs_model *model;
  vs_vecenv *vec;
  int envs;
  vs_episode_def young, grown; // before start_from_m and after
  double start_from_m;
} sim_matches;

static const vs_episode_def *episode_at(const sim_matches *m, double transitions_m) {
  return transitions_m < m->start_from_m ? &m->young : &m->grown;
}

static void learnt(void *self, double transitions_m) {
  sim_matches *m = self;
  for (int i = 0; i < m->envs; i++) vs_env_set_episode(vs_vecenv_env(m->vec, i), episode_at(m, transitions_m));
}

static vs_status reset(void *self, const vs_vecenv_buffers *buffers, vs_error *err) {
  return vs_vecenv_reset(((sim_matches *)self)->vec, buffers, err);
}
static vs_status step(void *self, const vs_vecenv_buffers *buffers, vs_error *err) {
  return vs_vecenv_step(((sim_matches *)self)->vec, buffers, err);
}
static size_t state_size(const void *self) { return vs_vecenv_state_size(((const sim_matches *)self)->vec); }
static void save(const void *self, void *state) { vs_vecenv_save(((const sim_matches *)self)->vec, state); }
static vs_status restore(void *self, const void *state, vs_error *err) {
  return vs_vecenv_restore(((sim_matches *)self)->vec, state, err);
}

static void free_matches(void *self) {
  sim_matches *m = self;
  vs_vecenv_free(m->vec);
  vs_model_free(m->model);
  free(m);
}

// A path as it stands, or from where vsss is installed (the default recipe's).
static vs_status load_realism(const char *path, vs_realism *out, vs_error *err) {
  char found[PATH_MAX];
  bool here = access(path, R_OK) == 0;
  if (!here && vs_path_find(path, found, sizeof found, NULL) == VS_OK) path = found;
  return vs_realism_load(path, out, err);
}

static vs_status open_vecenv(sim_matches *m, const vs_train_def *def, int rank, vs_error *err) {
  vs_drive drive;
  vs_status s = vs_drive_parse(def->drive, &drive, err);
  if (s != VS_OK) return s;
  vs_model_def model = vs_model_def_default(drive);
  s = vs_model_load(&model, &m->model, err);
  if (s != VS_OK) return s;
  vs_vecenv_def vec = {.env = vs_env_def_default(m->model),
                       .envs = def->envs,
                       .threads = def->threads,
                       .seed = vs_seed_mix(def->seed, 2000 + (uint64_t)rank)};
  vec.env.referee = vs_referee_def_training();
  vec.env.referee.duration_s = def->episode_s;
  vec.env.referee.still_distance_m = def->still_distance_m;
  vec.env.shuffle_adversaries = true;
  m->envs = def->envs;
  m->start_from_m = def->start_from_m;
  m->young =
      (vs_episode_def){.still_low_s = def->still_high_s, .still_high_s = def->still_high_s, .either_kicks_off = true};
  m->grown = (vs_episode_def){.open_play = def->start_open,
                              .penalty = def->start_penalty,
                              .free_ball = def->start_free_ball,
                              .still_low_s = def->still_low_s,
                              .still_high_s = def->still_high_s,
                              .either_kicks_off = true};
  vec.env.episode = *episode_at(m, 0.0);
  s = vs_placement_parse(def->placement, &vec.env.referee.placement, err);
  if (s == VS_OK) s = vs_predicts_parse(def->predicts, &vec.env.predicts, err);
  if (s == VS_OK && def->realism[0]) s = load_realism(def->realism, &vec.env.realism, err);
  return s == VS_OK ? vs_vecenv_new(&vec, &m->vec, err) : s;
}

vs_status vs_train_matches_open(const vs_train_def *def, const vs_league *league, int rank, const char *both,
                                vs_matches *out, vs_error *err) {
  sim_matches *m = calloc(1, sizeof *m);
  if (!m) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = open_vecenv(m, def, rank, err);
  for (int env = 0; s == VS_OK && env < def->envs; env++) {
    for (int team = 0; both && s == VS_OK && team < VS_TEAMS; team++)
      s = vs_vecenv_set_player(m->vec, env, (vs_team)team, both, err);
    if (both || vs_league_kind(league, env) != VS_OPPONENT_SCRIPT) continue;
    vs_team other = league->slot[env].learner == VS_BLUE ? VS_YELLOW : VS_BLUE;
    s = vs_vecenv_set_player(m->vec, env, other, league->def.share[league->slot[env].share].uri, err);
  }
  if (s != VS_OK) {
    free_matches(m);
    return s;
  }
  *out = (vs_matches){m, learnt, reset, step, state_size, save, restore, free_matches};
  return VS_OK;
}

const char *vs_train_matches_differ(const vs_train_def *a, const vs_train_def *b) {
  if (strcmp(a->drive, b->drive) != 0) return "drive";
  if (strcmp(a->placement, b->placement) != 0) return "placement";
  if (a->episode_s != b->episode_s) return "episode_s";
  if (a->envs != b->envs) return "envs";
  return strcmp(a->opponent, b->opponent) != 0 ? "opponent" : NULL;
}
