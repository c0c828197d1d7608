#include "vsss/radio_link.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

vs_status vs_radio_link_init(vs_radio_link *link, const uint8_t id[VS_TEAM_SIZE], vs_error *err) {
  memset(link, 0, sizeof *link);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    for (int j = 0; j < i; j++)
      if (id[i] == id[j]) return vs_fail(err, VS_USAGE, "robots %d and %d have the same radio id %d", j, i, id[i]);
    link->id[i] = id[i];
    link->robot[i].round_trip_us = -1;
  }
  link->command_age_us = -1;
  return VS_OK;
}

void vs_radio_link_set_key(vs_radio_link *link, const vs_radio_key *key, int64_t wall_us) {
  link->decoder.key = *key;
  link->counter = (uint64_t)(wall_us / 1000000) << 16 | (uint64_t)(wall_us % 1000000) * 65536 / 1000000;
}

vs_status vs_radio_link_set_wire(vs_radio_link *link, const vs_wire *wire, vs_error *err) {
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (link->id[i] > wire->max_id)
      return vs_fail(err, VS_USAGE, "robot %d has radio id %d, %s has 0 to %d", i, link->id[i], wire->name,
                     wire->max_id);
  link->wire = wire->encode ? wire : NULL;
  return VS_OK;
}

void vs_radio_link_command(vs_radio_link *link, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t decided_us) {
  link->have_command = true;
  link->stop = stop;
  link->command_us = decided_us;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    link->wheels[i] = wheels[i];
    if (!isfinite(wheels[i].left_radps) || !isfinite(wheels[i].right_radps)) link->stop = true;
  }
}

static size_t write_command(const vs_radio_link *link, uint64_t counter, bool stop, uint8_t *out) {
  static const vs_wheels still[VS_TEAM_SIZE];
  if (link->wire) return link->wire->encode(link->id, stop ? still : link->wheels, out);
  vs_radio_frame frame = {.type = VS_RADIO_COMMAND};
  vs_radio_command *c = &frame.as.command;
  c->seq = (uint8_t)counter;
  c->counter = counter;
  c->flags = stop ? VS_RADIO_FLAG_STOP : 0;
  c->n = VS_TEAM_SIZE;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    c->robot[i].id = link->id[i];
    c->robot[i].left = stop ? 0 : vs_radio_counts(link->wheels[i].left_radps);
    c->robot[i].right = stop ? 0 : vs_radio_counts(link->wheels[i].right_radps);
  }
  return vs_radio_encode_keyed(&frame, &link->decoder.key, out);
}

static size_t emit(vs_radio_link *link, bool stop, int64_t now_us, uint8_t *out) {
  uint64_t counter = link->counter++;
  link->sent_us[(uint8_t)counter] = now_us;
  link->stopping = stop;
  link->command_age_us = link->have_command ? now_us - link->command_us : -1;
  return write_command(link, counter, stop, out);
}

size_t vs_radio_link_due(vs_radio_link *link, int64_t now_us, uint8_t *out) {
  if (now_us < link->next_us) return 0;
  link->next_us += VS_RADIO_PERIOD_US;
  if (link->next_us <= now_us) link->next_us = now_us + VS_RADIO_PERIOD_US;
  bool stop = !link->have_command || link->stop || now_us - link->command_us > VS_RADIO_STALE_US;
  return emit(link, stop, now_us, out);
}

size_t vs_radio_link_stop(vs_radio_link *link, int64_t now_us, uint8_t *out) { return emit(link, true, now_us, out); }

size_t vs_radio_link_last_stop(const vs_radio_link *link, uint8_t ahead, uint8_t *out) {
  return write_command(link, link->counter + ahead, true, out);
}

static void heard(vs_radio_link *link, const vs_radio_telemetry *t, int64_t now_us) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (link->id[i] != t->id) continue;
    vs_radio_robot_state *r = &link->robot[i];
    r->last = *t;
    r->heard = true;
    r->heard_us = now_us;
    int64_t sent = link->sent_us[t->seq_echo];
    // An echo of a frame not sent in this run, or of the same number one round earlier, tells nothing.
    r->round_trip_us = sent && now_us - sent < 128LL * VS_RADIO_PERIOD_US ? now_us - sent : -1;
    return;
  }
  link->foreign++;
}

void vs_radio_link_receive(vs_radio_link *link, const uint8_t *bytes, size_t size, int64_t now_us) {
  if (link->wire) return; // what such a base says is for its own program
  for (size_t i = 0; i < size; i++) {
    vs_radio_frame frame;
    if (vs_radio_decode(&link->decoder, bytes[i], &frame) && frame.type == VS_RADIO_TELEMETRY)
      heard(link, &frame.as.telemetry, now_us);
  }
}

void vs_radio_link_report(const vs_radio_link *link, const char *device, const vs_serial_stats *serial, int64_t now_us,
                          vs_msg_radio *out) {
  memset(out, 0, sizeof *out);
  snprintf(out->device, sizeof out->device, "%s", device);
  out->up = serial->up;
  out->stopping = link->stopping;
  out->sent_frames = serial->sent;
  out->dropped_frames = serial->dropped;
  out->reopened = serial->reopened;
  out->received_frames = link->decoder.ok;
  out->bad_frames = link->decoder.bad;
  out->command_age_us = link->command_age_us;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_radio_robot_state *r = &link->robot[i];
    vs_msg_radio_robot *to = &out->robot[i];
    to->id = link->id[i];
    to->age_us = r->heard ? now_us - r->heard_us : -1;
    to->round_trip_us = r->round_trip_us;
    to->measured = (vs_wheels){vs_radio_radps(r->last.left), vs_radio_radps(r->last.right)};
    to->battery_v = r->last.battery_mv * 1e-3;
    to->uptime_s = r->last.uptime_ms * 1e-3;
    to->rssi_dbm = r->last.rssi_dbm;
    to->rx_ok = r->last.rx_ok;
    to->rx_bad = r->last.rx_bad;
  }
}
