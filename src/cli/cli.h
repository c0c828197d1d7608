// What a command of the program is. One command: one row in src/cli/main.c and one file src/cli/cmd_NAME.c.
#ifndef VSSS_CLI_CLI_H
#define VSSS_CLI_CLI_H

#include <stdbool.h>
#include <stddef.h>

#include "vsss/status.h"
#include "vsss/world.h"

typedef enum vs_flag_type {
  VS_FLAG_SWITCH,
  VS_FLAG_INT,
  VS_FLAG_REAL,
  VS_FLAG_TEXT,
  VS_FLAG_LIST,
  VS_FLAG_SEED
} vs_flag_type;

// One flag of a command. target: bool, int, double, const char * (pointing into argv), vs_flag_list
// (repeatable), uint64_t (seed).
// Numbers outside [min, max] are refused with the range (min == max == 0: no limits). The present value of target is
// shown as the default.
typedef struct vs_flag {
  const char *name; // without the dashes
  vs_flag_type type;
  void *target;
  const char *value_name; // "URI", "FILE", ... ; NULL for a switch
  const char *help;
  double min, max;
} vs_flag;

#define VS_FLAG_LIST_MAX 64
typedef struct vs_flag_list {
  int count;
  const char *value[VS_FLAG_LIST_MAX];
} vs_flag_list;

// Parses argv[1..] against flags (ended by a NULL name). Words that are no flags go to positional (NULL: none are
// allowed). --help prints usage, synopsis and the flags, and sets *help: the command returns 0 at once.
vs_status vs_args_parse(int argc, char **argv, const char *synopsis, const char *about, const vs_flag *flags,
                        vs_flag_list *positional, bool *help, vs_error *err);

// How this program was called, such as ./vsss: for command lines to be pasted where it was.
extern const char *vs_cli_program;
// A command line of program and words, quoted where a shell needs it so.
void vs_cli_command(const char *program, int argc, const char *const *argv, char *out, size_t size);

// "blue" or "yellow"; flag names who gave it, in the error.
vs_status vs_cli_team(const char *flag, const char *name, vs_team *out, vs_error *err);

// Asks for real-time priority; a refusal is a note on stderr, not an error.
void vs_cli_realtime(int priority);

// First thing of the program: standard streams that are closed must not become the first files that it opens, and a
// reader of its output that went away (| head) must not kill it before it has put things in order. False: there is
// nowhere to print to, which has been said.
bool vs_cli_begin(void);
// Last thing: status, or VS_FAIL where what was printed did not all arrive.
int vs_cli_end(const char *command, int status);

// Prints "vsss COMMAND: text" on stderr and returns the exit status that belongs to it.
int vs_cli_error(const char *command, const vs_error *err);

// Set by SIGINT, SIGTERM and SIGHUP (unless the program was started to ignore that one) once vs_cli_catch_interrupts was
// called; a second signal ends the program at once. And once standard output cannot be written any more.
void vs_cli_catch_interrupts(void);
bool vs_cli_interrupted(void);
bool vs_cli_go_on(void *unused); // the opposite, as vs_series_def and vs_train_eval_def want it
// What that second signal still does first; async-signal-safe.
void vs_cli_before_the_end(void (*act)(void));
// The same without disturbing a thread that computes: called before any other is started, blocks these signals in all and
// lets a thread of its own wait for them. first is called at the first, on that thread; second at the second, after which
// the program ends with 128 + the signal's number.
vs_status vs_cli_await_interrupts(void (*first)(void *context), void (*second)(void *context), void *context,
                                  vs_error *err);

// Lines that rewrite themselves on a terminal: bar, fraction, time left, then text, of which each '\n' begins another
// line; all are cut to the terminal's width. Below 0 the fraction is not known: the text alone. Silent where stderr is no terminal.
typedef struct vs_progress {
  long long start_us, last_us;
  double start_fraction; // what was done when it began, once shown
  int lines;             // on the terminal now, below the first
  bool terminal;
} vs_progress;
void vs_progress_start(vs_progress *progress);
void vs_progress_show(vs_progress *progress, double fraction, const char *text);
void vs_progress_clear(vs_progress *progress);

// The commit this program was built from, set by main; "unknown" in its tests.
extern const char *vs_cli_commit;
// Prints version, commit, libraries and features on stdout.
void vs_cli_version(void);
// Lets nothing be heard of ONNX Runtime's first session (policy.h).
void vs_cli_quiet_first_session(void);

#endif
