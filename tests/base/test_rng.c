// src/base/rng.c
#include "assert_near.h"
#include "vsss/rng.h"

static void same_seed_and_stream_give_same_numbers(void **state) {
  (void)state;
  vs_rng a = vs_rng_make(7, 3), b = vs_rng_make(7, 3);
  for (int i = 0; i < 100; i++) assert_int_equal(vs_rng_u64(&a), vs_rng_u64(&b));
}

static void streams_and_seeds_differ(void **state) {
  (void)state;
  vs_rng a = vs_rng_make(7, 3), b = vs_rng_make(7, 4), c = vs_rng_make(8, 3);
  uint64_t x = vs_rng_u64(&a), y = vs_rng_u64(&b), z = vs_rng_u64(&c);
  assert_int_not_equal(x, y);
  assert_int_not_equal(x, z);
  assert_int_not_equal(y, z);
}

static void uniform_has_the_moments_of_a_uniform(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(1, 0);
  double sum = 0, squares = 0;
  const int n = 100000;
  for (int i = 0; i < n; i++) {
    double u = vs_rng_uniform(&rng);
    assert_true(u >= 0.0 && u < 1.0);
    sum += u;
    squares += u * u;
  }
  // Standard error of the mean is 0.2887/sqrt(n) = 0.0009; four of them.
  assert_near(sum / n, 0.5, 0.0037);
  assert_near(squares / n, 1.0 / 3.0, 0.004);
}

static void normal_has_mean_0_and_deviation_1(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(2, 0);
  double sum = 0, squares = 0;
  const int n = 100000;
  for (int i = 0; i < n; i++) {
    double z = vs_rng_normal(&rng);
    sum += z;
    squares += z * z;
  }
  assert_near(sum / n, 0.0, 0.013);
  assert_near(squares / n, 1.0, 0.018);
}

static void below_reaches_every_value_equally_often(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(3, 0);
  int count[3] = {0};
  for (int i = 0; i < 30000; i++) count[vs_rng_below(&rng, 3)]++;
  for (int i = 0; i < 3; i++) assert_near(count[i], 10000, 330); // deviation 82
}

static void shuffle_keeps_the_items(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(4, 0);
  int items[5] = {0, 1, 2, 3, 4}, seen = 0;
  vs_rng_shuffle(&rng, items, 5);
  for (int i = 0; i < 5; i++) seen |= 1 << items[i];
  assert_int_equal(seen, 31);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_seed_and_stream_give_same_numbers),  cmocka_unit_test(streams_and_seeds_differ),
      cmocka_unit_test(uniform_has_the_moments_of_a_uniform),    cmocka_unit_test(normal_has_mean_0_and_deviation_1),
      cmocka_unit_test(below_reaches_every_value_equally_often), cmocka_unit_test(shuffle_keeps_the_items),
  };
  return cmocka_run_group_tests_name("base/rng", tests, NULL, NULL);
}
