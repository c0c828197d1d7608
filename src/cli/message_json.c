#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "json_text.h"
#include "message_text.h"

typedef struct json {
  char *at;
  size_t left;
  bool first; // no comma before the next member
} json;

static void raw(json *j, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void raw(json *j, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(j->at, j->left, format, list);
  va_end(list);
  if (n < 0 || j->left == 0) return;
  size_t used = (size_t)n < j->left ? (size_t)n : j->left - 1;
  j->at += used;
  j->left -= used;
}

static void name(json *j, const char *key) {
  raw(j, j->first ? "" : ", ");
  if (key) raw(j, "\"%s\": ", key);
  j->first = false;
}

static void open(json *j, const char *key, char bracket) {
  name(j, key);
  raw(j, "%c", bracket);
  j->first = true;
}

static void close(json *j, char bracket) {
  raw(j, "%c", bracket);
  j->first = false;
}

static void number(json *j, const char *key, double value) {
  name(j, key);
  if (isfinite(value))
    raw(j, "%.9g", value);
  else
    raw(j, "null");
}

static void whole(json *j, const char *key, int64_t value) {
  name(j, key);
  raw(j, "%lld", (long long)value);
}

static void boolean(json *j, const char *key, bool value) {
  name(j, key);
  raw(j, value ? "true" : "false");
}

static void quote(json *j, const char *text) {
  char piece[8];
  raw(j, "\"");
  for (vs_json_next(&text, piece); piece[0]; vs_json_next(&text, piece)) raw(j, "%s", piece);
  raw(j, "\"");
}

static void string(json *j, const char *key, const char *value) {
  name(j, key);
  quote(j, value);
}

static void pair(json *j, const char *key, double a, double b) {
  open(j, key, '[');
  number(j, NULL, a);
  number(j, NULL, b);
  close(j, ']');
}

static void event(json *j, const vs_event *e) {
  string(j, "event", vs_event_name(e->kind));
  string(j, "event_team", vs_team_name(e->team));
  whole(j, "event_quadrant", e->quadrant);
  number(j, "event_time_s", e->time_s);
}

static void world(json *j, const vs_msg_world *m) {
  const vs_world *w = &m->world;
  whole(j, "time_us", w->time_us);
  open(j, "ball", '{');
  boolean(j, "valid", w->ball.valid);
  number(j, "x_m", w->ball.x_m);
  number(j, "y_m", w->ball.y_m);
  number(j, "z_m", w->ball.z_m);
  number(j, "vx_mps", w->ball.vx_mps);
  number(j, "vy_mps", w->ball.vy_mps);
  number(j, "vz_mps", w->ball.vz_mps);
  close(j, '}');
  for (int team = 0; team < VS_TEAMS; team++) {
    open(j, vs_team_name((vs_team)team), '[');
    for (int i = 0, n = vs_team_size(w); i < n; i++) {
      const vs_robot *r = &w->robot[team][i];
      open(j, NULL, '{');
      boolean(j, "valid", r->valid);
      number(j, "x_m", r->pose.x_m);
      number(j, "y_m", r->pose.y_m);
      number(j, "theta_rad", r->pose.theta_rad);
      number(j, "vx_mps", r->vx_mps);
      number(j, "vy_mps", r->vy_mps);
      number(j, "omega_radps", r->omega_radps);
      number(j, "left_radps", r->left_radps);
      number(j, "right_radps", r->right_radps);
      close(j, '}');
    }
    close(j, ']');
  }
  number(j, "game_time_s", m->game.time_s);
  number(j, "game_duration_s", m->game.duration_s);
  pair(j, "score", m->game.score[0], m->game.score[1]);
  event(j, &m->game.last_event);
  whole(j, "asks_team", m->asks_team);
}

static void cmd(json *j, const vs_msg_cmd *c) {
  string(j, "team", vs_team_name(c->team));
  string(j, "source", c->source);
  boolean(j, "stop", c->stop);
  whole(j, "state_seq", c->state_seq);
  open(j, "wheels_radps", '[');
  for (int i = 0; i < vs_pitch_of(c->division)->team_size; i++)
    pair(j, NULL, c->wheels[i].left_radps, c->wheels[i].right_radps);
  close(j, ']');
}

static void policy(json *j, const vs_msg_policy *p) {
  char hash[20];
  snprintf(hash, sizeof hash, "%016llx", (unsigned long long)p->contract_hash);
  string(j, "team", vs_team_name(p->team));
  string(j, "player", p->player);
  string(j, "contract_hash", hash);
  open(j, "action", '[');
  for (int i = 0; i < VS_TEAM_SIZE; i++) pair(j, NULL, (double)p->action[i][0], (double)p->action[i][1]);
  close(j, ']');
  open(j, "observation", '[');
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    open(j, NULL, '[');
    for (int k = 0; k < VS_OBS_SIZE; k++) number(j, NULL, (double)p->observation[i][k]);
    close(j, ']');
  }
  close(j, ']');
}

static void detections(json *j, const vs_msg_detections *d) {
  whole(j, "width_px", d->width_px);
  whole(j, "height_px", d->height_px);
  open(j, "tags", '[');
  for (int i = 0; i < d->n_tags; i++) {
    const vs_msg_tag *tag = &d->tag[i];
    open(j, NULL, '{');
    whole(j, "id", tag->id);
    whole(j, "hamming", tag->hamming);
    number(j, "margin", tag->margin);
    pair(j, "centre_px", tag->centre_px[0], tag->centre_px[1]);
    open(j, "corners_px", '[');
    for (int k = 0; k < 4; k++) pair(j, NULL, tag->corner_px[k][0], tag->corner_px[k][1]);
    close(j, ']');
    number(j, "x_m", tag->pose.x_m);
    number(j, "y_m", tag->pose.y_m);
    number(j, "theta_rad", tag->pose.theta_rad);
    close(j, '}');
  }
  close(j, ']');
  open(j, "blobs", '[');
  for (int i = 0; i < d->n_blobs; i++) {
    const vs_msg_blob *blob = &d->blob[i];
    open(j, NULL, '{');
    string(j, "kind", blob->kind == VS_BLOB_BALL ? "ball" : "opponent");
    pair(j, "centre_px", blob->centre_px[0], blob->centre_px[1]);
    number(j, "area_px", blob->area_px);
    number(j, "confidence", blob->confidence);
    number(j, "x_m", blob->x_m);
    number(j, "y_m", blob->y_m);
    close(j, '}');
  }
  close(j, ']');
}

static void radio(json *j, const vs_msg_radio *r) {
  string(j, "device", r->device);
  boolean(j, "up", r->up);
  boolean(j, "stopping", r->stopping);
  whole(j, "sent_frames", r->sent_frames);
  whole(j, "dropped_frames", r->dropped_frames);
  whole(j, "reopened", r->reopened);
  whole(j, "received_frames", r->received_frames);
  whole(j, "bad_frames", r->bad_frames);
  whole(j, "command_age_us", r->command_age_us);
  open(j, "robots", '[');
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_msg_radio_robot *robot = &r->robot[i];
    open(j, NULL, '{');
    whole(j, "id", robot->id);
    whole(j, "age_us", robot->age_us);
    whole(j, "round_trip_us", robot->round_trip_us);
    pair(j, "measured_radps", robot->measured.left_radps, robot->measured.right_radps);
    number(j, "battery_v", robot->battery_v);
    whole(j, "rssi_dbm", robot->rssi_dbm);
    whole(j, "rx_ok", robot->rx_ok);
    whole(j, "rx_bad", robot->rx_bad);
    number(j, "uptime_s", robot->uptime_s);
    close(j, '}');
  }
  close(j, ']');
}

static void stats(json *j, const vs_msg_stats *s) {
  whole(j, "frames", s->frames);
  whole(j, "dropped_frames", s->dropped_frames);
  whole(j, "decisions", s->decisions);
  whole(j, "missed_ticks", s->missed_ticks);
  open(j, "stages", '[');
  for (int i = 0; i < s->n_stages; i++) {
    const vs_msg_stage *stage = &s->stage[i];
    open(j, NULL, '{');
    string(j, "name", stage->name);
    whole(j, "count", stage->count);
    number(j, "p50_us", stage->p50_us);
    number(j, "p99_us", stage->p99_us);
    number(j, "max_us", stage->max_us);
    open(j, "buckets", '[');
    for (int k = 0; k < VS_STATS_BUCKETS; k++) whole(j, NULL, stage->bucket[k]);
    close(j, ']');
    close(j, '}');
  }
  close(j, ']');
}

void vs_message_json(const vs_message *m, double time_s, char *out, size_t size) {
  json j = {out, size, true};
  open(&j, NULL, '{');
  number(&j, "t_s", time_s);
  string(&j, "channel", vs_channel_name(m->channel));
  whole(&j, "utime_us", m->utime_us);
  whole(&j, "utime_capture_us", m->utime_capture_us);
  whole(&j, "seq", m->seq);
  switch (m->channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE: world(&j, &m->as.world); break;
  case VS_CH_CMD: cmd(&j, &m->as.cmd); break;
  case VS_CH_REFEREE:
    event(&j, &m->as.referee.event);
    number(&j, "game_duration_s", m->as.referee.duration_s);
    pair(&j, "score", m->as.referee.score[0], m->as.referee.score[1]);
    break;
  case VS_CH_POLICY: policy(&j, &m->as.policy); break;
  case VS_CH_DETECTIONS: detections(&j, &m->as.detections); break;
  case VS_CH_RADIO: radio(&j, &m->as.radio); break;
  case VS_CH_STATS: stats(&j, &m->as.stats); break;
  case VS_CH_IMAGE:
    whole(&j, "width_px", m->as.image.width_px);
    whole(&j, "height_px", m->as.image.height_px);
    string(&j, "format", m->as.image.format);
    whole(&j, "size", m->as.image.size);
    break;
  case VS_CHANNELS: break;
  }
  close(&j, '}');
}
