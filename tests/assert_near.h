// The one float comparison of the tests: cmocka 1.1.5 has none for doubles with a tolerance.
#ifndef VSSS_TESTS_ASSERT_NEAR_H
#define VSSS_TESTS_ASSERT_NEAR_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define assert_near(actual, expected, tolerance)                                                                       \
  do {                                                                                                                 \
    double a_ = (actual), e_ = (expected), t_ = (tolerance);                                                           \
    if (!(fabs(a_ - e_) <= t_)) fail_msg("%s = %.9g, expected %.9g +- %.3g", #actual, a_, e_, t_);                     \
  } while (0)

#define assert_ok(call)                                                                                                \
  do {                                                                                                                 \
    vs_error err_ = {0};                                                                                               \
    vs_error *err = &err_;                                                                                             \
    if ((call) != VS_OK) fail_msg("%s: %s", #call, err_.text);                                                         \
  } while (0)

#endif
