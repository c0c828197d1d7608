// vsss plot: figures of a training run, like the paper's Figures 6 to 11, by gnuplot.
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"

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
     "The league",
     "score, count",
     {{"frozen_score", "score against the frozen self"},
      {"replacements", "times it was replaced"},
      {"pool", "in the pool"}}},
    {"policy", "Policy", "nats, fraction", {{"entropy", "entropy"}, {"kl", "KL"}, {"clip_fraction", "clipped"}}},
    {"value", "Value", "", {{"explained_variance", "explained variance"}, {"value_loss", "loss"}}},
    {"speed", "Speed", "transitions/s", {{"transitions_per_s", "transitions/s"}}},
};

// An update ends few episodes: each point is the mean of half a percent of the run.
static void plot_figure(FILE *out, const figure *f, const char *folder, const char *ending) {
  fprintf(out, "set output '%s/%s.%s'\nset title '%s'\nset ylabel '%s'\nplot ", folder, f->name, ending, f->title,
          f->y);
  for (int i = 0; f->curve[i][0]; i++)
    fprintf(out,
            "%s'%s/progress.csv' using (bin*floor(column('transitions')/1e6/bin)):(column('%s')) smooth unique "
            "with lines lw 2 title '%s'",
            i ? ", " : "", folder, f->curve[i][0], f->curve[i][1]);
  fprintf(out, "\n");
}

// Score and win rate against each opponent of the periodic evaluation, with the 95 % interval of the score.
static void plot_eval(FILE *out, const char *folder, const char *ending) {
  fprintf(out,
          "opponents = system(\"tail -n +2 '%s/eval.csv' | cut -d, -f4 | sort -u\")\n"
          "set output '%s/eval_score.%s'\nset title 'Score in matches'\nset ylabel 'goal difference per match'\n"
          "plot for [o in opponents] '%s/eval.csv' using (strcol('opponent') eq o ? column('transitions')/1e6 : NaN):"
          "(column('score')):(column('score_low')):(column('score_high')) with yerrorlines lw 2 title o\n"
          "set output '%s/eval_win.%s'\nset title 'Matches won'\nset ylabel 'percent'\nset yrange [0:100]\n"
          "plot for [o in opponents] '%s/eval.csv' using (strcol('opponent') eq o ? column('transitions')/1e6 : NaN):"
          "(100*column('win')) with linespoints lw 2 title o\nset autoscale y\n",
          folder, folder, ending, folder, folder, ending, folder);
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

static vs_status plot(const char *folder, bool svg, vs_error *err) {
  if (strchr(folder, '\'') || strchr(folder, '"'))
    return vs_fail(err, VS_USAGE, "%s: gnuplot cannot take a folder with quotes in its name", folder);
  if (!has_rows(folder, "progress.csv"))
    return vs_fail(err, VS_FAIL, "%s/progress.csv: missing or empty: is this the folder of a run?", folder);
  const char *ending = svg ? "svg" : "png";
  FILE *out = popen("gnuplot 2>&1", "w");
  if (!out) return vs_fail(err, VS_FAIL, "cannot start gnuplot: %s", strerror(errno));
  fprintf(out,
          "set terminal %s\nset datafile separator ','\nset key autotitle columnhead\nset datafile columnheaders\nset "
          "grid\nset key outside "
          "below\nset xlabel 'million transitions'\n"
          "stats '%s/progress.csv' using (column('transitions')/1e6) nooutput\nbin = STATS_max/200\n",
          svg ? "svg size 900,560 font 'sans,14'" : "pngcairo size 900,560 font 'sans,12'", folder);
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) plot_figure(out, &figures[i], folder, ending);
  bool eval = has_rows(folder, "eval.csv");
  if (eval) plot_eval(out, folder, ending);
  if (pclose(out) != 0)
    return vs_fail(err, VS_FAIL, "gnuplot failed (its words are above); without it: apt install gnuplot-nox");
  for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) printf("%s/%s.%s\n", folder, figures[i].name, ending);
  if (eval) printf("%s/eval_score.%s\n%s/eval_win.%s\n", folder, ending, folder, ending);
  return VS_OK;
}

int cmd_plot(int argc, char **argv) {
  bool svg = false, help;
  const vs_flag flags[] = {{"svg", VS_FLAG_SWITCH, &svg, NULL, "SVG instead of PNG", 0, 0}, {.name = NULL}};
  vs_flag_list words = {0};
  vs_error err = {0};
  vs_status s = vs_args_parse(argc, argv, "plot RUN [--svg]", "Draws the figures of a training run into its folder.",
                              flags, &words, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s == VS_OK && words.count != 1) s = vs_fail(&err, VS_USAGE, "name one run's folder, such as runs/vsss");
  if (s == VS_OK) s = plot(words.value[0], svg, &err);
  return s == VS_OK ? 0 : vs_cli_error("plot", &err);
}
