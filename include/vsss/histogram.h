// Durations counted in logarithmic buckets: any percentile to 2.5 %, one addition per value, no allocation.
#ifndef VSSS_HISTOGRAM_H
#define VSSS_HISTOGRAM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Bucket 0 holds [0, 1) us, bucket k >= 1 [r^(k-1), r^k) us with r = 1.05; the last everything from 9.8 s on.
#define VS_HISTOGRAM_BUCKETS 332

typedef struct vs_histogram {
  uint64_t count;
  double sum_us;
  int64_t max_us, max_at_us; // the longest, and the moment given with it
  uint32_t bucket[VS_HISTOGRAM_BUCKETS];
} vs_histogram; // all zero: empty

void vs_histogram_add(vs_histogram *histogram, int64_t duration_us, int64_t now_us); // below 0 counts as 0
double vs_histogram_mean_us(const vs_histogram *histogram);                          // 0 when empty
// The duration that a share q in [0, 1] of the values does not exceed, by the middle of its bucket, never above the
// maximum; 0 when empty.
double vs_histogram_quantile_us(const vs_histogram *histogram, double q);
// Lower bound of bucket k.
double vs_histogram_bound_us(int k);

#ifdef __cplusplus
}
#endif
#endif
