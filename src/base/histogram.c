#include "vsss/histogram.h"

#include <math.h>

#define RATIO 1.05

double vs_histogram_bound_us(int k) { return k < 1 ? 0.0 : pow(RATIO, k - 1); }

static int bucket_of(int64_t duration_us) {
  if (duration_us < 1) return 0;
  // A value on a bound may be off by one rounding of the logarithm: settle it against the bound itself.
  int k = (int)(log((double)duration_us) / log(RATIO)) + 1;
  if ((double)duration_us < vs_histogram_bound_us(k)) k--;
  if ((double)duration_us >= vs_histogram_bound_us(k + 1)) k++;
  return k < VS_HISTOGRAM_BUCKETS ? k : VS_HISTOGRAM_BUCKETS - 1;
}

void vs_histogram_add(vs_histogram *h, int64_t duration_us, int64_t now_us) {
  if (duration_us < 0) duration_us = 0;
  if (h->count == 0 || duration_us > h->max_us) {
    h->max_us = duration_us;
    h->max_at_us = now_us;
  }
  h->count++;
  h->sum_us += (double)duration_us;
  h->bucket[bucket_of(duration_us)]++;
}

double vs_histogram_mean_us(const vs_histogram *h) { return h->count ? h->sum_us / (double)h->count : 0.0; }

double vs_histogram_quantile_us(const vs_histogram *h, double q) {
  if (h->count == 0) return 0.0;
  uint64_t rank = (uint64_t)ceil(q * (double)h->count), below = 0;
  if (rank < 1) rank = 1;
  int k = 0;
  for (; k < VS_HISTOGRAM_BUCKETS - 1; k++) {
    below += h->bucket[k];
    if (below >= rank) break;
  }
  double middle = k == 0 ? 0.0 : sqrt(vs_histogram_bound_us(k) * vs_histogram_bound_us(k + 1));
  return k == VS_HISTOGRAM_BUCKETS - 1 || middle > (double)h->max_us ? (double)h->max_us : middle;
}
