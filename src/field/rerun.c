#include "field_internal.h"

#include <string.h>

#include "vsss/clock.h"

// What is decided by time is decided by this: each reading is in the record, and a run computed again is given them.
int64_t vs_field_clock_us(vs_field *f) {
  vs_tick *t = &f->tick;
  if (f->def.rerun) {
    int i = f->clock_used++;
    return i < t->n_clock ? t->clock_us[i] : 0; // 0: vs_field_again tells
  }
  int64_t now_us = vs_clock_monotonic_us();
  if (t->n_clock < VS_TICK_CLOCKS) t->clock_us[t->n_clock++] = now_us;
  return now_us;
}

void vs_field_keep(vs_field *f, const vs_frame *frame, const vs_field_tick_result *r) {
  vs_tick *t = &f->tick;
  t->frame = frame != NULL;
  t->fps = f->eyes.info.fps;
  t->camera = !f->dark;
  if (frame) {
    t->capture_us = frame->capture_us;
    t->frame_seq = frame->seq;
    vs_record_seen(&f->seen, t);
  }
  t->decided = r->decided;
  t->stop = r->stop;
  t->safety = r->safety;
  t->world_hash = vs_world_hash(VS_HASH_START, &r->world);
  memcpy(t->wheels, r->wheels, sizeof t->wheels);
  vs_record_tick(&f->record, t);
}

vs_status vs_field_again(vs_field *f, const vs_tick *tick, vs_tick *again, vs_error *err) {
  vs_field_tick_result r = {.got = tick->frame ? VS_CAMERA_FRAME : VS_CAMERA_TIMEOUT};
  vs_frame frame = {.capture_us = tick->capture_us,
                    .seq = tick->frame_seq,
                    .width = f->eyes.info.width,
                    .height = f->eyes.info.height};
  f->tick = *tick;
  f->clock_used = 0;
  f->armed = tick->armed;
  f->rearm = tick->rearm;
  vs_field_set_task(f, (vs_field_task)tick->task);
  f->dark = !tick->camera;
  f->eyes.info.fps = tick->fps;
  if (tick->frame) vs_field_see(f, &frame, &r);
  vs_field_turn(f, tick->frame ? &frame : NULL, &r);
  vs_field_keep(f, tick->frame ? &frame : NULL, &r);
  *again = f->tick;
  if (f->clock_used == tick->n_clock) return VS_OK;
  return vs_fail(err, VS_FAIL, "turn %d looked at the clock %d times, the recorded one %d times", tick->seq,
                 f->clock_used, tick->n_clock);
}
