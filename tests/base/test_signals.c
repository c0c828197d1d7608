// src/base/signals.c, and what it is for: src/learn/blas.c computes while signals arrive.
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>

#include "assert_near.h"
#include "learn/blas.h"
#include "vsss/clock.h"
#include "vsss/pool.h"
#include "vsss/rng.h"
#include "vsss/signals.h"

static volatile sig_atomic_t alarms;
static void count(int number) {
  (void)number;
  alarms++;
}

// A handler that does nothing, as a host program's timer or progress bar has one, every interval_us.
static void alarm_every(int interval_us) {
  struct sigaction action = {.sa_handler = count, .sa_flags = SA_RESTART};
  sigaction(SIGALRM, &action, NULL);
  const struct itimerval timer = {{0, interval_us}, {0, interval_us}};
  setitimer(ITIMER_REAL, &timer, NULL);
}

// Products as a gradient has them, of 192 rows, into memory of their own.
enum { ROWS = 192, IN = 464, OUT = 256, PIECES = 4 };
typedef struct products {
  vs_blas blas;
  float x[ROWS * IN], weight[IN * OUT], *out[PIECES];
  uint16_t x_bf16[ROWS * IN], weight_bf16[IN * OUT];
} products;

static void multiply(void *context, int piece, int thread) {
  (void)thread;
  products *p = context;
  bool bf16 = piece % 2 && vs_blas_has_bf16(&p->blas);
  free(p->out[piece]); // the heap is where the damage showed
  p->out[piece] = malloc(ROWS * OUT * sizeof(float));
  if (bf16)
    vs_blas_multiply_bf16(&p->blas, false, false, ROWS, OUT, IN, p->x_bf16, IN, p->weight_bf16, OUT, false,
                          p->out[piece], OUT);
  else
    vs_blas_multiply(&p->blas, false, false, ROWS, OUT, IN, p->x, IN, p->weight, OUT, false, p->out[piece], OUT);
}

static void products_come_out_the_same_while_a_timer_interrupts(void **state) {
  (void)state;
  static products p;
  vs_pool *pool;
  assert_ok(vs_blas_open(&p.blas, VS_BLAS_ANY, err));
  assert_ok(vs_pool_new(2, &pool, err));
  vs_rng rng = vs_rng_make(3, 0);
  for (int i = 0; i < ROWS * IN; i++) p.x[i] = (float)vs_rng_normal(&rng), p.x_bf16[i] = 0x3f80;
  for (int i = 0; i < IN * OUT; i++) p.weight[i] = (float)vs_rng_normal(&rng), p.weight_bf16[i] = 0x3f80;
  vs_pool_run(pool, PIECES, multiply, &p);
  static float expected[PIECES][ROWS * OUT];
  for (int i = 0; i < PIECES; i++) memcpy(expected[i], p.out[i], sizeof expected[i]);
  alarm_every(300);
  int64_t end_us = vs_clock_monotonic_us() + 4000000;
  while (vs_clock_monotonic_us() < end_us) {
    vs_pool_run(pool, PIECES, multiply, &p);
    for (int i = 0; i < PIECES; i++) assert_memory_equal(p.out[i], expected[i], sizeof expected[i]);
  }
  alarm_every(0);
  print_message("%d alarms\n", (int)alarms);
  assert_true(alarms > 20);
  for (int i = 0; i < PIECES; i++) free(p.out[i]);
  vs_pool_free(pool);
}

static bool blocked(int number) {
  sigset_t now;
  pthread_sigmask(SIG_BLOCK, NULL, &now);
  return sigismember(&now, number);
}

static void holding_blocks_all_but_faults_and_nests(void **state) {
  (void)state;
  vs_signals_hold();
  vs_signals_hold();
  assert_true(blocked(SIGINT) && blocked(SIGTERM) && blocked(SIGALRM) && blocked(SIGPROF) && blocked(SIGCHLD));
  assert_false(blocked(SIGSEGV) || blocked(SIGBUS) || blocked(SIGFPE) || blocked(SIGILL) || blocked(SIGABRT));
  vs_signals_release();
  assert_true(blocked(SIGINT));
  vs_signals_release();
  assert_false(blocked(SIGINT));
}

static void what_its_owner_had_blocked_stays_blocked(void **state) {
  (void)state;
  sigset_t own, before;
  sigemptyset(&own);
  sigaddset(&own, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &own, &before);
  vs_signals_hold();
  vs_signals_release();
  assert_true(blocked(SIGUSR1));
  assert_false(blocked(SIGINT));
  pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static void note_mask(void *context, int piece, int thread) {
  (void)piece;
  bool *open = context;
  if (thread > 0 && !blocked(SIGINT)) *open = true;
}

static void helpers_of_a_pool_take_no_signals(void **state) {
  (void)state;
  vs_pool *pool;
  bool open = false;
  assert_ok(vs_pool_new(4, &pool, err));
  for (int i = 0; i < 50; i++) vs_pool_run(pool, 64, note_mask, &open);
  assert_false(open);
  assert_false(blocked(SIGINT)); // the caller's own mask is as it was
  vs_pool_free(pool);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(products_come_out_the_same_while_a_timer_interrupts),
      cmocka_unit_test(holding_blocks_all_but_faults_and_nests),
      cmocka_unit_test(what_its_owner_had_blocked_stays_blocked),
      cmocka_unit_test(helpers_of_a_pool_take_no_signals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
