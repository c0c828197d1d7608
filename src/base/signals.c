#include "vsss/signals.h"

#include <pthread.h>
#include <signal.h>

static _Thread_local int held;
static _Thread_local sigset_t before; // the mask of the thread's owner

void vs_signals_hold(void) {
  if (held++ > 0) return;
  static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
  sigset_t all;
  sigfillset(&all);
  for (unsigned i = 0; i < sizeof faults / sizeof *faults; i++) sigdelset(&all, faults[i]);
  pthread_sigmask(SIG_BLOCK, &all, &before);
}

void vs_signals_release(void) {
  if (--held == 0) pthread_sigmask(SIG_SETMASK, &before, NULL);
}
