#include "report.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "json_text.h"

// One estimate as "56 [46, 66]".
static void cell(FILE *out, const vs_estimate *e, double scale, int digits, int width) {
  char text[64];
  snprintf(text, sizeof text, "%.*f [%.*f, %.*f]", digits, scale * e->mean, digits, scale * e->low, digits,
           scale * e->high);
  fprintf(out, "  %-*s", width, e->mean == e->mean ? text : "-");
}

enum { NAME_WIDTH = 12 };

static bool begins_character(char byte) { return ((unsigned char)byte & 0xc0) != 0x80; }

void vs_report_name(FILE *out, const char *name, int width) {
  int room = width < 0 ? -width : width, length = 0;
  for (const char *c = name; *c; c++) length += begins_character(*c);
  if (length > room) {
    for (int cut = length - (room - 2); cut > 0 || !begins_character(*name); name++) cut -= begins_character(*name);
    fprintf(out, "..%s", name);
    return;
  }
  if (width < 0) fprintf(out, "%*s", room - length, "");
  fputs(name, out);
  if (width > 0) fprintf(out, "%*s", room - length, "");
}

// At most 100 columns.
void vs_report_table_head(FILE *out) {
  fprintf(out, "%-*s %6s  %-13s  %-13s  %-13s  %-11s  %s\n", NAME_WIDTH, "against", "played", "win % [95 %]", "draw %",
          "loss %", "goals", "score");
}

void vs_report_table_row(FILE *out, const char *against, const vs_series_summary *s) {
  vs_report_name(out, against, NAME_WIDTH);
  fprintf(out, " %6d", s->matches);
  cell(out, &s->win, 100, 0, 13);
  cell(out, &s->draw, 100, 0, 13);
  cell(out, &s->loss, 100, 0, 13);
  char goals[32];
  snprintf(goals, sizeof goals, "%.2f : %.2f", s->goals_for.mean, s->goals_against.mean);
  fprintf(out, "  %-11s", s->matches ? goals : "-");
  cell(out, &s->score, 1, 2, 0);
  fprintf(out, "\n");
}

void vs_report_restarts_head(FILE *out) {
  fprintf(out, "%-12s %11s %11s %17s %10s %7s %7s %18s\n", "a match", "penalties", "against", "free balls",
          "goal kicks", "still %", "seconds", "idle, sent off");
}

void vs_report_restarts_row(FILE *out, const char *against, const vs_series_summary *s) {
  char idle[64];
  snprintf(idle, sizeof idle, "%.1f:%.1f  %.1f:%.1f", s->idle_warnings[VS_BLUE], s->idle_warnings[VS_YELLOW],
           s->idle_sent_off[VS_BLUE], s->idle_sent_off[VS_YELLOW]);
  char won[24], conceded[24], free_balls[32];
  snprintf(won, sizeof won, "%.1f (%.2f)", s->penalties_for, s->penalty_goals_for);
  snprintf(conceded, sizeof conceded, "%.1f (%.2f)", s->penalties_against, s->penalty_goals_against);
  snprintf(free_balls, sizeof free_balls, "%.1f (%.2f:%.2f)", s->free_balls, s->free_ball_goals_for,
           s->free_ball_goals_against);
  vs_report_name(out, against, NAME_WIDTH);
  fprintf(out, " %11s %11s %17s %10.1f %7.0f %7.1f %18s\n", won, conceded, free_balls, s->goal_kicks,
          100.0 * s->still_share, s->mean_time_s, idle);
}

void vs_report_knockout(FILE *out, const char *against, const vs_series_summary *s) {
  if (!(s->extra_time + s->shoot_out > 0)) return;
  fprintf(out, "%s: %.0f of %d matches went to extra time, %.0f to a shoot-out", against, s->extra_time * s->matches,
          s->matches, s->shoot_out * s->matches);
  if (s->lot > 0) fprintf(out, ", %.0f to the lot", s->lot * s->matches);
  fprintf(out, "\n");
}

void vs_report_idle(FILE *out, const char *player, double warnings, double sent_off) {
  if (!(warnings > 0)) return;
  fprintf(out, "%s breaks the idle rule: a robot stands or spins on the spot for %g s %.1f times a match", player,
          VS_IDLE_S, warnings);
  if (sent_off > 0) fprintf(out, ", and %.1f are sent off", sent_off);
  fprintf(out, "\n");
}

typedef struct column {
  const char *name;
  vs_estimate value;
} column;

enum { COLUMNS = 6 };
static void columns_of(const vs_series_summary *s, column out[COLUMNS]) {
  const column all[COLUMNS] = {{"win", s->win},
                               {"draw", s->draw},
                               {"loss", s->loss},
                               {"goals_for", s->goals_for},
                               {"goals_against", s->goals_against},
                               {"score", s->score}};
  memcpy(out, all, sizeof all);
}

// What has no interval.
typedef struct plain {
  const char *name;
  double value;
} plain;

enum { PLAINS = 18 };
static void plains_of(const vs_series_summary *s, plain out[PLAINS]) {
  const plain all[PLAINS] = {{"penalties_for", s->penalties_for},
                             {"penalties_against", s->penalties_against},
                             {"free_balls", s->free_balls},
                             {"goal_kicks", s->goal_kicks},
                             {"mean_time_s", s->mean_time_s},
                             {"idle_warnings", s->idle_warnings[VS_BLUE]},
                             {"idle_warnings_against", s->idle_warnings[VS_YELLOW]},
                             {"idle_sent_off", s->idle_sent_off[VS_BLUE]},
                             {"idle_sent_off_against", s->idle_sent_off[VS_YELLOW]},
                             {"penalty_goals_for", s->penalty_goals_for},
                             {"penalty_goals_against", s->penalty_goals_against},
                             {"free_ball_goals_for", s->free_ball_goals_for},
                             {"free_ball_goals_against", s->free_ball_goals_against},
                             {"still_share", s->still_share},
                             {"free_kicks", s->free_kicks},
                             {"extra_time", s->extra_time},
                             {"shoot_out", s->shoot_out},
                             {"lot", s->lot}};
  memcpy(out, all, sizeof all);
}

void vs_report_csv_head(FILE *out) {
  vs_series_summary none = {0};
  column c[COLUMNS];
  columns_of(&none, c);
  fprintf(out, "blue,yellow,matches");
  for (int i = 0; i < COLUMNS; i++) fprintf(out, ",%s,%s_low,%s_high", c[i].name, c[i].name, c[i].name);
  plain p[PLAINS];
  plains_of(&none, p);
  for (int i = 0; i < PLAINS; i++) fprintf(out, ",%s", p[i].name);
  fprintf(out, "\n");
}

// A field of a CSV file: quoted where it holds a comma or a quote.
static void csv_text(FILE *out, const char *text) {
  if (!strpbrk(text, ",\"\n")) {
    fprintf(out, "%s", text);
    return;
  }
  fputc('"', out);
  for (; *text; text++) fprintf(out, *text == '"' ? "\"\"" : "%c", *text);
  fputc('"', out);
}

void vs_report_csv_row(FILE *out, const char *blue, const char *yellow, const vs_series_summary *s) {
  csv_text(out, blue);
  fputc(',', out);
  csv_text(out, yellow);
  fprintf(out, ",%d", s->matches);
  column c[COLUMNS];
  columns_of(s, c);
  for (int i = 0; i < COLUMNS; i++) fprintf(out, ",%.6g,%.6g,%.6g", c[i].value.mean, c[i].value.low, c[i].value.high);
  plain p[PLAINS];
  plains_of(s, p);
  for (int i = 0; i < PLAINS; i++) fprintf(out, ",%.6g", p[i].value);
  fprintf(out, "\n");
}

static void json_number(FILE *out, const char *name, double value) {
  if (isfinite(value))
    fprintf(out, "\"%s\": %.9g", name, value);
  else
    fprintf(out, "\"%s\": null", name);
}

void vs_report_json_flags(FILE *out, const vs_match_flags *flags) {
  fprintf(out,
          "\"division\": \"%s\", \"drive\": \"%s\", \"rules\": \"%s\", \"knockout\": %s, \"placement\": \"%s\", "
          "\"seconds\": %g, \"seed\": "
          "%" PRIu64 ", \"realism\": ",
          flags->division, flags->drive, flags->rules, flags->knockout ? "true" : "false", flags->placement,
          flags->seconds, flags->seed);
  if (flags->realism)
    vs_json_put(out, flags->realism);
  else
    fprintf(out, "null");
}

void vs_report_json_match(FILE *out, const vs_match_result *m) {
  fprintf(out, "{\"seed\": \"%016llx\", \"hash\": \"%016llx\", ", (unsigned long long)m->seed,
          (unsigned long long)m->hash);
  json_number(out, "time_s", m->time_s);
  fprintf(out, ", \"finished\": %s, \"score\": [%d, %d]", m->played ? "true" : "false", m->score[VS_BLUE],
          m->score[VS_YELLOW]);
  static const char *const ended[] = {"regular time", "regular time", "extra time", "extra time", "shoot-out"};
  int winner = vs_match_winner(m);
  fprintf(out, ", \"winner\": %s%s%s, \"ended_in\": \"%s\", \"shoot_out\": [%d, %d]", winner < 0 ? "" : "\"",
          winner < 0 ? "null" : vs_team_name((vs_team)winner), winner < 0 ? "" : "\"", m->lot ? "lot" : ended[m->half],
          m->shoot_out[VS_BLUE], m->shoot_out[VS_YELLOW]);
  fprintf(out, ", \"penalties\": [%d, %d], \"free_balls\": %d, \"goal_kicks\": [%d, %d], \"free_kicks\": [%d, %d]",
          m->events[VS_BLUE][VS_EVENT_PENALTY], m->events[VS_YELLOW][VS_EVENT_PENALTY],
          m->events[VS_BLUE][VS_EVENT_FREE_BALL] + m->events[VS_YELLOW][VS_EVENT_FREE_BALL],
          m->events[VS_BLUE][VS_EVENT_GOAL_KICK], m->events[VS_YELLOW][VS_EVENT_GOAL_KICK],
          m->events[VS_BLUE][VS_EVENT_FREE_KICK], m->events[VS_YELLOW][VS_EVENT_FREE_KICK]);
  fprintf(out, ", \"idle_warnings\": [%d, %d], \"idle_sent_off\": [%d, %d]}", m->idle_warnings[VS_BLUE],
          m->idle_warnings[VS_YELLOW], m->idle_sent_off[VS_BLUE], m->idle_sent_off[VS_YELLOW]);
}

void vs_report_json_matches(FILE *out, const vs_match_result *results, int n) {
  const char *separator = "";
  fprintf(out, "[");
  for (int i = 0; i < n; i++) {
    if (results[i].time_s <= 0.0) continue;
    fprintf(out, "%s", separator);
    vs_report_json_match(out, &results[i]);
    separator = ",\n  ";
  }
  fprintf(out, "]");
}

void vs_report_json_summary(FILE *out, const vs_series_summary *s) {
  column c[COLUMNS];
  columns_of(s, c);
  fprintf(out, "{\"matches\": %d", s->matches);
  for (int i = 0; i < COLUMNS; i++) {
    fprintf(out, ", \"%s\": {", c[i].name);
    json_number(out, "mean", c[i].value.mean);
    fprintf(out, ", ");
    json_number(out, "low", c[i].value.low);
    fprintf(out, ", ");
    json_number(out, "high", c[i].value.high);
    fprintf(out, "}");
  }
  plain p[PLAINS];
  plains_of(s, p);
  for (int i = 0; i < PLAINS; i++) {
    fprintf(out, ", ");
    json_number(out, p[i].name, p[i].value);
  }
  fprintf(out, "}");
}
