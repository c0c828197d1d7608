// vsss plot: figures of a training run, like the paper's Figures 6 to 11, by gnuplot.
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "gnuplot.h"
#include "plot_compare.h"
#include "plot_paper.h"

// One picture: a name, a title, what the y axis says, and curves as columns of progress.csv ("name title" pairs).
typedef struct figure {
  const char *name, *title, *y;
  const char *curve[10][2];
} figure;

static const figure figures[] = {
    {"reward",
     "Reward per transition",
     "reward",
     {{"reward", "sum"}, {"term_progress", "ball progress"}, {"term_approach", "approach"}, {"term_goal", "goal"}}},
    {"terms",
     "Terms of the paper reward",
     "term",
     {{"term_speed", "r_{speed}"},
      {"term_distance", "r_{dist}"},
      {"term_offence", "r_{off}"},
      {"term_defence", "r_{def}"}}},
    {"goals", "Goals per episode", "goals", {{"goals_for", "for"}, {"goals_against", "against"}}},
    {"episode", "Length of an episode", "seconds", {{"episode_s", "mean"}}},
    {"league",
     "Score against earlier selves",
     "goal difference per episode",
     {{"self_score", "the present self"}, {"pool_score", "pool"}, {"frozen_score", "frozen self"}}},
    {"pool",
     "Earlier selves",
     "count",
     {{"pool", "in the pool"}, {"replacements", "times the frozen one was replaced"}}},
    {"policy", "Policy", "nats, fraction", {{"entropy", "entropy"}, {"kl", "KL"}, {"clip_fraction", "clipped"}}},
    {"value", "Value", "", {{"explained_variance", "explained variance"}, {"value_loss", "loss"}}},
    {"speed", "Speed", "transitions/s", {{"transitions_per_s", "transitions/s"}}},
};

enum { COLUMNS_MAX = 128 };
// Columns of progress.csv in which something was measured: gnuplot ends with an error where there is nothing to draw.
typedef struct measured {
  int count;
  char name[COLUMNS_MAX][48];
} measured;

static void read_measured(const char *folder, measured *m) {
  char path[PATH_MAX], line[4096], header[4096] = "";
  bool found[COLUMNS_MAX] = {false};
  snprintf(path, sizeof path, "%s/progress.csv", folder);
  FILE *f = fopen(path, "r");
  if (f && !fgets(header, sizeof header, f)) header[0] = '\0';
  while (f && fgets(line, sizeof line, f)) {
    char *rest = line, *cell;
    for (int i = 0; i < COLUMNS_MAX && (cell = strsep(&rest, ",\n")) != NULL; i++)
      if (*cell) found[i] = true;
  }
  if (f) fclose(f);
  m->count = 0;
  char *rest = header, *cell;
  for (int i = 0; i < COLUMNS_MAX && (cell = strsep(&rest, ",\n")) != NULL; i++)
    if (found[i]) snprintf(m->name[m->count++], sizeof *m->name, "%s", cell);
}

static bool was_measured(const measured *m, const char *column) {
  for (int i = 0; i < m->count; i++)
    if (!strcmp(m->name[i], column)) return true;
  return false;
}

static bool can_draw(const figure *f, const measured *m) {
  for (int i = 0; f->curve[i][0]; i++)
    if (was_measured(m, f->curve[i][0])) return true;
  return false;
}

// An update ends few episodes: each point is the mean of half a percent of the run. gnuplot runs in the run's folder.
static void plot_figure(FILE *out, const figure *f, const measured *m, const char *ending) {
  if (!can_draw(f, m)) return;
  fprintf(out, "set output '%s.%s'\nset title '%s'\nset ylabel '%s'\nplot ", f->name, ending, f->title, f->y);
  const char *separator = "";
  for (int i = 0; f->curve[i][0]; i++) {
    if (!was_measured(m, f->curve[i][0])) continue;
    fprintf(out,
            "%s'progress.csv' using (bin*floor(column('transitions')/1e6/bin)):(column('%s')) smooth unique "
            "with lines lw 2 title '%s'",
            separator, f->curve[i][0], f->curve[i][1]);
    separator = ", ";
  }
  fprintf(out, "\n");
}

enum { OPPONENTS_MAX = 32 };
typedef struct opponents {
  int count;
  char name[OPPONENTS_MAX][128];
} opponents;

// The fourth column of eval.csv, each name once.
static void read_opponents(const char *folder, opponents *o) {
  char path[PATH_MAX], line[4096];
  snprintf(path, sizeof path, "%s/eval.csv", folder);
  FILE *f = fopen(path, "r");
  o->count = 0;
  for (bool header = true; f && fgets(line, sizeof line, f); header = false) {
    char *rest = line, *cell = NULL;
    for (int column = 0; column < 4; column++) cell = strsep(&rest, ",");
    int known = 0;
    while (cell && known < o->count && strcmp(o->name[known], cell) != 0) known++;
    if (header || !rest || !cell || known < o->count || o->count == OPPONENTS_MAX) continue;
    snprintf(o->name[o->count++], sizeof *o->name, "%s", cell);
  }
  if (f) fclose(f);
}

static void plot_opponents(FILE *out, const opponents *o, const char *values, const char *style) {
  fprintf(out, "plot ");
  for (int i = 0; i < o->count; i++) {
    fprintf(out, "%s'eval.csv' using (strcol('opponent') eq ", i ? ", " : "");
    vs_gnuplot_quote(out, o->name[i]);
    fprintf(out, " ? column('transitions')/1e6 : NaN):%s with %s lw 2 title ", values, style);
    vs_gnuplot_quote(out, o->name[i]);
    fprintf(out, " noenhanced");
  }
  fprintf(out, "\n");
}

// Drawn where the run got that far.
static void mark_the_paper(FILE *out) {
  for (int i = 0; i < VS_PLOT_PAPER_CROSSINGS; i++) {
    fprintf(out, "if (STATS_max >= %g) {\n", vs_plot_paper[i].transitions_m);
    vs_plot_mark_crossing(out, &vs_plot_paper[i], "graph 0.02 rotate by 90 offset 0.7,0");
    fprintf(out, "}\n");
  }
}

// Score and win rate against each opponent of the periodic evaluation, with the 95 % interval of the score.
static void plot_eval(FILE *out, const opponents *o, const char *ending) {
  fprintf(out, "set output 'eval_score.%s'\nset title 'Score in matches'\nset ylabel 'goal difference per match'\n",
          ending);
  mark_the_paper(out);
  plot_opponents(out, o, "(column('score')):(column('score_low')):(column('score_high'))", "yerrorlines");
  fprintf(out, "set output 'eval_win.%s'\nset title 'Matches won'\nset ylabel 'percent'\nset yrange [0:100]\n", ending);
  plot_opponents(out, o, "(100*column('win'))", "linespoints");
}

static bool has_rows(const char *folder, const char *name) {
  char path[PATH_MAX], line[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "r");
  int lines = 0;
  while (f && lines < 2 && fgets(line, sizeof line, f)) lines++;
  if (f) fclose(f);
  return lines == 2;
}

static void write_script(FILE *out, const measured *m, const opponents *o, bool svg) {
  const char *ending = svg ? "svg" : "png";
  vs_gnuplot_terminal(out, svg, 900, 560);
  fprintf(out, "set datafile separator ','\nset datafile missing NaN\nset key autotitle columnhead\n"
               "set datafile columnheaders\nset grid\nset key outside below\nset xlabel 'million transitions'\n"
               "stats 'progress.csv' using (column('transitions')/1e6) nooutput\nbin = STATS_max/200\n");
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) plot_figure(out, &figures[i], m, ending);
  if (o->count) plot_eval(out, o, ending);
}

static vs_status plot(const char *folder, bool svg, vs_error *err) {
  if (!has_rows(folder, "progress.csv"))
    return vs_fail(err, VS_FAIL, "%s/progress.csv: missing or empty: is this the folder of a run?", folder);
  opponents o;
  measured m;
  read_opponents(folder, &o);
  read_measured(folder, &m);
  vs_gnuplot g;
  vs_status s = vs_gnuplot_begin(&g, err);
  if (s != VS_OK) return s;
  write_script(g.script, &m, &o, svg);
  s = vs_gnuplot_run(&g, folder, err);
  vs_gnuplot_end(&g);
  if (s != VS_OK) return s;
  const char *ending = svg ? "svg" : "png";
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
    if (can_draw(&figures[i], &m)) printf("%s/%s.%s\n", folder, figures[i].name, ending);
  if (o.count) printf("%s/eval_score.%s\n%s/eval_win.%s\n", folder, ending, folder, ending);
  return VS_OK;
}

int cmd_plot(int argc, char **argv) {
  bool help;
  const char *into = NULL;
  vs_plot_compare_def compare = {0};
  const vs_flag flags[] = {
      {"compare", VS_FLAG_TEXT, &into, "FOLDER", "matches of the runs side by side instead, drawn into this folder", 0,
       0},
      {"minutes", VS_FLAG_SWITCH, &compare.minutes, NULL, "... over minutes of training instead of transitions", 0, 0},
      {"svg", VS_FLAG_SWITCH, &compare.svg, NULL, "SVG instead of PNG", 0, 0},
      {.name = NULL}};
  vs_flag_list words = {0};
  vs_error err = {0};
  vs_status s = vs_args_parse(argc, argv, "plot RUN... [flags]",
                              "Draws the figures of training runs, each into its folder.", flags, &words, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s == VS_OK && !words.count) s = vs_fail(&err, VS_USAGE, "name a run's folder, such as runs/vsss");
  if (s == VS_OK && compare.minutes && !into)
    s = vs_fail(&err, VS_USAGE, "--minutes goes with --compare FOLDER: the figures of one run are over transitions");
  compare.runs = words.count;
  compare.run = words.value;
  if (s == VS_OK && into) s = vs_plot_compare(&compare, into, &err);
  for (int i = 0; s == VS_OK && !into && i < words.count; i++) s = plot(words.value[i], compare.svg, &err);
  return s == VS_OK ? 0 : vs_cli_error("plot", &err);
}
