// What a command shows on a terminal: errors, the progress line; and the interrupts it reacts to.
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli.h"
#include "vsss/clock.h"
#include "vsss/realtime.h"

int vs_cli_error(const char *command, const vs_error *err) {
  fprintf(stderr, "vsss %s: %s\n", command, err->text);
  return err->status;
}

void vs_cli_realtime(int priority) {
  vs_error err = {0};
  if (vs_realtime_try(priority, &err) != VS_OK) fprintf(stderr, "going on all the same: %s\n", err.text);
}

bool vs_cli_begin(void) {
  signal(SIGPIPE, SIG_IGN);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0); // what FFmpeg would write to standard error, our errors say
  const bool can_print = fcntl(STDOUT_FILENO, F_GETFD) >= 0;
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++) // opens the lowest that is free
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDWR) < 0) return false;
  if (!can_print) fprintf(stderr, "vsss: standard output is closed: send it to a file, or to /dev/null\n");
  return can_print;
}

int vs_cli_end(const char *command, int status) {
  errno = 0;
  bool failed = fflush(stdout) != 0;
  const char *why = failed && errno ? strerror(errno) : "not all that was printed could be written";
  if (!failed && !ferror(stdout)) return status;
  fprintf(stderr, "vsss %s: standard output: %s\n", command, why);
  return status ? status : VS_FAIL;
}

static atomic_bool interrupted;
static void (*last_act)(void);

static void on_second_interrupt(int number) {
  if (last_act) last_act();
  signal(number, SIG_DFL);
  raise(number);
}

static void on_interrupt(int number) {
  interrupted = true;
  signal(number, on_second_interrupt);
}

void vs_cli_before_the_end(void (*act)(void)) { last_act = act; }

static const int interrupts[] = {SIGINT, SIGTERM, SIGHUP};
enum { INTERRUPTS = sizeof interrupts / sizeof *interrupts };

// nohup: the program is to outlive its terminal.
static bool is_kept_from(int number) {
  struct sigaction now;
  return number == SIGHUP && sigaction(number, NULL, &now) == 0 && now.sa_handler == SIG_IGN;
}

void vs_cli_catch_interrupts(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_interrupt;
  for (int i = 0; i < INTERRUPTS; i++)
    if (!is_kept_from(interrupts[i])) sigaction(interrupts[i], &action, NULL);
}

static struct {
  sigset_t set;
  void (*first)(void *context);
  void (*second)(void *context);
  void *context;
} awaited;

static void *await_interrupts(void *unused) {
  (void)unused;
  int number;
  if (sigwait(&awaited.set, &number) != 0) return NULL;
  interrupted = true;
  awaited.first(awaited.context);
  if (sigwait(&awaited.set, &number) != 0) return NULL;
  // A third ends the program whatever the second is busy with.
  for (int i = 0; i < INTERRUPTS; i++) signal(interrupts[i], SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &awaited.set, NULL);
  awaited.second(awaited.context);
  _exit(128 + number);
}

vs_status vs_cli_await_interrupts(void (*first)(void *context), void (*second)(void *context), void *context,
                                  vs_error *err) {
  awaited.first = first;
  awaited.second = second;
  awaited.context = context;
  sigemptyset(&awaited.set);
  for (int i = 0; i < INTERRUPTS; i++)
    if (!is_kept_from(interrupts[i])) sigaddset(&awaited.set, interrupts[i]);
  pthread_sigmask(SIG_BLOCK, &awaited.set, NULL);
  pthread_t thread;
  int failed = pthread_create(&thread, NULL, await_interrupts, NULL);
  if (failed) {
    pthread_sigmask(SIG_UNBLOCK, &awaited.set, NULL);
    return vs_fail(err, VS_FAIL, "cannot start a thread: %s", strerror(failed));
  }
  pthread_detach(thread);
  return VS_OK;
}

bool vs_cli_interrupted(void) { return interrupted || ferror(stdout); }

bool vs_cli_go_on(void *unused) {
  (void)unused;
  return !vs_cli_interrupted();
}

void vs_progress_start(vs_progress *progress) {
  *progress =
      (vs_progress){.start_us = vs_clock_monotonic_us(), .start_fraction = -1, .terminal = isatty(STDERR_FILENO)};
}

// Back to the first of the lines shown, all of them erased.
static void rewind_lines(vs_progress *progress) {
  fprintf(stderr, "\r");
  if (progress->lines > 0) fprintf(stderr, "\033[%dA", progress->lines);
  fprintf(stderr, "\033[J");
  progress->lines = 0;
}

static int terminal_width(void) {
  struct winsize size;
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

static double seconds_left(vs_progress *progress, double fraction, long long now_us) {
  if (progress->start_fraction < 0) progress->start_fraction = fraction;
  double done = fraction - progress->start_fraction, spent_s = (double)(now_us - progress->start_us) * 1e-6;
  return done > 0.0 ? spent_s * (1.0 - fraction) / done : 0.0;
}

void vs_progress_show(vs_progress *progress, double fraction, const char *text) {
  long long now = vs_clock_monotonic_us();
  if (!progress->terminal || now - progress->last_us < 100000) return;
  progress->last_us = now;
  enum { WIDTH = 20 };
  char bar[WIDTH + 1], first[512];
  int full = (int)floor(fmin(fmax(fraction, 0.0), 1.0) * WIDTH), width = terminal_width() - 1;
  for (int i = 0; i < WIDTH; i++) bar[i] = i < full ? '#' : '.';
  bar[WIDTH] = '\0';
  int left_s = (int)seconds_left(progress, fraction, now), line = (int)strcspn(text, "\n");
  if (fraction < 0.0)
    snprintf(first, sizeof first, "%.*s", line, text);
  else
    snprintf(first, sizeof first, "[%s] %3.0f %% %2d:%02d left  %.*s", bar, 100.0 * fraction, left_s / 60, left_s % 60,
             line, text);
  rewind_lines(progress);
  fprintf(stderr, "%.*s", width, first);
  for (text += line; *text; text += line) {
    line = (int)strcspn(++text, "\n");
    fprintf(stderr, "\n%.*s", line < width ? line : width, text);
    progress->lines++;
  }
  fflush(stderr);
}

void vs_progress_clear(vs_progress *progress) {
  if (!progress->terminal) return;
  rewind_lines(progress);
  fflush(stderr);
}
