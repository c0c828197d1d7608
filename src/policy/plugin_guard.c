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

static struct sigaction before[SIGNALS];         // written once, by install()
static _Thread_local sigjmp_buf *volatile guard; // where this thread returns to; NULL outside of foreign code

static void on_signal(int number) {
  if (guard) siglongjmp(*guard, number);
  // Not ours: put the old handler back and let the instruction fault again.
  for (int i = 0; i < SIGNALS; i++)
    if (fatal_signals[i] == number) sigaction(number, &before[i], NULL);
  if (number == SIGABRT) raise(number);
}

static void install(void) {
  for (int i = 0; i < SIGNALS; i++) {
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_ONSTACK};
    sigemptyset(&action.sa_mask);
    sigaction(fatal_signals[i], &action, &before[i]);
  }
}

int vs_guard_run(void (*call)(void *argument), void *argument) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, install);
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
