#include "vsss/pool.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/signals.h"

struct helper {
  vs_pool *pool;
  int number; // from 1; the caller of vs_pool_run is thread 0
  pthread_t thread;
};

struct vs_pool {
  int helpers; // beside the caller
  struct helper *helper;
  pthread_mutex_t lock;
  pthread_cond_t start, finished;
  vs_pool_work work;
  void *context;
  int pieces, next, running; // next piece to hand out; pieces handed out and not done
  bool stop;
};

// Does pieces until none is left. Called and left with the lock held.
static void do_pieces(vs_pool *pool, int thread) {
  while (pool->next < pool->pieces) {
    int piece = pool->next++;
    pool->running++;
    pthread_mutex_unlock(&pool->lock);
    pool->work(pool->context, piece, thread);
    pthread_mutex_lock(&pool->lock);
    pool->running--;
  }
}

static void *help(void *argument) {
  const struct helper *self = argument;
  vs_pool *pool = self->pool;
  pthread_mutex_lock(&pool->lock);
  while (!pool->stop) {
    do_pieces(pool, self->number);
    if (pool->running == 0) pthread_cond_signal(&pool->finished);
    if (!pool->stop && pool->next >= pool->pieces) pthread_cond_wait(&pool->start, &pool->lock);
  }
  pthread_mutex_unlock(&pool->lock);
  return NULL;
}

vs_status vs_pool_new(int threads, vs_pool **out, vs_error *err) {
  *out = NULL;
  vs_pool *pool = calloc(1, sizeof *pool);
  if (pool) pool->helper = calloc((size_t)threads, sizeof *pool->helper);
  if (!pool || !pool->helper) {
    free(pool);
    return vs_fail(err, VS_FAIL, "out of memory for %d threads", threads);
  }
  pthread_mutex_init(&pool->lock, NULL);
  pthread_cond_init(&pool->start, NULL);
  pthread_cond_init(&pool->finished, NULL);
  for (; pool->helpers < threads - 1; pool->helpers++) {
    struct helper *h = &pool->helper[pool->helpers];
    *h = (struct helper){.pool = pool, .number = pool->helpers + 1};
    vs_signals_hold(); // the helper inherits that for good
    int failed = pthread_create(&h->thread, NULL, help, h);
    vs_signals_release();
    if (failed) {
      vs_status s = vs_fail(err, VS_FAIL, "cannot start thread %d of %d: %s; lower threads", pool->helpers + 2, threads,
                            strerror(failed));
      vs_pool_free(pool);
      return s;
    }
  }
  *out = pool;
  return VS_OK;
}

void vs_pool_free(vs_pool *pool) {
  if (!pool) return;
  pthread_mutex_lock(&pool->lock);
  pool->stop = true;
  pthread_cond_broadcast(&pool->start);
  pthread_mutex_unlock(&pool->lock);
  for (int i = 0; i < pool->helpers; i++) pthread_join(pool->helper[i].thread, NULL);
  pthread_cond_destroy(&pool->finished);
  pthread_cond_destroy(&pool->start);
  pthread_mutex_destroy(&pool->lock);
  free(pool->helper);
  free(pool);
}

void vs_pool_run(vs_pool *pool, int pieces, vs_pool_work work, void *context) {
  pthread_mutex_lock(&pool->lock);
  pool->work = work;
  pool->context = context;
  pool->next = 0;
  pool->pieces = pieces;
  pthread_cond_broadcast(&pool->start);
  do_pieces(pool, 0);
  while (pool->running > 0) pthread_cond_wait(&pool->finished, &pool->lock);
  pool->pieces = pool->next = 0;
  pthread_mutex_unlock(&pool->lock);
}

int vs_pool_threads(const vs_pool *pool) { return pool->helpers + 1; }
