#include "plot_paper.h"

// Three transitions a time step: 14.98 and 23.54 million steps (section VIII).
const vs_plot_crossing vs_plot_paper[VS_PLOT_PAPER_CROSSINGS] = {{"inf:", 45.0, "paper passes INF"},
                                                                 {"emc:", 71.0, "paper passes EMC"}};

void vs_plot_mark_crossing(FILE *script, const vs_plot_crossing *crossing, const char *label) {
  double x = crossing->transitions_m;
  fprintf(script,
          "set arrow from %g, graph 0 to %g, graph 1 nohead dashtype 2 lc rgb 'gray40'\n"
          "set label '%s' at %g, %s textcolor rgb 'gray40'\n",
          x, x, crossing->text, x, label);
}
