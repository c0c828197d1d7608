#include "motion_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "replay.h"
#include "vsss/geom.h"

typedef struct marks {
  int id[VS_TEAM_SIZE];
  double yaw_rad[VS_TEAM_SIZE];
  vs_team team;
} marks;

static marks marks_of(const vs_field_def *def) {
  const vs_track_def *t = &def->tracker;
  marks m = {.team = def->team};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    m.id[i] = t->own == VS_MARK_ARUCO    ? t->aruco_id[def->team][i]
              : t->own == VS_MARK_COLOUR ? t->plate_id[def->team][i]
                                         : t->tag_id[i];
    m.yaw_rad[i] = t->tag_yaw_rad[i];
  }
  return m;
}

static vs_status find_marks(vs_bus_log *log, const char *path, const char *config, marks *out, vs_error *err) {
  static vs_field_config c;
  vs_status s = config ? VS_FAIL : replay_setup(log, path, &c, NULL); // without one it is a log of lcm-logger
  if (s != VS_OK) s = vs_field_config_load(config, &c, err);
  if (s == VS_OK) *out = marks_of(&c.def);
  return s;
}

static bool grow(vs_motion_log *l) {
  int capacity = l->capacity ? 2 * l->capacity : 4096;
  size_t n = (size_t)capacity;
  bool ok = true;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_motion_robot *r = &l->robot[i];
    void *command = realloc(r->command, n * sizeof *r->command), *sight = realloc(r->sight, n * sizeof *r->sight);
    if (command) r->command = command;
    if (sight) r->sight = sight;
    ok = ok && command && sight;
  }
  void *age = realloc(l->age_ms, n * sizeof *l->age_ms);
  if (age) l->age_ms = age;
  l->capacity = capacity;
  return ok && age;
}

static void take_command(vs_motion_log *l, const vs_message *m) {
  if (m->as.cmd.team != l->team) return;
  l->age_ms[l->ages++] = 1e-3 * (double)(m->utime_us - m->utime_capture_us);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_motion_robot *r = &l->robot[i];
    vs_wheels w = m->as.cmd.stop ? (vs_wheels){0, 0} : m->as.cmd.wheels[i];
    const vs_motion_command *last = r->commands ? &r->command[r->commands - 1] : NULL;
    bool same = last && last->wheels.left_radps == w.left_radps && last->wheels.right_radps == w.right_radps;
    if (!same && (!last || m->utime_us >= last->time_us))
      r->command[r->commands++] = (vs_motion_command){m->utime_us, w};
  }
}

static void take_sight(vs_motion_log *l, const marks *own, const vs_message *m) {
  const vs_msg_detections *d = &m->as.detections;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_motion_robot *r = &l->robot[i];
    bool newer = !r->sights || m->utime_capture_us > r->sight[r->sights - 1].time_us;
    for (int k = 0; k < d->n_tags && newer; k++) {
      if (d->tag[k].id != own->id[i]) continue;
      vs_pose pose = d->tag[k].pose;
      pose.theta_rad = vs_wrap_rad(pose.theta_rad - own->yaw_rad[i]);
      r->sight[r->sights++] = (vs_motion_sight){m->utime_capture_us, pose};
      break;
    }
  }
}

static bool full(const vs_motion_log *l) {
  bool any = l->ages + 1 >= l->capacity;
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    any = any || l->robot[i].commands + 1 >= l->capacity || l->robot[i].sights + 1 >= l->capacity;
  return any;
}

static vs_status read_all(vs_bus_log *log, const marks *own, vs_motion_log *out, vs_error *err) {
  static vs_message m;
  vs_bus_log_rewind(log);
  for (bool end = false;;) {
    vs_log_event event;
    vs_status s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) return s;
    bool command = !strcmp(event.channel, vs_channel_name(VS_CH_CMD));
    bool sight = !strcmp(event.channel, vs_channel_name(VS_CH_DETECTIONS));
    if (!command && !sight) continue;
    if (vs_message_decode(command ? VS_CH_CMD : VS_CH_DETECTIONS, event.data, event.size, &m, NULL, NULL) != VS_OK)
      continue;
    if (full(out) && !grow(out)) return vs_fail(err, VS_FAIL, "out of memory");
    if (command)
      take_command(out, &m);
    else
      take_sight(out, own, &m);
  }
}

vs_status vs_motion_log_read(const vs_flag_list *words, const char *config, vs_motion_log *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  if (words->count != 1) return vs_fail(err, VS_USAGE, "expected one log, of 'vsss field --record LOG'");
  const char *path = words->value[0];
  vs_bus_log *log = NULL;
  marks own;
  vs_status s = vs_bus_supported(err);
  if (s == VS_OK) s = vs_bus_log_open(path, &log, err);
  if (s == VS_OK) s = find_marks(log, path, config, &own, err);
  if (s == VS_OK) {
    out->team = own.team;
    s = read_all(log, &own, out, err);
  }
  vs_bus_log_close(log);
  int sights = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) sights += out->robot[i].sights;
  if (s == VS_OK && (!out->ages || !sights))
    s = vs_fail(err, VS_FAIL, "%.200s: holds no %s of %s; record it with 'vsss field --policy shake: --record FILE'",
                path, out->ages ? "sights" : "commands", vs_team_name(out->team));
  if (s != VS_OK) vs_motion_log_free(out);
  return s;
}

void vs_motion_log_free(vs_motion_log *l) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    free(l->robot[i].command);
    free(l->robot[i].sight);
  }
  free(l->age_ms);
  memset(l, 0, sizeof *l);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double vs_motion_quantile(double *value, int n, double p) {
  if (n == 0) return 0;
  qsort(value, (size_t)n, sizeof *value, ascending);
  int i = (int)(p * n);
  return value[i < n ? i : n - 1];
}
