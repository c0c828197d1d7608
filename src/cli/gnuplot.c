#include "gnuplot.h"

#include <errno.h>
#include <string.h>

#include "child.h"

vs_status vs_gnuplot_begin(vs_gnuplot *g, vs_error *err) {
  *g = (vs_gnuplot){.script = tmpfile(), .said = tmpfile()};
  if (g->script && g->said) return VS_OK;
  vs_status s = vs_fail(err, VS_FAIL, "a temporary file: %s", strerror(errno));
  vs_gnuplot_end(g);
  return s;
}

vs_status vs_gnuplot_run(vs_gnuplot *g, const char *folder, vs_error *err) {
  char *argv[] = {"gnuplot", "-", NULL}, line[256], why[256] = "no reason given";
  if (fflush(g->script) != 0 || fseek(g->script, 0, SEEK_SET) != 0)
    return vs_fail(err, VS_FAIL, "a temporary file: %s", strerror(errno));
  const vs_child_def def = {.argv = argv, .folder = folder, .in = fileno(g->script), .err = fileno(g->said)};
  pid_t child;
  int failed = vs_child_start(&def, &child);
  if (failed == ENOENT) return vs_fail(err, VS_FAIL, "gnuplot is missing: apt install gnuplot-nox");
  if (failed) return vs_fail(err, VS_FAIL, "cannot start gnuplot: %s", strerror(failed));
  if (vs_child_wait(child) == 0) return VS_OK;
  rewind(g->said);
  while (fgets(line, sizeof line, g->said)) {
    line[strcspn(line, "\n")] = '\0';
    if (line[0] && strncmp(line, "Warning", 7) != 0) memcpy(why, line, sizeof why);
  }
  return vs_fail(err, VS_FAIL, "gnuplot: %s", why);
}

void vs_gnuplot_end(vs_gnuplot *g) {
  if (g->script) fclose(g->script);
  if (g->said) fclose(g->said);
  *g = (vs_gnuplot){0};
}

// In single quotes gnuplot takes everything as it is but the quote, which is written twice, and the end of a line, which
// ends the command too.
void vs_gnuplot_quote(FILE *script, const char *text) {
  fputc('\'', script);
  for (; *text; text++) fprintf(script, *text == '\'' ? "''" : "%c", *text == '\n' ? ' ' : *text);
  fputc('\'', script);
}

void vs_gnuplot_terminal(FILE *script, bool svg, int width, int height) {
  fprintf(script, "set terminal %s size %d,%d font 'sans,%d'\n", svg ? "svg" : "pngcairo", width, height,
          svg ? 14 : 12);
}
