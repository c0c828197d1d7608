#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/word.h"
#include "league.h"
#include "vsss/config.h"

enum { OWN_KEYS = 18, CLUB_KEYS = 3 };

static vs_status check(const char *path, league_file *f, vs_error *err) {
  int n = 0;
  for (int i = 0; i < LEAGUE_CLUBS; i++) {
    const league_club *c = &f->club[i];
    if (!*c->name && !*c->player && !*c->command) continue;
    if (!*c->name) return vs_fail(err, VS_USAGE, "%s: [club%d] has no name", path, i + 1);
    for (const char *at = c->name; *at; at++)
      if (!isalnum((unsigned char)*at) && !strchr(" ._-+", *at))
        return vs_fail(err, VS_USAGE, "%s: [club%d] name = %s: letters, digits, spaces and . _ - + make a name", path,
                       i + 1, c->name);
    if (!*c->player == !*c->command)
      return vs_fail(err, VS_USAGE, "%s: [club%d] %s: give either player (a URI) or command (a program)", path, i + 1,
                     c->name);
    for (int k = 0; k < n; k++)
      if (!strcmp(f->club[k].name, c->name))
        return vs_fail(err, VS_USAGE, "%s: [club%d] name = %s: another club has it", path, i + 1, c->name);
    f->club[n++] = *c;
  }
  f->clubs = n;
  return n >= 2 ? VS_OK : vs_fail(err, VS_USAGE, "%s: %d club: a league has at least 2, [club1] and [club2]", path, n);
}

static vs_status check_format(const char *path, const char *format, league_file *f, vs_error *err) {
  static const char *const names[] = {"round-robin", "knockout", "groups", NULL};
  int k;
  if (vs_word_parse("format", format, names, &k, err) != VS_OK) return vs_fail_prefix(err, "%s: [league]", path);
  f->format = (league_format)k;
  if (f->format != LEAGUE_IN_GROUPS) {
    f->groups = f->advance = 1;
    return VS_OK;
  }
  if (f->clubs < 2 * f->groups)
    return vs_fail(err, VS_USAGE, "%s: [league] groups = %d: %d clubs are too few, a group has at least 2", path,
                   f->groups, f->clubs);
  if (f->advance > f->clubs / f->groups || f->advance * f->groups < 2)
    return vs_fail(err, VS_USAGE, "%s: [league] advance = %d: of %d clubs in %d groups 1 to %d each, at least 2 in all",
                   path, f->advance, f->clubs, f->groups, f->clubs / f->groups);
  return VS_OK;
}

// What is named in the file, as it is written there.
typedef struct words {
  char format[24], division[16], dialect[16], robot[16], drive[16], ports[64];
} words;

static vs_status check_words(const char *path, const words *w, league_file *f, vs_error *err) {
  f->ports = vs_ports_default();
  vs_status s = vs_division_parse(w->division, &f->division, err);
  if (s == VS_OK) s = vs_rules_parse(f->rules_name, &f->rules, err);
  if (s == VS_OK) s = vs_drive_parse(w->drive, &f->drive, err);
  if (s == VS_OK) s = vs_dialect_parse(w->dialect, &f->dialect, err);
  if (s == VS_OK && *w->ports) s = vs_ports_parse(w->ports, &f->ports, err);
  if (s == VS_OK) s = vs_robot_preset_find(*w->robot ? w->robot : vs_dialect_name(f->dialect), &f->robot, err);
  if (s != VS_OK) vs_fail_prefix(err, "%s: [league]", path);
  return s;
}

vs_status league_file_load(const char *path, league_file *f, vs_error *err) {
  *f = (league_file){.groups = 2,
                     .advance = 2,
                     .rounds = 1,
                     .seconds = 600,
                     .pause_s = 1,
                     .wait_s = 20,
                     .silence_s = 10,
                     .rules_name = "league",
                     .folder = "league",
                     .record = true,
                     .own_network = true,
                     .seed = 1};
  words w = {.format = "round-robin", .division = "3v3", .dialect = "firasim", .drive = "contact"};
  vs_config_key schema[OWN_KEYS + LEAGUE_CLUBS * CLUB_KEYS + 1] = {
      {"league.format", VS_CONFIG_TEXT, w.format, sizeof w.format, 0, 0, "round-robin, knockout or groups"},
      {"league.groups", VS_CONFIG_INT, &f->groups, 0, 1, LEAGUE_GROUPS, "how many, of format = groups"},
      {"league.advance", VS_CONFIG_INT, &f->advance, 0, 1, LEAGUE_CLUBS, "so many of each group go on to the knockout"},
      {"league.rounds", VS_CONFIG_INT, &f->rounds, 0, 1, 100, "each pair meets so often, from both sides each time"},
      {"league.seconds", VS_CONFIG_REAL, &f->seconds, 0, 1, 7200, "of a match"},
      {"league.pause", VS_CONFIG_REAL, &f->pause_s, 0, 0, 60, "from a call to the placing, and from there to play"},
      {"league.wait", VS_CONFIG_REAL, &f->wait_s, 0, 0.1, 600, "for a club's program to be heard"},
      {"league.silence", VS_CONFIG_REAL, &f->silence_s, 0, 0.5, 600, "in all, after which a club has lost"},
      {"league.division", VS_CONFIG_TEXT, w.division, sizeof w.division, 0, 0, "3v3 or 5v5"},
      {"league.rules", VS_CONFIG_TEXT, f->rules_name, sizeof f->rules_name, 0, 0, "as --rules"},
      {"league.dialect", VS_CONFIG_TEXT, w.dialect, sizeof w.dialect, 0, 0, "firasim or travesim"},
      {"league.robot", VS_CONFIG_TEXT, w.robot, sizeof w.robot, 0, 0, "default: the dialect's"},
      {"league.drive", VS_CONFIG_TEXT, w.drive, sizeof w.drive, 0, 0, "contact or planar"},
      {"league.folder", VS_CONFIG_TEXT, f->folder, sizeof f->folder, 0, 0, "of results and logs"},
      {"league.ports", VS_CONFIG_TEXT, w.ports, sizeof w.ports, 0, 0, "as --ports"},
      {"league.realtime", VS_CONFIG_BOOL, &f->realtime, 0, 0, 0, "instead of as fast as the clubs answer"},
      {"league.own_network", VS_CONFIG_BOOL, &f->own_network, 0, 0, 0, "of the league and its programs, where allowed"},
      {"league.record", VS_CONFIG_BOOL, &f->record, 0, 0, 0, "a log of each match"},
      {"league.seed", VS_CONFIG_SEED, &f->seed, 0, 0, 0, "of players that draw"},
  };
  char names[LEAGUE_CLUBS][CLUB_KEYS][24];
  for (int i = 0; i < LEAGUE_CLUBS; i++) {
    league_club *c = &f->club[i];
    snprintf(names[i][0], 24, "club%d.name", i + 1);
    snprintf(names[i][1], 24, "club%d.player", i + 1);
    snprintf(names[i][2], 24, "club%d.command", i + 1);
    vs_config_key *row = schema + OWN_KEYS + i * CLUB_KEYS;
    row[0] = (vs_config_key){names[i][0], VS_CONFIG_TEXT, c->name, sizeof c->name, 0, 0, "for the table"};
    row[1] = (vs_config_key){names[i][1], VS_CONFIG_TEXT, c->player, sizeof c->player, 0, 0, "URI"};
    row[2] = (vs_config_key){names[i][2], VS_CONFIG_TEXT, c->command, sizeof c->command, 0, 0, "a program"};
  }
  vs_status s = vs_config_load(path, schema, err);
  if (s == VS_OK) s = check(path, f, err);
  if (s == VS_OK) s = check_words(path, &w, f, err);
  return s == VS_OK ? check_format(path, w.format, f, err) : s;
}
