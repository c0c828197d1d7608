// vs_message -> bytes of the wire, through the types that lcm-gen made of lcm_types.
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

_Static_assert(VSSS_REFEREE_T_KICK_OFF == VS_EVENT_KICK_OFF && VSSS_REFEREE_T_GOAL == VS_EVENT_GOAL &&
                   VSSS_REFEREE_T_PENALTY == VS_EVENT_PENALTY && VSSS_REFEREE_T_FREE_BALL == VS_EVENT_FREE_BALL &&
                   VSSS_REFEREE_T_GOAL_KICK == VS_EVENT_GOAL_KICK && VSSS_REFEREE_T_HALF_TIME == VS_EVENT_HALF_TIME &&
                   VSSS_REFEREE_T_END == VS_EVENT_END && VSSS_REFEREE_T_HALT == VS_EVENT_HALT,
               "the kinds of referee_t are those of vs_event_kind");

// Every type starts with the same three fields.
#define STAMP(m) .utime = (m)->utime_us, .utime_capture = (m)->utime_capture_us, .seq = (m)->seq

// The arrays of world_t and world_5v5_t, [team][robot].
static void put_robots(const vs_world *w, const vs_wire_robots *to) {
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0; i < to->team_size; i++) {
      const vs_robot *r = &w->robot[team][i];
      int k = team * to->team_size + i;
      to->x_m[k] = r->pose.x_m;
      to->y_m[k] = r->pose.y_m;
      to->theta_rad[k] = r->pose.theta_rad;
      to->vx_mps[k] = r->vx_mps;
      to->vy_mps[k] = r->vy_mps;
      to->omega_radps[k] = r->omega_radps;
      to->left_radps[k] = r->left_radps;
      to->right_radps[k] = r->right_radps;
      to->valid[k] = r->valid;
    }
}

// One body for both types, which differ in the sizes of their arrays alone.
#define ENCODE_WORLD(type, size_of_team)                                                                               \
  do {                                                                                                                 \
    type t = {STAMP(m)};                                                                                               \
    const vs_wire_robots robots = VS_WIRE_ROBOTS(&t, size_of_team);                                                    \
    t.seq = (int32_t)w->seq;                                                                                           \
    t.time_us = w->time_us;                                                                                            \
    put_robots(w, &robots);                                                                                            \
    t.ball_x_m = w->ball.x_m;                                                                                          \
    t.ball_y_m = w->ball.y_m;                                                                                          \
    t.ball_z_m = w->ball.z_m;                                                                                          \
    t.ball_vx_mps = w->ball.vx_mps;                                                                                    \
    t.ball_vy_mps = w->ball.vy_mps;                                                                                    \
    t.ball_vz_mps = w->ball.vz_mps;                                                                                    \
    t.ball_valid = w->ball.valid;                                                                                      \
    t.game_time_s = g->time_s;                                                                                         \
    t.game_duration_s = g->duration_s;                                                                                 \
    for (int team = 0; team < VS_TEAMS; team++) t.score[team] = g->score[team];                                        \
    t.event_kind = (int8_t)g->last_event.kind;                                                                         \
    t.event_team = (int8_t)g->last_event.team;                                                                         \
    t.event_quadrant = (int8_t)g->last_event.quadrant;                                                                 \
    t.event_time_s = g->last_event.time_s;                                                                             \
    t.asks_team = (int8_t)m->as.world.asks_team;                                                                       \
    return type##_encode(out, 0, size, &t);                                                                            \
  } while (0)

static int encode_world(const vs_message *m, uint8_t *out, int size) {
  const vs_world *w = &m->as.world.world;
  const vs_game *g = &m->as.world.game;
  if (w->division == VS_5V5) ENCODE_WORLD(vsss_world_5v5_t, 5);
  ENCODE_WORLD(vsss_world_t, VS_TEAM_SIZE);
}

#define ENCODE_CMD(type, size_of_team)                                                                                 \
  do {                                                                                                                 \
    type t = {STAMP(m)};                                                                                               \
    t.state_seq = (int32_t)c->state_seq;                                                                               \
    t.team = (int8_t)c->team;                                                                                          \
    for (int i = 0; i < (size_of_team); i++) {                                                                         \
      t.left_radps[i] = c->wheels[i].left_radps;                                                                       \
      t.right_radps[i] = c->wheels[i].right_radps;                                                                     \
    }                                                                                                                  \
    t.stop = c->stop;                                                                                                  \
    t.source = (char *)c->source;                                                                                      \
    return type##_encode(out, 0, size, &t);                                                                            \
  } while (0)

static int encode_cmd(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_cmd *c = &m->as.cmd;
  if (c->division == VS_5V5) ENCODE_CMD(vsss_cmd_5v5_t, 5);
  ENCODE_CMD(vsss_cmd_t, VS_TEAM_SIZE);
}

static int encode_referee(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_referee *r = &m->as.referee;
  vsss_referee_t t = {STAMP(m)};
  t.kind = (int8_t)r->event.kind;
  t.team = (int8_t)r->event.team;
  t.quadrant = (int8_t)r->event.quadrant;
  t.time_s = r->event.time_s;
  t.duration_s = r->duration_s;
  for (int team = 0; team < VS_TEAMS; team++) t.score[team] = r->score[team];
  t.text = (char *)vs_event_name(r->event.kind);
  return vsss_referee_t_encode(out, 0, size, &t);
}

static int encode_policy(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_policy *p = &m->as.policy;
  vsss_policy_t t = {STAMP(m)};
  t.contract_hash = (int64_t)p->contract_hash;
  t.team = (int8_t)p->team;
  _Static_assert(sizeof t.observation == sizeof p->observation && sizeof t.action == sizeof p->action,
                 "policy_t has the contract's sizes");
  memcpy(t.observation, p->observation, sizeof t.observation);
  memcpy(t.action, p->action, sizeof t.action);
  t.player = (char *)p->player;
  return vsss_policy_t_encode(out, 0, size, &t);
}

static int clip(int n, int max) { return n < 0 ? 0 : n > max ? max : n; }

static int encode_detections(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_detections *d = &m->as.detections;
  vsss_detections_t t = {STAMP(m)};
  t.width_px = d->width_px;
  t.height_px = d->height_px;
  t.n_tags = clip(d->n_tags, VS_BUS_TAGS);
  for (int i = 0; i < t.n_tags; i++) {
    const vs_msg_tag *tag = &d->tag[i];
    t.tag_id[i] = tag->id;
    t.tag_hamming[i] = tag->hamming;
    t.tag_margin[i] = tag->margin;
    memcpy(t.tag_centre_px[i], tag->centre_px, sizeof tag->centre_px);
    memcpy(t.tag_corner_px[i], tag->corner_px, sizeof tag->corner_px);
    t.tag_x_m[i] = tag->pose.x_m;
    t.tag_y_m[i] = tag->pose.y_m;
    t.tag_theta_rad[i] = tag->pose.theta_rad;
  }
  t.n_blobs = clip(d->n_blobs, VS_BUS_BLOBS);
  for (int i = 0; i < t.n_blobs; i++) {
    const vs_msg_blob *blob = &d->blob[i];
    t.blob_kind[i] = (int8_t)blob->kind;
    memcpy(t.blob_centre_px[i], blob->centre_px, sizeof blob->centre_px);
    t.blob_area_px[i] = blob->area_px;
    t.blob_confidence[i] = blob->confidence;
    t.blob_x_m[i] = blob->x_m;
    t.blob_y_m[i] = blob->y_m;
  }
  return vsss_detections_t_encode(out, 0, size, &t);
}

static int encode_radio(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_radio *r = &m->as.radio;
  vsss_radio_t t = {STAMP(m)};
  t.up = r->up;
  t.stopping = r->stopping;
  t.sent_frames = r->sent_frames;
  t.dropped_frames = r->dropped_frames;
  t.reopened = r->reopened;
  t.received_frames = r->received_frames;
  t.bad_frames = r->bad_frames;
  t.command_age_us = r->command_age_us;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_msg_radio_robot *robot = &r->robot[i];
    t.robot_id[i] = robot->id;
    t.robot_age_us[i] = robot->age_us;
    t.robot_round_trip_us[i] = robot->round_trip_us;
    t.robot_left_radps[i] = robot->measured.left_radps;
    t.robot_right_radps[i] = robot->measured.right_radps;
    t.robot_battery_v[i] = robot->battery_v;
    t.robot_rssi_dbm[i] = robot->rssi_dbm;
    t.robot_rx_ok[i] = robot->rx_ok;
    t.robot_rx_bad[i] = robot->rx_bad;
    t.robot_uptime_s[i] = robot->uptime_s;
  }
  t.device = (char *)r->device;
  return vsss_radio_t_encode(out, 0, size, &t);
}

static int encode_stats(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_stats *s = &m->as.stats;
  vsss_stats_t t = {STAMP(m)};
  t.frames = s->frames;
  t.dropped_frames = s->dropped_frames;
  t.decisions = s->decisions;
  t.missed_ticks = s->missed_ticks;
  t.n_stages = clip(s->n_stages, VS_STATS_STAGES);
  for (int i = 0; i < VS_STATS_STAGES; i++) {
    const vs_msg_stage *stage = &s->stage[i];
    t.stage_name[i] = i < t.n_stages ? (char *)stage->name : (char *)"";
    if (i >= t.n_stages) continue;
    t.stage_count[i] = stage->count;
    t.stage_p50_us[i] = stage->p50_us;
    t.stage_p99_us[i] = stage->p99_us;
    t.stage_max_us[i] = stage->max_us;
    memcpy(t.stage_bucket[i], stage->bucket, sizeof t.stage_bucket[i]);
  }
  return vsss_stats_t_encode(out, 0, size, &t);
}

static int encode_image(const vs_message *m, uint8_t *out, int size) {
  const vs_msg_image *image = &m->as.image;
  if (image->size < 0 || image->size > VS_BUS_IMAGE_MAX) return -1;
  vsss_image_t t = {STAMP(m)};
  t.width_px = image->width_px;
  t.height_px = image->height_px;
  t.size = image->size;
  t.format = (char *)image->format;
  t.data = (uint8_t *)image->data;
  return vsss_image_t_encode(out, 0, size, &t);
}

size_t vs_message_encode(const vs_message *message, uint8_t *out, size_t out_size) {
  int size = out_size > VS_MESSAGE_MAX_BYTES ? VS_MESSAGE_MAX_BYTES : (int)out_size, used = -1;
  switch (message->channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE: used = encode_world(message, out, size); break;
  case VS_CH_CMD: used = encode_cmd(message, out, size); break;
  case VS_CH_REFEREE: used = encode_referee(message, out, size); break;
  case VS_CH_POLICY: used = encode_policy(message, out, size); break;
  case VS_CH_DETECTIONS: used = encode_detections(message, out, size); break;
  case VS_CH_RADIO: used = encode_radio(message, out, size); break;
  case VS_CH_STATS: used = encode_stats(message, out, size); break;
  case VS_CH_IMAGE: used = encode_image(message, out, size); break;
  case VS_CHANNELS: break;
  }
  return used > 0 ? (size_t)used : 0;
}
