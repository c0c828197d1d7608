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

#ifdef __cplusplus
}
#endif
#endif
