// Runs foreign code so that its crash is a return value. A fatal signal raised by the code itself on this thread jumps
// back here; any other goes to whoever handled it before. The program is meant to end after such a report: what the
// foreign code held (locks, memory) stays as it was.
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "policy_internal.h"

static const int fatal_signals[] = {SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGABRT};
enum { SIGNALS = sizeof fatal_signals / sizeof *fatal_signals };

static struct sigaction before[SIGNALS]; // who else wants each signal
static pthread_mutex_t installing = PTHREAD_MUTEX_INITIALIZER;
static _Thread_local sigjmp_buf *volatile guard; // where this thread returns to; NULL outside of foreign code

static void on_signal(int number) {
  if (guard) siglongjmp(*guard, number);
  // Not ours: put the old handler back and let the instruction fault again.
  for (int i = 0; i < SIGNALS; i++)
    if (fatal_signals[i] == number) sigaction(number, &before[i], NULL);
  if (number == SIGABRT) raise(number);
}

// At every call, since other code of the program may have set handlers in between.
static void install(void) {
  pthread_mutex_lock(&installing);
  for (int i = 0; i < SIGNALS; i++) {
    struct sigaction now, action = {.sa_handler = on_signal, .sa_flags = SA_ONSTACK};
    sigaction(fatal_signals[i], NULL, &now);
    if (now.sa_handler == on_signal) continue;
    before[i] = now;
    sigemptyset(&action.sa_mask);
    sigaction(fatal_signals[i], &action, NULL);
  }
  pthread_mutex_unlock(&installing);
}

int vs_guard_run(void (*call)(void *argument), void *argument) {
  install();
  // The handler needs a stack of its own: a plugin may crash by running out of this one.
  unsigned char stack[32768];
  stack_t mine = {.ss_sp = stack, .ss_size = sizeof stack}, theirs;
  bool switched = sigaltstack(&mine, &theirs) == 0;

  sigjmp_buf here;
  sigjmp_buf *volatile outer = guard;
  int number = sigsetjmp(here, 1);
  if (number == 0) {
    guard = &here;
    call(argument);
  }
  guard = outer;
  if (switched) sigaltstack(&theirs, NULL);
  return number;
}
