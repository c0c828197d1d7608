// Where the paper's learned team passed its opponents, in million transitions: three a time step, 14.98 and 23.54 million
// steps (section VIII).
#ifndef VSSS_CLI_PLOT_PAPER_H
#define VSSS_CLI_PLOT_PAPER_H

#define VS_PLOT_PAPER_CROSSINGS 2
static const struct {
  const char *opponent; // as players are named
  double transitions_m;
  const char *text;
} vs_plot_paper[VS_PLOT_PAPER_CROSSINGS] = {{"inf:", 45.0, "paper passes INF"}, {"emc:", 71.0, "paper passes EMC"}};

#endif
