// src/cli/main.c and src/cli/terminal.c: every command where its surroundings fail it: correct work, or one line that
// says what failed, never a crash and never a result that went nowhere with status 0.
#include <signal.h>
#include <stdbool.h>
#include <unistd.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"

static char run_folder[96];

// Commands that print something and end soon; %s: a folder of a finished run.
static const char *const commands[] = {
    "sim --blue zero: --yellow emc: --drive planar --seconds 2",
    "sim --blue zero: --yellow emc: --drive planar --seconds 2 --matches 3",
    "sim --blue zero: --yellow emc: --drive planar --seconds 2 --json",
    "eval --blue zero: --against inf:,emc: --matches 2 --seconds 1 --drive planar",
    "eval --round-robin zero:,emc: --matches 1 --seconds 1 --drive planar",
    "plot '%s' --svg",
    "train --resume '%s'",
    "--help",
    "sim --help",
};
enum { COMMANDS = sizeof commands / sizeof *commands };

// The others, as far as they need no device; %1$s: the folder of this test, %2$d: a port or a shift of ports.
static const char *const others[] = {
    "detect deploy/docs/match.png",
    "detect deploy/docs/match.png --json",
    "doctor",
    "doctor --json",
    "field --camera deploy/docs/match.png --no-lcm --seconds 1",
    "rig --no-lcm --dir %1$s/rig",
    "serve --blue zero: --yellow emc: --seconds 1 --sync --ports +%2$d",
    "league %1$s/league.ini",
    "replay %1$s/log",
    "replay %1$s/log --json",
    "spy --print --lcm memq:// --seconds 0.1",
    "--version",
};
enum { OTHERS = sizeof others / sizeof *others };

// Those that go on until they are told to end.
static const char *const waiting[] = {
    "field --camera deploy/docs/match.png --no-lcm",
    "rig --no-lcm --dir %1$s/rig",
    "serve --ports +%2$d",
    "spy --print --lcm memq://",
    "view --live --lcm memq:// --port %2$d",
    "sim --blue zero: --yellow emc: --realtime --lcm memq://",
};
enum { WAITING = sizeof waiting / sizeof *waiting };

static const char *command(int index) {
  static char text[512];
  snprintf(text, sizeof text, commands[index], run_folder);
  return text;
}

static const char *other(const char *format) {
  static char text[512];
  snprintf(text, sizeof text, format, folder, 2000 + (int)(getpid() % 30000));
  return text;
}

typedef struct outcome {
  int status, lines; // of standard error
  char out[65536], err[16384];
} outcome;

// before VSSS command after, by a shell.
static void run(outcome *o, const char *before, const char *arguments, const char *after) {
  char binary[4096], line[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(line, sizeof line, "%s '%s' %s %s 2>%s/err", before, binary, arguments, after, folder);
  FILE *out = popen(line, "r");
  size_t n = fread(o->out, 1, sizeof o->out - 1, out);
  o->out[n] = '\0';
  int status = pclose(out);
  o->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  char path[128];
  snprintf(path, sizeof path, "%s/err", folder);
  FILE *err = fopen(path, "r");
  vsss_read_all(err, o->err, sizeof o->err);
  fclose(err);
  o->lines = 0;
  for (const char *c = o->err; *c; c++) o->lines += *c == '\n';
}

static outcome o;

static void assert_says(const char *what, const char *arguments, int status, const char *words) {
  if (o.status != status || o.lines != 1 || !strstr(o.err, words))
    fail_msg("%s: vsss %s: status %d, expected %d and one line with '%s', got: %s", what, arguments, o.status, status,
             words, o.err);
}

// This build lacks what the command needs.
static bool not_here(const char *arguments) {
  if (!strstr(o.err, "install ")) return false;
  print_message("note: 1 check not run: vsss %s: %s", arguments, o.err);
  return true;
}

static void output_that_goes_nowhere_is_an_error(void **state) {
  (void)state;
  for (int i = 0; i < OTHERS; i++) {
    run(&o, "", other(others[i]), ">&-");
    assert_says("closed", other(others[i]), 2, "standard output is closed");
    run(&o, "timeout 60", other(others[i]), ">/dev/full");
    if (!not_here(other(others[i]))) assert_says("full", other(others[i]), 1, "standard output: ");
  }
  for (int i = 0; i < COMMANDS; i++) {
    run(&o, "", command(i), ">&-");
    assert_says("closed", command(i), 2, "standard output is closed");
    run(&o, "", command(i), ">/dev/full");
    assert_says("full", command(i), 1, "standard output: No space left on device");
  }
}

// The shell's own reader is gone before anything is said.
static void a_reader_that_goes_away_does_not_kill(void **state) {
  (void)state;
  for (int i = 0; i < COMMANDS; i++) {
    char line[1024], status_file[128];
    snprintf(status_file, sizeof status_file, "%s/status", folder);
    char binary[4096];
    vsss_binary(binary, sizeof binary);
    char all[8192];
    snprintf(all, sizeof all, "{ sleep 0.1; '%s' %s 2>%s/err; echo $? >%s; } | true", binary, command(i), folder,
             status_file);
    assert_int_equal(system(all), 0);
    FILE *f = fopen(status_file, "r");
    assert_non_null(fgets(line, sizeof line, f));
    fclose(f);
    if (atoi(line) != 1) fail_msg("vsss %s: status %s", command(i), line);
  }
}

static void tables_do_not_land_in_files_of_closed_streams(void **state) {
  (void)state;
  char arguments[256];
  snprintf(arguments, sizeof arguments, "eval --blue zero: --against emc: --matches 1 --seconds 1 --json %s/j", folder);
  run(&o, "", arguments, "<&- >/dev/null");
  assert_int_equal(o.status, 0);
  char path[128], first[64] = "";
  snprintf(path, sizeof path, "%s/j", folder);
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  assert_non_null(fgets(first, sizeof first, f));
  fclose(f);
  assert_int_equal(strncmp(first, "{\"command\": \"eval\"", 18), 0);
}

static void a_file_that_cannot_be_written_is_named_before_any_work(void **state) {
  (void)state;
  static const char *const rows[][2] = {
      {"eval --blue zero: --matches 1000 --json /proc/none", "/proc/none"},
      {"eval --blue zero: --matches 1000 --csv /proc/none", "/proc/none"},
      {"sim --blue zero: --matches 1000 --video /proc/none.mp4", "/proc/none.mp4"},
      {"sim --blue zero: --matches 1000 --video x.gif", ".mp4"},
      {"train --run /proc/none", "/proc/none"},
      {"train --run /dev/null", "/dev/null"},
      {"train --run /dev/null/run", "/dev/null"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    run(&o, "timeout 60", rows[i][0], "");
    assert_says("unwritable", rows[i][0], strstr(rows[i][0], "gif") ? 2 : 1, rows[i][1]);
  }
}

// The eval table itself into a full disk.
static void a_full_disk_is_told(void **state) {
  (void)state;
  run(&o, "", "eval --blue zero: --against emc: --matches 1 --seconds 1 --drive planar --json /dev/full", "");
  assert_says("full disk", "eval --json /dev/full", 1, "/dev/full");
  run(&o, "", "eval --blue zero: --against emc: --matches 1 --seconds 1 --drive planar --csv /dev/full", "");
  assert_says("full disk", "eval --csv /dev/full", 1, "/dev/full");
}

// Works, or says why not: few file descriptors.
static void few_file_descriptors_are_one_line_or_enough(void **state) {
  (void)state;
  for (int limit = 4; limit <= 16; limit += 3)
    for (int i = 0; i < COMMANDS; i++) {
      char before[64];
      snprintf(before, sizeof before, "prlimit --nofile=%d", limit);
      run(&o, before, command(i), "");
      if (o.status != 0 && (o.status > 2 || o.lines < 1)) // a library may add lines of its own
        if (!strstr(o.err, "error while loading shared libraries"))
          fail_msg("%d descriptors: vsss %s: status %d: %s", limit, command(i), o.status, o.err);
    }
}

static void no_home_and_other_locales_change_nothing(void **state) {
  (void)state;
  static const char *const before[] = {"env -u HOME",        "HOME=/nonexistent", "LC_ALL=C.UTF-8",
                                       "LC_ALL=de_DE.UTF-8", "LC_ALL=nonsense",   "env -i PATH=$PATH"};
  static outcome plain;
  for (int i = 0; i < COMMANDS; i++) {
    run(&plain, "", command(i), "| sed 's/in [0-9.]* s.*//; s/wall_s.: [0-9.]*//'");
    for (size_t k = 0; k < sizeof before / sizeof *before; k++) {
      run(&o, before[k], command(i), "| sed 's/in [0-9.]* s.*//; s/wall_s.: [0-9.]*//'");
      if (strcmp(o.out, plain.out)) fail_msg("%s vsss %s: %s%s", before[k], command(i), o.out, o.err);
    }
  }
}

// Every character that a shell or gnuplot could obey, in the name of a run's folder.
static void any_name_of_a_folder_is_only_a_name(void **state) {
  (void)state;
  static const char *const names[] = {"with space", "`touch stolen`", "$(touch stolen)", "\"quoted\"",  "semi;colon",
                                      "it'\\''s",   "-dash",          "per%cent",        "back\\slash", "new\nline"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char text[1024];
    snprintf(text, sizeof text, "cp -r '%s' '%s/%s'", run_folder, folder, names[i]);
    assert_int_equal(system(text), 0);
    snprintf(text, sizeof text, "plot '%s/%s' --svg", folder, names[i]);
    run(&o, "", text, "");
    if (o.status != 0) fail_msg("vsss %s: %s", text, o.err);
    snprintf(text, sizeof text, "test -s '%s/%s/reward.svg' && test -s '%s/%s/eval_win.svg' && ! test -e stolen",
             folder, names[i], folder, names[i]);
    assert_int_equal(system(text), 0);
    snprintf(text, sizeof text, "plot '%s/%s' --compare '%s/%s/side' --svg", folder, names[i], folder, names[i]);
    run(&o, "", text, "");
    if (o.status != 0) fail_msg("vsss %s: %s", text, o.err);
    snprintf(text, sizeof text, "train --resume '%s/%s' --transitions 0.0001", folder, names[i]);
    run(&o, "", text, "");
    if (o.status != 0) fail_msg("vsss %s: %s", text, o.err);
  }
}

// Started, and ready for a hang-up, which it catches: however slow the machine.
static pid_t start_ready(const char *arguments) {
  char path[128], line[256];
  snprintf(path, sizeof path, "%s/said", folder);
  pid_t child = vsss_start(path, arguments);
  snprintf(path, sizeof path, "/proc/%ld/status", (long)child);
  for (int i = 0; i < 6000; i++) {
    unsigned long long caught = 0;
    bool ended = false;
    FILE *f = fopen(path, "r");
    while (f && fgets(line, sizeof line, f)) {
      ended |= !strncmp(line, "State:\tZ", 8);
      sscanf(line, "SigCgt: %llx", &caught);
    }
    if (f) fclose(f);
    if (ended || caught >> (SIGHUP - 1) & 1) break;
    usleep(10000);
  }
  usleep(300000);
  return child;
}

static void a_hang_up_ends_a_series_in_order(void **state) {
  (void)state;
  pid_t child = start_ready(other("eval --blue zero: --against emc: --matches 1000000 --seconds 10 --json %1$s/hup"));
  kill(child, SIGHUP);
  assert_int_equal(vsss_wait(child, 60), 0);
  char line[64] = "";
  FILE *f = popen(other("tail -c 3 %1$s/hup"), "r"); // "]}": a slow machine has played none
  assert_non_null(fgets(line, sizeof line, f));
  pclose(f);
  assert_string_equal(line, "]}\n");
}

static void a_hang_up_ends_in_order_what_waits(void **state) {
  (void)state;
  for (int i = 0; i < WAITING; i++) {
    pid_t child = start_ready(other(waiting[i]));
    kill(child, SIGHUP);
    int status = vsss_wait(child, 60);
    snprintf(o.err, sizeof o.err, "%s", folder_file("said"));
    if (status != 0 && !not_here(other(waiting[i])))
      fail_msg("vsss %s: status %d: %s", other(waiting[i]), status, o.err);
  }
}

static void a_name_without_its_colon_is_understood(void **state) {
  (void)state;
  assert_refused("sim --blue emc", 2, "did you mean 'emc:'?");
  assert_refused("sim --blue INF", 2, "did you mean 'inf:'?");
  assert_refused("sim --blue team/best.onnx", 2, "did you mean 'onnx:team/best.onnx'?");
  assert_refused("sim --blue ./team.so", 2, "did you mean 'plugin:./team.so'?");
}

static int make_run(void **state) {
  if (make_folder(state) != 0) return -1;
  snprintf(run_folder, sizeof run_folder, "%s/a run", folder);
  char arguments[512];
  snprintf(
      arguments, sizeof arguments,
      "train --run '%s' --threads 1 --set envs=4 --set steps=16 --set minibatch=64 --set hidden=16,16 --transitions "
      "0.0005 --eval-every 0.000001 --eval-against zero:,emc: --eval-matches 1",
      run_folder);
  run(&o, "", arguments, "");
  if (o.status != 0) print_error("%s", o.err);
  if (o.status != 0) return o.status;
  run(&o, "", other("sim --blue zero: --yellow emc: --drive planar --seconds 1 --lcm 'file://%1$s/log?mode=w'"), "");
  if (o.status != 0 && !strstr(o.err, "install ")) return o.status;
  FILE *league = fopen(other("%1$s/league.ini"), "w");
  if (!league) return -1;
  fprintf(league, "[league]\nseconds = 1\nfolder = %s/league\n[club1]\nname = A\nplayer = zero:\n", folder);
  fprintf(league, "[club2]\nname = B\nplayer = emc:\n");
  return fclose(league);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(output_that_goes_nowhere_is_an_error),
      cmocka_unit_test(a_reader_that_goes_away_does_not_kill),
      cmocka_unit_test(tables_do_not_land_in_files_of_closed_streams),
      cmocka_unit_test(a_file_that_cannot_be_written_is_named_before_any_work),
      cmocka_unit_test(a_full_disk_is_told),
      cmocka_unit_test(few_file_descriptors_are_one_line_or_enough),
      cmocka_unit_test(no_home_and_other_locales_change_nothing),
      cmocka_unit_test(any_name_of_a_folder_is_only_a_name),
      cmocka_unit_test(a_hang_up_ends_a_series_in_order),
      cmocka_unit_test(a_hang_up_ends_in_order_what_waits),
      cmocka_unit_test(a_name_without_its_colon_is_understood),
  };
  return cmocka_run_group_tests(tests, make_run, remove_folder);
}
