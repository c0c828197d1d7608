// src/base/realtime.c
#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>

#include "assert_near.h"
#include "vsss/realtime.h"

// Where the system refuses, the reason must name the file that allows it; where it allows, the thread must have it.
static void priority_is_granted_or_the_refusal_says_how_to_allow_it(void **state) {
  (void)state;
  vs_error err = {0};
  struct sched_param param;
  int policy;
  vs_status s = vs_realtime_try(5, &err);
  pthread_getschedparam(pthread_self(), &policy, &param);
  if (s == VS_OK || strstr(err.text, "memory")) {
    assert_int_equal(policy, SCHED_FIFO);
    assert_int_equal(param.sched_priority, 5);
  } else {
    assert_int_equal(s, VS_FAIL);
    assert_int_equal(policy, SCHED_OTHER);
  }
  if (s != VS_OK) assert_non_null(strstr(err.text, "/etc/security/limits.d/vsss.conf"));
  munlockall();
  param.sched_priority = 0;
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &param);
}

static void a_priority_out_of_range_is_refused(void **state) {
  (void)state;
  vs_error err = {0};
  assert_int_equal(vs_realtime_try(100, &err), VS_USAGE);
  assert_string_equal(err.text, "real-time priority 100: allowed are 1 to 99");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(priority_is_granted_or_the_refusal_says_how_to_allow_it),
      cmocka_unit_test(a_priority_out_of_range_is_refused),
  };
  return cmocka_run_group_tests_name("base/realtime", tests, NULL, NULL);
}
