#include "train_options.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "vsss/number.h"

bool train_resumes_file(const train_options *o) {
  struct stat info;
  return o->resume && stat(o->resume, &info) == 0 && S_ISREG(info.st_mode);
}

void train_checkpoint_to_resume(const train_options *o, char *path, size_t size) {
  snprintf(path, size, train_resumes_file(o) ? "%s" : "%s/checkpoint", o->resume);
}

vs_status train_settings(const train_options *o, vs_train_def *def, vs_error *err) {
  char checkpoint[PATH_MAX];
  vs_status s = VS_OK;
  if (o->resume) {
    train_checkpoint_to_resume(o, checkpoint, sizeof checkpoint);
    s = vs_train_read_def(checkpoint, def, err);
  } else {
    s = vs_train_def_preset(o->preset, def, err);
  }
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  vs_train_schema(def, keys);
  if (s == VS_OK && o->config) s = vs_config_load(o->config, keys, err);
  for (int i = 0; s == VS_OK && i < o->set.count; i++) s = vs_config_set(o->set.value[i], keys, err);
  const struct {
    const char *key, *value;
  } texts[] = {{"opponent", o->league ? "self=0.6,pool=0.4" : NULL},
               {"opponent", o->opponent},
               {"reward", o->reward},
               {"reward_end", o->reward_end},
               {"realism", o->realism},
               {"learner", o->learner}};
  for (size_t i = 0; s == VS_OK && i < sizeof texts / sizeof *texts; i++) {
    char line[512];
    snprintf(line, sizeof line, "%s=%s", texts[i].key, texts[i].value ? texts[i].value : "");
    if (texts[i].value) s = vs_config_set(line, keys, err);
  }
  if (s == VS_OK && o->seed && !vs_parse_seed(o->seed, &def->seed))
    s = vs_fail(err, VS_USAGE, "--seed %s: expected a whole number from 0 to 2^64-1", o->seed);
  if (o->threads > 0) def->threads = o->threads;
  if (o->transitions_m > 0.0) def->transitions_m = o->transitions_m;
  return s == VS_OK ? vs_train_def_check(def, err) : s;
}

bool train_sets_limit(const train_options *o) {
  bool set = o->transitions_m > 0.0 || o->config;
  for (int i = 0; i < o->set.count; i++) set |= strncmp(o->set.value[i], "transitions_m", 13) == 0;
  return set;
}
