// What the command line of `vsss train` says, and what follows from it.
#ifndef VSSS_CLI_TRAIN_OPTIONS_H
#define VSSS_CLI_TRAIN_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "cli.h"
#include "vsss/learn.h"

// Texts are NULL where the flag was not given and has no default; numbers 0.
typedef struct train_options {
  const char *preset, *config, *run, *resume, *export, *slim, *untrained, *opponent, *reward, *reward_end, *realism,
      *learner, *imitate, *eval_against, *eval_drive, *seed;
  int threads, imitate_updates, eval_matches;
  double minutes, transitions_m, checkpoint_min, keep_m, eval_min, eval_m;
  bool league;
  vs_flag_list set, average;
} train_options;

// --resume names a run's folder, or a checkpoint: then a new run begins with what that one had learnt.
bool train_resumes_file(const train_options *options);
void train_checkpoint_to_resume(const train_options *options, char *path, size_t size);
// The settings of the run: preset or checkpoint, then file, then flags: later ones win.
vs_status train_settings(const train_options *options, vs_train_def *def, vs_error *err);
// The user says how long to train.
bool train_sets_limit(const train_options *options);

#endif
