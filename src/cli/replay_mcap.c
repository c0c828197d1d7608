// A log as an MCAP file for Foxglove-like tools: field, robots, ball, commands, score as JSON with schemas.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mcap.h"
#include "mcap_scene.h"
#include "replay.h"
#include "vsss/check.h"
#include "vsss/field.h"

enum { FIELD, ROBOTS, BALL, COMMANDS, SCORE, SCENE, TOPICS };
#define SCENE_NS 33000000 // between two scenes at least: they are long

#define NUMBER             "{\"type\":\"number\"}"
#define NUMBERS            "{\"type\":\"array\",\"items\":{\"type\":\"number\"}}"
#define OBJECT(properties) "{\"type\":\"object\",\"properties\":{" properties "}}"
#define TEAM                                                                                                           \
  "{\"type\":\"array\",\"items\":" OBJECT("\"id\":{\"type\":\"integer\"},\"x_m\":" NUMBER ",\"y_m\":" NUMBER           \
                                          ",\"theta_rad\":" NUMBER ",\"vx_mps\":" NUMBER ",\"vy_mps\":" NUMBER         \
                                          ",\"omega_radps\":" NUMBER) "}"

static const mcap_topic topics[TOPICS] = {
    {"field",
     OBJECT("\"length_m\":" NUMBER ",\"width_m\":" NUMBER ",\"goal_width_m\":" NUMBER ",\"goal_depth_m\":" NUMBER),
     NULL},
    {"robots", OBJECT("\"time_s\":" NUMBER ",\"blue\":" TEAM ",\"yellow\":" TEAM), NULL},
    {"ball",
     OBJECT("\"time_s\":" NUMBER ",\"x_m\":" NUMBER ",\"y_m\":" NUMBER ",\"z_m\":" NUMBER ",\"vx_mps\":" NUMBER
            ",\"vy_mps\":" NUMBER ",\"vz_mps\":" NUMBER),
     NULL},
    {"commands",
     OBJECT("\"team\":{\"type\":\"string\"},\"stop\":{\"type\":\"boolean\"},\"left_radps\":" NUMBERS
            ",\"right_radps\":" NUMBERS),
     NULL},
    {"score",
     OBJECT("\"time_s\":" NUMBER ",\"blue\":{\"type\":\"integer\"},\"yellow\":{\"type\":\"integer\"}"
            ",\"event\":{\"type\":\"string\"}"),
     NULL},
    {"scene", mcap_scene_schema, MCAP_SCENE_SCHEMA_NAME},
};

static int add_robots(char *out, size_t size, const vs_robot robot[VS_TEAM_MOST]) {
  int n = snprintf(out, size, "["), some = 0;
  for (int i = 0; i < VS_TEAM_MOST; i++) { // those that the division has not are not valid
    const vs_robot *r = &robot[i];
    if (!r->valid) continue;
    n += snprintf(out + n, size - (size_t)n,
                  "%s{\"id\":%d,\"x_m\":%.5f,\"y_m\":%.5f,\"theta_rad\":%.5f,\"vx_mps\":%.5f,\"vy_mps\":%.5f,"
                  "\"omega_radps\":%.5f}",
                  some++ ? "," : "", i, r->pose.x_m, r->pose.y_m, r->pose.theta_rad, r->vx_mps, r->vy_mps,
                  r->omega_radps);
  }
  return n + snprintf(out + n, size - (size_t)n, "]");
}

static void put_scene(mcap_file *f, uint64_t ns, const vs_world *w, uint64_t *before_ns) {
  char json[MCAP_SCENE_JSON_MAX];
  bool first = f->messages[SCENE] == 0;
  if (!first && ns >= *before_ns && ns - *before_ns < SCENE_NS) return;
  *before_ns = ns;
  mcap_scene(w, ns, first, json);
  mcap_message(f, SCENE, ns, json);
}

// A world with a number that is none, as in a damaged log, has no JSON.
static void put_world(mcap_file *f, uint64_t ns, const vs_msg_world *m, uint64_t *scene_ns) {
  char json[3072];
  if (!vs_world_ok(&m->world) || !isfinite(m->game.time_s)) return;
  put_scene(f, ns, &m->world, scene_ns);
  const vs_ball *b = &m->world.ball;
  double time_s = m->game.time_s;
  int n = snprintf(json, sizeof json, "{\"time_s\":%.4f,\"blue\":", time_s);
  n += add_robots(json + n, sizeof json - (size_t)n, m->world.robot[VS_BLUE]);
  n += snprintf(json + n, sizeof json - (size_t)n, ",\"yellow\":");
  n += add_robots(json + n, sizeof json - (size_t)n, m->world.robot[VS_YELLOW]);
  snprintf(json + n, sizeof json - (size_t)n, "}");
  mcap_message(f, ROBOTS, ns, json);
  if (!b->valid) return;
  snprintf(json, sizeof json,
           "{\"time_s\":%.4f,\"x_m\":%.5f,\"y_m\":%.5f,\"z_m\":%.5f,\"vx_mps\":%.5f,\"vy_mps\":%.5f,\"vz_mps\":%.5f}",
           time_s, b->x_m, b->y_m, b->z_m, b->vx_mps, b->vy_mps, b->vz_mps);
  mcap_message(f, BALL, ns, json);
}

static void put_score(mcap_file *f, uint64_t ns, double time_s, const int score[VS_TEAMS], vs_event_kind event) {
  char json[256];
  if (!isfinite(time_s)) return;
  snprintf(json, sizeof json, "{\"time_s\":%.4f,\"blue\":%d,\"yellow\":%d,\"event\":\"%s\"}", time_s, score[VS_BLUE],
           score[VS_YELLOW], vs_event_name(event));
  mcap_message(f, SCORE, ns, json);
}

static void put_command(mcap_file *f, uint64_t ns, const vs_msg_cmd *m) {
  char json[512];
  const int robots = vs_pitch_of(m->division)->team_size;
  if (!vs_all_finite(&m->wheels[0].left_radps, 2 * VS_TEAM_MOST)) return;
  int n =
      snprintf(json, sizeof json, "{\"team\":\"%s\",\"stop\":%s", vs_team_name(m->team), m->stop ? "true" : "false");
  for (int side = 0; side < 2; side++) {
    n += snprintf(json + n, sizeof json - (size_t)n, ",\"%s_radps\":[", side == 0 ? "left" : "right");
    for (int i = 0; i < robots; i++)
      n += snprintf(json + n, sizeof json - (size_t)n, "%s%.4f", i ? "," : "",
                    side == 0 ? m->wheels[i].left_radps : m->wheels[i].right_radps);
    n += snprintf(json + n, sizeof json - (size_t)n, "]");
  }
  snprintf(json + n, sizeof json - (size_t)n, "}");
  mcap_message(f, COMMANDS, ns, json);
}

static void put_field(mcap_file *f, uint64_t ns, const vs_pitch *pitch) {
  char json[256];
  snprintf(json, sizeof json, "{\"length_m\":%.3f,\"width_m\":%.3f,\"goal_width_m\":%.3f,\"goal_depth_m\":%.3f}",
           2 * pitch->half_length_m, 2 * pitch->half_width_m, 2 * pitch->goal_half_width_m, pitch->goal_depth_m);
  mcap_message(f, FIELD, ns, json);
}

static void put_message(mcap_file *f, uint64_t ns, const vs_message *m, uint64_t *scene_ns) {
  switch (m->channel) {
  case VS_CH_CMD: put_command(f, ns, &m->as.cmd); return;
  case VS_CH_REFEREE:
    put_score(f, ns, m->as.referee.event.time_s, m->as.referee.score, m->as.referee.event.kind);
    return;
  default: put_world(f, ns, &m->as.world, scene_ns);
  }
}

static vs_status convert(vs_bus_log *log, vs_channel world, vs_division division, mcap_file *f, vs_error *err) {
  vs_message *m = malloc(sizeof *m);
  if (!m) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = VS_OK;
  uint64_t scene_ns = 0;
  vs_bus_log_rewind(log);
  while (s == VS_OK && !vs_cli_interrupted()) {
    vs_log_event event;
    bool end;
    vs_channel channel;
    s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) break;
    if (!vs_channel_parse(event.channel, &channel) || strcmp(vs_channel_name(channel), event.channel) != 0) continue;
    if (channel != world && channel != VS_CH_CMD && channel != VS_CH_REFEREE) continue;
    if (vs_message_decode(channel, event.data, event.size, m, NULL, NULL) != VS_OK) continue;
    // When it was, not when it was written: a match played faster than real time is watched at its own pace.
    int64_t utime_us = m->utime_us > 0 ? m->utime_us : event.utime_us;
    uint64_t ns = utime_us > 0 ? 1000 * (uint64_t)utime_us : 0;
    if (f->messages[FIELD] == 0) put_field(f, ns, vs_pitch_of(division));
    put_message(f, ns, m, &scene_ns);
  }
  free(m);
  return s;
}

vs_status replay_mcap(vs_bus_log *log, const replay_summary *summary, const char *path, vs_error *err) {
  if (!summary->have_truth && !summary->have_state)
    return vs_fail(err, VS_FAIL, "the log has neither VSSS_TRUTH nor VSSS_STATE: there is no world to export");
  mcap_file f;
  vs_status s = mcap_open(path, topics, TOPICS, &f, err);
  if (s != VS_OK) return s;
  s = convert(log, summary->have_truth ? VS_CH_TRUTH : VS_CH_STATE, summary->division, &f, err);
  vs_status closed = mcap_close(&f, s == VS_OK ? err : NULL);
  if (s == VS_OK) s = closed;
  if (s == VS_OK)
    printf("%s: %llu worlds, %llu commands, %llu events\n", path, (unsigned long long)f.messages[ROBOTS],
           (unsigned long long)f.messages[COMMANDS], (unsigned long long)f.messages[SCORE]);
  return s;
}
