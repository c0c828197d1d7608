// One match of a league: starts the clubs' programs, serves them, judges who has lost by the rules, ends them.
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli.h"
#include "league.h"
#include "serve_record.h"
#include "vsss/clock.h"

// A program is told where it plays by its environment, and leads a group of processes of its own. What it says goes to a
// file.
static vs_status start(const league_file *f, int club, int team, const vs_ports *ports, const char *said, pid_t *out,
                       vs_error *err) {
  const struct {
    const char *name;
    int value;
  } told[] = {{"VSSS_VISION_PORT", ports->vision},
              {"VSSS_COMMAND_PORT", ports->command},
              {"VSSS_TEAM_PORT", ports->team[team]},
              {"VSSS_REFEREE_PORT", ports->referee},
              {"VSSS_PLACEMENT_PORT", ports->placer}};
  for (size_t k = 0; k < sizeof told / sizeof *told; k++) {
    char number[16];
    snprintf(number, sizeof number, "%d", told[k].value);
    setenv(told[k].name, number, 1);
  }
  setenv("VSSS_TEAM", vs_team_name((vs_team)team), 1);
  int file = open(said, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return vs_fail(err, VS_FAIL, "%s: cannot be written: %s", said, strerror(errno));
  pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    signal(SIGINT, SIG_DFL);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", f->club[club].command, (char *)NULL);
    _exit(127);
  }
  close(file);
  if (child < 0) return vs_fail(err, VS_FAIL, "%s cannot be started: %s", f->club[club].name, strerror(errno));
  setpgid(child, child);
  *out = child;
  return VS_OK;
}

// Asked to end, then made to. The group goes with it.
static void end(pid_t child) {
  if (child <= 0) return;
  kill(-child, SIGTERM);
  for (int k = 0; k < 100 && waitpid(child, NULL, WNOHANG) == 0; k++) usleep(20000);
  kill(-child, SIGKILL);
  waitpid(child, NULL, WNOHANG);
}

static vs_status prepare(const league_file *f, const league_result *m, vs_serve_def *def, vs_model **model,
                         vs_error *err) {
  *def = vs_serve_def_default();
  def->dialect = f->dialect;
  def->ports = f->ports;
  def->match.robot = f->robot;
  def->match.referee = vs_referee_def_default(f->rules);
  vs_referee_def_lasts(&def->match.referee, f->seconds);
  def->match.referee.knockout = league_is_knockout(f, m);
  def->match.pause_s = f->pause_s;
  def->match.seed = vs_seed_mix(f->seed, (uint64_t)(m->round * 1000 + m->club[VS_BLUE] * 30 + m->club[VS_YELLOW]));
  def->sync = !f->realtime;
  def->ends = vs_cli_interrupted;
  for (int t = 0; t < VS_TEAMS; t++) {
    const char *uri = f->club[m->club[t]].player;
    def->match.player[t] = *uri ? uri : NULL;
  }
  vs_model_def model_def = vs_model_def_default(f->drive);
  model_def.division = f->division;
  model_def.frame_hz = vs_dialect_hz(def->dialect);
  model_def.substeps_per_frame = def->dialect == VS_DIALECT_TRAVESIM ? 2 : 3;
  vs_status s = vs_model_load(&model_def, model, err);
  def->match.model = *model;
  return s;
}

static void forfeit(const league_file *f, league_result *m, int team, const char *why) {
  size_t used = strlen(m->why);
  m->forfeits |= 1 << team;
  snprintf(m->why + used, sizeof m->why - used, "%s%s %.80s", used ? "; " : "", f->club[m->club[team]].name, why);
}

// A program that has ended, was never heard, or was silent for too long has lost.
static bool judge(const league_file *f, league_result *m, vs_serve *server, pid_t child[VS_TEAMS], bool waited) {
  for (int t = 0; t < VS_TEAMS; t++) {
    if (!*f->club[m->club[t]].command || (m->forfeits & 1 << t)) continue;
    const vs_team_traffic *traffic = &vs_serve_get_stats(server)->team[t];
    int status;
    char why[80];
    if (child[t] > 0 && waitpid(child[t], &status, WNOHANG) == child[t]) {
      kill(-child[t], SIGKILL);
      child[t] = 0;
      if (WIFSIGNALED(status))
        snprintf(why, sizeof why, "crashed (signal %d)", WTERMSIG(status));
      else
        snprintf(why, sizeof why, "ended by itself (status %d)", WEXITSTATUS(status));
      forfeit(f, m, t, why);
    } else if (waited && !traffic->heard) {
      forfeit(f, m, t, "was never heard");
    } else if (traffic->silent_s > f->silence_s) {
      snprintf(why, sizeof why, "was silent for more than %g s", f->silence_s);
      forfeit(f, m, t, why);
    }
  }
  return m->forfeits != 0;
}

static vs_status play(const league_file *f, league_result *m, vs_serve *server, pid_t child[VS_TEAMS],
                      serve_record *log, vs_error *err) {
  vs_hosted *match = vs_serve_match(server);
  int64_t begin_us = vs_clock_monotonic_us() + (int64_t)(1e6 * f->wait_s);
  vs_hosted_said said;
  vs_status s = VS_OK;
  for (int frame = 0; s == VS_OK && vs_hosted_phase(match) != VS_PHASE_OVER && !vs_cli_interrupted(); frame++) {
    bool waited = vs_hosted_phase(match) != VS_PHASE_WAIT || vs_clock_monotonic_us() >= begin_us;
    if (frame % 30 == 0 && judge(f, m, server, child, waited)) break;
    s = vs_serve_frame(server, &said, NULL, 0, err);
    if (s == VS_OK && log) s = serve_record_frame(log, match, &said, err);
  }
  const vs_referee *referee = vs_hosted_referee(match);
  memcpy(m->score, referee->game.score, sizeof m->score);
  memcpy(m->shoot_out, referee->kicks_scored, sizeof m->shoot_out);
  m->lot = referee->lot;
  if (s != VS_OK && vs_hosted_broken(match) >= 0) { // its fault, not the league's
    forfeit(f, m, vs_hosted_broken(match), err->text);
    *err = (vs_error){0};
    s = VS_OK;
  }
  if (!m->forfeits) return s;
  m->lot = 0;
  for (int t = 0; t < VS_TEAMS; t++) {
    m->score[t] = m->forfeits == 1 << !t ? LEAGUE_FORFEIT_GOALS : 0;
    m->shoot_out[t] = 0;
  }
  return s;
}

vs_status league_match_play(const league_file *f, league_result *m, const char *log, vs_error *err) {
  vs_serve_def def;
  vs_model *model = NULL;
  vs_serve *server = NULL;
  serve_record *record = NULL;
  pid_t child[VS_TEAMS] = {0, 0};
  const char *names[VS_TEAMS] = {f->club[m->club[VS_BLUE]].name, f->club[m->club[VS_YELLOW]].name};
  m->forfeits = 0;
  m->why[0] = '\0';
  vs_status s = prepare(f, m, &def, &model, err);
  if (s == VS_OK) s = vs_serve_new(&def, &server, err);
  if (s == VS_OK && f->record) s = serve_record_open(log, names, &record, err);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++) {
    char said[2 * LEAGUE_TEXT];
    snprintf(said, sizeof said, "%s.%s.txt", log, vs_team_name((vs_team)t));
    if (*f->club[m->club[t]].command) s = start(f, m->club[t], t, &def.ports, said, &child[t], err);
  }
  if (s == VS_OK) s = play(f, m, server, child, record, err);
  for (int t = 0; t < VS_TEAMS; t++) end(child[t]);
  serve_record_close(record);
  vs_serve_free(server);
  vs_model_free(model);
  return s;
}
