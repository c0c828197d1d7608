// src/base/realtime.c
#include <pthread.h>
#include <sched.h>
#include <stdbool.h>
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

static void *be_prompt(void *policy) {
  struct sched_param param;
  vs_realtime_prompt();
  pthread_getschedparam(pthread_self(), policy, &param);
  assert_int_equal(param.sched_priority, *(int *)policy == SCHED_FIFO ? 1 : 0);
  return NULL;
}

// Real time where this user may, else as before; the thread that started it stays as it was.
static void a_prompt_thread_has_the_lowest_real_time_priority_where_allowed(void **state) {
  (void)state;
  pthread_t thread;
  struct sched_param param = {.sched_priority = 1};
  int policy = -1, own = -1;
  assert_int_equal(pthread_create(&thread, NULL, be_prompt, &policy), 0);
  pthread_join(thread, NULL);
  pthread_getschedparam(pthread_self(), &own, &param);
  assert_int_equal(own, SCHED_OTHER);
  param.sched_priority = 1;
  bool allowed = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param) == 0;
  param.sched_priority = 0;
  if (allowed) assert_int_equal(pthread_setschedparam(pthread_self(), SCHED_OTHER, &param), 0);
  assert_int_equal(policy, allowed ? SCHED_FIFO : SCHED_OTHER);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(priority_is_granted_or_the_refusal_says_how_to_allow_it),
      cmocka_unit_test(a_priority_out_of_range_is_refused),
      cmocka_unit_test(a_prompt_thread_has_the_lowest_real_time_priority_where_allowed),
  };
  return cmocka_run_group_tests_name("base/realtime", tests, NULL, NULL);
}
