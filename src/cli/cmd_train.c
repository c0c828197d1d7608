// vsss train: PPO self-play.
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "commands.h"
#include "run_folder.h"
#include "train_options.h"
#include "train_text.h"
#include "vsss/clock.h"
#include "vsss/file.h"
#include "vsss/journal.h"
#include "vsss/learn.h"
#include "vsss/number.h"
#include "vsss/paths.h"

typedef struct session {
  const train_options *opt;
  char folder[PATH_MAX - 64], command[1024];
  vs_group *group;   // NULL: alone
  atomic_bool first; // rank 0: shows, logs, saves
  bool continued;    // --resume of this folder
  atomic_bool ready; // train is there: from here on an interrupt may save it
  vs_train *train;
  vs_journal *journal;
  vs_train_report report;
  double start_s, checkpoint_s, eval_s, line_s;
  double eval_transitions; // at which the last evaluation was
  double kept_m;           // million transitions of the last checkpoint that is kept
  vs_drive eval_drive;
  char scores[256]; // of the last evaluation, for the policy's metadata
  vs_progress progress;
  pthread_mutex_t alive; // held while an interrupt uses what is here, and from the end on
} session;

static double now_s(void) { return 1e-6 * (double)vs_clock_monotonic_us(); }

static vs_status save_checkpoint(session *s, vs_error *err) {
  char path[PATH_MAX];
  snprintf(path, sizeof path, "%s/checkpoint", s->folder);
  return vs_train_save(s->train, path, err);
}

static vs_status save(session *s, vs_error *err) {
  char path[PATH_MAX];
  vs_status status = save_checkpoint(s, err);
  const char *const notes[] = {"command", s->command, "commit", vs_cli_commit, "score", s->scores, NULL};
  snprintf(path, sizeof path, "%s/policy.onnx", s->folder);
  if (status == VS_OK) status = vs_train_export(s->train, path, true, notes, err);
  if (status == VS_OK && s->opt->export) status = vs_train_export(s->train, s->opt->export, true, notes, err);
  if (status == VS_OK && s->opt->slim) status = vs_train_save_slim(s->train, s->opt->slim, err);
  s->checkpoint_s = now_s();
  return status;
}

// Lines that rewrite themselves on a terminal, a line a minute elsewhere.
static void show(session *s) {
  char text[1024];
  train_text(s->train, &s->report, text, sizeof text);
  const vs_train_def *def = vs_train_settings(s->train);
  double fraction = def->transitions_m > 0.0 ? s->report.transitions * 1e-6 / def->transitions_m : 0.0;
  if (s->opt->minutes > 0.0) fraction = fmax(fraction, (now_s() - s->start_s) / (60.0 * s->opt->minutes));
  if (s->progress.terminal) {
    vs_progress_show(&s->progress, fraction, text);
  } else if (now_s() - s->line_s >= 60.0 || s->line_s == 0.0) {
    s->line_s = now_s();
    for (char *end; (end = strchr(text, '\n')) != NULL;) *end = ' ';
    printf("%6.1f min  update %.0f  %s\n", s->report.wall_s / 60.0, s->report.update, text);
    fflush(stdout);
  }
}

static bool time_is_up(const session *s) {
  return s->opt->minutes > 0.0 && now_s() - s->start_s >= 60.0 * s->opt->minutes;
}

static bool show_imitation(void *context, double part, double loss) {
  session *s = context;
  char text[96];
  snprintf(text, sizeof text, "imitating %.40s: -log p %.3f", s->opt->imitate, loss);
  if (s->first && s->progress.terminal) vs_progress_show(&s->progress, part, text);
  if (s->first && !s->progress.terminal && part >= 1.0) printf("%s\n", text);
  return !vs_cli_interrupted();
}

static vs_status imitate(session *s, vs_error *err) {
  vs_progress_start(&s->progress);
  vs_status status = vs_train_imitate(s->train, s->opt->imitate, s->opt->imitate_updates, show_imitation, s, err);
  vs_progress_clear(&s->progress);
  return status;
}

static vs_status evaluate_against(session *s, const char *opponent, const char *policy, vs_error *err) {
  const vs_train_eval_def def = {.policy_file = policy,
                                 .opponent = opponent,
                                 .drive = s->eval_drive,
                                 .matches = s->opt->eval_matches,
                                 .threads = vs_train_settings(s->train)->threads,
                                 .seed = 1,
                                 .go_on = vs_cli_go_on};
  vs_train_score eval;
  vs_status status = vs_train_evaluate(&def, &eval, err);
  if (status != VS_OK || eval.matches < s->opt->eval_matches) return status;
  size_t used = strlen(s->scores);
  snprintf(s->scores + used, sizeof s->scores - used, "%s%s %.2f", used ? ", " : "", opponent, eval.score);
  vs_progress_clear(&s->progress);
  printf("%6.1f min  %.2f M  against %-10s won %3.0f drawn %3.0f lost %3.0f %%  goals %.2f : %.2f  score %+.2f\n",
         s->report.wall_s / 60.0, s->report.transitions * 1e-6, opponent, 100 * eval.win, 100 * eval.draw,
         100 * eval.loss, eval.goals_for, eval.goals_against, eval.score);
  fflush(stdout);
  return vs_journal_add_eval(s->journal, &s->report, &eval, err);
}

// The policy as it is now against each of --eval-against, on --eval-drive.
static vs_status evaluate(session *s, vs_error *err) {
  char policy[PATH_MAX], names[256];
  snprintf(policy, sizeof policy, "%s/policy.onnx", s->folder);
  snprintf(names, sizeof names, "%s", s->opt->eval_against);
  vs_status status = save(s, err);
  s->scores[0] = '\0';
  char *rest = names;
  for (char *one; status == VS_OK && (one = strsep(&rest, ",")) != NULL;)
    if (*one) status = evaluate_against(s, one, policy, err);
  s->eval_s = now_s();
  s->eval_transitions = s->report.transitions;
  return status;
}

static bool evaluation_is_due(const session *s) {
  const train_options *o = s->opt;
  return (o->eval_min > 0.0 && now_s() - s->eval_s >= 60.0 * o->eval_min) ||
         (o->eval_m > 0.0 && s->report.transitions - s->eval_transitions >= 1e6 * o->eval_m);
}

// RUN/kept/0160019040.checkpoint: the networks as they were after so many transitions.
static vs_status keep(session *s, vs_error *err) {
  char path[PATH_MAX];
  double million = s->report.transitions * 1e-6;
  s->kept_m = floor(million / s->opt->keep_m) * s->opt->keep_m;
  snprintf(path, sizeof path, "%s/kept", s->folder);
  vs_status status = vs_path_make_folder(path, 0777, err);
  if (status != VS_OK) return status;
  snprintf(path, sizeof path, "%s/kept/%010.0f.checkpoint", s->folder, s->report.transitions);
  return vs_train_save_slim(s->train, path, err);
}

// What rank 0 does after an update.
static vs_status record(session *s, vs_error *err) {
  vs_status status = vs_journal_add(s->journal, &s->report, err);
  if (status != VS_OK) return status;
  show(s);
  if (s->opt->keep_m > 0.0 && s->report.transitions * 1e-6 >= s->kept_m + s->opt->keep_m) status = keep(s, err);
  if (status != VS_OK) return status;
  if (evaluation_is_due(s)) return evaluate(s, err);
  return now_s() - s->checkpoint_s >= 60.0 * s->opt->checkpoint_min ? save(s, err) : VS_OK;
}

// At the first interrupt, while the update goes on.
static void announce_stop(void *context) {
  session *s = context;
  if (s->first)
    fprintf(stderr,
            "%svsss train: stopping after this update; once more, and what was learnt before it is saved at once\n",
            isatty(STDERR_FILENO) ? "\n" : ""); // below the line of progress
}

// At the second: saves the state before this update, which is in memory.
static void save_now(void *context) {
  session *s = context;
  if (!s->first) return;
  char path[PATH_MAX];
  double update;
  vs_error err = {0};
  pthread_mutex_lock(&s->alive);
  snprintf(path, sizeof path, "%s/checkpoint", s->folder);
  bool ready = s->ready;
  if (!ready || vs_train_save_kept(s->train, path, &update, &err) != VS_OK)
    fprintf(stderr, "vsss train: %s\n", ready ? err.text : "nothing to save yet");
  else
    fprintf(stderr, "vsss train: saved as it was after update %.0f: --resume %s goes on\n", update, s->folder);
}

static vs_status run(session *s, vs_error *err) {
  bool stop = vs_train_done(s->train) || vs_cli_interrupted();
  vs_status status = vs_group_any(s->group, &stop, err);
  s->start_s = s->checkpoint_s = s->eval_s = now_s();
  s->eval_transitions = vs_train_transitions(s->train);
  if (s->opt->keep_m > 0.0) s->kept_m = floor(s->eval_transitions * 1e-6 / s->opt->keep_m) * s->opt->keep_m;
  vs_progress_start(&s->progress);
  while (status == VS_OK && !stop) {
    status = vs_train_update(s->train, &s->report, err);
    if (status == VS_OK && s->first) status = vs_train_keep(s->train, err);
    if (status == VS_OK && s->first) status = record(s, err);
    stop = vs_cli_interrupted() || time_is_up(s) || vs_train_done(s->train);
    if (status == VS_OK) status = vs_group_any(s->group, &stop, err);
  }
  vs_progress_clear(&s->progress);
  if (status == VS_OK && s->first) status = save(s, err);
  return status;
}

// A new run from a checkpoint that is done: as long again as a run of ours is, unless the user says how long.
static void raise_limit(session *s) {
  if (!train_resumes_file(s->opt) || !vs_train_done(s->train) || train_sets_limit(s->opt)) return;
  double old = vs_train_settings(s->train)->transitions_m, more = vs_train_def_default().transitions_m;
  double limit = vs_train_transitions(s->train) * 1e-6 + more;
  vs_train_go_on(s->train, limit);
  if (s->first)
    printf("%s has reached its limit of %.6g M transitions: going on to %.6g M (--transitions sets another)\n",
           s->opt->resume, old, limit);
}

// A run can be continued from its start on, before it has learnt anything.
static vs_status begin(session *s, vs_error *err) {
  vs_status status = s->first ? vs_train_keep(s->train, err) : VS_OK;
  return status == VS_OK && s->first && !s->continued ? save_checkpoint(s, err) : status;
}

static vs_status prepare(session *s, const vs_train_def *def, vs_error *err) {
  char path[PATH_MAX];
  vs_status status = s->first ? vs_run_folder_lock(s->folder, err) : VS_OK;
  snprintf(path, sizeof path, "%s/checkpoint", s->folder);
  if (status == VS_OK && s->first && !s->continued && access(path, F_OK) == 0)
    return vs_fail(err, VS_USAGE, "%s holds a run: continue it with --resume %s, or choose another --run", s->folder,
                   s->folder);
  if (status == VS_OK) status = vs_train_new(def, s->group, &s->train, err);
  if (status == VS_OK && s->opt->resume) {
    char note[256];
    train_checkpoint_to_resume(s->opt, path, sizeof path);
    status = vs_train_load(s->train, path, note, err);
    if (status == VS_OK && note[0]) printf("%s\n", note);
    if (status == VS_OK) status = vs_train_average(s->train, s->opt->average.value, s->opt->average.count, err);
    if (status == VS_OK) raise_limit(s);
  }
  if (status == VS_OK && s->first) status = vs_run_folder_note(s->folder, s->command, vs_cli_commit, err);
  if (status != VS_OK || !s->first) return status;
  char text[VS_TRAIN_TEXT_MAX];
  snprintf(path, sizeof path, "%s/settings.ini", s->folder);
  vs_train_def_text(vs_train_settings(s->train), true, text, sizeof text);
  status = vs_file_replace(path, text, strlen(text), err);
  if (status != VS_OK) return status;
  return vs_journal_open(s->folder, vs_train_updates(s->train), &s->journal, err);
}

static vs_status train(const train_options *o, int argc, char **argv, vs_error *err) {
  static session s; // an interrupt may look at it until the very end
  s = (session){.opt = o, .alive = PTHREAD_MUTEX_INITIALIZER};
  s.continued = o->resume && !train_resumes_file(o);
  if (o->average.count && !train_resumes_file(o))
    return vs_fail(err, VS_USAGE, "--average begins a new run: give --resume CHECKPOINT too, and --run FOLDER");
  snprintf(s.folder, sizeof s.folder, "%s", s.continued ? o->resume : o->run);
  vs_cli_command("vsss", argc, (const char *const *)argv, s.command, sizeof s.command);
  vs_train_def def;
  vs_status status = vs_cli_await_interrupts(announce_stop, save_now, &s, err);
  if (status == VS_OK) status = train_settings(o, &def, err);
  if (status == VS_OK) status = vs_drive_parse(o->eval_drive, &s.eval_drive, err);
  if (status == VS_OK) status = vs_group_open(&s.group, err);
  s.first = vs_group_rank(s.group) == 0;
  if (status == VS_OK) status = prepare(&s, &def, err);
  s.ready = status == VS_OK;
  if (status == VS_OK) status = begin(&s, err);
  if (status == VS_OK && s.first) {
    if (s.group) printf("%d ranks, each:\n", vs_group_size(s.group));
    printf("training in %s: %d matches x %d steps, %d threads, %s drive, against %s; %s\n", s.folder, def.envs,
           def.steps, def.threads, def.drive, def.opponent, vs_train_products(s.train));
    fflush(stdout);
  }
  if (status == VS_OK && o->imitate) status = imitate(&s, err);
  if (status == VS_OK && o->imitate) status = begin(&s, err);
  if (status == VS_OK) status = run(&s, err);
  if (status == VS_OK && s.first) {
    bool done = vs_train_done(s.train);
    printf("%s at %.2f M transitions after %.1f min of training: %s/checkpoint, %s/policy.onnx\n",
           done ? "done" : "stopped", vs_train_transitions(s.train) * 1e-6, vs_train_wall_s(s.train) / 60.0, s.folder,
           s.folder);
    vs_run_folder_next(s.folder, done ? vs_train_settings(s.train)->transitions_m : 0.0);
  }
  pthread_mutex_lock(&s.alive); // for good: an interrupt that comes too late waits for the end
  vs_journal_close(s.journal);
  s.ready = false;
  vs_train_free(s.train);
  if (status != VS_OK && s.group) vs_cli_error("train", err); // said now: closing ends this process too
  vs_group_close(s.group, status != VS_OK);
  return status;
}

int cmd_train(int argc, char **argv) {
  train_options o = {.preset = "default",
                     .run = "runs/vsss",
                     .checkpoint_min = 5.0,
                     .imitate_updates = 40,
                     .eval_against = "random:,inf:,emc:",
                     .eval_drive = "contact",
                     .eval_matches = 20};
  const vs_flag flags[] = {
      {"preset", VS_FLAG_TEXT, &o.preset, "NAME", "default (our recipe) or paper (its Table 2)", 0, 0},
      {"config", VS_FLAG_TEXT, &o.config, "FILE", "settings as an INI file", 0, 0},
      {"set", VS_FLAG_LIST, &o.set, "KEY=VALUE", "one setting (see settings.ini in the run's folder); repeatable", 0,
       0},
      {"seed", VS_FLAG_TEXT, &o.seed, "N", "everything random follows from it", 0, 0},
      {"threads", VS_FLAG_INT, &o.threads, "N", "0: as set", 0, 256},
      {"opponent", VS_FLAG_TEXT, &o.opponent, "MIX", "such as frozen, emc: or self=0.6,pool=0.4", 0, 0},
      {"league", VS_FLAG_SWITCH, &o.league, NULL, "against itself and a pool of earlier selves", 0, 0},
      {"reward", VS_FLAG_TEXT, &o.reward, "MIX", "paper, dense or goals, then term=weight; --set anneal_from_m,", 0, 0},
      {"reward-end", VS_FLAG_TEXT, &o.reward_end, "MIX", "... anneal_to_m: what it becomes between these", 0, 0},
      {"realism", VS_FLAG_TEXT, &o.realism, "FILE", "sensors and dynamics drawn anew each episode", 0, 0},
      {"learner", VS_FLAG_TEXT, &o.learner, "NAME", "own or torch", 0, 0},
      {"imitate", VS_FLAG_TEXT, &o.imitate, "URI", "first clone this scripted player, such as emc:", 0, 0},
      {"imitate-updates", VS_FLAG_INT, &o.imitate_updates, "N", "... from this many batches", 1, 100000},
      {"minutes", VS_FLAG_REAL, &o.minutes, "MIN", "stop after; 0: no limit", 0, 1e6},
      {"transitions", VS_FLAG_REAL, &o.transitions_m, "MILLION", "stop at; 0: as set", 0, 1e9},
      {"checkpoint-every", VS_FLAG_REAL, &o.checkpoint_min, "MIN", "minutes between checkpoints", 0.001, 1e6},
      {"keep-every-m", VS_FLAG_REAL, &o.keep_m, "MILLION", "keep the networks after so many transitions in RUN/kept", 0,
       1e6},
      {"eval-every", VS_FLAG_REAL, &o.eval_min, "MIN", "matches this often; 0: never", 0, 1e6},
      {"eval-every-m", VS_FLAG_REAL, &o.eval_m, "MILLION", "... or after so many transitions", 0, 1e6},
      {"eval-against", VS_FLAG_TEXT, &o.eval_against, "URIS", "... against these players", 0, 0},
      {"eval-drive", VS_FLAG_TEXT, &o.eval_drive, "NAME", "... on contact (the reference) or planar", 0, 0},
      {"eval-matches", VS_FLAG_INT, &o.eval_matches, "N", "... so many each", 1, 100000},
      {"run", VS_FLAG_TEXT, &o.run, "FOLDER", "a new run: checkpoint, policy.onnx, CSV, TensorBoard", 0, 0},
      {"resume", VS_FLAG_TEXT, &o.resume, "FOLDER", "continue this run; a checkpoint: begin --run with it", 0, 0},
      {"average", VS_FLAG_LIST, &o.average, "CHECKPOINT", "... with the mean of that one's networks and these", 0, 0},
      {"export", VS_FLAG_TEXT, &o.export, "FILE", "write the policy here too", 0, 0},
      {"slim", VS_FLAG_TEXT, &o.slim, "FILE", "a small checkpoint too, the networks alone", 0, 0},
      {"write-untrained", VS_FLAG_TEXT, &o.untrained, "FILE", "write a policy nobody trained as ONNX and stop", 0, 0},
      {.name = NULL},
  };
  bool help;
  vs_error err = {0};
  vs_status s = vs_args_parse(argc, argv, "train [flags]", "Learns by self-play.", flags, NULL, &help, &err);
  if (s != VS_OK) return vs_cli_error("train", &err);
  if (help) return 0;
  vs_learn_environment();
  uint64_t seed = 1;
  if (o.untrained && o.seed && !vs_parse_seed(o.seed, &seed))
    s = vs_fail(&err, VS_USAGE, "--seed %s: expected a whole number from 0 to 2^64-1", o.seed);
  else if (o.untrained)
    s = vs_learn_write_untrained(o.untrained, seed, &err);
  else
    s = train(&o, argc, argv, &err);
  return s == VS_OK ? 0 : vs_cli_error("train", &err);
}
