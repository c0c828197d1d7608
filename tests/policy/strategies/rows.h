// A table of cases becomes one test per row, named by the row: an array of structs whose first member is the name.
#ifndef VSSS_TESTS_POLICY_ROWS_H
#define VSSS_TESTS_POLICY_ROWS_H

#include "assert_near.h"

#define RUN_ROWS(group, rows, run) run_rows(group, rows, sizeof rows / sizeof *(rows), sizeof *(rows), run)

static inline int run_rows(const char *group, const void *rows, size_t n, size_t size, CMUnitTestFunction run) {
  struct CMUnitTest test[128];
  assert_true(n <= sizeof test / sizeof *test);
  for (size_t i = 0; i < n; i++) {
    const char *row = (const char *)rows + i * size;
    test[i] = (struct CMUnitTest){*(const char *const *)row, run, NULL, NULL, (void *)row};
  }
  return _cmocka_run_group_tests(group, test, n, NULL, NULL);
}

#endif
