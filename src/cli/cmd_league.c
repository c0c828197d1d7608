// vsss league: clubs play each other, in a round robin, groups or a knockout; goes on where it was stopped.
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "league.h"
#include "own_network.h"
#include "vsss/paths.h"
#include "vsss/policy.h"

static const char about[] =
    "Plays a league of the clubs in FILE.ini, over the network of `vsss serve` where a club is a program. After\n"
    "each match table, JSON and an HTML page are in the league's folder; run again, it goes on where it was stopped.\n"
    "A club that crashes or stays silent loses by the rules, and is named. A file:\n\n"
    "  [league]\n"
    "  seconds = 600\n"
    "  folder = runs/league\n"
    "  [club1]\n"
    "  name = Ours\n"
    "  player = onnx:            # any player's URI\n"
    "  [club2]\n"
    "  name = Guests\n"
    "  command = \"./client --$VSSS_TEAM\"   # also VSSS_VISION_PORT, _COMMAND_PORT, _TEAM_PORT, _REFEREE_PORT,\n"
    "                            # _PLACEMENT_PORT; ended after the match\n\n"
    "format = round-robin, knockout, or groups (groups = 2, advance = 2 of each go on to a knockout). A knockout match "
    "that\n"
    "is tied goes on to extra time and a shoot-out; seeds are in the file's order.\n\n"
    "Others: rounds, pause, wait, silence, division, rules, dialect, robot, drive, ports, realtime, record, seed, "
    "own_network = "
    "yes (the programs\n"
    "play in a network namespace of their own, where the system allows it; with no they share the machine's network).";

// A URI that does not open should fail before the first match.
static vs_status check_players(const league_file *f, vs_error *err) {
  for (int i = 0; i < f->clubs; i++) {
    vs_player *player = NULL;
    if (!*f->club[i].player) continue;
    vs_status s = vs_player_open(f->club[i].player, &player, err);
    if (s != VS_OK) {
      vs_fail_prefix(err, "%s", f->club[i].name);
      return s;
    }
    vs_player_close(player);
  }
  return VS_OK;
}

// Programs that know only the standard ports, and other matches on this machine, do not meet. A league of players alone
// needs none.
static void enter_own_network(const league_file *f) {
  bool programs = false;
  vs_error why = {0};
  for (int i = 0; i < f->clubs; i++) programs = programs || *f->club[i].command;
  if (!f->own_network || !programs || own_network_enter(&why) == VS_OK) return;
  fprintf(stderr, "vsss league: the programs share this machine's network: %s\n", why.text);
}

static vs_status play_one(const league_file *f, league_result *r, int *n, int of, league_result m, vs_error *err) {
  char name[2 * LEAGUE_TEXT], log[3 * LEAGUE_TEXT];
  league_log_name(f, &m, name, sizeof name);
  snprintf(log, sizeof log, "%s/%s", f->folder, name);
  vs_status s = league_match_play(f, &m, log, err);
  if (s != VS_OK || vs_cli_interrupted()) return s; // what was not played to its end is played again
  r[(*n)++] = m;
  printf("%d of %d  %s %d : %d %s%s%s\n", *n, of, f->club[m.club[VS_BLUE]].name, m.score[VS_BLUE], m.score[VS_YELLOW],
         f->club[m.club[VS_YELLOW]].name, *m.why ? "  " : "", m.why);
  fflush(stdout);
  return league_save(f, r, *n, of, err);
}

static vs_status play_all(const league_file *f, vs_error *err) {
  int of = league_of(f), n = 0;
  league_result *r = calloc((size_t)of + 1, sizeof *r), next;
  if (!r) return vs_fail(err, VS_FAIL, "out of memory for %d matches", of);
  vs_status s = league_load_results(f, r, of, &n, err);
  if (s == VS_OK && n > 0) printf("%d of %d matches are in %s\n", n, of, f->folder);
  while (s == VS_OK && !vs_cli_interrupted() && league_next(f, r, n, &next)) s = play_one(f, r, &n, of, next, err);
  if (n > 0) {
    printf("\n");
    league_print_table(f, r, n);
    printf("\n%s/index.html\n", f->folder);
  }
  if (s == VS_OK && league_next(f, r, n, &next)) printf("stopped: %d of %d matches; run it again to go on\n", n, of);
  free(r);
  return s;
}

int cmd_league(int argc, char **argv) {
  vs_flag_list file = {0};
  const vs_flag flags[] = {{NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  static league_file f;
  bool help;
  vs_error err = {0};
  vs_status s = vs_args_parse(argc, argv, "league FILE.ini", about, flags, &file, &help, &err);
  if (help) return 0;
  if (s == VS_OK && file.count != 1)
    s = vs_fail(&err, VS_USAGE, "give the league's file: vsss league FILE.ini (--help shows one)");
  if (s == VS_OK) s = league_file_load(file.value[0], &f, &err);
  if (s == VS_OK) enter_own_network(&f);
  if (s == VS_OK) s = check_players(&f, &err);
  if (s == VS_OK) s = vs_path_make_folder(f.folder, 0777, &err);
  if (s == VS_OK) {
    vs_cli_catch_interrupts();
    s = play_all(&f, &err);
  }
  return s == VS_OK ? 0 : vs_cli_error("league", &err);
}
