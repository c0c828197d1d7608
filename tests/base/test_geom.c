// src/base/geom.c
#include "assert_near.h"
#include "vsss/geom.h"

static void angles_wrap_into_minus_pi_exclusive_to_pi(void **state) {
  (void)state;
  assert_near(vs_wrap_rad(0.5), 0.5, 0);
  assert_near(vs_wrap_rad(3 * VS_PI), VS_PI, 1e-12);
  assert_near(vs_wrap_rad(-VS_PI), VS_PI, 0); // -pi is written as pi
  assert_near(vs_wrap_rad(VS_PI), VS_PI, 0);
  assert_near(vs_wrap_rad(-0.5 - 4 * VS_PI), -0.5, 1e-12);
}

static void clamp_and_distance(void **state) {
  (void)state;
  assert_near(vs_clamp(2, -1, 1), 1, 0);
  assert_near(vs_clamp(-2, -1, 1), -1, 0);
  assert_near(vs_clamp(0.25, -1, 1), 0.25, 0);
  assert_near(vs_distance_m(1, 1, 4, 5), 5, 1e-15); // 3-4-5
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(angles_wrap_into_minus_pi_exclusive_to_pi),
      cmocka_unit_test(clamp_and_distance),
  };
  return cmocka_run_group_tests_name("base/geom", tests, NULL, NULL);
}
