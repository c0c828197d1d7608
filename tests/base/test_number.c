// src/base/number.c
#include <stdio.h>

#include "assert_near.h"
#include "comma_locale.h"
#include "vsss/number.h"

static void real_numbers_are_finite_and_nothing_follows_them(void **state) {
  (void)state;
  double x = 7.0;
  static const char *const wrong[] = {"", " ", "x", "1x", "1 ", "nan", "inf", "-inf", "1e999", "--1", "1,5"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (vs_parse_real(wrong[i], &x)) fail_msg("'%s' was taken for %g", wrong[i], x);
  assert_near(x, 7.0, 0);
  assert_true(vs_parse_real("-1.25e2", &x));
  assert_near(x, -125.0, 0);
  assert_true(vs_parse_real("1e-400", &x));
  assert_near(x, 0.0, 1e-300);
}

static void whole_numbers_fit_an_int(void **state) {
  (void)state;
  int n = 7;
  static const char *const wrong[] = {"1.5", "2147483648", "-2147483649", "1e10", "nan", ""};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (vs_parse_whole(wrong[i], &n)) fail_msg("'%s' was taken for %d", wrong[i], n);
  assert_int_equal(n, 7);
  assert_true(vs_parse_whole("2147483647", &n));
  assert_int_equal(n, 2147483647);
  assert_true(vs_parse_whole("-2147483648", &n));
  assert_true(n == -2147483647 - 1);
  assert_true(vs_parse_whole("1e3", &n));
  assert_int_equal(n, 1000);
}

static void seeds_have_64_bits(void **state) {
  (void)state;
  uint64_t seed = 7;
  static const char *const wrong[] = {
      "", "-1", "+1", "1.0", "0x", "0xg", "18446744073709551616", "0x10000000000000000", "1e3", " 1", "1 ", "a1"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (vs_parse_seed(wrong[i], &seed)) fail_msg("'%s' was taken for %llu", wrong[i], (unsigned long long)seed);
  assert_true(seed == 7);
  assert_true(vs_parse_seed("18446744073709551615", &seed));
  assert_true(seed == UINT64_MAX);
  assert_true(vs_parse_seed("0xFfffFFFFffffffff", &seed));
  assert_true(seed == UINT64_MAX);
  assert_true(vs_parse_seed("010", &seed));
  assert_true(seed == 10);
}

static void the_point_is_a_point_in_every_locale(void **state) {
  (void)state;
  set_comma_locale();
  double x = 7.0;
  assert_true(vs_parse_real("0.5", &x));
  assert_near(x, 0.5, 0);
  assert_false(vs_parse_real("0,5", &x));
  assert_string_equal(vs_real_text(46.66).text, "46.66");
  assert_string_equal(vs_real_text(-1e-7).text, "-1e-07");
  char text[16];
  snprintf(text, sizeof text, "%g", 0.5);
  assert_string_equal(text, "0,5"); // the program's own numbers stay as they were
  setlocale(LC_ALL, "C");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(real_numbers_are_finite_and_nothing_follows_them),
      cmocka_unit_test(whole_numbers_fit_an_int),
      cmocka_unit_test(seeds_have_64_bits),
      cmocka_unit_test(the_point_is_a_point_in_every_locale),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
