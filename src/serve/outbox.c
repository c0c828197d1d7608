#include "outbox.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/realtime.h"

struct vs_outbox {
  vs_udp to;
  pthread_t thread;
  pthread_mutex_t lock; // of all that follows
  pthread_cond_t changed;
  bool full, closes;
  size_t size;
  int64_t due_us, unsent;
  vs_histogram late;
  uint8_t bytes[VS_LEAGUE_DATAGRAM_5V5_MAX];
};

static void *work(void *context) {
  vs_outbox *b = context;
  vs_realtime_fine_timers();
  vs_realtime_prompt();
  pthread_mutex_lock(&b->lock);
  for (;;) {
    while (!b->full && !b->closes) pthread_cond_wait(&b->changed, &b->lock);
    if (!b->full) break;
    pthread_mutex_unlock(&b->lock);
    // Nobody writes into a full box.
    vs_clock_sleep_until_us(b->due_us);
    bool sent = vs_udp_send(&b->to, b->bytes, b->size);
    int64_t now_us = vs_clock_monotonic_us();
    pthread_mutex_lock(&b->lock);
    vs_histogram_add(&b->late, now_us > b->due_us ? now_us - b->due_us : 0, b->due_us);
    b->unsent += sent ? 0 : 1;
    b->full = false;
    pthread_cond_broadcast(&b->changed);
  }
  pthread_mutex_unlock(&b->lock);
  return NULL;
}

vs_status vs_outbox_new(const vs_udp *to, vs_outbox **out, vs_error *err) {
  vs_outbox *b = calloc(1, sizeof *b);
  if (!b) return vs_fail(err, VS_FAIL, "out of memory for what is sent");
  b->to = *to;
  pthread_mutex_init(&b->lock, NULL);
  pthread_cond_init(&b->changed, NULL);
  int refused = pthread_create(&b->thread, NULL, work, b);
  if (refused) {
    pthread_cond_destroy(&b->changed);
    pthread_mutex_destroy(&b->lock);
    free(b);
    return vs_fail(err, VS_FAIL, "no thread to send with: %s", strerror(refused));
  }
  *out = b;
  return VS_OK;
}

void vs_outbox_free(vs_outbox *b) {
  if (!b) return;
  pthread_mutex_lock(&b->lock);
  b->closes = true;
  pthread_cond_broadcast(&b->changed);
  pthread_mutex_unlock(&b->lock);
  pthread_join(b->thread, NULL);
  pthread_cond_destroy(&b->changed);
  pthread_mutex_destroy(&b->lock);
  free(b);
}

void vs_outbox_put(vs_outbox *b, const uint8_t *data, size_t size, int64_t due_us) {
  pthread_mutex_lock(&b->lock);
  while (b->full) pthread_cond_wait(&b->changed, &b->lock);
  memcpy(b->bytes, data, size);
  b->size = size;
  b->due_us = due_us;
  b->full = true;
  pthread_cond_broadcast(&b->changed);
  pthread_mutex_unlock(&b->lock);
}

void vs_outbox_flush(vs_outbox *b) {
  if (!b) return;
  pthread_mutex_lock(&b->lock);
  while (b->full) pthread_cond_wait(&b->changed, &b->lock);
  pthread_mutex_unlock(&b->lock);
}

void vs_outbox_told(vs_outbox *b, vs_histogram *late, int64_t *unsent) {
  pthread_mutex_lock(&b->lock);
  *late = b->late;
  *unsent = b->unsent;
  pthread_mutex_unlock(&b->lock);
}
