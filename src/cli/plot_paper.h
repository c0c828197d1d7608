// Where the paper's learned team passed its opponents.
#ifndef VSSS_CLI_PLOT_PAPER_H
#define VSSS_CLI_PLOT_PAPER_H

#include <stdio.h>

#define VS_PLOT_PAPER_CROSSINGS 2
typedef struct vs_plot_crossing {
  const char *opponent; // as players are named
  double transitions_m;
  const char *text;
} vs_plot_crossing;
extern const vs_plot_crossing vs_plot_paper[VS_PLOT_PAPER_CROSSINGS];

// A dashed line over the whole height; label: where its text stands, as gnuplot says it from the second coordinate on.
void vs_plot_mark_crossing(FILE *script, const vs_plot_crossing *crossing, const char *label);

#endif
