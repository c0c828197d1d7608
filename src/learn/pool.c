#include "pool.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

struct vs_pool {
  int threads; // helpers, beside the caller
  pthread_t *thread;
  pthread_mutex_t lock;
  pthread_cond_t start, finished;
  void (*work)(void *context, int piece);
  void *context;
  int pieces, next, running; // next piece to hand out; pieces handed out and not done
  bool stop;
};

// Does pieces until none is left. Called and left with the lock held.
static void do_pieces(vs_pool *pool) {
  while (pool->next < pool->pieces) {
    int piece = pool->next++;
    pool->running++;
    pthread_mutex_unlock(&pool->lock);
    pool->work(pool->context, piece);
    pthread_mutex_lock(&pool->lock);
    pool->running--;
  }
}

static void *helper(void *argument) {
  vs_pool *pool = argument;
  pthread_mutex_lock(&pool->lock);
  while (!pool->stop) {
    do_pieces(pool);
    if (pool->running == 0) pthread_cond_signal(&pool->finished);
    if (!pool->stop && pool->next >= pool->pieces) pthread_cond_wait(&pool->start, &pool->lock);
  }
  pthread_mutex_unlock(&pool->lock);
  return NULL;
}

vs_status vs_pool_new(int threads, vs_pool **out, vs_error *err) {
  *out = NULL;
  vs_pool *pool = calloc(1, sizeof *pool);
  if (pool) pool->thread = calloc((size_t)threads, sizeof *pool->thread);
  if (!pool || !pool->thread) {
    free(pool);
    return vs_fail(err, VS_FAIL, "out of memory for %d threads", threads);
  }
  pthread_mutex_init(&pool->lock, NULL);
  pthread_cond_init(&pool->start, NULL);
  pthread_cond_init(&pool->finished, NULL);
  for (; pool->threads < threads - 1; pool->threads++)
    if (pthread_create(&pool->thread[pool->threads], NULL, helper, pool) != 0) {
      vs_pool_free(pool);
      return vs_fail(err, VS_FAIL, "cannot start thread %d of %d", pool->threads + 1, threads);
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
  for (int i = 0; i < pool->threads; i++) pthread_join(pool->thread[i], NULL);
  pthread_cond_destroy(&pool->finished);
  pthread_cond_destroy(&pool->start);
  pthread_mutex_destroy(&pool->lock);
  free(pool->thread);
  free(pool);
}

void vs_pool_run(vs_pool *pool, int pieces, void (*work)(void *context, int piece), void *context) {
  pthread_mutex_lock(&pool->lock);
  pool->work = work;
  pool->context = context;
  pool->next = 0;
  pool->pieces = pieces;
  pthread_cond_broadcast(&pool->start);
  do_pieces(pool);
  while (pool->running > 0) pthread_cond_wait(&pool->finished, &pool->lock);
  pool->pieces = pool->next = 0;
  pthread_mutex_unlock(&pool->lock);
}
