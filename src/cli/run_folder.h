// The folder of a training run: one training at a time, and who trained in it, when, where, with what command.
#ifndef VSSS_CLI_RUN_FOLDER_H
#define VSSS_CLI_RUN_FOLDER_H

#include <stddef.h>

#include "vsss/status.h"

// Makes the folder where it is not there and locks it for as long as this process lives: lock holds who has it, and a
// second training is refused with that.
vs_status vs_run_folder_lock(const char *folder, vs_error *err);
// Adds to folder/history.txt when and where this program was started, its commit and the command line.
vs_status vs_run_folder_note(const char *folder, const char *command, const char *commit, vs_error *err);
// Prints the commands that may come next, to be pasted; limit_m: of a run that has reached it, else 0.
void vs_run_folder_next(const char *folder, double limit_m);

#endif
