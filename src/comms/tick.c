// vs_tick <-> bytes of the wire. The type has no texts, so its size is fixed and checked.
#include "vsss/tick.h"

#include <string.h>

#include "lcm/vsss_tick_t.h"

_Static_assert(sizeof(vs_tick_blob) == 6 * sizeof(double), "a blob is a row of ball and adversary");

size_t vs_tick_encode(const vs_tick *k, int64_t utime_us, int64_t utime_capture_us, uint8_t *out, size_t size) {
  vsss_tick_t t = {.utime = utime_us, .utime_capture = utime_capture_us, .seq = k->seq};
  t.frame = k->frame;
  t.frame_seq = (int32_t)k->frame_seq;
  t.capture_us = k->capture_us;
  t.fps = k->fps;
  t.camera = k->camera;
  t.player_failed = k->player_failed;
  t.armed = k->armed;
  t.rearm = k->rearm;
  t.task = (int8_t)k->task;
  t.n_clock = k->n_clock;
  memcpy(t.clock_us, k->clock_us, sizeof t.clock_us);
  t.heard = k->heard;
  t.heard_us = k->heard_us;
  t.kind = (int8_t)k->referee.event.kind;
  t.team = (int8_t)k->referee.event.team;
  t.quadrant = (int8_t)k->referee.event.quadrant;
  t.time_s = k->referee.event.time_s;
  t.duration_s = k->referee.duration_s;
  for (int i = 0; i < VS_TEAMS; i++) t.score[i] = k->referee.score[i];
  t.n_tags = k->n_tags;
  for (int i = 0; i < k->n_tags; i++) {
    const vs_tick_tag *tag = &k->tag[i];
    t.tag_kind[i] = tag->kind;
    t.tag_id[i] = tag->id;
    t.tag_hamming[i] = tag->hamming;
    t.tag_margin[i] = tag->margin;
    memcpy(t.tag_centre_px[i], tag->centre_px, sizeof tag->centre_px);
    memcpy(t.tag_corner_px[i], tag->corner_px, sizeof tag->corner_px);
  }
  t.n_balls = k->n_balls;
  memcpy(t.ball, k->ball, (size_t)k->n_balls * sizeof *k->ball);
  t.n_adversaries = k->n_adversaries;
  memcpy(t.adversary, k->adversary, (size_t)k->n_adversaries * sizeof *k->adversary);
  t.decided = k->decided;
  t.stop = k->stop;
  t.safety = (int8_t)k->safety;
  t.world_hash = (int64_t)k->world_hash;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    t.left_radps[i] = k->wheels[i].left_radps;
    t.right_radps[i] = k->wheels[i].right_radps;
  }
  int written = vsss_tick_t_encode(out, 0, (int)size, &t);
  return written > 0 ? (size_t)written : 0;
}

static bool within(int value, int most) { return value >= 0 && value <= most; }

vs_status vs_tick_decode(const uint8_t *data, size_t size, vs_tick *k, vs_error *err) {
  vsss_tick_t t;
  memset(k, 0, sizeof *k);
  if (size > VS_TICK_BYTES || vsss_tick_t_decode(data, 0, (int)size, &t) != (int)size)
    return vs_fail(err, VS_FAIL, "%s: another version of lcm_types/tick_t.lcm, or damaged", VS_TICK_CHANNEL);
  if (!within(t.n_clock, VS_TICK_CLOCKS) || !within(t.n_tags, VS_TICK_ROWS) || !within(t.n_balls, VS_TICK_ROWS) ||
      !within(t.n_adversaries, VS_TICK_ROWS) || !within(t.kind, VS_EVENT_KINDS - 1) || !within(t.team, VS_TEAMS - 1) ||
      !within(t.quadrant, 4) || !within(t.task, 3))
    return vs_fail(err, VS_FAIL, "%s %d: a count or a kind that cannot be", VS_TICK_CHANNEL, t.seq);
  k->seq = t.seq;
  k->frame = t.frame;
  k->frame_seq = (uint32_t)t.frame_seq;
  k->capture_us = t.capture_us;
  k->fps = t.fps;
  k->camera = t.camera;
  k->player_failed = t.player_failed;
  k->armed = t.armed;
  k->rearm = t.rearm;
  k->task = t.task;
  k->n_clock = t.n_clock;
  memcpy(k->clock_us, t.clock_us, sizeof k->clock_us);
  k->heard = t.heard;
  k->heard_us = t.heard_us;
  k->referee = (vs_msg_referee){.event = {(vs_event_kind)t.kind, (vs_team)t.team, t.quadrant, t.time_s},
                                .duration_s = t.duration_s,
                                .score = {t.score[0], t.score[1]}};
  k->n_tags = t.n_tags;
  for (int i = 0; i < k->n_tags; i++) {
    vs_tick_tag *tag = &k->tag[i];
    *tag =
        (vs_tick_tag){.kind = t.tag_kind[i], .id = t.tag_id[i], .hamming = t.tag_hamming[i], .margin = t.tag_margin[i]};
    memcpy(tag->centre_px, t.tag_centre_px[i], sizeof tag->centre_px);
    memcpy(tag->corner_px, t.tag_corner_px[i], sizeof tag->corner_px);
  }
  k->n_balls = t.n_balls;
  memcpy(k->ball, t.ball, sizeof k->ball);
  k->n_adversaries = t.n_adversaries;
  memcpy(k->adversary, t.adversary, sizeof k->adversary);
  k->decided = t.decided;
  k->stop = t.stop;
  k->safety = t.safety;
  k->world_hash = (uint64_t)t.world_hash;
  for (int i = 0; i < VS_TEAM_SIZE; i++) k->wheels[i] = (vs_wheels){t.left_radps[i], t.right_radps[i]};
  return VS_OK;
}
