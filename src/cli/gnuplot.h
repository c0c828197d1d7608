// gnuplot as a child process: a script is written, then run.
#ifndef VSSS_CLI_GNUPLOT_H
#define VSSS_CLI_GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>

#include "vsss/status.h"

typedef struct vs_gnuplot {
  FILE *script; // what it will be told; the caller writes
  FILE *said;   // what it says, of which only the reason of a failure is worth reading
} vs_gnuplot;

vs_status vs_gnuplot_begin(vs_gnuplot *g, vs_error *err);
// Runs the script in that folder.
vs_status vs_gnuplot_run(vs_gnuplot *g, const char *folder, vs_error *err);
void vs_gnuplot_end(vs_gnuplot *g);

// Any text as a string of gnuplot's that it takes as it is.
void vs_gnuplot_quote(FILE *script, const char *text);
// The terminal: width and height in pixels.
void vs_gnuplot_terminal(FILE *script, bool svg, int width, int height);

#endif
