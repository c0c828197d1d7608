// Bytes of the wire -> vs_message. The generated decoders trust the lengths inside a message; so that a damaged log cannot
// mislead them, the tail of every message (its texts and bytes, which all types have last) is checked first.
#include <stdio.h>
#include <string.h>

#include "bus_internal.h"
#include "lcm/vsss_cmd_5v5_t.h"
#include "lcm/vsss_cmd_t.h"
#include "lcm/vsss_detections_t.h"
#include "lcm/vsss_image_t.h"
#include "lcm/vsss_policy_t.h"
#include "lcm/vsss_radio_t.h"
#include "lcm/vsss_referee_t.h"
#include "lcm/vsss_stats_t.h"
#include "lcm/vsss_world_5v5_t.h"
#include "lcm/vsss_world_t.h"

#define STAMP_FROM(m, t) ((m)->utime_us = (t)->utime, (m)->utime_capture_us = (t)->utime_capture, (m)->seq = (t)->seq)

// An enumeration from the wire, or 0 where it is none of ours.
static int kind_of(int value, int count) { return value >= 0 && value < count ? value : 0; }
static int clip(int n, int max) { return n < 0 ? 0 : n > max ? max : n; }

static void take_robots(const vs_wire_robots *from, vs_world *w) {
  memset(w->robot, 0, sizeof w->robot);
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0; i < from->team_size; i++) {
      int k = team * from->team_size + i;
      w->robot[team][i] = (vs_robot){.pose = {from->x_m[k], from->y_m[k], from->theta_rad[k]},
                                     .vx_mps = from->vx_mps[k],
                                     .vy_mps = from->vy_mps[k],
                                     .omega_radps = from->omega_radps[k],
                                     .left_radps = from->left_radps[k],
                                     .right_radps = from->right_radps[k],
                                     .valid = from->valid[k] != 0};
    }
}

// One body for both types, which differ in the sizes of their arrays alone.
#define DECODE_WORLD(type, of_division, size_of_team)                                                                  \
  do {                                                                                                                 \
    type t;                                                                                                            \
    if (type##_decode(data, 0, size, &t) != size) return false;                                                        \
    const vs_wire_robots robots = VS_WIRE_ROBOTS(&t, size_of_team);                                                    \
    STAMP_FROM(m, &t);                                                                                                 \
    w->time_us = t.time_us;                                                                                            \
    w->seq = (uint32_t)t.seq;                                                                                          \
    w->division = (of_division);                                                                                       \
    take_robots(&robots, w);                                                                                           \
    w->ball = (vs_ball){.x_m = t.ball_x_m,                                                                             \
                        .y_m = t.ball_y_m,                                                                             \
                        .z_m = t.ball_z_m,                                                                             \
                        .vx_mps = t.ball_vx_mps,                                                                       \
                        .vy_mps = t.ball_vy_mps,                                                                       \
                        .vz_mps = t.ball_vz_mps,                                                                       \
                        .valid = t.ball_valid != 0};                                                                   \
    m->as.world.game = (vs_game){                                                                                      \
        .time_s = t.game_time_s,                                                                                       \
        .duration_s = t.game_duration_s,                                                                               \
        .score = {t.score[0], t.score[1]},                                                                             \
        .last_event = {(vs_event_kind)kind_of(t.event_kind, VS_EVENT_KINDS), (vs_team)kind_of(t.event_team, VS_TEAMS), \
                       clip(t.event_quadrant, 4), t.event_time_s},                                                     \
    };                                                                                                                 \
    m->as.world.asks_team = t.asks_team >= 0 && t.asks_team < VS_TEAMS ? t.asks_team : -1;                             \
    return true;                                                                                                       \
  } while (0)

static bool decode_world(const uint8_t *data, int size, vs_message *m, vs_division division) {
  vs_world *w = &m->as.world.world;
  if (division == VS_5V5) DECODE_WORLD(vsss_world_5v5_t, VS_5V5, 5);
  DECODE_WORLD(vsss_world_t, VS_3V3, VS_TEAM_SIZE);
}

#define DECODE_CMD(type, of_division, size_of_team)                                                                    \
  do {                                                                                                                 \
    type t;                                                                                                            \
    if (type##_decode(data, 0, size, &t) != size) return false;                                                        \
    STAMP_FROM(m, &t);                                                                                                 \
    c->team = (vs_team)kind_of(t.team, VS_TEAMS);                                                                      \
    c->division = (of_division);                                                                                       \
    memset(c->wheels, 0, sizeof c->wheels);                                                                            \
    for (int i = 0; i < (size_of_team); i++) c->wheels[i] = (vs_wheels){t.left_radps[i], t.right_radps[i]};            \
    c->stop = t.stop != 0;                                                                                             \
    c->state_seq = t.state_seq;                                                                                        \
    snprintf(c->source, sizeof c->source, "%s", t.source);                                                             \
    type##_decode_cleanup(&t);                                                                                         \
    return true;                                                                                                       \
  } while (0)

static bool decode_cmd(const uint8_t *data, int size, vs_message *m, vs_division division) {
  vs_msg_cmd *c = &m->as.cmd;
  if (division == VS_5V5) DECODE_CMD(vsss_cmd_5v5_t, VS_5V5, 5);
  DECODE_CMD(vsss_cmd_t, VS_3V3, VS_TEAM_SIZE);
}

static bool decode_referee(const uint8_t *data, int size, vs_message *m) {
  vsss_referee_t t;
  if (vsss_referee_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  m->as.referee = (vs_msg_referee){
      .event = {(vs_event_kind)kind_of(t.kind, VS_EVENT_KINDS), (vs_team)kind_of(t.team, VS_TEAMS), clip(t.quadrant, 4),
                t.time_s},
      .duration_s = t.duration_s,
      .score = {t.score[0], t.score[1]},
  };
  vsss_referee_t_decode_cleanup(&t);
  return true;
}

static bool decode_policy(const uint8_t *data, int size, vs_message *m) {
  vsss_policy_t t;
  if (vsss_policy_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  vs_msg_policy *p = &m->as.policy;
  p->team = (vs_team)kind_of(t.team, VS_TEAMS);
  p->contract_hash = (uint64_t)t.contract_hash;
  memcpy(p->observation, t.observation, sizeof p->observation);
  memcpy(p->action, t.action, sizeof p->action);
  snprintf(p->player, sizeof p->player, "%s", t.player);
  vsss_policy_t_decode_cleanup(&t);
  return true;
}

static bool decode_detections(const uint8_t *data, int size, vs_message *m) {
  vsss_detections_t t;
  if (vsss_detections_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  vs_msg_detections *d = &m->as.detections;
  d->width_px = t.width_px;
  d->height_px = t.height_px;
  d->n_tags = clip(t.n_tags, VS_BUS_TAGS);
  for (int i = 0; i < d->n_tags; i++) {
    vs_msg_tag *tag = &d->tag[i];
    tag->id = t.tag_id[i];
    tag->hamming = t.tag_hamming[i];
    tag->margin = t.tag_margin[i];
    memcpy(tag->centre_px, t.tag_centre_px[i], sizeof tag->centre_px);
    memcpy(tag->corner_px, t.tag_corner_px[i], sizeof tag->corner_px);
    tag->pose = (vs_pose){t.tag_x_m[i], t.tag_y_m[i], t.tag_theta_rad[i]};
  }
  d->n_blobs = clip(t.n_blobs, VS_BUS_BLOBS);
  for (int i = 0; i < d->n_blobs; i++)
    d->blob[i] = (vs_msg_blob){.kind = (vs_blob_kind)kind_of(t.blob_kind[i], VS_BLOB_OPPONENT + 1),
                               .centre_px = {t.blob_centre_px[i][0], t.blob_centre_px[i][1]},
                               .area_px = t.blob_area_px[i],
                               .confidence = t.blob_confidence[i],
                               .x_m = t.blob_x_m[i],
                               .y_m = t.blob_y_m[i]};
  return true;
}

static bool decode_radio(const uint8_t *data, int size, vs_message *m) {
  vsss_radio_t t;
  if (vsss_radio_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  vs_msg_radio *r = &m->as.radio;
  r->up = t.up != 0;
  r->stopping = t.stopping != 0;
  r->sent_frames = t.sent_frames;
  r->dropped_frames = t.dropped_frames;
  r->reopened = t.reopened;
  r->received_frames = t.received_frames;
  r->bad_frames = t.bad_frames;
  r->command_age_us = t.command_age_us;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    r->robot[i] = (vs_msg_radio_robot){.id = t.robot_id[i],
                                       .age_us = t.robot_age_us[i],
                                       .round_trip_us = t.robot_round_trip_us[i],
                                       .measured = {t.robot_left_radps[i], t.robot_right_radps[i]},
                                       .battery_v = t.robot_battery_v[i],
                                       .uptime_s = t.robot_uptime_s[i],
                                       .rssi_dbm = t.robot_rssi_dbm[i],
                                       .rx_ok = t.robot_rx_ok[i],
                                       .rx_bad = t.robot_rx_bad[i]};
  snprintf(r->device, sizeof r->device, "%s", t.device);
  vsss_radio_t_decode_cleanup(&t);
  return true;
}

static bool decode_stats(const uint8_t *data, int size, vs_message *m) {
  vsss_stats_t t;
  if (vsss_stats_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  vs_msg_stats *s = &m->as.stats;
  s->frames = t.frames;
  s->dropped_frames = t.dropped_frames;
  s->decisions = t.decisions;
  s->missed_ticks = t.missed_ticks;
  s->n_stages = clip(t.n_stages, VS_STATS_STAGES);
  for (int i = 0; i < s->n_stages; i++) {
    vs_msg_stage *stage = &s->stage[i];
    snprintf(stage->name, sizeof stage->name, "%s", t.stage_name[i]);
    stage->count = t.stage_count[i];
    stage->p50_us = t.stage_p50_us[i];
    stage->p99_us = t.stage_p99_us[i];
    stage->max_us = t.stage_max_us[i];
    memcpy(stage->bucket, t.stage_bucket[i], sizeof stage->bucket);
  }
  vsss_stats_t_decode_cleanup(&t);
  return true;
}

static bool decode_image(const uint8_t *data, int size, vs_message *m, uint8_t *image_buffer) {
  vsss_image_t t;
  if (vsss_image_t_decode(data, 0, size, &t) != size) return false;
  STAMP_FROM(m, &t);
  vs_msg_image *image = &m->as.image;
  image->width_px = t.width_px;
  image->height_px = t.height_px;
  snprintf(image->format, sizeof image->format, "%s", t.format);
  image->size = image_buffer ? clip(t.size, VS_BUS_IMAGE_MAX) : 0;
  image->data = image_buffer;
  if (image->size) memcpy(image_buffer, t.data, (size_t)image->size);
  vsss_image_t_decode_cleanup(&t);
  return true;
}

// What each type ends with: its texts, then the bytes of an image, whose number is the last fixed field.
typedef struct shape {
  int64_t fingerprint;
  size_t fixed; // bytes before the first text
  int texts;
} shape;

// Worlds and commands of 5 against 5 have types of their own on the channels of 3 against 3's.
static vs_division division_on_wire(vs_channel channel, int64_t fingerprint) {
  bool of_five = channel == VS_CH_CMD ? fingerprint == __vsss_cmd_5v5_t_get_hash()
                                      : (channel == VS_CH_TRUTH || channel == VS_CH_STATE) &&
                                            fingerprint == __vsss_world_5v5_t_get_hash();
  return of_five ? VS_5V5 : VS_3V3;
}

static shape shape_of_five(vs_channel channel) {
  static char empty[] = "";
  if (channel == VS_CH_CMD) {
    vsss_cmd_5v5_t t = {.source = empty};
    return (shape){__vsss_cmd_5v5_t_get_hash(), (size_t)vsss_cmd_5v5_t_encoded_size(&t) - 5, 1};
  }
  vsss_world_5v5_t t = {0};
  return (shape){__vsss_world_5v5_t_get_hash(), (size_t)vsss_world_5v5_t_encoded_size(&t), 0};
}

static shape shape_of(vs_channel channel) {
  static char empty[] = "";
  // An empty text takes five bytes: its length and its end.
  switch (channel) {
  case VS_CH_CMD: {
    vsss_cmd_t t = {.source = empty};
    return (shape){__vsss_cmd_t_get_hash(), (size_t)vsss_cmd_t_encoded_size(&t) - 5, 1};
  }
  case VS_CH_REFEREE: {
    vsss_referee_t t = {.text = empty};
    return (shape){__vsss_referee_t_get_hash(), (size_t)vsss_referee_t_encoded_size(&t) - 5, 1};
  }
  case VS_CH_POLICY: {
    vsss_policy_t t = {.player = empty};
    return (shape){__vsss_policy_t_get_hash(), (size_t)vsss_policy_t_encoded_size(&t) - 5, 1};
  }
  case VS_CH_RADIO: {
    vsss_radio_t t = {.device = empty};
    return (shape){__vsss_radio_t_get_hash(), (size_t)vsss_radio_t_encoded_size(&t) - 5, 1};
  }
  case VS_CH_STATS: {
    vsss_stats_t t = {0};
    for (int i = 0; i < VS_STATS_STAGES; i++) t.stage_name[i] = empty;
    return (shape){__vsss_stats_t_get_hash(), (size_t)vsss_stats_t_encoded_size(&t) - 5 * VS_STATS_STAGES,
                   VS_STATS_STAGES};
  }
  case VS_CH_IMAGE: {
    vsss_image_t t = {.format = empty};
    return (shape){__vsss_image_t_get_hash(), (size_t)vsss_image_t_encoded_size(&t) - 5, 1};
  }
  case VS_CH_DETECTIONS: {
    vsss_detections_t t = {0};
    return (shape){__vsss_detections_t_get_hash(), (size_t)vsss_detections_t_encoded_size(&t), 0};
  }
  default: {
    vsss_world_t t = {0};
    return (shape){__vsss_world_t_get_hash(), (size_t)vsss_world_t_encoded_size(&t), 0};
  }
  }
}

static int64_t big_endian(const uint8_t *p, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; i++) value = value << 8 | p[i];
  return bytes == 4 ? (int64_t)(int32_t)(uint32_t)value : (int64_t)value;
}

static bool tail_ok(vs_channel channel, const shape *s, const uint8_t *data, size_t size) {
  size_t at = s->fixed;
  for (int i = 0; i < s->texts; i++) {
    if (size < at + 5) return false;
    int64_t length = big_endian(data + at, 4);
    if (length < 1 || (size_t)length > size - at - 4 || data[at + 4 + (size_t)length - 1] != 0) return false;
    at += 4 + (size_t)length;
  }
  int64_t bytes = channel == VS_CH_IMAGE ? big_endian(data + s->fixed - 4, 4) : 0;
  return bytes >= 0 && size - at == (size_t)bytes;
}

vs_status vs_message_decode(vs_channel channel, const uint8_t *data, size_t size, vs_message *out,
                            uint8_t *image_buffer, vs_error *err) {
  if ((unsigned)channel >= VS_CHANNELS) return vs_fail(err, VS_FAIL, "no channel of vsss");
  vs_division division = size < 8 ? VS_3V3 : division_on_wire(channel, big_endian(data, 8));
  shape s = division == VS_5V5 ? shape_of_five(channel) : shape_of(channel);
  if (size < 8 || big_endian(data, 8) != s.fingerprint)
    return vs_fail(err, VS_FAIL, "%s: a message of another version of the types in lcm_types",
                   vs_channel_name(channel));
  if (size < s.fixed || size > (size_t)1 << 30 || !tail_ok(channel, &s, data, size))
    return vs_fail(err, VS_FAIL, "%s: a damaged message of %zu bytes", vs_channel_name(channel), size);
  out->channel = channel;
  int n = (int)size;
  bool ok = false;
  switch (channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE: ok = decode_world(data, n, out, division); break;
  case VS_CH_CMD: ok = decode_cmd(data, n, out, division); break;
  case VS_CH_REFEREE: ok = decode_referee(data, n, out); break;
  case VS_CH_POLICY: ok = decode_policy(data, n, out); break;
  case VS_CH_DETECTIONS: ok = decode_detections(data, n, out); break;
  case VS_CH_RADIO: ok = decode_radio(data, n, out); break;
  case VS_CH_STATS: ok = decode_stats(data, n, out); break;
  case VS_CH_IMAGE: ok = decode_image(data, n, out, image_buffer); break;
  case VS_CHANNELS: break;
  }
  return ok ? VS_OK : vs_fail(err, VS_FAIL, "%s: a damaged message of %zu bytes", vs_channel_name(channel), size);
}
