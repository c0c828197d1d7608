#include "field_overlay.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "video.h"
#include "vsss/realtime.h"

#define NICE 10 // of the thread and of ffmpeg, which it starts

struct field_overlay {
  const char *path;
  vs_calib calib;
  vs_team team;
  bool turned;
  int width, height; // of the video: even
  pthread_t thread;
  pthread_mutex_t lock; // of all below
  pthread_cond_t wake;
  bool opened, stop, full; // full: what is below is the thread's until it is written
  vs_status status;        // of the video
  vs_error why;
  int64_t start_us, last_us, due_us; // pictures of the video are counted from the first
  int64_t written, left_out;
  bool has_picture;
  field_scene scene;
  uint8_t *clean, *drawn, *rgb; // [height][width][3]; drawn into is a copy
};

static size_t bytes_of(const field_overlay *o) { return 3 * (size_t)o->width * (size_t)o->height; }

// As often as it takes to come up with the time.
static vs_status write_picture(field_overlay *o, vs_video *video, vs_error *err) {
  vs_image image = {o->drawn, o->width, o->height, 3 * o->width};
  memcpy(o->drawn, o->clean, bytes_of(o));
  field_scene_draw(&o->scene, &o->calib, &image);
  for (size_t i = 0; i < bytes_of(o); i += 3) {
    o->rgb[i] = o->drawn[i + 2];
    o->rgb[i + 1] = o->drawn[i + 1];
    o->rgb[i + 2] = o->drawn[i];
  }
  int64_t until = 1 + (o->last_us - o->start_us) * FIELD_OVERLAY_HZ / 1000000;
  vs_status s = VS_OK;
  for (; o->written < until && s == VS_OK; o->written++) s = vs_video_frame(video, o->rgb, err);
  return s;
}

// Opens the video too, so that ffmpeg is neither of real-time priority nor in anybody's way.
static void *work(void *overlay) {
  field_overlay *o = overlay;
  vs_video *video = NULL;
  vs_error why = {0};
  setpriority(PRIO_PROCESS, 0, NICE); // of this thread
  vs_status s = vs_video_open(o->path, o->width, o->height, FIELD_OVERLAY_HZ, &video, &why);
  pthread_mutex_lock(&o->lock);
  o->status = s;
  o->opened = true;
  pthread_cond_broadcast(&o->wake);
  while (s == VS_OK) {
    while (!o->full && !o->stop) pthread_cond_wait(&o->wake, &o->lock);
    if (!o->full) break; // a last one is still written
    pthread_mutex_unlock(&o->lock);
    s = write_picture(o, video, &why);
    pthread_mutex_lock(&o->lock);
    if (s == VS_OK) o->full = false; // else nothing is taken any more
  }
  pthread_mutex_unlock(&o->lock);
  vs_error at_close = {0};
  if (vs_video_close(video, &at_close) != VS_OK && s == VS_OK) {
    s = VS_FAIL;
    why = at_close;
  }
  o->status = s;
  o->why = why;
  return NULL;
}

static void release(field_overlay *o) {
  pthread_cond_destroy(&o->wake);
  pthread_mutex_destroy(&o->lock);
  free(o->clean);
  free(o->drawn);
  free(o->rgb);
  free(o);
}

vs_status field_overlay_open(const char *path, const vs_field *field, const vs_field_def *def, field_overlay **out,
                             vs_error *err) {
  *out = NULL;
  field_overlay *o = calloc(1, sizeof *o);
  if (!o) return vs_fail(err, VS_FAIL, "out of memory");
  const vs_camera_info *camera = vs_field_camera(field);
  o->path = path;
  o->calib = *vs_field_calib(field);
  o->team = def->team;
  o->turned = (def->team == VS_BLUE) != def->tracker.attack_plus_x;
  o->width = camera->width & ~1;
  o->height = camera->height & ~1;
  pthread_mutex_init(&o->lock, NULL);
  pthread_cond_init(&o->wake, NULL);
  o->clean = calloc(1, bytes_of(o));
  o->drawn = malloc(bytes_of(o));
  o->rgb = malloc(bytes_of(o));
  if (!o->clean || !o->drawn || !o->rgb || vs_realtime_plain_thread(&o->thread, work, o)) {
    release(o);
    return vs_fail(err, VS_FAIL, "%s: no memory or no thread for it", path);
  }
  pthread_mutex_lock(&o->lock);
  while (!o->opened) pthread_cond_wait(&o->wake, &o->lock);
  vs_status s = o->status;
  pthread_mutex_unlock(&o->lock);
  if (s == VS_OK) {
    *out = o;
    return VS_OK;
  }
  pthread_join(o->thread, NULL);
  if (err) *err = o->why;
  release(o);
  return s;
}

static void fill(field_overlay *o, const vs_field *field, const vs_field_tick_result *tick) {
  field_scene *s = &o->scene;
  const vs_frame *frame = vs_field_frame(field);
  size_t row = 3 * (size_t)o->width;
  for (int y = 0; frame && y < o->height; y++)
    memcpy(o->clean + row * (size_t)y, frame->bgr + (size_t)y * (size_t)frame->bgr_stride, row);
  s->team = o->team;
  s->turned = o->turned;
  s->now = tick->world;
  vs_field_ahead(field, &tick->world, &s->ahead);
  if (frame) s->seen = *vs_field_seen(field);
  if (!frame) s->seen.tags = s->seen.balls = s->seen.adversaries = 0;
  memcpy(s->wheels, tick->wheels, sizeof s->wheels);
  s->stop = tick->stop;
  s->picture = frame != NULL;
  s->bridged = tick->bridged;
  s->safety = tick->safety;
  s->age_ms = 1e-3 * (double)tick->age_us;
  s->silent_s = 1e-6 * (double)tick->silent_us;
  s->latency_s = vs_field_latency_s(field);
}

void field_overlay_show(field_overlay *o, const vs_field *field, const vs_field_tick_result *tick) {
  const int64_t period_us = 1000000 / FIELD_OVERLAY_HZ, now_us = tick->now_us;
  if (o->start_us && now_us + period_us / 4 < o->due_us) return; // a faster camera's
  if (pthread_mutex_trylock(&o->lock)) {
    o->due_us = now_us + period_us;
    o->left_out++; // only this side counts
    return;
  }
  if (o->full) {
    o->left_out++;
  } else {
    if (!o->start_us) o->start_us = now_us;
    o->last_us = now_us;
    fill(o, field, tick);
    o->full = true;
    pthread_cond_signal(&o->wake);
  }
  o->due_us = now_us + period_us;
  pthread_mutex_unlock(&o->lock);
}

vs_status field_overlay_close(field_overlay *o, int64_t *left_out, vs_error *err) {
  if (!o) return VS_OK;
  pthread_mutex_lock(&o->lock);
  o->stop = true;
  pthread_cond_signal(&o->wake);
  pthread_mutex_unlock(&o->lock);
  pthread_join(o->thread, NULL);
  *left_out = o->left_out;
  vs_status s = o->status;
  if (s != VS_OK && err) *err = o->why;
  release(o);
  return s;
}
