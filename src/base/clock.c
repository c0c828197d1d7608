#include "vsss/clock.h"

#include <errno.h>
#include <time.h>

static int64_t read_us(clockid_t id) {
  struct timespec t;
  clock_gettime(id, &t);
  return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

int64_t vs_clock_monotonic_us(void) { return read_us(CLOCK_MONOTONIC); }

int64_t vs_clock_wall_us(void) { return read_us(CLOCK_REALTIME); }

void vs_clock_sleep_until_us(int64_t monotonic_us) {
  struct timespec t = {monotonic_us / 1000000, monotonic_us % 1000000 * 1000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR) {
  }
}
