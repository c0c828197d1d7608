// Figures of several training runs side by side: a panel for each opponent of their evaluations, a curve for each run.
#ifndef VSSS_CLI_PLOT_COMPARE_H
#define VSSS_CLI_PLOT_COMPARE_H

#include <stdbool.h>

#include "vsss/status.h"

typedef struct vs_plot_compare_def {
  int runs;
  const char *const *run; // their folders, each with an eval.csv
  bool minutes;           // over minutes of training instead of transitions
  bool svg;               // instead of PNG
} vs_plot_compare_def;

// Makes the folder where it is not there, draws compare_win and compare_score into it and prints their names.
vs_status vs_plot_compare(const vs_plot_compare_def *def, const char *folder, vs_error *err);

#endif
