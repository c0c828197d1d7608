// What a league has come to: table on the terminal, CSV that it resumes from, JSON, and one HTML page without scripts.
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "json_text.h"
#include "league.h"
#include "vsss/eval.h"
#include "vsss/file.h"

typedef struct ratings {
  double elo[LEAGUE_CLUBS], half_interval[LEAGUE_CLUBS]; // 95 %
} ratings;

// Of all matches; a shoot-out is a draw.
static ratings rate(const league_file *f, const league_result *r, int n) {
  double points[LEAGUE_CLUBS * LEAGUE_CLUBS] = {0}, deviation[LEAGUE_CLUBS] = {0};
  int games[LEAGUE_CLUBS * LEAGUE_CLUBS] = {0};
  ratings out = {{0}, {0}};
  for (int k = 0; k < n; k++)
    for (int t = 0; t < VS_TEAMS; t++) {
      int at = r[k].club[t] * f->clubs + r[k].club[!t], own = r[k].score[t], other = r[k].score[!t];
      points[at] += own > other ? 1 : own == other ? 0.5 : 0;
      games[at]++;
    }
  vs_elo(f->clubs, points, games, out.elo);
  vs_elo_deviations(f->clubs, games, out.elo, deviation, NULL);
  for (int i = 0; i < f->clubs; i++) out.half_interval[i] = 1.96 * deviation[i];
  return out;
}

// "2 : 2, 3 : 1 in the shoot-out"
static void put_score(FILE *out, const league_result *m) {
  fprintf(out, "%d : %d", m->score[VS_BLUE], m->score[VS_YELLOW]);
  if (m->lot)
    fprintf(out, ", by lot");
  else if (m->shoot_out[VS_BLUE] != m->shoot_out[VS_YELLOW])
    fprintf(out, ", %d : %d in the shoot-out", m->shoot_out[VS_BLUE], m->shoot_out[VS_YELLOW]);
}

static void print_group(const league_file *f, const league_result *r, int n, int group, const ratings *rated) {
  league_standing s[LEAGUE_CLUBS];
  int clubs = league_standings(f, r, n, group, s);
  if (f->format == LEAGUE_IN_GROUPS) printf("group %c\n", 'A' + group);
  printf("%-24s %6s %4s %4s %4s %9s %6s  %s\n", "club", "played", "won", "drew", "lost", "goals", "points",
         "Elo [95 %]");
  for (int i = 0; i < clubs; i++) {
    double elo = rated->elo[s[i].club], half = rated->half_interval[s[i].club];
    printf("%-24s %6d %4d %4d %4d %4d:%-4d %6d  %+.0f [%+.0f, %+.0f]\n", f->club[s[i].club].name, s[i].played, s[i].won,
           s[i].drawn, s[i].lost, s[i].goals, s[i].against, s[i].points, elo, elo - half, elo + half);
  }
}

void league_print_table(const league_file *f, const league_result *r, int n) {
  ratings rated = rate(f, r, n);
  for (int g = 0; g < f->groups && f->format != LEAGUE_KNOCKOUT; g++) print_group(f, r, n, g, &rated);
  for (int k = 0; k < n; k++) {
    if (!league_is_knockout(f, &r[k])) continue;
    printf("%-14s %s - %s  ", league_round_name(f, r[k].round), f->club[r[k].club[VS_BLUE]].name,
           f->club[r[k].club[VS_YELLOW]].name);
    put_score(stdout, &r[k]);
    printf("\n");
  }
  int champion = league_champion(f, r, n);
  if (champion >= 0) printf("%s has won\n", f->club[champion].name);
  for (int k = 0; k < n; k++)
    if (r[k].forfeits)
      printf("%s against %s: %s\n", f->club[r[k].club[VS_BLUE]].name, f->club[r[k].club[VS_YELLOW]].name, r[k].why);
}

void league_log_name(const league_file *f, const league_result *m, char *out, size_t size) {
  snprintf(out, size, "%d-%s-%s.log", m->round, f->club[m->club[VS_BLUE]].name, f->club[m->club[VS_YELLOW]].name);
  for (char *c = out; *c; c++)
    if (*c == ' ') *c = '_';
}

static void put_html(FILE *out, const char *text) {
  for (; *text; text++) {
    if (*text == '<')
      fputs("&lt;", out);
    else if (*text == '&')
      fputs("&amp;", out);
    else if (*text == '"')
      fputs("&quot;", out);
    else
      fputc(*text, out);
  }
}

static void write_csv(const league_file *f, const league_result *r, int n, FILE *out) {
  fprintf(out, "round,blue,yellow,blue_goals,yellow_goals,forfeits,why,blue_shoot_out,yellow_shoot_out,lot\n");
  for (int k = 0; k < n; k++) {
    char why[sizeof r->why];
    snprintf(why, sizeof why, "%s", r[k].why);
    for (char *c = why; *c; c++)
      if (*c == '\n' || *c == '"') *c = ' ';
    fprintf(out, "%d,%s,%s,%d,%d,%d,\"%s\",%d,%d,%d\n", r[k].round, f->club[r[k].club[VS_BLUE]].name,
            f->club[r[k].club[VS_YELLOW]].name, r[k].score[VS_BLUE], r[k].score[VS_YELLOW], r[k].forfeits, why,
            r[k].shoot_out[VS_BLUE], r[k].shoot_out[VS_YELLOW], r[k].lot);
  }
}

static void put_club(FILE *out, const char *key, const league_file *f, int club) {
  fprintf(out, "\"%s\": ", key);
  if (club >= 0)
    vs_json_put(out, f->club[club].name);
  else
    fprintf(out, "null");
}

static void write_json(const league_file *f, const league_result *r, int n, int of, FILE *out) {
  ratings rated = rate(f, r, n);
  const char *separator = "";
  fprintf(out, "{\"matches\": %d, \"of\": %d, ", n, of);
  put_club(out, "champion", f, league_champion(f, r, n));
  fprintf(out, ", \"table\": [");
  for (int g = 0; g < f->groups; g++) {
    league_standing s[LEAGUE_CLUBS];
    int clubs = league_standings(f, r, n, g, s);
    for (int i = 0; i < clubs; i++, separator = ",") {
      fprintf(out, "%s\n {", separator);
      put_club(out, "club", f, s[i].club);
      if (f->format == LEAGUE_IN_GROUPS) fprintf(out, ", \"group\": \"%c\"", 'A' + g);
      fprintf(out,
              ", \"played\": %d, \"won\": %d, \"drawn\": %d, \"lost\": %d, \"goals\": %d, \"against\": %d, "
              "\"points\": %d, \"elo\": %.1f, \"elo_half_interval_95\": %.1f}",
              s[i].played, s[i].won, s[i].drawn, s[i].lost, s[i].goals, s[i].against, s[i].points, rated.elo[s[i].club],
              rated.half_interval[s[i].club]);
    }
  }
  fprintf(out, "],\n \"results\": [");
  for (int k = 0; k < n; k++) {
    fprintf(out, "%s\n {\"round\": %d, \"blue\": ", k ? "," : "", r[k].round);
    vs_json_put(out, f->club[r[k].club[VS_BLUE]].name);
    fprintf(out, ", \"yellow\": ");
    vs_json_put(out, f->club[r[k].club[VS_YELLOW]].name);
    if (league_is_knockout(f, &r[k])) {
      fprintf(out, ", \"knockout\": \"%s\", \"shoot_out\": [%d, %d], ", league_round_name(f, r[k].round),
              r[k].shoot_out[VS_BLUE], r[k].shoot_out[VS_YELLOW]);
      put_club(out, "winner", f, league_winner(&r[k]));
    }
    fprintf(out, ", \"score\": [%d, %d], \"forfeits\": %d, \"why\": ", r[k].score[VS_BLUE], r[k].score[VS_YELLOW],
            r[k].forfeits);
    vs_json_put(out, r[k].why);
    fprintf(out, "}");
  }
  fprintf(out, "]}\n");
}

static void write_cell(const league_file *f, const league_result *r, int n, int blue, int yellow, FILE *out) {
  fprintf(out, "<td>");
  for (int k = 0; k < n; k++) {
    if (r[k].club[VS_BLUE] != blue || r[k].club[VS_YELLOW] != yellow || league_is_knockout(f, &r[k])) continue;
    char log[2 * LEAGUE_TEXT];
    league_log_name(f, &r[k], log, sizeof log);
    if (f->record) fprintf(out, "<a href=\"%s\">", log);
    fprintf(out, "%d:%d%s", r[k].score[VS_BLUE], r[k].score[VS_YELLOW], r[k].forfeits ? "*" : "");
    fprintf(out, f->record ? "</a> " : " ");
  }
  fprintf(out, "</td>");
}

static void write_group(const league_file *f, const league_result *r, int n, int group, const ratings *rated,
                        FILE *out) {
  league_standing s[LEAGUE_CLUBS];
  int clubs = league_standings(f, r, n, group, s);
  if (f->format == LEAGUE_IN_GROUPS) fprintf(out, "<h2>Group %c</h2>\n", 'A' + group);
  fprintf(out, "<table><tr><th>club</th><th>played</th><th>won</th><th>drew</th><th>lost</th><th>goals</th>"
               "<th>points</th><th>Elo</th></tr>\n");
  for (int i = 0; i < clubs; i++) {
    fprintf(out, "<tr><td>");
    put_html(out, f->club[s[i].club].name);
    fprintf(out,
            "</td><td>%d</td><td>%d</td><td>%d</td><td>%d</td><td>%d:%d</td><td>%d</td><td>%+.0f &plusmn; "
            "%.0f</td></tr>\n",
            s[i].played, s[i].won, s[i].drawn, s[i].lost, s[i].goals, s[i].against, s[i].points, rated->elo[s[i].club],
            rated->half_interval[s[i].club]);
  }
  fprintf(out, "</table>\n<h2>Row as blue against column as yellow</h2><table><tr><th></th>");
  for (int i = 0; i < f->clubs; i++) {
    if (league_group(f, i) != group) continue;
    fprintf(out, "<th>");
    put_html(out, f->club[i].name);
    fprintf(out, "</th>");
  }
  fprintf(out, "</tr>\n");
  for (int i = 0; i < f->clubs; i++) {
    if (league_group(f, i) != group) continue;
    fprintf(out, "<tr><td>");
    put_html(out, f->club[i].name);
    fprintf(out, "</td>");
    for (int k = 0; k < f->clubs; k++)
      if (league_group(f, k) == group) write_cell(f, r, n, i, k, out);
    fprintf(out, "</tr>\n");
  }
  fprintf(out, "</table>\n");
}

static void write_knockout(const league_file *f, const league_result *r, int n, FILE *out) {
  int champion = league_champion(f, r, n);
  fprintf(out, "<h2>Knockout</h2><table><tr><th>round</th><th>blue</th><th>yellow</th><th>result</th></tr>\n");
  for (int k = 0; k < n; k++) {
    if (!league_is_knockout(f, &r[k])) continue;
    fprintf(out, "<tr><td>%s</td>", league_round_name(f, r[k].round));
    for (int t = 0; t < VS_TEAMS; t++) {
      bool won = league_winner(&r[k]) == r[k].club[t];
      fprintf(out, won ? "<td><b>" : "<td>");
      put_html(out, f->club[r[k].club[t]].name);
      fprintf(out, won ? "</b></td>" : "</td>");
    }
    char log[2 * LEAGUE_TEXT];
    league_log_name(f, &r[k], log, sizeof log);
    fprintf(out, "<td>");
    if (f->record) fprintf(out, "<a href=\"%s\">", log);
    put_score(out, &r[k]);
    fprintf(out, "%s%s</td></tr>\n", r[k].forfeits ? "*" : "", f->record ? "</a>" : "");
  }
  fprintf(out, "</table>\n");
  if (champion < 0) return;
  fprintf(out, "<p><b>");
  put_html(out, f->club[champion].name);
  fprintf(out, "</b> has won.</p>\n");
}

static void write_page(const league_file *f, const league_result *r, int n, int of, FILE *out) {
  ratings rated = rate(f, r, n);
  fprintf(
      out,
      "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>League</title><style>"
      "body{font:16px sans-serif;margin:2em}table{border-collapse:collapse;margin:1em 0}"
      "td,th{border:1px solid #bbb;padding:.3em .6em;text-align:right}td:first-child,th:first-child{text-align:left}"
      "</style></head><body><h1>League</h1><p>%d of %d matches, %s rules, %g s each</p>\n",
      n, of, f->rules_name, f->seconds);
  for (int g = 0; g < f->groups && f->format != LEAGUE_KNOCKOUT; g++) write_group(f, r, n, g, &rated, out);
  if (f->format != LEAGUE_ROUND_ROBIN) write_knockout(f, r, n, out);
  for (int k = 0; k < n; k++) {
    if (!r[k].forfeits) continue;
    fprintf(out, "<p>* ");
    put_html(out, r[k].why);
    fprintf(out, "</p>\n");
  }
  fprintf(out, "<p>A score links to the match's log: vsss replay LOG --video FILE shows it.</p></body></html>\n");
}

vs_status league_save(const league_file *f, const league_result *r, int n, int of, vs_error *err) {
  static const char *const names[] = {"results.csv", "results.json", "index.html"};
  for (int k = 0; k < 3; k++) {
    char path[2 * LEAGUE_TEXT], *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return vs_fail(err, VS_FAIL, "out of memory");
    if (k == 0) write_csv(f, r, n, out);
    if (k == 1) write_json(f, r, n, of, out);
    if (k == 2) write_page(f, r, n, of, out);
    fclose(out);
    snprintf(path, sizeof path, "%s/%s", f->folder, names[k]);
    vs_status s = vs_file_replace(path, text, size, err);
    free(text);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

static int club_named(const league_file *f, const char *name) {
  for (int i = 0; i < f->clubs; i++)
    if (!strcmp(f->club[i].name, name)) return i;
  return -1;
}

vs_status league_load_results(const league_file *f, league_result *r, int most, int *n, vs_error *err) {
  char path[2 * LEAGUE_TEXT], line[512];
  snprintf(path, sizeof path, "%s/results.csv", f->folder);
  *n = 0;
  FILE *in = fopen(path, "r");
  if (!in) return errno == ENOENT ? VS_OK : vs_fail(err, VS_FAIL, "%s: cannot be read: %s", path, strerror(errno));
  vs_status s = VS_OK;
  for (int number = 1; s == VS_OK && fgets(line, sizeof line, in); number++) {
    char blue[48], yellow[48];
    league_result m = {0};
    if (number == 1) continue;
    line[strcspn(line, "\n")] = '\0';
    int fields = sscanf(line, "%d,%47[^,],%47[^,],%d,%d,%d,\"%159[^\"]", &m.round, blue, yellow, &m.score[VS_BLUE],
                        &m.score[VS_YELLOW], &m.forfeits, m.why);
    const char *quote = strrchr(line, '"'); // files of before end there
    if (quote) sscanf(quote, "\",%d,%d,%d", &m.shoot_out[VS_BLUE], &m.shoot_out[VS_YELLOW], &m.lot);
    if (fields >= 6) m.club[VS_BLUE] = club_named(f, blue), m.club[VS_YELLOW] = club_named(f, yellow);
    if (fields < 6 || m.club[VS_BLUE] < 0 || m.club[VS_YELLOW] < 0 || m.forfeits < 0 || m.forfeits > 3 || m.lot < 0 ||
        m.round < 1 || m.round > league_rounds(f) || m.lot > VS_TEAMS || *n == most)
      s = vs_fail(err, VS_FAIL,
                  "%s, line %d: '%.60s' is no result of this league: give it another folder, or remove that line", path,
                  number, line);
    else
      r[(*n)++] = m;
  }
  fclose(in);
  return s;
}
