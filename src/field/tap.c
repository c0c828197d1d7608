#include "tap.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vsss/clock.h"

#define RADIO_PERIOD_US 200000
#define STATS_PERIOD_US 1000000

static void referee_spoke(const vs_message *message, void *user) {
  vs_tap *tap = user;
  tap->heard = message->as.referee;
  if (tap->record) {
    tap->message = *message;
    vs_bus_publish(tap->record, &tap->message, NULL);
  }
  tap->heard_us = vs_clock_monotonic_us();
  tap->news = true;
}

static void add_note(char *note, size_t size, const char *what, const vs_error *why) {
  if (!note || !size) return;
  size_t used = strlen(note);
  snprintf(note + used, size - used, "playing on without %s: %s\n", what, why->text);
}

vs_status vs_tap_open(vs_tap *tap, const vs_field_def *def, const vs_calib *calib, char *note, size_t note_size,
                      vs_error *err) {
  memset(tap, 0, sizeof *tap);
  tap->team = def->team;
  tap->policy = def->policy;
  tap->radio = def->radio ? def->radio : "none";
  tap->calib = *calib;
  tap->tag_height_m = def->tracker.tag_height_m;
  tap->patch_height_m = def->tracker.patch_height_m;
  tap->ball_height_m = def->tracker.ball_height_m;
  if (!def->lcm) return VS_OK;
  vs_error why = {0};
  vs_status s = vs_bus_open(def->lcm_url, &tap->bus, &why);
  if (s == VS_OK)
    s = def->lcm_remote ? vs_bus_subscribe(tap->bus, VS_CH_REFEREE, false, referee_spoke, tap, &why)
                        : vs_bus_subscribe_near(tap->bus, VS_CH_REFEREE, referee_spoke, tap, &why);
  if (s == VS_OK) {
    if (def->image_hz > 0.0 && vs_pictures_new(tap->bus, def->image_hz, &tap->pictures, &why) != VS_OK)
      add_note(note, note_size, "pictures on LCM", &why);
    return VS_OK;
  }
  vs_tap_close(tap);
  if (def->lcm_url) return vs_fail(err, s, "%s", why.text);
  add_note(note, note_size, "LCM", &why);
  return VS_OK;
}

void vs_tap_close(vs_tap *tap) {
  vs_pictures_free(tap->pictures);
  tap->pictures = NULL;
  vs_bus_close(tap->bus);
  tap->bus = NULL;
}

bool vs_tap_listen(vs_tap *tap) {
  if (!tap->bus) return false;
  vs_bus_handle(tap->bus, 0, NULL, NULL);
  bool news = tap->news;
  tap->news = false;
  return news;
}

static int64_t epoch_us(int64_t monotonic_us) { return monotonic_us + vs_clock_wall_us() - vs_clock_monotonic_us(); }

static void send(vs_tap *tap, vs_channel channel, int64_t capture_us) {
  vs_message *m = &tap->message;
  m->channel = channel;
  m->utime_us = 0;
  m->utime_capture_us = epoch_us(capture_us);
  m->seq = tap->seq[channel]++;
  if (tap->bus && vs_bus_publish(tap->bus, m, NULL) != VS_OK) tap->lost++;
  if (tap->record) vs_bus_publish(tap->record, m, NULL); // what cannot be written is counted with the turns
}

static void put_tag(const vs_tap *tap, const vs_tag *from, vs_msg_tag *to) {
  to->id = from->id;
  to->hamming = from->hamming;
  to->margin = from->margin;
  memcpy(to->centre_px, from->centre_px, sizeof to->centre_px);
  memcpy(to->corner_px, from->corner_px, sizeof to->corner_px);
  double x[4], y[4];
  for (int i = 0; i < 4; i++)
    vs_calib_to_field(&tap->calib, from->corner_px[i][0], from->corner_px[i][1], tap->tag_height_m, &x[i], &y[i]);
  to->pose.x_m = (x[0] + x[1] + x[2] + x[3]) / 4;
  to->pose.y_m = (y[0] + y[1] + y[2] + y[3]) / 4;
  to->pose.theta_rad = atan2(y[3] + y[2] - y[0] - y[1], x[3] + x[2] - x[0] - x[1]);
}

static void put_blobs(const vs_tap *tap, vs_msg_detections *m, vs_blob_kind kind, const vs_blob *blob, int n,
                      double height_m) {
  for (int i = 0; i < n && m->n_blobs < VS_BUS_BLOBS; i++) {
    vs_msg_blob *to = &m->blob[m->n_blobs++];
    *to = (vs_msg_blob){kind, {blob[i].x_px, blob[i].y_px}, blob[i].area_px, blob[i].confidence, 0, 0};
    vs_calib_to_field(&tap->calib, blob[i].x_px, blob[i].y_px, height_m, &to->x_m, &to->y_m);
  }
}

void vs_tap_frame(vs_tap *tap, const vs_world *world, const vs_game *game, const vs_detections *seen, int width_px,
                  int height_px) {
  if (!tap->bus && !tap->record) return;
  tap->message.as.world = (vs_msg_world){.world = *world, .game = *game, .asks_team = -1};
  send(tap, VS_CH_STATE, world->time_us);

  vs_msg_detections *m = &tap->message.as.detections;
  m->width_px = width_px;
  m->height_px = height_px;
  m->n_tags = seen->tags < VS_BUS_TAGS ? seen->tags : VS_BUS_TAGS;
  for (int i = 0; i < m->n_tags; i++) put_tag(tap, &seen->tag[i], &m->tag[i]);
  m->n_blobs = 0;
  put_blobs(tap, m, VS_BLOB_BALL, seen->ball, seen->balls, tap->ball_height_m);
  put_blobs(tap, m, VS_BLOB_OPPONENT, seen->adversary, seen->adversaries, tap->patch_height_m);
  send(tap, VS_CH_DETECTIONS, seen->capture_us);
}

void vs_tap_command(vs_tap *tap, const vs_world *world, const vs_wheels wheels[VS_TEAM_SIZE], bool stop) {
  if (!tap->bus && !tap->record) return;
  vs_msg_cmd *cmd = &tap->message.as.cmd;
  cmd->team = tap->team;
  cmd->division = VS_3V3;
  memcpy(cmd->wheels, wheels, VS_TEAM_SIZE * sizeof *cmd->wheels);
  cmd->stop = stop;
  cmd->state_seq = world->seq;
  snprintf(cmd->source, sizeof cmd->source, "%s", tap->policy);
  send(tap, VS_CH_CMD, world->time_us);
}

void vs_tap_decision(vs_tap *tap, const vs_control *control, const vs_world *world) {
  if (!tap->bus && !tap->record) return;
  vs_msg_policy *m = &tap->message.as.policy;
  m->team = tap->team;
  m->contract_hash = vs_contract_hash();
  vs_observer_write(vs_control_observer(control), &m->observation[0][0]);
  memcpy(m->action, vs_control_action(control), sizeof m->action);
  snprintf(m->player, sizeof m->player, "%s", tap->policy);
  send(tap, VS_CH_POLICY, world->time_us);
}

void vs_tap_picture(vs_tap *tap, const vs_frame *frame) {
  if (tap->pictures) vs_pictures_show(tap->pictures, frame, epoch_us(frame->capture_us));
}

static void send_radio(vs_tap *tap, const vs_field_stats *all, const vs_radio_link *link, int64_t now_us) {
  vs_radio_link_report(link, tap->radio, &all->serial, now_us, &tap->message.as.radio);
  int64_t newest_us = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (link->robot[i].heard && link->robot[i].heard_us > newest_us) newest_us = link->robot[i].heard_us;
  send(tap, VS_CH_RADIO, newest_us ? newest_us : now_us);
}

// From buckets of 5 % to powers of two.
static void put_stage(const char *name, const vs_histogram *h, vs_msg_stage *to) {
  memset(to, 0, sizeof *to);
  snprintf(to->name, sizeof to->name, "%s", name);
  to->count = (int64_t)h->count;
  to->p50_us = vs_histogram_quantile_us(h, 0.5);
  to->p99_us = vs_histogram_quantile_us(h, 0.99);
  to->max_us = (double)h->max_us;
  for (int k = 0; k < VS_HISTOGRAM_BUCKETS; k++) {
    if (!h->bucket[k]) continue;
    int power = k < 1 ? 0 : (int)log2(vs_histogram_bound_us(k) * 1.0247); // by the bucket's middle
    if (power >= VS_STATS_BUCKETS) power = VS_STATS_BUCKETS - 1;
    to->bucket[power] += (int32_t)h->bucket[k];
  }
}

static void send_stats(vs_tap *tap, const vs_field_stats *all, const vs_histogram second[VS_STAGES], int64_t now_us) {
  vs_msg_stats *m = &tap->message.as.stats;
  *m = (vs_msg_stats){.frames = all->frames,
                      .dropped_frames = all->dropped,
                      .decisions = all->decisions,
                      .missed_ticks = all->missed_ticks,
                      .n_stages = VS_STAGES};
  for (int i = 0; i < VS_STAGES; i++) put_stage(vs_stage_name((vs_stage)i), &second[i], &m->stage[i]);
  send(tap, VS_CH_STATS, now_us - STATS_PERIOD_US);
}

void vs_tap_slow(vs_tap *tap, const vs_field_stats *all, const vs_radio_link *link, vs_histogram second[VS_STAGES]) {
  int64_t now_us = vs_clock_monotonic_us();
  if ((tap->bus || tap->record) && now_us - tap->radio_us >= RADIO_PERIOD_US) {
    tap->radio_us = now_us;
    send_radio(tap, all, link, now_us);
  }
  if (now_us - tap->stats_us < STATS_PERIOD_US) return;
  tap->stats_us = now_us;
  if (tap->bus || tap->record) send_stats(tap, all, second, now_us);
  memset(second, 0, VS_STAGES * sizeof *second);
}

int64_t vs_tap_lost(const vs_tap *tap) { return tap->lost + vs_pictures_lost(tap->pictures); }
