// What a command shows on a terminal: errors, the progress line; and the interrupts it reacts to.
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
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

static volatile sig_atomic_t interrupted;

static void on_interrupt(int number) {
  interrupted = 1;
  signal(number, SIG_DFL);
}

void vs_cli_catch_interrupts(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

bool vs_cli_interrupted(void) { return interrupted; }

void vs_progress_start(vs_progress *progress) {
  progress->start_us = vs_clock_monotonic_us();
  progress->last_us = 0;
  progress->terminal = isatty(STDERR_FILENO);
}

void vs_progress_show(vs_progress *progress, double fraction, const char *text) {
  long long now = vs_clock_monotonic_us();
  if (!progress->terminal || now - progress->last_us < 100000) return;
  progress->last_us = now;
  enum { WIDTH = 20 };
  char bar[WIDTH + 1];
  int full = (int)floor(fmin(fmax(fraction, 0.0), 1.0) * WIDTH);
  for (int i = 0; i < WIDTH; i++) bar[i] = i < full ? '#' : '.';
  bar[WIDTH] = '\0';
  double spent_s = (double)(now - progress->start_us) * 1e-6;
  double left_s = fraction > 0.0 ? spent_s * (1.0 - fraction) / fraction : 0.0;
  fprintf(stderr, "\r\033[K[%s] %3.0f %% %2d:%02d left  %s", bar, 100.0 * fraction, (int)left_s / 60, (int)left_s % 60,
          text);
  fflush(stderr);
}

void vs_progress_clear(vs_progress *progress) {
  if (!progress->terminal) return;
  fprintf(stderr, "\r\033[K");
  fflush(stderr);
}
