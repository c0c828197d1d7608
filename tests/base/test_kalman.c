// Tests src/base/kalman.c: what it estimates of a motion it was made for, and of noise.
#include <math.h>

#include "assert_near.h"
#include "vsss/kalman.h"
#include "vsss/rng.h"

// First update by hand: value 0 of deviation 0.1, rate 0 of deviation 1, one second later without disturbance:
// p = {0.01 + 1, 1, 1}; a measurement of 1 with deviation 0.1: s = 1.02, gains 1.01/1.02 and 1/1.02.
static void the_first_update_is_the_one_worked_out_by_hand(void **state) {
  (void)state;
  vs_kalman k;
  vs_kalman_start(&k, 0, 0.1, 1);
  vs_kalman_predict(&k, 1, 0);
  vs_kalman_update(&k, 1, 0.1);
  assert_near(k.value, 1.01 / 1.02, 1e-12);
  assert_near(k.rate, 1 / 1.02, 1e-12);
  assert_near(k.p[0], 1.01 - 1.01 / 1.02 * 1.01, 1e-12);
  assert_near(k.p[1], 1 - 1.01 / 1.02, 1e-12);
  assert_near(k.p[2], 1 - 1 / 1.02, 1e-12);
}

static void a_constant_velocity_is_found_without_error(void **state) {
  (void)state;
  vs_kalman k;
  vs_kalman_start(&k, 0, 0.002, 1);
  for (int i = 1; i <= 60; i++) {
    vs_kalman_predict(&k, 1.0 / 30, 6);
    vs_kalman_update(&k, 0.7 * i / 30 - k.value, 0.002);
  }
  assert_near(k.rate, 0.7, 1e-9);
  assert_near(k.value, 1.4, 1e-9);
}

// Something slow to change (0.5 m/s2) at rest, seen with 2 mm of noise: differences of frames would say +-85 mm/s.
static void noise_makes_less_speed_than_differences_do(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(1, 0);
  vs_kalman k;
  double squares = 0;
  vs_kalman_start(&k, 0, 0.002, 1);
  for (int i = 0; i < 3000; i++) {
    vs_kalman_predict(&k, 1.0 / 30, 0.5);
    vs_kalman_update(&k, 0.002 * vs_rng_normal(&rng) - k.value, 0.002);
    squares += k.rate * k.rate / 3000;
  }
  assert_true(sqrt(squares) < 0.04 && sqrt(squares) > 0.005);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_first_update_is_the_one_worked_out_by_hand),
      cmocka_unit_test(a_constant_velocity_is_found_without_error),
      cmocka_unit_test(noise_makes_less_speed_than_differences_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
