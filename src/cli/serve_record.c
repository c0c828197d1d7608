#include "serve_record.h"

#include <stdio.h>
#include <stdlib.h>

#include "vsss/bus.h"
#include "vsss/clock.h"

struct serve_record {
  vs_bus *bus;
  const char *const *uri;
  int32_t seq[VS_CHANNELS];
  int64_t start_us;
  vs_message message;
};

vs_status serve_record_open(const char *path, const char *const uri[VS_TEAMS], serve_record **out, vs_error *err) {
  char url[480];
  if (snprintf(url, sizeof url, "file://%s?mode=w", path) >= (int)sizeof url)
    return vs_fail(err, VS_USAGE, "--record %.60s...: the path is too long", path);
  serve_record *r = calloc(1, sizeof *r);
  if (!r) return vs_fail(err, VS_FAIL, "out of memory for a record");
  vs_status s = vs_bus_open(url, &r->bus, err);
  if (s != VS_OK) {
    free(r);
    return s;
  }
  r->uri = uri;
  r->start_us = vs_clock_wall_us();
  *out = r;
  return VS_OK;
}

static vs_status put(serve_record *r, vs_channel channel, int64_t time_us, vs_error *err) {
  r->message.channel = channel;
  r->message.utime_us = r->message.utime_capture_us = r->start_us + time_us;
  r->message.seq = r->seq[channel]++;
  return vs_bus_publish(r->bus, &r->message, err);
}

vs_status serve_record_frame(serve_record *r, const vs_hosted *match, const vs_hosted_said *said, vs_error *err) {
  const vs_world *world = vs_hosted_world(match);
  const vs_game *game = vs_hosted_game(match);
  vs_wheels wheels[VS_TEAMS][VS_TEAM_MOST];
  vs_hosted_wheels(match, wheels);
  vs_msg_world *w = &r->message.as.world;
  w->world = *world;
  w->game = *game;
  w->asks_team = -1;
  vs_status s = put(r, VS_CH_TRUTH, world->time_us, err);
  for (int t = 0; t < VS_TEAMS && s == VS_OK; t++) {
    vs_msg_cmd *m = &r->message.as.cmd;
    m->team = (vs_team)t;
    m->division = world->division;
    for (int i = 0; i < VS_TEAM_MOST; i++) m->wheels[i] = wheels[t][i];
    m->stop = false;
    m->state_seq = (int64_t)world->seq - 1;
    snprintf(m->source, sizeof m->source, "%s", r->uri[t]);
    s = put(r, VS_CH_CMD, world->time_us, err);
  }
  if (s != VS_OK || said->event.kind == VS_EVENT_NONE) return s;
  vs_msg_referee *m = &r->message.as.referee;
  m->event = said->event;
  m->duration_s = game->duration_s;
  for (int t = 0; t < VS_TEAMS; t++) m->score[t] = game->score[t];
  return put(r, VS_CH_REFEREE, world->time_us, err);
}

void serve_record_close(serve_record *r) {
  if (!r) return;
  vs_bus_close(r->bus);
  free(r);
}
