#include "field_internal.h"

#include <math.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/isolate.h"

const char *vs_stage_name(vs_stage stage) {
  static const char *const names[VS_STAGES] = {"camera", "detect",  "track",        "control",
                                               "write",  "publish", "decision age", "camera to radio"};
  return names[stage];
}

void vs_field_count(vs_field *f, vs_stage stage, int64_t duration_us, int64_t now_us) {
  vs_histogram_add(&f->stats.stage[stage], duration_us, now_us);
  vs_histogram_add(&f->second[stage], duration_us, now_us);
}

// Ends a stage.
void vs_field_mark(vs_field *f, vs_stage stage) {
  int64_t now_us = vs_clock_monotonic_us();
  vs_field_count(f, stage, now_us - f->mark_us, now_us);
  f->mark_us = now_us;
}

void vs_field_count_frame(vs_field *f, const vs_frame *frame) {
  if (f->stats.frames++ > 0) f->stats.dropped += (int64_t)(uint32_t)(frame->seq - f->last_seq) - 1;
  if (!f->start_us) f->start_us = frame->capture_us;
  f->last_seq = frame->seq;
  f->mark_us = frame->capture_us;
}

// A decision that came more than half a period late is one or more missed.
void vs_field_count_decision(vs_field *f, int64_t capture_us) {
  double period_us = 1e6 / vs_player_rate_hz(vs_control_player(f->control[f->plays]));
  double periods = f->last_decision_us ? (double)(capture_us - f->last_decision_us) / period_us : 1.0;
  if (periods > 1.5) f->stats.missed_ticks += llround(periods) - 1;
  f->last_decision_us = capture_us;
  f->stats.decisions++;
}

void vs_field_get_stats(vs_field *f, vs_field_stats *out) {
  vs_radio_link link;
  vs_sender_state(f->sender, &link, &f->stats.serial);
  memcpy(f->stats.robot, link.robot, sizeof f->stats.robot);
  f->stats.track = f->tracker.stats;
  f->stats.lost_messages = vs_tap_lost(&f->tap);
  f->stats.lost_record = f->record.lost;
  f->stats.camera_lost = f->eyes.lost;
  f->stats.camera_reopened = f->eyes.reopened;
  f->stats.player_failures = 0;
  for (int i = 0; i < 2 && f->control[i]; i++)
    f->stats.player_failures += vs_player_failures(vs_control_player(f->control[i]));
  memcpy(f->stats.entered, f->safety.entered, sizeof f->stats.entered);
  *out = f->stats;
}
