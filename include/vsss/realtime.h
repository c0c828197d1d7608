// Asking the system for punctuality.
#ifndef VSSS_REALTIME_H
#define VSSS_REALTIME_H

#include <pthread.h>
#include <stddef.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Puts the calling thread, and those it starts from now on, before everything that is not real time (SCHED_FIFO at
// priority, 1 to 99) and keeps the process's memory from being swapped out. VS_FAIL: refused, with the lines for
// /etc/security/limits.d that allow it; everything goes on as before.
vs_status vs_realtime_try(int priority, vs_error *err);

// Sleeps of the calling thread end when they should, not up to 50 us later as Linux otherwise lets them. Nothing elsewhere.
void vs_realtime_fine_timers(void);

// A thread without real time, whatever the calling thread has: for work that a loop hands off. 0, or what pthread_create
// failed with.
int vs_realtime_plain_thread(pthread_t *out, void *(*run)(void *), void *context);

// For a thread that only sleeps and computes next to nothing when it wakes: it is to go before those that compute. The lowest
// real-time priority where this user may have one, else turns of 0.1 ms, which Linux gives to anybody since 6.12. Never fails;
// one that runs in real time already stays as it is.
void vs_realtime_prompt(void);

#ifdef __cplusplus
}
#endif
#endif
