// vsss eval: many matches of one player against others, or of all against all, with intervals and ratings.
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "eval.h"
#include "vsss/clock.h"

// "random:,inf:" -> player[]. A comma inside a URI cannot be written.
static vs_status split(eval_command *c, const char *flag, const char *list, int least, vs_error *err) {
  c->names = strdup(list);
  if (!c->names) return vs_fail(err, VS_FAIL, "out of memory");
  char *rest = c->names;
  for (char *one; (one = strsep(&rest, ",")) != NULL;) {
    if (!*one) return vs_fail(err, VS_USAGE, "--%s %s: an empty name; write URI,URI,...", flag, list);
    if (c->players == EVAL_MAX_PLAYERS)
      return vs_fail(err, VS_USAGE, "--%s: more than %d players", flag, EVAL_MAX_PLAYERS);
    c->player[c->players++] = one;
  }
  if (c->players < least) return vs_fail(err, VS_USAGE, "--%s %s: at least %d players", flag, list, least);
  return VS_OK;
}

static void add_pairing(eval_command *c, int blue, int yellow) {
  c->pairings[c->count] =
      (eval_pairing){.uri = {blue < 0 ? c->blue : c->player[blue], yellow < 0 ? c->blue : c->player[yellow]},
                     .player = {blue, yellow},
                     .swapped = !c->round_robin && yellow < 0,
                     .results = c->results + (size_t)c->count * (size_t)c->matches};
  c->count++;
}

static vs_status make_pairings(eval_command *c, vs_error *err) {
  vs_status s =
      c->round_robin ? split(c, "round-robin", c->round_robin, 2, err) : split(c, "against", c->against, 1, err);
  if (s != VS_OK) return s;
  size_t most = (size_t)c->players * (size_t)(c->players > 1 ? c->players : 2);
  int names = c->players + !c->round_robin;
  if (c->name.count > names)
    return vs_fail(err, VS_USAGE, "--name: given %d times for %d players", c->name.count, names);
  c->pairings = calloc(most, sizeof *c->pairings);
  c->results = calloc(most * (size_t)c->matches, sizeof *c->results);
  if (!c->pairings || !c->results) return vs_fail(err, VS_FAIL, "out of memory for %d matches", c->matches);
  for (int j = 0; j < c->players; j++) {
    if (!c->round_robin) add_pairing(c, -1, j);
    if (!c->round_robin && c->swap) add_pairing(c, j, -1);
    for (int i = 0; c->round_robin && i < c->players; i++)
      if (i != j) add_pairing(c, i, j);
  }
  return VS_OK;
}

static bool match_done(void *context, int index, const vs_match_result *result) {
  (void)index;
  eval_command *c = context;
  const eval_pairing *p = &c->pairings[c->current];
  c->done++;
  char text[200];
  snprintf(text, sizeof text, "%d of %d matches  %s %d : %d %s", c->done, c->count * c->matches, p->uri[VS_BLUE],
           result->score[VS_BLUE], result->score[VS_YELLOW], p->uri[VS_YELLOW]);
  vs_progress_show(&c->progress, (double)c->done / ((double)c->count * c->matches), text);
  return !vs_cli_interrupted();
}

// Both colours as one row: matches as yellow seen from the other side.
static vs_status sum_both(const eval_command *c, const eval_pairing *p, vs_series_summary *out, vs_error *err) {
  size_t n = (size_t)c->matches;
  vs_match_result *both = calloc(2 * n, sizeof *both);
  if (!both) return vs_fail(err, VS_FAIL, "out of memory for %d matches", c->matches);
  memcpy(both, p[-1].results, n * sizeof *both);
  for (size_t i = 0; i < n; i++) vs_match_mirror(&p->results[i], &both[n + i]);
  vs_status s = vs_series_sum_up(both, 2 * c->matches, out, err);
  free(both);
  return s;
}

// The row of an opponent, once all its matches are played.
static vs_status print_row(const eval_command *c, const eval_pairing *p, vs_error *err) {
  vs_series_summary row = p->summary;
  if (c->round_robin || (c->swap && !p->swapped)) return VS_OK;
  vs_status s = c->swap ? sum_both(c, p, &row, err) : VS_OK;
  if (s == VS_OK && row.matches > 0)
    vs_report_table_row(stdout, eval_name(c, p->player[p->swapped ? VS_BLUE : VS_YELLOW]), &row);
  return s;
}

static vs_status play_pairing(eval_command *c, const vs_env_def *env, vs_error *err) {
  eval_pairing *p = &c->pairings[c->current];
  vs_series_def def = {.env = *env,
                       .matches = c->matches,
                       .threads = c->match.threads,
                       .seed = c->match.seed,
                       .progress = match_done,
                       .go_on = vs_cli_go_on,
                       .context = c};
  for (int t = 0; t < VS_TEAMS; t++) def.env.player[t] = p->uri[t];
  vs_status s = vs_series_play(&def, p->results, err);
  if (s != VS_OK) vs_fail_prefix(err, "%s against %s", p->uri[VS_BLUE], p->uri[VS_YELLOW]);
  // What is done counts, even where a match failed.
  vs_status summed = vs_series_sum_up(p->results, c->matches, &p->summary, s == VS_OK ? err : NULL);
  vs_progress_clear(&c->progress);
  if (summed == VS_OK) summed = print_row(c, p, s == VS_OK ? err : NULL);
  fflush(stdout);
  return s != VS_OK ? s : summed;
}

// A URI that does not open should fail before the first match, not after an hour of them.
static vs_status check_players(const eval_command *c, vs_error *err) {
  for (int i = -1; i < c->players; i++) {
    const char *uri = i < 0 ? c->blue : c->player[i];
    if (i < 0 && c->round_robin) continue;
    vs_player *player = NULL;
    vs_status s = vs_player_open(uri, &player, err);
    if (s != VS_OK) return s;
    vs_player_close(player);
  }
  return VS_OK;
}

static vs_status open_output(const char *path, FILE **out, vs_error *err) {
  *out = fopen(path, "w");
  if (*out) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: cannot be written: %s", path, strerror(errno));
}

static vs_status close_output(FILE *out, const char *path, vs_error *err) {
  bool bad = ferror(out) != 0;
  if (fclose(out) != 0) bad = true;
  return bad ? vs_fail(err, VS_FAIL, "%s: cannot be written: %s", path, strerror(errno)) : VS_OK;
}

static vs_status evaluate(eval_command *c, const vs_env_def *env, FILE *json, FILE *csv, vs_error *err) {
  eval_print_head(c);
  int64_t start_us = vs_clock_monotonic_us();
  vs_progress_start(&c->progress);
  vs_status played = VS_OK;
  for (c->current = 0; c->current < c->count && played == VS_OK && !vs_cli_interrupted(); c->current++)
    played = play_pairing(c, env, err);
  vs_progress_clear(&c->progress);

  eval_print_tables(c);
  if (c->done < c->count * c->matches) printf("\nstopped: %d of %d matches\n", c->done, c->count * c->matches);
  double played_s = 0.0, wall_s = (double)(vs_clock_monotonic_us() - start_us) * 1e-6;
  for (int i = 0; i < c->count; i++) played_s += c->pairings[i].summary.mean_time_s * c->pairings[i].summary.matches;
  printf("\n%.0f s played in %.1f s (%.0f times real time)\n", played_s, wall_s, played_s / wall_s);
  vs_status s = VS_OK;
  if (json) {
    eval_write_json(c, json);
    s = close_output(json, c->json, err);
  }
  if (csv) {
    eval_write_csv(c, csv);
    vs_status t = close_output(csv, c->csv, err);
    if (s == VS_OK) s = t;
  }
  return played != VS_OK ? played : s;
}

static vs_status run(eval_command *c, vs_error *err) {
  if (c->round_robin && c->swap)
    return vs_fail(err, VS_USAGE, "--round-robin plays both colours: --swap is not needed");
  if (c->round_robin && c->against) return vs_fail(err, VS_USAGE, "--round-robin and --against exclude each other");
  if (!c->against) c->against = "random:,inf:,emc:";
  vs_status s = make_pairings(c, err);
  if (s == VS_OK) s = check_players(c, err);
  vs_model *model = NULL;
  vs_env_def env;
  if (s == VS_OK) s = vs_match_flags_open(&c->match, &model, &env, err);
  // Opened first: a path that cannot be written is told before the matches.
  FILE *json = NULL, *csv = NULL;
  if (s == VS_OK && c->json) s = open_output(c->json, &json, err);
  if (s == VS_OK && c->csv) s = open_output(c->csv, &csv, err);
  if (s == VS_OK) {
    vs_cli_catch_interrupts();
    s = evaluate(c, &env, json, csv, err);
  }
  vs_model_free(model);
  return s;
}

int cmd_eval(int argc, char **argv) {
  eval_command c = {.match = vs_match_flags_default(), .blue = "onnx:", .matches = 100};
  const vs_flag flags[] = {
      {"blue", VS_FLAG_TEXT, &c.blue, "URI", "the player that is measured", 0, 0},
      {"against", VS_FLAG_TEXT, &c.against, "URI,...", "its opponents, all yellow [random:,inf:,emc:]", 0, 0},
      {"round-robin", VS_FLAG_TEXT, &c.round_robin, "URI,...", "all against all, from both sides: cross table, Elo", 0,
       0},
      {"matches", VS_FLAG_INT, &c.matches, "N", "of each pairing", 1, 1000000},
      {"swap", VS_FLAG_SWITCH, &c.swap, NULL, "each pairing in both colours, counted together", 0, 0},
      {"name", VS_FLAG_LIST, &c.name, "NAME", "what the tables call --blue, the next one the first opponent, ...", 0,
       0},
      VS_MATCH_FLAG_ROWS(c.match),
      {"json", VS_FLAG_TEXT, &c.json, "FILE", "also write everything there, each match with its hash", 0, 0},
      {"csv", VS_FLAG_TEXT, &c.csv, "FILE", "also write the table there", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  bool help;
  vs_error err = {0};
  char about[2048];
  vs_match_flags_about("Plays many matches and prints win, draw and loss rates, goals and score, each with its\n"
                       "95 % interval (rates: Wilson, others: bootstrap). One of them again: vsss sim --match K.",
                       about, sizeof about);
  vs_status s = vs_args_parse(argc, argv, "eval [flags]", about, flags, NULL, &help, &err);
  if (help) return 0;
  if (s == VS_OK) s = run(&c, &err);
  free(c.names);
  free(c.pairings);
  free(c.results);
  return s == VS_OK ? 0 : vs_cli_error("eval", &err);
}
