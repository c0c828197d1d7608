#include "plot_compare.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gnuplot.h"
#include "plot_paper.h"
#include "vsss/number.h"
#include "vsss/paths.h"

// One row of an eval.csv.
typedef struct point {
  int run, opponent;
  double transitions_m, minutes, win_percent, score;
} point;

enum { OPPONENTS_MAX = 12 };
typedef struct points {
  int count, room;
  point *at;
  int opponents;
  char opponent[OPPONENTS_MAX][128];
} points;

static vs_status find_opponent(points *p, const char *name, int *out, vs_error *err) {
  for (*out = 0; *out < p->opponents; ++*out)
    if (!strcmp(p->opponent[*out], name)) return VS_OK;
  if (p->opponents == OPPONENTS_MAX)
    return vs_fail(err, VS_FAIL, "more than %d opponents: compare fewer runs at once", OPPONENTS_MAX);
  snprintf(p->opponent[p->opponents++], sizeof *p->opponent, "%s", name);
  return VS_OK;
}

static vs_status add(points *p, point new, vs_error *err) {
  if (p->count == p->room) {
    int room = p->room ? 2 * p->room : 256;
    point *grown = realloc(p->at, (size_t)room * sizeof *grown);
    if (!grown) return vs_fail(err, VS_FAIL, "out of memory");
    p->room = room;
    p->at = grown;
  }
  p->at[p->count++] = new;
  return VS_OK;
}

typedef enum column { TRANSITIONS, WALL_S, OPPONENT, WIN, SCORE, COLUMNS } column;
static const char *const column_name[COLUMNS] = {"transitions", "wall_s", "opponent", "win", "score"};

// cell: of each column what stands in this line, found by where stands[] says.
static bool split(char *line, const int stands[COLUMNS], const char *cell[COLUMNS]) {
  memset(cell, 0, COLUMNS * sizeof *cell);
  char *rest = line, *one;
  for (int i = 0; (one = strsep(&rest, ",\n")) != NULL; i++)
    for (int c = 0; c < COLUMNS; c++)
      if (stands[c] == i) cell[c] = one;
  for (int c = 0; c < COLUMNS; c++)
    if (!cell[c]) return false;
  return true;
}

static vs_status read_header(const char *path, char *line, int stands[COLUMNS], vs_error *err) {
  for (int c = 0; c < COLUMNS; c++) stands[c] = -1;
  char *rest = line, *one;
  for (int i = 0; (one = strsep(&rest, ",\n")) != NULL; i++)
    for (int c = 0; c < COLUMNS; c++)
      if (!strcmp(one, column_name[c])) stands[c] = i;
  for (int c = 0; c < COLUMNS; c++)
    if (stands[c] < 0) return vs_fail(err, VS_FAIL, "%s:1: no column '%s'", path, column_name[c]);
  return VS_OK;
}

static vs_status read_row(const char *path, int number, char *line, const int stands[COLUMNS], int run, points *p,
                          vs_error *err) {
  const char *cell[COLUMNS];
  point new = {.run = run};
  double transitions, wall_s, win;
  if (!split(line, stands, cell) || !vs_parse_real(cell[TRANSITIONS], &transitions) ||
      !vs_parse_real(cell[WALL_S], &wall_s) || !vs_parse_real(cell[WIN], &win) ||
      !vs_parse_real(cell[SCORE], &new.score))
    return vs_fail(err, VS_FAIL, "%s:%d: not a row of transitions, wall_s, opponent, win and score", path, number);
  vs_status s = find_opponent(p, cell[OPPONENT], &new.opponent, err);
  if (s != VS_OK) return s;
  new.transitions_m = transitions / 1e6;
  new.minutes = wall_s / 60.0;
  new.win_percent = 100.0 * win;
  return add(p, new, err);
}

static vs_status read_run(const char *folder, int run, points *p, vs_error *err) {
  char path[PATH_MAX], line[4096];
  int stands[COLUMNS], before = p->count;
  snprintf(path, sizeof path, "%s/eval.csv", folder);
  FILE *f = fopen(path, "r");
  if (!f)
    return vs_fail(err, VS_FAIL, "%s: %s: train with --eval-every-m to have matches to compare", path, strerror(errno));
  vs_status s =
      fgets(line, sizeof line, f) ? read_header(path, line, stands, err) : vs_fail(err, VS_FAIL, "%s: empty", path);
  for (int number = 2; s == VS_OK && fgets(line, sizeof line, f); number++)
    s = read_row(path, number, line, stands, run, p, err);
  fclose(f);
  if (s == VS_OK && p->count == before) s = vs_fail(err, VS_FAIL, "%s: no matches in it yet", path);
  return s;
}

static bool has(const points *p, int run, int opponent) {
  for (int i = 0; i < p->count; i++)
    if (p->at[i].run == run && p->at[i].opponent == opponent) return true;
  return false;
}

// A block of gnuplot's for each curve, named by opponent and run.
static void write_curves(FILE *script, const points *p, const vs_plot_compare_def *def) {
  for (int o = 0; o < p->opponents; o++)
    for (int r = 0; r < def->runs; r++) {
      if (!has(p, r, o)) continue;
      fprintf(script, "$c%d_%d << END\n", o, r);
      for (int i = 0; i < p->count; i++)
        if (p->at[i].run == r && p->at[i].opponent == o)
          fprintf(script, "%g %g %g\n", def->minutes ? p->at[i].minutes : p->at[i].transitions_m, p->at[i].win_percent,
                  p->at[i].score);
      fprintf(script, "END\n");
    }
}

static const char *last_part(const char *folder) {
  const char *part = folder;
  for (const char *c = folder; *c; c++)
    if (c[0] == '/' && c[1]) part = c + 1;
  return part;
}

static int panel_rows(const points *p) { return (p->opponents + 1) / 2; }

// In the panel of the opponent that it passed, where a run got that far.
static void mark_the_paper(FILE *script, const points *p, int opponent) {
  double most_m = 0.0;
  for (int i = 0; i < p->count; i++) most_m = fmax(most_m, p->at[i].transitions_m);
  fprintf(script, "unset arrow\nunset label\n");
  for (int i = 0; i < VS_PLOT_PAPER_CROSSINGS; i++)
    if (!strcmp(p->opponent[opponent], vs_plot_paper[i].opponent) && most_m >= vs_plot_paper[i].transitions_m)
      vs_plot_mark_crossing(script, &vs_plot_paper[i], "graph 0.3 rotate by 90 offset 0.7,0");
}

// value: 2 is what was won, 3 the score.
static void write_figure(FILE *script, const points *p, const vs_plot_compare_def *def, const char *name, int value) {
  fprintf(script, "set output '%s.%s'\nset multiplot layout %d,%d\n", name, def->svg ? "svg" : "png", panel_rows(p),
          p->opponents > 1 ? 2 : 1);
  fprintf(script, value == 2 ? "set yrange [0:100]\nset ylabel '%% won'\n"
                             : "set autoscale y\nset ylabel 'goal difference per match'\n");
  for (int o = 0; o < p->opponents; o++) {
    if (!def->minutes) mark_the_paper(script, p, o);
    fprintf(script, "set title ");
    vs_gnuplot_quote(script, p->opponent[o]);
    fprintf(script, " noenhanced\nplot ");
    const char *separator = "";
    for (int r = 0; r < def->runs; r++) {
      if (!has(p, r, o)) continue;
      fprintf(script, "%s$c%d_%d using 1:%d with linespoints lw 2 lc %d pt %d title ", separator, o, r, value, r + 1,
              r + 1);
      vs_gnuplot_quote(script, last_part(def->run[r]));
      fprintf(script, " noenhanced");
      separator = ", ";
    }
    fprintf(script, "\n");
  }
  fprintf(script, "unset multiplot\n");
}

static vs_status draw(const points *p, const vs_plot_compare_def *def, const char *folder, vs_error *err) {
  vs_gnuplot g;
  vs_status s = vs_gnuplot_begin(&g, err);
  if (s != VS_OK) return s;
  vs_gnuplot_terminal(g.script, def->svg, 900, 320 * panel_rows(p));
  fprintf(g.script, "set grid\nset key bottom right\nset xlabel '%s'\nset xrange [0:]\n",
          def->minutes ? "minutes of training" : "million transitions");
  write_curves(g.script, p, def);
  write_figure(g.script, p, def, "compare_win", 2);
  write_figure(g.script, p, def, "compare_score", 3);
  s = vs_gnuplot_run(&g, folder, err);
  vs_gnuplot_end(&g);
  return s;
}

vs_status vs_plot_compare(const vs_plot_compare_def *def, const char *folder, vs_error *err) {
  points p = {0};
  vs_status s = VS_OK;
  for (int r = 0; s == VS_OK && r < def->runs; r++) s = read_run(def->run[r], r, &p, err);
  if (s == VS_OK) s = vs_path_make_folder(folder, 0777, err);
  if (s == VS_OK) s = draw(&p, def, folder, err);
  if (s == VS_OK)
    for (int i = 0; i < 2; i++) printf("%s/compare_%s.%s\n", folder, i ? "score" : "win", def->svg ? "svg" : "png");
  free(p.at);
  return s;
}
