// src/base/histogram.c
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/histogram.h"
#include "vsss/rng.h"

static int ascending(const void *a, const void *b) {
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

static void quantiles_are_those_of_the_sorted_data_to_one_bucket(void **state) {
  (void)state;
  enum { N = 5000 };
  static int64_t value[N];
  static vs_histogram h;
  memset(&h, 0, sizeof h);
  vs_rng rng = vs_rng_make(5, 0);
  double sum = 0;
  for (int i = 0; i < N; i++) {
    value[i] = (int64_t)exp(vs_rng_range(&rng, 0.0, 13.8)); // 1 us to 1 s
    sum += (double)value[i];
    vs_histogram_add(&h, value[i], i);
  }
  qsort(value, N, sizeof *value, ascending);
  const double q[] = {0.01, 0.5, 0.95, 0.99, 0.999};
  for (int i = 0; i < 5; i++) {
    double exact = (double)value[(int)ceil(q[i] * N) - 1];
    // The middle of a bucket of 5 % is at most 2.5 % away, plus half a microsecond where values are whole.
    assert_near(vs_histogram_quantile_us(&h, q[i]), exact, 0.025 * exact + 0.5);
  }
  assert_near(vs_histogram_quantile_us(&h, 1.0), (double)value[N - 1], 0.025 * (double)value[N - 1]);
  assert_near(vs_histogram_mean_us(&h), sum / N, 1e-6 * sum / N);
}

static void the_maximum_remembers_when_it_happened(void **state) {
  (void)state;
  static vs_histogram h;
  memset(&h, 0, sizeof h);
  vs_histogram_add(&h, 10, 100);
  vs_histogram_add(&h, 900, 200);
  vs_histogram_add(&h, 30, 300);
  assert_int_equal(h.max_us, 900);
  assert_int_equal(h.max_at_us, 200);
  assert_int_equal(h.count, 3);
}

static void an_empty_one_says_zero(void **state) {
  (void)state;
  static vs_histogram h;
  memset(&h, 0, sizeof h);
  assert_near(vs_histogram_quantile_us(&h, 0.5), 0, 0);
  assert_near(vs_histogram_mean_us(&h), 0, 0);
}

static void extremes_go_to_the_first_and_the_last_bucket(void **state) {
  (void)state;
  static vs_histogram h;
  memset(&h, 0, sizeof h);
  vs_histogram_add(&h, -5, 0);
  vs_histogram_add(&h, 0, 0);
  vs_histogram_add(&h, INT64_C(3600000000), 0);
  assert_int_equal(h.bucket[0], 2);
  assert_int_equal(h.bucket[VS_HISTOGRAM_BUCKETS - 1], 1);
  assert_near(vs_histogram_quantile_us(&h, 1.0), 3.6e9, 0);
}

static void every_value_lies_within_the_bounds_of_its_bucket(void **state) {
  (void)state;
  for (int64_t us = 1; us < 200000; us += 1 + us / 50) {
    static vs_histogram h;
    memset(&h, 0, sizeof h);
    vs_histogram_add(&h, us, 0);
    int k = 0;
    while (!h.bucket[k]) k++;
    assert_true((double)us >= vs_histogram_bound_us(k) && (double)us < vs_histogram_bound_us(k + 1));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quantiles_are_those_of_the_sorted_data_to_one_bucket),
      cmocka_unit_test(the_maximum_remembers_when_it_happened),
      cmocka_unit_test(an_empty_one_says_zero),
      cmocka_unit_test(extremes_go_to_the_first_and_the_last_bucket),
      cmocka_unit_test(every_value_lies_within_the_bounds_of_its_bucket),
  };
  return cmocka_run_group_tests_name("base/histogram", tests, NULL, NULL);
}
