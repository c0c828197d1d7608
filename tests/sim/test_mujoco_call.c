// Tests src/sim/mujoco_call.c: MuJoCo's fatal errors become a status, and nothing reaches the terminal or a log file.
#include <mujoco/mujoco.h>
#include <string.h>
#include <unistd.h>

#include "../../src/sim/mujoco_call.h"
#include "assert_near.h"

static int steps;

static void harmless(void *context) { *(int *)context = 7; }

static void fatal(void *context) {
  (void)context;
  steps = 1;
  mju_error("the solver ran out of paper");
  steps = 2;
}

static void warned(void *context) {
  (void)context;
  mju_warning("not so good");
}

static void work_that_succeeds_returns_ok(void **state) {
  (void)state;
  int value = 0;
  assert_ok(vs_mujoco_call(harmless, &value, err));
  assert_int_equal(value, 7);
}

static void fatal_error_ends_the_work_and_is_reported(void **state) {
  (void)state;
  vs_error err = {0};
  assert_int_equal(vs_mujoco_call(fatal, NULL, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "the solver ran out of paper"));
  assert_int_equal(steps, 1);
  int value = 0;
  assert_int_equal(vs_mujoco_call(harmless, &value, &err), VS_OK); // and the next call works
  assert_int_equal(value, 7);
}

static void nothing_is_written_to_a_log_file(void **state) {
  (void)state;
  vs_error err = {0};
  assert_int_equal(vs_mujoco_call(warned, NULL, &err), VS_OK);
  assert_int_equal(vs_mujoco_call(fatal, NULL, &err), VS_FAIL);
  assert_int_not_equal(access("MUJOCO_LOG.TXT", F_OK), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(work_that_succeeds_returns_ok),
      cmocka_unit_test(fatal_error_ends_the_work_and_is_reported),
      cmocka_unit_test(nothing_is_written_to_a_log_file),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
