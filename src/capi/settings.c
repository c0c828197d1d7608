// The settings of vs_capi_vec_new: names as in the INI files of ./vsss train and its flags.
#include <limits.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/config_rows.h"
#include "capi_internal.h"
#include "learn/reward_mix.h"
#include "vsss/config.h"
#include "vsss/paths.h"

static void schema_of(capi_settings *d, vs_config_key keys[CAPI_SETTINGS_MAX]) {
  const vs_config_key rows[] = {
      WHOLE(envs, 1, 4096, "matches side by side"),
      WHOLE(threads, 1, 256, "threads; results do not depend on them"),
      SEED(seed, "everything random follows from it"),
      TEXT(drive, "planar (fast) or contact (the reference)"),
      TEXT(rules, "paper or league"),
      TEXT(placement, "restarts: random (legal poses), paper, or mixed: each one or the other"),
      REAL(episode_s, 0, 3600, "an episode ends here; 0: 40 s, or a match's length where goals do not end it"),
      TEXT(realism, "INI file of sensors and dynamics, drawn anew each episode; empty: the paper's noise"),
      TEXT(predicts, "who sees the world moved on by the delay: learned (and whoever calls), none or all"),
      TEXT(reward, "paper, dense or goals, then term=weight"),
      TEXT(blue, "URI of blue's player, such as emc:; empty: whoever calls"),
      TEXT(yellow, "... of yellow's"),
      WHOLE(goal_difference_stop, 0, 1000, "goals of difference that end a match; 0: never"),
      WHOLE(halves, 1, 2, "halves of a match"),
      SWITCH(end_at_first_goal, "a goal ends the episode (training) or not (matches)"),
      SWITCH(either_kicks_off, "kick-offs by a team drawn at random, not by blue"),
      SWITCH(shuffle_adversaries, "adversaries are observed in an order drawn for each episode"),
      REAL(still_low_s, 0, 60,
           "free ball after so many seconds of a still ball, drawn for each episode; 0: the rules'"),
      REAL(still_high_s, 0, 60, "... up to"),
      REAL(start_open, 0, 1, "share of episodes that begin in open play, ball rolling"),
      REAL(start_penalty, 0, 1, "... with a penalty"),
      REAL(start_free_ball, 0, 1, "... with a free ball; the rest with a kick-off"),
      SWITCH(stay_over, "an ended match waits to be started"),
      {.name = NULL},
  };
  _Static_assert(sizeof rows / sizeof *rows <= CAPI_SETTINGS_MAX, "raise CAPI_SETTINGS_MAX");
  memcpy(keys, rows, sizeof rows);
}

const char *vs_capi_setting(int index, bool help) {
  capi_settings settings;
  vs_config_key keys[CAPI_SETTINGS_MAX] = {{0}};
  schema_of(&settings, keys);
  for (int i = 0; i <= index; i++)
    if (!keys[i].name) return NULL;
  return help ? keys[index].help : keys[index].name;
}

vs_status vs_capi_set(const char *text, const void *schema, vs_error *err) {
  vs_error own = {0};
  vs_status s = vs_config_set(text, schema, &own);
  if (s == VS_OK) return s;
  static const char by_flag[] = "command line: ";
  const char *line = own.text;
  if (!strncmp(line, by_flag, strlen(by_flag))) line += strlen(by_flag);
  return vs_fail(err, s, "%s", line);
}

vs_status vs_capi_realism(const char *value, char *kept, size_t size, vs_realism *out, vs_error *err) {
  if (strlen(value) >= size) return vs_fail(err, VS_USAGE, "realism: longer than %zu characters", size - 1);
  memcpy(kept, value, strlen(value) + 1);
  *out = vs_realism_default();
  if (!value[0]) return VS_OK;
  if (strchr(value, '\n')) return vs_realism_parse("realism", value, out, err);
  char found[PATH_MAX];
  if (access(value, R_OK) != 0 && vs_path_find(value, found, sizeof found, NULL) == VS_OK) value = found;
  return vs_realism_load(value, out, err);
}

vs_status vs_capi_settings_read(const char *const *texts, capi_settings *out, vs_error *err) {
  static const char realism[] = "realism=";
  *out = (capi_settings){.envs = 1,
                         .threads = 1,
                         .seed = 1,
                         .drive = "planar",
                         .rules = "paper",
                         .placement = "random",
                         .predicts = "learned",
                         .reward = "dense",
                         .goal_difference_stop = 10,
                         .halves = 1,
                         .end_at_first_goal = true};
  vs_config_key schema[CAPI_SETTINGS_MAX] = {{0}};
  schema_of(out, schema);
  for (; *texts; texts++) {
    if (!strncmp(*texts, realism, strlen(realism))) { // may be a whole file
      vs_realism checked;
      vs_status s = vs_capi_realism(*texts + strlen(realism), out->realism, sizeof out->realism, &checked, err);
      if (s != VS_OK) return s;
      continue;
    }
    vs_status s = vs_capi_set(*texts, schema, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

static vs_status read_rules(const capi_settings *s, vs_referee_def *out, vs_error *err) {
  vs_rules rules;
  vs_status status = vs_rules_parse(s->rules, &rules, err);
  if (status != VS_OK) return status;
  *out = s->end_at_first_goal ? vs_referee_def_training() : vs_referee_def_default(rules);
  out->rules = rules;
  out->end_at_first_goal = s->end_at_first_goal;
  out->goal_difference_stop = s->goal_difference_stop;
  out->halves = s->halves;
  if (s->episode_s > 0) out->duration_s = s->episode_s;
  return vs_placement_parse(s->placement, &out->placement, err);
}

vs_status vs_capi_settings_open(const capi_settings *s, vs_vecenv_def *def, vs_model **model,
                                vs_reward_weights *weights, vs_error *err) {
  vs_drive drive;
  vs_status status = vs_drive_parse(s->drive, &drive, err);
  if (status != VS_OK) return status;
  if (s->start_open + s->start_penalty + s->start_free_ball > 1)
    return vs_fail(err, VS_USAGE, "start_open, start_penalty and start_free_ball are shares: their sum is above 1");
  if (s->still_low_s > s->still_high_s)
    return vs_fail(err, VS_USAGE, "still_low_s = %g is above still_high_s = %g", s->still_low_s, s->still_high_s);
  vs_env_def env = vs_env_def_default(NULL);
  status = vs_reward_mix_parse(s->reward, weights, err);
  if (status == VS_OK) status = read_rules(s, &env.referee, err);
  if (status == VS_OK) status = vs_predicts_parse(s->predicts, &env.predicts, err);
  char kept[sizeof s->realism];
  if (status == VS_OK) status = vs_capi_realism(s->realism, kept, sizeof kept, &env.realism, err);
  if (status != VS_OK) return status;
  vs_model_def model_def = vs_model_def_default(drive);
  status = vs_model_load(&model_def, model, err);
  if (status != VS_OK) return status;
  env.model = *model;
  env.player[VS_BLUE] = s->blue[0] ? s->blue : NULL;
  env.player[VS_YELLOW] = s->yellow[0] ? s->yellow : NULL;
  env.shuffle_adversaries = s->shuffle_adversaries;
  env.episode = (vs_episode_def){.open_play = s->start_open,
                                 .penalty = s->start_penalty,
                                 .free_ball = s->start_free_ball,
                                 .still_low_s = s->still_low_s,
                                 .still_high_s = s->still_high_s,
                                 .either_kicks_off = s->either_kicks_off};
  *def = (vs_vecenv_def){.env = env,
                         .envs = s->envs,
                         .threads = s->threads < s->envs ? s->threads : s->envs,
                         .seed = s->seed,
                         .stay_over = s->stay_over};
  bool both = !env.player[VS_BLUE] == !env.player[VS_YELLOW];
  def->teams = both ? VS_ROWS_BOTH : env.player[VS_BLUE] ? VS_ROWS_YELLOW : VS_ROWS_BLUE;
  return VS_OK;
}

uint64_t vs_capi_settings_hash(const capi_settings *settings) {
  capi_settings s = *settings;
  s.threads = s.seed = 0;
  vs_config_key keys[CAPI_SETTINGS_MAX] = {{0}};
  schema_of(&s, keys);
  uint64_t hash = vs_hash_bytes(VS_HASH_START, vs_contract_hash_hex(), 16);
  for (const vs_config_key *k = keys; k->name; k++) {
    size_t size = k->type == VS_CONFIG_TEXT   ? strlen(k->target)
                  : k->type == VS_CONFIG_REAL ? sizeof(double)
                  : k->type == VS_CONFIG_INT  ? sizeof(int)
                  : k->type == VS_CONFIG_SEED ? sizeof(uint64_t)
                                              : sizeof(bool);
    hash = vs_hash_bytes(hash, k->target, size);
  }
  return hash;
}
