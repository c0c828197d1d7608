// src/base/pool.c
#define _GNU_SOURCE // RTLD_NEXT
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/eval.h"
#include "vsss/pool.h"
#include "vsss/vecenv.h"

// Stands before the C library's: the calls after `allowed` fail as they do where no more threads may be.
static int allowed = -1;
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
  static int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
  if (!real) *(void **)&real = dlsym(RTLD_NEXT, "pthread_create");
  if (allowed == 0) return EAGAIN;
  if (allowed > 0) allowed--;
  return real(thread, attributes, start, argument);
}

static void count(void *context, int piece, int thread) {
  (void)thread;
  ((int *)context)[piece]++;
}

static void every_piece_is_done_once_for_any_number_of_threads(void **state) {
  (void)state;
  for (int threads = 1; threads <= 5; threads++) {
    vs_pool *pool;
    assert_ok(vs_pool_new(threads, &pool, err));
    assert_int_equal(vs_pool_threads(pool), threads);
    for (int pieces = 0; pieces < 40; pieces++) {
      int done[40] = {0};
      vs_pool_run(pool, pieces, count, done);
      for (int i = 0; i < 40; i++) assert_int_equal(done[i], i < pieces);
    }
    vs_pool_free(pool);
  }
}

static void a_thread_that_cannot_be_started_is_an_error_that_says_which(void **state) {
  (void)state;
  for (int started = 0; started < 3; started++) {
    vs_error err = {0};
    vs_pool *pool = NULL;
    allowed = started;
    vs_status s = vs_pool_new(4, &pool, &err);
    allowed = -1;
    char expected[32];
    snprintf(expected, sizeof expected, "thread %d of 4", started + 2);
    assert_int_equal(s, VS_FAIL);
    assert_null(pool);
    assert_non_null(strstr(err.text, expected));
    assert_non_null(strstr(err.text, "lower threads"));
  }
}

static void who_needs_a_pool_says_so_too(void **state) {
  (void)state;
  vs_error err = {0};
  vs_model_def model_def = vs_model_def_default(VS_DRIVE_PLANAR);
  vs_model *model;
  assert_int_equal(vs_model_load(&model_def, &model, &err), VS_OK);
  vs_vecenv_def def = {.env = vs_env_def_default(model), .envs = 2, .threads = 3};
  vs_vecenv *vec = NULL;
  allowed = 1;
  assert_int_equal(vs_vecenv_new(&def, &vec, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "thread 3 of 3"));
  vs_series_def series = {.env = def.env, .matches = 3, .threads = 3};
  vs_match_result results[3];
  allowed = 0;
  assert_int_equal(vs_series_play(&series, results, &err), VS_FAIL);
  allowed = -1;
  assert_non_null(strstr(err.text, "thread 2 of 3"));
  vs_model_free(model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_piece_is_done_once_for_any_number_of_threads),
      cmocka_unit_test(a_thread_that_cannot_be_started_is_an_error_that_says_which),
      cmocka_unit_test(who_needs_a_pool_says_so_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
