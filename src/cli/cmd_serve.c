// vsss serve: teams of other programs play here, over the network of the simulation league.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "json_text.h"
#include "match_flags.h"
#include "message_text.h"
#include "operator.h"
#include "serve_record.h"
#include "serve_replay.h"
#include "vsss/clock.h"
#include "vsss/serve.h"

typedef struct serve_command {
  const char *uri[VS_TEAMS]; // "net" or a player's
  const char *division, *dialect, *rules, *referee, *ports, *interface, *robot, *drive, *record, *league_log, *replay;
  double seconds, pause_s, wait_s, answer_s;
  int seed, rt;
  bool no_referee, knockout, sync, realtime, json;

  vs_serve_def def;
  vs_model *model;
  vs_serve *server;
  serve_record *log;
  vs_progress progress;
  vs_operator keys;
  int64_t start_us;
} serve_command;

static const char about[] =
    "Plays the simulator of the league for teams' own programs: sends the world to 224.0.0.1:10002 60 times a second "
    "and\n"
    "takes wheel commands on 127.0.0.1:20011, as FIRASim does, with a referee that speaks VSSReferee's messages on\n"
    "224.5.23.2. A team is 'net' or any player (emc:, onnx:, ...). The match starts when the teams of the network are\n"
    "heard. Only this machine is reached unless --interface says otherwise.";

static vs_status read_rules(serve_command *c, vs_error *err) {
  vs_rules rules;
  vs_status s = vs_rules_parse(c->rules, &rules, err);
  if (s != VS_OK) return s;
  vs_hosted_def *match = &c->def.match;
  match->referee = vs_referee_def_default(rules);
  if (c->seconds > 0) vs_referee_def_lasts(&match->referee, c->seconds);
  match->referee.knockout = c->knockout;
  match->pause_s = c->pause_s;
  match->seed = (uint64_t)c->seed;
  if (!strcmp(c->referee, "external"))
    match->mode = VS_REFEREE_EXTERNAL;
  else if (strcmp(c->referee, "own") != 0)
    return vs_fail(err, VS_USAGE, "--referee %.40s: own or external (or --no-referee)", c->referee);
  if (c->no_referee && match->mode == VS_REFEREE_EXTERNAL)
    return vs_fail(err, VS_USAGE, "--no-referee and --referee external exclude each other");
  if (c->no_referee) match->mode = VS_REFEREE_NONE;
  if (c->knockout && match->mode != VS_REFEREE_OWN)
    return vs_fail(err, VS_USAGE, "--knockout: extra time and a shoot-out are called by our own referee only");
  return VS_OK;
}

static vs_status prepare(serve_command *c, vs_error *err) {
  c->def = vs_serve_def_default();
  vs_drive drive;
  vs_division division;
  vs_status s = vs_dialect_parse(c->dialect, &c->def.dialect, err);
  if (s == VS_OK) s = vs_division_parse(c->division, &division, err);
  if (s == VS_OK) s = vs_drive_parse(c->drive, &drive, err);
  if (s == VS_OK) s = read_rules(c, err);
  if (s == VS_OK)
    s = vs_robot_preset_find(c->robot ? c->robot : vs_dialect_name(c->def.dialect), &c->def.match.robot, err);
  if (s == VS_OK && c->ports) s = vs_ports_parse(c->ports, &c->def.ports, err);
  if (s == VS_OK && c->sync && c->realtime) s = vs_fail(err, VS_USAGE, "--sync and --realtime exclude each other");
  if (s != VS_OK) return s;
  for (int t = 0; t < VS_TEAMS; t++) c->def.match.player[t] = strcmp(c->uri[t], "net") ? c->uri[t] : NULL;
  c->def.interface = c->interface;
  c->def.sync = c->sync;
  c->def.answer_s = c->answer_s;
  c->def.ends = vs_cli_interrupted;
  vs_model_def model = vs_model_def_default(drive);
  model.division = division;
  model.frame_hz = vs_dialect_hz(c->def.dialect);
  model.substeps_per_frame = c->def.dialect == VS_DIALECT_TRAVESIM ? 2 : 3; // about 5 ms, as in sim
  s = vs_model_load(&model, &c->model, err);
  c->def.match.model = c->model;
  return s;
}

static void print_head(const serve_command *c) {
  if (c->json) return;
  const vs_ports *p = &c->def.ports;
  printf("%s (blue) against %s (yellow), %s, %s rules%s, %s robots\n", c->uri[VS_BLUE], c->uri[VS_YELLOW], c->division,
         c->rules, c->knockout ? ", knockout" : "", c->def.match.robot->name);
  printf("world      to   %s:%d, %d a second of play\n", VS_VISION_GROUP, p->vision, vs_dialect_hz(c->def.dialect));
  const char *here = c->interface ? "0.0.0.0" : "127.0.0.1";
  if (c->def.dialect == VS_DIALECT_TRAVESIM)
    printf("commands   on   %s:%d (blue), %d (yellow); replacements on %d\n", here, p->team[VS_BLUE],
           p->team[VS_YELLOW], p->command);
  else
    printf("commands   on   %s:%d\n", here, p->command);
  if (c->def.match.mode == VS_REFEREE_OWN)
    printf("referee    to   %s:%d; placements on %d\n", VS_REFEREE_GROUP, p->referee, p->placer);
  vs_time_outs by = vs_time_outs_by(c->def.match.referee.rules);
  if (c->def.match.mode == VS_REFEREE_OWN && by.number > 0 && isatty(STDIN_FILENO))
    printf("time-outs  b (blue), y (yellow): %d of %g s each, at the next stop of play; the same key ends one\n",
           by.number, by.length_s);
  if (c->def.match.mode == VS_REFEREE_EXTERNAL) printf("referee    from %s:%d\n", VS_REFEREE_GROUP, p->referee);
  printf("\n");
  fflush(stdout);
}

static void print_line(serve_command *c, const char *text) {
  if (c->json) return;
  vs_progress_clear(&c->progress);
  printf("%7.2f s  %s\n", vs_hosted_game(vs_serve_match(c->server))->time_s, text);
  fflush(stdout);
}

// A team's key asks for its time-out, and ends it.
static void obey_keys(serve_command *c) {
  char typed[16];
  int n = vs_operator_typed(&c->keys, typed, sizeof typed);
  for (int k = 0; k < n; k++) {
    vs_hosted *match = vs_serve_match(c->server);
    vs_team team = typed[k] == 'y' ? VS_YELLOW : VS_BLUE;
    vs_error why = {0};
    char line[96];
    if (typed[k] != 'b' && typed[k] != 'y') continue;
    if (vs_hosted_ready(match, team))
      snprintf(line, sizeof line, "%s is ready", vs_team_name(team));
    else if (vs_hosted_time_out(match, team, &why) == VS_OK)
      snprintf(line, sizeof line, "%s asks for a time-out", vs_team_name(team));
    else
      snprintf(line, sizeof line, "%.90s", why.text);
    print_line(c, line);
  }
}

// The time-out that has just begun.
static void print_time_out(serve_command *c, const vs_hosted_said *said) {
  const vs_hosted *match = vs_serve_match(c->server);
  if (said->calls == 0 || vs_hosted_phase(match) != VS_PHASE_TIME_OUT) return;
  vs_team team = (vs_team)vs_hosted_call(match)->team;
  vs_time_outs by = vs_time_outs_by(c->def.match.referee.rules);
  char line[96];
  snprintf(line, sizeof line, "time-out of %s, %d of %d: %g s, '%c' ends it", vs_team_name(team),
           vs_hosted_time_outs_taken(match, team), by.number, by.length_s, vs_team_name(team)[0]);
  print_line(c, line);
}

static void print_frame(serve_command *c, const vs_hosted_said *said, const char *note) {
  const vs_hosted *match = vs_serve_match(c->server);
  const vs_game *game = vs_hosted_game(match);
  if (!c->json && (said->event.kind != VS_EVENT_NONE || *note)) vs_progress_clear(&c->progress);
  if (!c->json && *note) printf("%7.2f s  %s\n", game->time_s, note);
  if (!c->json && said->event.kind != VS_EVENT_NONE) {
    char text[64];
    vs_event_text(&said->event, text, sizeof text);
    printf("%7.2f s  %s  %d : %d\n", game->time_s, text, game->score[VS_BLUE], game->score[VS_YELLOW]);
  }
  if (!c->json && (*note || said->event.kind != VS_EVENT_NONE)) fflush(stdout);
  char text[200];
  snprintf(text, sizeof text, "%s %d : %d %s  %5.1f s  %s", c->uri[VS_BLUE], game->score[VS_BLUE],
           game->score[VS_YELLOW], c->uri[VS_YELLOW], game->time_s, vs_phase_name(vs_hosted_phase(match)));
  vs_progress_show(&c->progress, game->time_s / game->duration_s, text);
}

static vs_status play(serve_command *c, vs_error *err) {
  vs_hosted *match = vs_serve_match(c->server);
  int64_t begin_us = vs_clock_monotonic_us() + (int64_t)(1e6 * c->wait_s);
  double played_s = 0;
  vs_hosted_said said;
  char note[256];
  vs_status s = VS_OK;
  c->start_us = vs_clock_monotonic_us();
  while (s == VS_OK && vs_hosted_phase(match) != VS_PHASE_OVER && !vs_cli_interrupted()) {
    if (vs_hosted_phase(match) == VS_PHASE_WAIT && vs_clock_monotonic_us() >= begin_us) vs_hosted_begin(match);
    s = vs_serve_frame(c->server, &said, note, sizeof note, err);
    if (s == VS_OK && c->log) s = serve_record_frame(c->log, match, &said, err);
    if (s != VS_OK) break;
    print_frame(c, &said, note);
    print_time_out(c, &said);
    obey_keys(c);
    // Without our rules nobody else ends the match.
    played_s = vs_hosted_game(match)->time_s;
    if (c->def.match.mode != VS_REFEREE_OWN && c->seconds > 0 && played_s >= c->seconds) break;
  }
  vs_progress_clear(&c->progress);
  return s;
}

static void print_team(FILE *out, const serve_command *c, vs_team team) {
  const vs_team_traffic *t = &vs_serve_get_stats(c->server)->team[team];
  fprintf(out, "\"%s\": {\"player\": ", vs_team_name(team));
  vs_json_put(out, c->uri[team]);
  fprintf(out,
          ", \"heard\": %s, \"packets\": %" PRId64 ", \"commands\": %" PRId64 ", \"saturated\": %" PRId64
          ", \"placements\": %" PRId64 ", \"illegal_placements\": %" PRId64 ", \"silences\": %" PRId64
          ", \"silent_s\": %.2f, \"time_outs\": %d}",
          t->heard ? "true" : "false", t->packets, t->commands, t->saturated, t->placements, t->illegal_placements,
          t->silences, t->silent_s, vs_hosted_time_outs_taken(vs_serve_match(c->server), team));
}

// How a knockout match ended: "none" while it has not.
static void print_knockout(const serve_command *c) {
  const vs_referee *r = vs_hosted_referee(vs_serve_match(c->server));
  int winner = vs_referee_winner(r);
  printf(" \"knockout\": {\"winner\": \"%s\", \"extra_time\": %s, \"kicks\": [%d, %d], \"kicks_scored\": [%d, %d], "
         "\"lot\": %s},\n",
         winner < 0 ? "none" : vs_team_name((vs_team)winner), r->half >= VS_HALF_EXTRA_1 ? "true" : "false",
         r->kicks[VS_BLUE], r->kicks[VS_YELLOW], r->kicks_scored[VS_BLUE], r->kicks_scored[VS_YELLOW],
         r->lot ? "true" : "false");
}

static void print_json(const serve_command *c, double wall_s) {
  const vs_serve_stats *s = vs_serve_get_stats(c->server);
  const vs_hosted *match = vs_serve_match(c->server);
  const vs_game *game = vs_hosted_game(match);
  printf("{\"command\": \"serve\", \"division\": \"%s\", \"dialect\": \"%s\", \"rules\": \"%s\", \"robot\": \"%s\", "
         "\"seed\": %d,\n",
         c->division, vs_dialect_name(c->def.dialect), c->rules, c->def.match.robot->name, c->seed);
  printf(" \"complete\": %s, \"score\": [%d, %d], \"time_s\": %.3f, \"hash\": \"%016" PRIx64 "\",\n",
         vs_hosted_phase(match) == VS_PHASE_OVER ? "true" : "false", game->score[VS_BLUE], game->score[VS_YELLOW],
         game->time_s, vs_hosted_hash(match));
  if (c->knockout) print_knockout(c);
  printf(" ");
  print_team(stdout, c, VS_BLUE);
  printf(",\n ");
  print_team(stdout, c, VS_YELLOW);
  printf(",\n \"frames\": %" PRId64 ", \"unsent\": %" PRId64 ", \"garbage\": %" PRId64 ", \"dropped_rows\": %" PRId64
         ", \"foreign_commands\": %" PRId64 ", \"refused_replacements\": %" PRId64 ",\n",
         s->frames, s->unsent, s->garbage, s->dropped, s->foreign, s->refused_replacements);
  printf(" \"wall_s\": %.3f, \"times_real_time\": %.2f, \"late_us\": {\"p50\": %.0f, \"p99\": %.0f, \"max\": %" PRId64
         "}}\n",
         wall_s, (double)s->frames / vs_dialect_hz(c->def.dialect) / wall_s, vs_histogram_quantile_us(&s->late, 0.5),
         vs_histogram_quantile_us(&s->late, 0.99), s->late.max_us);
}

static void print_end(const serve_command *c) {
  double wall_s = 1e-6 * (double)(vs_clock_monotonic_us() - c->start_us);
  if (c->json) {
    print_json(c, wall_s);
    return;
  }
  const vs_serve_stats *s = vs_serve_get_stats(c->server);
  const vs_game *game = vs_hosted_game(vs_serve_match(c->server));
  printf("\n%s %d : %d %s after %.1f s\n", c->uri[VS_BLUE], game->score[VS_BLUE], game->score[VS_YELLOW],
         c->uri[VS_YELLOW], game->time_s);
  const vs_referee *referee = vs_hosted_referee(vs_serve_match(c->server));
  if (referee->half == VS_HALF_SHOOT_OUT)
    printf("shoot-out %d : %d%s\n", referee->kicks_scored[VS_BLUE], referee->kicks_scored[VS_YELLOW],
           referee->lot ? ", by lot" : "");
  for (int t = 0; t < VS_TEAMS; t++) {
    const vs_team_traffic *p = &s->team[t];
    if (c->def.match.player[t]) continue;
    printf("%-7s %" PRId64 " packets, %" PRId64 " of %" PRId64
           " commands faster than the wheels, silent %.1f s, %" PRId64 " placements (%" PRId64 " illegal)\n",
           vs_team_name((vs_team)t), p->packets, p->saturated, p->commands, p->silent_s, p->placements,
           p->illegal_placements);
  }
  if (s->garbage + s->dropped + s->foreign + s->refused_replacements + s->unsent > 0)
    printf("ignored: %" PRId64 " datagrams that were no message, %" PRId64 " rows with impossible values, %" PRId64
           " commands for others, %" PRId64 " replacements; %" PRId64 " datagrams could not be sent\n",
           s->garbage, s->dropped, s->foreign, s->refused_replacements, s->unsent);
  printf("%" PRId64 " frames in %.1f s", s->frames, wall_s);
  if (c->sync)
    printf(" (%.0f times real time)\n", (double)s->frames / vs_dialect_hz(c->def.dialect) / wall_s);
  else
    printf(", sent late by %.2f ms (median), %.2f ms (99 %%), %.1f ms (worst)\n",
           1e-3 * vs_histogram_quantile_us(&s->late, 0.5), 1e-3 * vs_histogram_quantile_us(&s->late, 0.99),
           1e-3 * (double)s->late.max_us);
}

int cmd_serve(int argc, char **argv) {
  serve_command c = {.uri = {"net", "net"},
                     .division = "3v3",
                     .dialect = "firasim",
                     .rules = "league",
                     .referee = "own",
                     .drive = "contact",
                     .pause_s = 8,
                     .wait_s = 60,
                     .answer_s = 1,
                     .seed = 1};
  const vs_flag flags[] = {
      {"blue", VS_FLAG_TEXT, &c.uri[VS_BLUE], "URI|net", "who attacks +x", 0, 0},
      {"yellow", VS_FLAG_TEXT, &c.uri[VS_YELLOW], "URI|net", "who attacks -x", 0, 0},
      {"division", VS_FLAG_TEXT, &c.division, "NAME", "3v3, or 5v5: five robots a team on 2.2 x 1.8 m", 0, 0},
      {"dialect", VS_FLAG_TEXT, &c.dialect, "NAME", "firasim, or travesim (100 Hz, a port for each team)", 0, 0},
      {"robot", VS_FLAG_TEXT, &c.robot, "NAME", "paper, firasim or travesim: wheels and drive [the dialect's]", 0, 0},
      {"rules", VS_FLAG_TEXT, &c.rules, "NAME", "paper, league (the network referee's), serie-a-2023 or larc-2026", 0,
       0},
      {"referee", VS_FLAG_TEXT, &c.referee, "NAME", "own, or external: obey a VSSReferee", 0, 0},
      {"no-referee", VS_FLAG_SWITCH, &c.no_referee, NULL, "goals are counted, who may place places", 0, 0},
      {"knockout", VS_FLAG_SWITCH, &c.knockout, NULL, "a tie is followed by extra time and a shoot-out", 0, 0},
      {"pause", VS_FLAG_REAL, &c.pause_s, "S", "from the call to the placing, and from there to play", 0, 60},
      {"wait", VS_FLAG_REAL, &c.wait_s, "S", "for the teams of the network, then start without them", 0, 86400},
      {"seconds", VS_FLAG_REAL, &c.seconds, "S", "of play; 0: the rules' (without own referee: until Ctrl-C)", 0, 7200},
      {"realtime", VS_FLAG_SWITCH, &c.realtime, NULL, "at the pace of the clock (the default)", 0, 0},
      {"sync", VS_FLAG_SWITCH, &c.sync, NULL, "a frame as soon as the teams have answered the last", 0, 0},
      {"answer", VS_FLAG_REAL, &c.answer_s, "S", "with --sync: how long to wait for an answer", 0.001, 60},
      {"ports", VS_FLAG_TEXT, &c.ports, "PORTS",
       "+N for all, or vision=N,command=N,blue=N,yellow=N,referee=N,placement=N", 0, 0},
      {"interface", VS_FLAG_TEXT, &c.interface, "NAME", "the hall's network, such as eth0; else this machine only", 0,
       0},
      {"drive", VS_FLAG_TEXT, &c.drive, "NAME", "contact (the reference) or planar (the fast twin)", 0, 0},
      {"seed", VS_FLAG_INT, &c.seed, "N", "of players that draw", 0, 2147483647},
      {"rt", VS_FLAG_INT, &c.rt, "PRIO",
       "real-time priority, such as 50, and locked memory; 0: of what sends the world alone, where allowed", 0, 99},
      {"record", VS_FLAG_TEXT, &c.record, "LOG", "write a log for 'vsss replay'", 0, 0},
      {"league-log", VS_FLAG_TEXT, &c.league_log, "FILE", "write the datagrams as VSSReferee's recorder does", 0, 0},
      {"replay", VS_FLAG_TEXT, &c.replay, "FILE", "play no match: send such a file's datagrams again", 0, 0},
      {"json", VS_FLAG_SWITCH, &c.json, NULL, "one JSON object on standard output, nothing else", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0},
  };
  bool help;
  vs_error err = {0};
  char text[3072];
  vs_match_flags_about(about, text, sizeof text);
  vs_status s = vs_args_parse(argc, argv, "serve [flags]", text, flags, NULL, &help, &err);
  if (help) return 0;
  if (s == VS_OK && c.replay) {
    vs_ports ports = vs_ports_default();
    if (c.ports) s = vs_ports_parse(c.ports, &ports, &err);
    vs_cli_catch_interrupts();
    if (s == VS_OK) s = serve_replay(c.replay, &ports, c.interface, &err);
    return s == VS_OK ? 0 : vs_cli_error("serve", &err);
  }
  if (s == VS_OK) s = prepare(&c, &err);
  if (s == VS_OK && c.league_log) s = vs_league_log_create(c.league_log, &c.def.log, &err);
  if (s == VS_OK) s = vs_serve_new(&c.def, &c.server, &err);
  if (s == VS_OK && c.record) s = serve_record_open(c.record, c.uri, &c.log, &err);
  if (s == VS_OK) {
    vs_cli_catch_interrupts();
    if (c.rt) vs_cli_realtime(c.rt);
    vs_progress_start(&c.progress);
    print_head(&c);
    s = vs_operator_open(NULL, &c.keys, &err);
    if (s == VS_OK) s = play(&c, &err);
    vs_operator_close(&c.keys);
    print_end(&c);
  }
  serve_record_close(c.log);
  vs_serve_free(c.server);
  vs_model_free(c.model);
  vs_status logged = vs_league_log_close(c.def.log, s == VS_OK ? &err : NULL);
  if (s == VS_OK) s = logged;
  return s == VS_OK ? 0 : vs_cli_error("serve", &err);
}
