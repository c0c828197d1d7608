// Tables of `vsss eval`, on screen and as CSV and JSON.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "eval.h"
#include "json_text.h"

const char *eval_name(const eval_command *c, int player) {
  int at = c->round_robin ? player : player + 1;
  if (at < c->name.count) return c->name.value[at];
  return player < 0 ? c->blue : c->player[player];
}

void eval_print_head(const eval_command *c) {
  char about[160];
  vs_match_flags_describe(&c->match, about, sizeof about);
  if (c->round_robin)
    printf("round robin of %d players, %d matches as blue and as yellow in each pairing: %s\n", c->players, c->matches,
           about);
  else
    printf("%s as blue, %d matches against each%s: %s\n", eval_name(c, -1), c->matches,
           c->swap ? ", and as yellow" : "", about);
  printf("blue attacks +x and kicks off first; %s; 10 goals ahead ends a match\n\n",
         c->round_robin || c->swap ? "both colours are played" : "colours are not swapped (--swap)");
  if (!c->round_robin) vs_report_table_head(stdout);
  fflush(stdout);
}

static void print_knockout(const eval_command *c) {
  for (int i = 0; i < c->count; i++) {
    const eval_pairing *p = &c->pairings[i];
    char both[128];
    snprintf(both, sizeof both, "%s against %s", eval_name(c, p->player[VS_BLUE]), eval_name(c, p->player[VS_YELLOW]));
    vs_report_knockout(stdout, both, &p->summary);
  }
}

static void print_restarts(const eval_command *c) {
  printf("\n");
  vs_report_restarts_head(stdout);
  for (int i = 0; i < c->count; i++)
    if (c->pairings[i].summary.matches > 0)
      vs_report_restarts_row(stdout, eval_name(c, c->pairings[i].player[c->pairings[i].swapped ? VS_BLUE : VS_YELLOW]),
                             &c->pairings[i].summary);
}

// Each player that broke the idle rule is told so once, over all its matches.
static void print_idle(const eval_command *c) {
  for (int k = -1; k < c->players; k++) {
    const char *uri = k < 0 ? c->blue : c->player[k];
    double warnings = 0, sent_off = 0;
    int matches = 0;
    if (k < 0 && c->round_robin) continue;
    for (int i = 0; i < c->count; i++)
      for (int t = 0; t < VS_TEAMS; t++) {
        const eval_pairing *p = &c->pairings[i];
        if (strcmp(p->uri[t], uri) != 0 || p->summary.matches == 0) continue;
        warnings += p->summary.idle_warnings[t] * p->summary.matches;
        sent_off += p->summary.idle_sent_off[t] * p->summary.matches;
        matches += p->summary.matches;
      }
    bool told = k >= 0 && !c->round_robin && !strcmp(uri, c->blue);
    if (matches > 0 && !told) vs_report_idle(stdout, uri, warnings / matches, sent_off / matches);
  }
}

// Elo of the players from all matches played, and how far the 95 % interval reaches to either side. EVAL_MAX_PLAYERS doubles.
static void rate(const eval_command *c, double *rating, double *reach) {
  double points[EVAL_MAX_PLAYERS * EVAL_MAX_PLAYERS] = {0};
  int games[EVAL_MAX_PLAYERS * EVAL_MAX_PLAYERS] = {0};
  for (int k = 0; k < c->count; k++) {
    const eval_pairing *p = &c->pairings[k];
    if (p->summary.matches == 0) continue;
    int blue = p->player[VS_BLUE] * c->players + p->player[VS_YELLOW];
    int yellow = p->player[VS_YELLOW] * c->players + p->player[VS_BLUE];
    double won = (p->summary.win.mean + 0.5 * p->summary.draw.mean) * p->summary.matches;
    points[blue] += won;
    points[yellow] += p->summary.matches - won;
    games[blue] += p->summary.matches;
    games[yellow] += p->summary.matches;
  }
  vs_elo(c->players, points, games, rating);
  if (vs_elo_deviations(c->players, games, rating, reach, NULL) != VS_OK)
    for (int i = 0; i < c->players; i++) reach[i] = NAN;
  for (int i = 0; i < c->players; i++) reach[i] *= 1.96;
}

static const eval_pairing *find_pairing(const eval_command *c, int blue, int yellow) {
  for (int k = 0; k < c->count; k++)
    if (c->pairings[k].player[VS_BLUE] == blue && c->pairings[k].player[VS_YELLOW] == yellow) return &c->pairings[k];
  return NULL;
}

static void print_cross_table(const eval_command *c) {
  double rating[EVAL_MAX_PLAYERS], reach[EVAL_MAX_PLAYERS];
  rate(c, rating, reach);
  printf("win/draw/loss %% and score of the row as blue against the column as yellow; Elo with its 95 %% "
         "interval\n\n%-16s",
         "");
  for (int j = 0; j < c->players; j++) {
    printf("  ");
    vs_report_name(stdout, eval_name(c, j), 18);
  }
  printf("  %12s\n", "Elo");
  for (int i = 0; i < c->players; i++) {
    vs_report_name(stdout, eval_name(c, i), 16);
    for (int j = 0; j < c->players; j++) {
      const eval_pairing *p = find_pairing(c, i, j);
      char cell[64] = "";
      if (p && p->summary.matches > 0)
        snprintf(cell, sizeof cell, "%.0f/%.0f/%.0f %+.2f", 100 * p->summary.win.mean, 100 * p->summary.draw.mean,
                 100 * p->summary.loss.mean, p->summary.score.mean);
      printf("  %-18s", cell);
    }
    printf("  %6.0f +-%4.0f\n", rating[i], reach[i]);
  }
}

void eval_print_tables(const eval_command *c) {
  c->round_robin ? print_cross_table(c) : print_restarts(c);
  printf("\n");
  print_knockout(c);
  print_idle(c);
}

void eval_write_csv(const eval_command *c, FILE *out) {
  vs_report_csv_head(out);
  for (int i = 0; i < c->count; i++)
    if (c->pairings[i].summary.matches > 0)
      vs_report_csv_row(out, c->pairings[i].uri[VS_BLUE], c->pairings[i].uri[VS_YELLOW], &c->pairings[i].summary);
}

static void write_ratings(const eval_command *c, FILE *out) {
  double rating[EVAL_MAX_PLAYERS], reach[EVAL_MAX_PLAYERS];
  rate(c, rating, reach);
  fprintf(out, "\"elo\": {");
  for (int i = 0; i < c->players; i++) {
    fprintf(out, "%s", i ? ", " : "");
    vs_json_put(out, c->player[i]);
    fprintf(out, ": %.2f", rating[i]);
  }
  fprintf(out, "},\n\"elo_interval\": {");
  for (int i = 0; i < c->players; i++) {
    fprintf(out, "%s", i ? ", " : "");
    vs_json_put(out, c->player[i]);
    if (isfinite(reach[i]))
      fprintf(out, ": [%.2f, %.2f]", rating[i] - reach[i], rating[i] + reach[i]);
    else
      fprintf(out, ": null");
  }
  fprintf(out, "},\n");
}

void eval_write_json(const eval_command *c, FILE *out) {
  fprintf(out, "{\"command\": \"eval\", ");
  vs_report_json_flags(out, &c->match);
  fprintf(out, ", \"complete\": %s,\n", c->done == c->count * c->matches ? "true" : "false");
  if (c->round_robin) write_ratings(c, out);
  fprintf(out, "\"series\": [");
  const char *separator = "";
  for (int i = 0; i < c->count; i++) {
    const eval_pairing *p = &c->pairings[i];
    if (p->summary.matches == 0) continue;
    fprintf(out, "%s\n{\"blue\": ", separator);
    vs_json_put(out, p->uri[VS_BLUE]);
    fprintf(out, ", \"yellow\": ");
    vs_json_put(out, p->uri[VS_YELLOW]);
    fprintf(out, ",\n \"summary\": ");
    vs_report_json_summary(out, &p->summary);
    fprintf(out, ",\n \"matches\": ");
    vs_report_json_matches(out, p->results, c->matches);
    fprintf(out, "}");
    separator = ",";
  }
  fprintf(out, "]}\n");
}
