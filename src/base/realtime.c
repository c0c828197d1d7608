#define _GNU_SOURCE
#include "vsss/realtime.h"

#include <errno.h>
#include <sched.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#ifdef __linux__
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

vs_status vs_realtime_try(int priority, vs_error *err) {
  int low = sched_get_priority_min(SCHED_FIFO), high = sched_get_priority_max(SCHED_FIFO);
  if (priority < low || priority > high)
    return vs_fail(err, VS_USAGE, "real-time priority %d: allowed are %d to %d", priority, low, high);
  struct sched_param wanted = {.sched_priority = priority};
  int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  if (refused)
    return vs_fail(err, VS_FAIL,
                   "no real-time priority (%s); allow it in /etc/security/limits.d/vsss.conf with the lines "
                   "'@vsss - rtprio 60' and '@vsss - memlock unlimited' and log in again",
                   strerror(refused));
  if (mlockall(MCL_CURRENT | MCL_FUTURE))
    return vs_fail(err, VS_FAIL,
                   "memory may be swapped out (%s); allow locking it in /etc/security/limits.d/vsss.conf with the line "
                   "'@vsss - memlock unlimited' and log in again",
                   strerror(errno));
  return VS_OK;
}

void vs_realtime_fine_timers(void) {
#ifdef __linux__
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
#endif
}

int vs_realtime_plain_thread(pthread_t *out, void *(*run)(void *), void *context) {
  pthread_attr_t plain;
  const struct sched_param none = {0};
  pthread_attr_init(&plain);
  pthread_attr_setinheritsched(&plain, PTHREAD_EXPLICIT_SCHED);
  pthread_attr_setschedpolicy(&plain, SCHED_OTHER);
  pthread_attr_setschedparam(&plain, &none);
  int failed = pthread_create(out, &plain, run, context);
  pthread_attr_destroy(&plain);
  return failed;
}

// As in sched_setattr(2); glibc has no wrapper before 2.41. For SCHED_OTHER runtime is the length of a turn in ns.
static void take_short_turns(void) {
#if defined(__linux__) && defined(SYS_sched_getattr)
  struct {
    uint32_t size, policy;
    uint64_t flags;
    int32_t nice;
    uint32_t priority;
    uint64_t runtime, deadline, period;
    uint32_t least, most;
  } now = {0};
  if (syscall(SYS_sched_getattr, 0, &now, sizeof now, 0) != 0) return;
  now.runtime = 100000;
  (void)syscall(SYS_sched_setattr, 0, &now, 0);
#endif
}

void vs_realtime_prompt(void) {
  int policy;
  struct sched_param now, lowest = {.sched_priority = sched_get_priority_min(SCHED_FIFO)};
  if (pthread_getschedparam(pthread_self(), &policy, &now) != 0 || policy != SCHED_OTHER) return;
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &lowest) != 0) take_short_turns();
}
