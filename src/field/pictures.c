#include "pictures.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/image.h"
#include "vsss/realtime.h"

enum { WIDTH_PX = 640, SHRINK_MAX = 16 }; // no wider than that; smaller still where the bytes do not fit

struct vs_pictures {
  vs_bus *bus;
  int64_t period_us, due_us;
  pthread_t thread;
  pthread_mutex_t lock; // of all below
  pthread_cond_t wake;
  bool stop, full; // full: the frame below is the thread's until it has left
  int64_t lost;
  uint8_t *bgr; // packed rows
  size_t capacity;
  int width, height;
  vs_message message;
  uint8_t jpeg[VS_BUS_IMAGE_MAX];
};

// The best of falling qualities and sizes that fits one datagram.
static vs_status squeeze(vs_pictures *p, vs_msg_image *image, vs_error *err) {
  static const int qualities[] = {80, 60, 40, 25};
  const vs_image frame = {p->bgr, p->width, p->height, 3 * p->width};
  vs_status s = VS_FAIL;
  for (int shrink = 1; shrink <= SHRINK_MAX && s != VS_OK; shrink++) {
    if (p->width / shrink > WIDTH_PX) continue;
    for (size_t i = 0; i < sizeof qualities / sizeof *qualities && s != VS_OK; i++) {
      size_t size = 0;
      const vs_jpeg_def def = {qualities[i], shrink};
      s = vs_image_jpeg(&frame, &def, p->jpeg, sizeof p->jpeg, &size, err);
      *image = (vs_msg_image){p->width / shrink, p->height / shrink, "jpeg", (int)size, p->jpeg};
    }
  }
  return s;
}

static void *send_all(void *pictures) {
  vs_pictures *p = pictures;
  pthread_mutex_lock(&p->lock);
  for (;;) {
    while (!p->full && !p->stop) pthread_cond_wait(&p->wake, &p->lock);
    if (p->stop) break;
    pthread_mutex_unlock(&p->lock);
    vs_error why = {0};
    p->message.channel = VS_CH_IMAGE;
    p->message.utime_us = 0;
    bool sent = squeeze(p, &p->message.as.image, &why) == VS_OK && vs_bus_publish(p->bus, &p->message, &why) == VS_OK;
    p->message.seq++;
    pthread_mutex_lock(&p->lock);
    p->lost += !sent;
    p->full = false;
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

vs_status vs_pictures_new(vs_bus *bus, double hz, vs_pictures **out, vs_error *err) {
  *out = NULL;
  if (!(hz >= 0.1 && hz <= 5.0)) return vs_fail(err, VS_USAGE, "%g pictures a second: allowed are 0.1 to 5", hz);
  uint8_t pixels[8 * 8 * 3] = {0};
  const vs_image black = {pixels, 8, 8, 8 * 3};
  const vs_jpeg_def def = {80, 1};
  uint8_t jpeg[2048];
  size_t size;
  vs_status s = vs_image_jpeg(&black, &def, jpeg, sizeof jpeg, &size, err); // loads OpenCV now, not in play
  if (s != VS_OK) return s;
  vs_pictures *p = calloc(1, sizeof *p);
  if (!p) return vs_fail(err, VS_FAIL, "out of memory");
  p->bus = bus;
  p->period_us = (int64_t)(1e6 / hz);
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->wake, NULL);
  if (vs_realtime_plain_thread(&p->thread, send_all, p)) {
    pthread_cond_destroy(&p->wake);
    pthread_mutex_destroy(&p->lock);
    free(p);
    return vs_fail(err, VS_FAIL, "no thread for pictures on LCM");
  }
  *out = p;
  return VS_OK;
}

void vs_pictures_free(vs_pictures *p) {
  if (!p) return;
  pthread_mutex_lock(&p->lock);
  p->stop = true;
  pthread_cond_signal(&p->wake);
  pthread_mutex_unlock(&p->lock);
  pthread_join(p->thread, NULL);
  pthread_cond_destroy(&p->wake);
  pthread_mutex_destroy(&p->lock);
  free(p->bgr);
  free(p);
}

// Room for the frame's pixels, taken at the first frame: a camera's size does not change.
static bool make_room(vs_pictures *p, size_t bytes) {
  if (bytes <= p->capacity) return true;
  uint8_t *bgr = realloc(p->bgr, bytes);
  if (!bgr) return false;
  p->bgr = bgr;
  p->capacity = bytes;
  return true;
}

void vs_pictures_show(vs_pictures *p, const vs_frame *frame, int64_t utime_capture_us) {
  int64_t now_us = vs_clock_monotonic_us();
  if (now_us < p->due_us || pthread_mutex_trylock(&p->lock)) return;
  size_t row_bytes = 3 * (size_t)frame->width;
  if (!p->full && make_room(p, row_bytes * (size_t)frame->height)) {
    for (int y = 0; y < frame->height; y++)
      memcpy(p->bgr + (size_t)y * row_bytes, frame->bgr + (size_t)y * (size_t)frame->bgr_stride, row_bytes);
    p->width = frame->width;
    p->height = frame->height;
    p->message.utime_capture_us = utime_capture_us;
    p->due_us = now_us + p->period_us;
    p->full = true;
    pthread_cond_signal(&p->wake);
  }
  pthread_mutex_unlock(&p->lock);
}

int64_t vs_pictures_lost(vs_pictures *p) {
  if (!p) return 0;
  pthread_mutex_lock(&p->lock);
  int64_t lost = p->lost;
  pthread_mutex_unlock(&p->lock);
  return lost;
}
