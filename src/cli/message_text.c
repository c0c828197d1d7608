#include "message_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// Text that grows to the end of its buffer and is cut there.
typedef struct text {
  char *at;
  size_t left;
} text;

static void add(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(text *t, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = vsnprintf(t->at, t->left, format, list);
  va_end(list);
  if (n < 0 || t->left == 0) return;
  size_t used = (size_t)n < t->left ? (size_t)n : t->left - 1;
  t->at += used;
  t->left -= used;
}

void vs_event_text(const vs_event *event, char *out, size_t size) {
  text t = {out, size};
  add(&t, "%s", vs_event_name(event->kind));
  if (event->kind == VS_EVENT_GOAL)
    add(&t, " by %s", vs_team_name(event->team));
  else if (event->kind == VS_EVENT_PENALTY || event->kind == VS_EVENT_KICK_OFF || event->kind == VS_EVENT_FREE_KICK)
    add(&t, " for %s", vs_team_name(event->team));
  else if (event->kind == VS_EVENT_EXTRA_TIME)
    add(&t, ", kick-off for %s", vs_team_name(event->team));
  else if (event->kind == VS_EVENT_SHOOT_OUT)
    add(&t, ", kick of %s", vs_team_name(event->team));
  else if (event->kind == VS_EVENT_SENT_OFF)
    add(&t, ": a robot of %s, for standing idle", vs_team_name(event->team));
  else if (event->kind == VS_EVENT_GOAL_KICK)
    add(&t, " for %s in quadrant %d", vs_team_name(event->team), event->quadrant);
  else if (event->kind == VS_EVENT_FREE_BALL && event->quadrant == 0)
    add(&t, " in the middle");
  else if (event->kind == VS_EVENT_FREE_BALL)
    add(&t, " in quadrant %d", event->quadrant);
}

static void world_text(const vs_msg_world *m, text *t) {
  const vs_world *w = &m->world;
  add(t, "clock %.1f  score %d:%d  ", m->game.time_s, m->game.score[0], m->game.score[1]);
  if (w->ball.valid)
    add(t, "ball %+.3f %+.3f", w->ball.x_m, w->ball.y_m);
  else
    add(t, "ball lost");
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0, n = vs_team_size(w); i < n; i++) {
      const vs_robot *r = &w->robot[team][i];
      add(t, "  %c%d", team == VS_BLUE ? 'b' : 'y', i);
      if (r->valid)
        add(t, " %+.3f %+.3f %+.0f deg", r->pose.x_m, r->pose.y_m, r->pose.theta_rad * (180.0 / M_PI));
      else
        add(t, " lost");
    }
}

static void detections_text(const vs_msg_detections *d, text *t) {
  add(t, "%dx%d  %d tags", d->width_px, d->height_px, d->n_tags);
  for (int i = 0; i < d->n_tags; i++)
    add(t, "  #%d %.1f %.1f px margin %.0f", d->tag[i].id, d->tag[i].centre_px[0], d->tag[i].centre_px[1],
        d->tag[i].margin);
  for (int i = 0; i < d->n_blobs; i++)
    add(t, "  %s %.1f %.1f px area %.0f", d->blob[i].kind == VS_BLOB_BALL ? "ball" : "opponent",
        d->blob[i].centre_px[0], d->blob[i].centre_px[1], d->blob[i].area_px);
}

static void radio_text(const vs_msg_radio *r, text *t) {
  add(t, "%s %s%s  sent %lld dropped %lld received %lld bad %lld reopened %lld", r->device, r->up ? "up" : "away",
      r->stopping ? ", stopping" : "", (long long)r->sent_frames, (long long)r->dropped_frames,
      (long long)r->received_frames, (long long)r->bad_frames, (long long)r->reopened);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (r->robot[i].age_us < 0)
      add(t, "  robot %d silent", r->robot[i].id);
    else
      add(t, "  robot %d %.2f V %d dBm %.1f ms", r->robot[i].id, r->robot[i].battery_v, r->robot[i].rssi_dbm,
          (double)r->robot[i].round_trip_us * 1e-3);
  }
}

static void stats_text(const vs_msg_stats *s, text *t) {
  add(t, "frames %lld (lost %lld)  decisions %lld (missed %lld)", (long long)s->frames, (long long)s->dropped_frames,
      (long long)s->decisions, (long long)s->missed_ticks);
  for (int i = 0; i < s->n_stages; i++)
    add(t, "  %s p50 %.0f p99 %.0f us", s->stage[i].name, s->stage[i].p50_us, s->stage[i].p99_us);
}

void vs_message_text(const vs_message *m, char *out, size_t size) {
  text t = {out, size};
  if (size) out[0] = '\0';
  switch (m->channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE: world_text(&m->as.world, &t); break;
  case VS_CH_CMD:
    add(&t, "%s %s%s", vs_team_name(m->as.cmd.team), m->as.cmd.source, m->as.cmd.stop ? "  STOP" : "");
    for (int i = 0; i < vs_pitch_of(m->as.cmd.division)->team_size; i++)
      add(&t, "  %+.1f %+.1f", m->as.cmd.wheels[i].left_radps, m->as.cmd.wheels[i].right_radps);
    add(&t, " rad/s");
    break;
  case VS_CH_REFEREE: {
    char event[64];
    vs_event_text(&m->as.referee.event, event, sizeof event);
    add(&t, "%s at %.1f s, score %d:%d", event, m->as.referee.event.time_s, m->as.referee.score[0],
        m->as.referee.score[1]);
    break;
  }
  case VS_CH_POLICY:
    add(&t, "%s %s ", vs_team_name(m->as.policy.team), m->as.policy.player);
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      add(&t, " %+.2f %+.2f", (double)m->as.policy.action[i][0], (double)m->as.policy.action[i][1]);
    break;
  case VS_CH_DETECTIONS: detections_text(&m->as.detections, &t); break;
  case VS_CH_RADIO: radio_text(&m->as.radio, &t); break;
  case VS_CH_STATS: stats_text(&m->as.stats, &t); break;
  case VS_CH_IMAGE:
    add(&t, "%dx%d %s %d bytes", m->as.image.width_px, m->as.image.height_px, m->as.image.format, m->as.image.size);
    break;
  case VS_CHANNELS: break;
  }
}

void vs_text_clean(char *text) {
  for (unsigned char *c = (unsigned char *)text; *c; c++) {
    if (c[0] == 0xC2 && c[1] >= 0x80 && c[1] < 0xA0) c[0] = '?', c[1] = '?'; // U+0080 to U+009F
    if (*c < 0x20 || *c == 0x7F) *c = '?';
    // A byte of 0x80 to 0x9F on its own is a control character to terminals of one byte per character.
    bool continues = (char *)c > text && c[-1] >= 0x80;
    if (*c >= 0x80 && *c < 0xA0 && !continues) *c = '?';
  }
}
