// Time. Durations come from the monotonic clock only; wall time is for stamps that leave the process.
#ifndef VSSS_CLOCK_H
#define VSSS_CLOCK_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

int64_t vs_clock_monotonic_us(void);
int64_t vs_clock_wall_us(void); // since the epoch
void vs_clock_sleep_until_us(int64_t monotonic_us);

#ifdef __cplusplus
}
#endif
#endif
