// vsss replay --check: a run of the field, computed again from its record.
#define _GNU_SOURCE // memfd_create
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "field_config.h"
#include "replay.h"
#include "vsss/config.h"
#include "vsss/field_loop.h"
#include "vsss/tick.h"

typedef struct setup {
  char policy[256], fallback[256], policy_hash[32], fallback_hash[32], camera[512], team[16], own_tags[16],
      their_tags[16];
  int version, width_px, height_px;
  bool attack_plus_x, go, referee_goes, calibrated;
  uint64_t seed, start_us;
} setup;

typedef struct check {
  setup setup;
  vs_field_config config;
  vs_field_rerun start;
  int calib_file; // in memory; -1: none
  char calib_path[64];
  vs_field *field;
  int64_t turns, decided, stopped, failures;
} check;

static vs_status read_setup(const char *path, const char *text, setup *s, vs_error *err) {
  const vs_config_key rows[] = {
      {"setup.version", VS_CONFIG_INT, &s->version, 0, 1, 1, "of the record"},
      {"setup.policy", VS_CONFIG_TEXT, s->policy, sizeof s->policy, 0, 0, "who played"},
      {"setup.fallback", VS_CONFIG_TEXT, s->fallback, sizeof s->fallback, 0, 0, "who took over"},
      {"setup.policy_hash", VS_CONFIG_TEXT, s->policy_hash, sizeof s->policy_hash, 0, 0, "of its file"},
      {"setup.fallback_hash", VS_CONFIG_TEXT, s->fallback_hash, sizeof s->fallback_hash, 0, 0, "of its file"},
      {"setup.camera", VS_CONFIG_TEXT, s->camera, sizeof s->camera, 0, 0, "source of the pictures"},
      {"setup.team", VS_CONFIG_TEXT, s->team, sizeof s->team, 0, 0, "blue or yellow"},
      {"setup.attack_plus_x", VS_CONFIG_BOOL, &s->attack_plus_x, 0, 0, 0, "which way we played"},
      {"setup.own_tags", VS_CONFIG_TEXT, s->own_tags, sizeof s->own_tags, 0, 0, "what we wore"},
      {"setup.their_tags", VS_CONFIG_TEXT, s->their_tags, sizeof s->their_tags, 0, 0, "what they wore"},
      {"setup.go", VS_CONFIG_BOOL, &s->go, 0, 0, 0, "released from the start"},
      {"setup.referee_goes", VS_CONFIG_BOOL, &s->referee_goes, 0, 0, 0, "a referee released the robots"},
      {"setup.calibrated", VS_CONFIG_BOOL, &s->calibrated, 0, 0, 0, "there was a calibration"},
      {"setup.seed", VS_CONFIG_SEED, &s->seed, 0, 0, 0, "of the policy"},
      {"setup.width_px", VS_CONFIG_INT, &s->width_px, 0, 1, 16384, "of the pictures"},
      {"setup.height_px", VS_CONFIG_INT, &s->height_px, 0, 1, 16384, "of the pictures"},
      {"setup.start_us", VS_CONFIG_SEED, &s->start_us, 0, 0, 0, "monotonic, when it began"},
      {NULL, VS_CONFIG_INT, NULL, 0, 0, 0, NULL}};
  vs_status status = vs_config_parse(path, text, rows, err);
  if (status == VS_OK && (!s->version || !*s->policy || !s->width_px || !s->height_px))
    return vs_fail(err, VS_FAIL, "%s: its %s is not whole", path, VS_SETUP_CHANNEL);
  return status;
}

// The next message of a channel; text: its bytes with an end.
static vs_status find(vs_bus_log *log, const char *path, const char *channel, char **text, vs_error *err) {
  *text = NULL;
  vs_bus_log_rewind(log);
  for (bool end = false;;) {
    vs_log_event event;
    vs_status s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK) return s;
    if (end) return vs_fail(err, VS_FAIL, "%.200s: holds no %s: not a record of 'vsss field --record'", path, channel);
    if (strcmp(event.channel, channel) != 0) continue;
    *text = malloc(event.size + 1);
    if (!*text) return vs_fail(err, VS_FAIL, "out of memory");
    memcpy(*text, event.data, event.size);
    (*text)[event.size] = '\0';
    return VS_OK;
  }
}

// A file that changed since would compute something else.
static vs_status same_file(const char *uri, const char *recorded, vs_error *err) {
  char now[20];
  vs_field_policy_hash(uri, now);
  if (!*recorded || !strcmp(recorded, now)) return VS_OK;
  return vs_fail(err, VS_FAIL, "%.200s: %s; the record was made with the file of hash %s", uri,
                 *now ? "has changed" : "is not here", recorded);
}

static vs_status apply(const setup *s, vs_field_def *d, vs_error *err) {
  vs_status status = vs_cli_team("setup.team =", s->team, &d->team, err);
  vs_mark own, their;
  if (status == VS_OK) status = vs_mark_parse("setup.own_tags =", s->own_tags, false, &own, err);
  if (status == VS_OK) status = vs_mark_parse("setup.their_tags =", s->their_tags, true, &their, err);
  if (status != VS_OK) return status;
  vs_vision_marks(&d->detector, &d->tracker, own, their);
  d->camera = s->camera;
  d->policy = s->policy;
  d->fallback = *s->fallback ? s->fallback : NULL;
  d->radio = NULL;
  d->tracker.attack_plus_x = s->attack_plus_x;
  d->go = s->go;
  d->referee_goes = s->referee_goes;
  d->seed = s->seed;
  d->lcm = false;
  return VS_OK;
}

static vs_status open_calib(check *c, const char *text, vs_error *err) {
  c->calib_file = memfd_create("calib.ini", MFD_CLOEXEC);
  size_t size = strlen(text);
  if (c->calib_file < 0 || write(c->calib_file, text, size) != (ssize_t)size)
    return vs_fail(err, VS_FAIL, "no memory for the calibration");
  snprintf(c->calib_path, sizeof c->calib_path, "/proc/self/fd/%d", c->calib_file);
  c->config.def.calib = c->calib_path;
  return VS_OK;
}

static vs_status load(vs_bus_log *log, const char *path, setup *out, vs_field_config *config, vs_error *err) {
  char *text = NULL;
  vs_status s = find(log, path, VS_SETUP_CHANNEL, &text, err);
  if (s == VS_OK) s = read_setup(path, text, out, err);
  free(text);
  text = NULL;
  if (s == VS_OK) s = find(log, path, VS_CONFIG_CHANNEL, &text, err);
  if (s == VS_OK) s = vs_field_config_parse(path, text, config, err);
  free(text);
  return s == VS_OK ? apply(out, &config->def, err) : s;
}

vs_status replay_setup(vs_bus_log *log, const char *path, vs_field_config *config, vs_error *err) {
  static setup s; // the definition's texts lie in it
  return load(log, path, &s, config, err);
}

static vs_status start(check *c, vs_bus_log *log, const char *path, vs_error *err) {
  char *text = NULL;
  c->calib_file = -1;
  vs_status s = load(log, path, &c->setup, &c->config, err);
  if (s == VS_OK) s = same_file(c->setup.policy, c->setup.policy_hash, err);
  if (s == VS_OK) s = same_file(c->setup.fallback, c->setup.fallback_hash, err);
  c->start = (vs_field_rerun){c->setup.width_px, c->setup.height_px, (int64_t)c->setup.start_us};
  c->config.def.rerun = &c->start;
  if (s == VS_OK && c->setup.calibrated) s = find(log, path, VS_CALIB_CHANNEL, &text, err);
  if (s == VS_OK && text) s = open_calib(c, text, err);
  free(text);
  return s == VS_OK ? vs_field_new(&c->config.def, &c->field, NULL, 0, err) : s;
}

// The first of what came of a turn that is not the same, bit for bit.
static vs_status compare(const vs_tick *was, const vs_tick *is, double at_s, vs_error *err) {
  char at[64];
  snprintf(at, sizeof at, "turn %d, %.3f s after the first", was->seq, at_s);
  if (was->world_hash != is->world_hash)
    return vs_fail(err, VS_FAIL, "%s: the tracked world differs (hash %016" PRIx64 ", now %016" PRIx64 ")", at,
                   was->world_hash, is->world_hash);
  if (was->player_failed != is->player_failed)
    return vs_fail(err, VS_FAIL, "%s: the player %s, now it %s", at, was->player_failed ? "failed" : "answered",
                   is->player_failed ? "fails" : "answers");
  if (was->decided != is->decided)
    return vs_fail(err, VS_FAIL, "%s: %s, now it %s", at, was->decided ? "decided" : "did not decide",
                   is->decided ? "decides" : "does not");
  if (was->safety != is->safety || was->stop != is->stop)
    return vs_fail(err, VS_FAIL, "%s: safety was '%s', now '%s'", at, vs_safety_name((vs_safety_state)was->safety),
                   vs_safety_name((vs_safety_state)is->safety));
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    if (memcmp(&was->wheels[i], &is->wheels[i], sizeof was->wheels[i]) != 0)
      return vs_fail(err, VS_FAIL, "%s: robot %d was commanded %.17g %.17g rad/s, now %.17g %.17g", at, i,
                     was->wheels[i].left_radps, was->wheels[i].right_radps, is->wheels[i].left_radps,
                     is->wheels[i].right_radps);
  return VS_OK;
}

static vs_status run(check *c, vs_bus_log *log, vs_error *err) {
  vs_progress progress;
  vs_progress_start(&progress);
  static vs_tick was, is;
  int64_t first_us = 0;
  vs_status s = VS_OK;
  vs_bus_log_rewind(log);
  for (bool end = false; s == VS_OK && !vs_cli_interrupted();) {
    vs_log_event event;
    s = vs_bus_log_next(log, &event, &end, err);
    if (s != VS_OK || end) break;
    if (strcmp(event.channel, VS_TICK_CHANNEL) != 0) continue;
    s = vs_tick_decode(event.data, event.size, &was, err);
    if (s == VS_OK && was.seq != c->turns)
      s = vs_fail(err, VS_FAIL, "turn %lld is missing: the disk was full, or the record is damaged",
                  (long long)c->turns);
    if (s != VS_OK) break;
    if (!c->turns++) first_us = event.utime_us;
    vs_error other = {0};
    vs_status again = vs_field_again(c->field, &was, &is, &other);
    s = compare(&was, &is, 1e-6 * (double)(event.utime_us - first_us), err);
    if (s == VS_OK && again != VS_OK) s = vs_fail(err, VS_FAIL, "%s", other.text);
    c->decided += was.decided;
    c->stopped += was.stop;
    c->failures += was.player_failed;
    vs_progress_show(&progress, vs_bus_log_fraction(log), "computed again");
  }
  vs_progress_clear(&progress);
  return s;
}

vs_status replay_check(vs_bus_log *log, const char *path, vs_error *err) {
  check *c = calloc(1, sizeof *c);
  if (!c) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = start(c, log, path, err);
  if (s == VS_USAGE) s = err->status = VS_FAIL; // what is wrong is in the record
  if (s == VS_OK) s = run(c, log, err);
  if (s == VS_OK && !c->turns) s = vs_fail(err, VS_FAIL, "%.200s: holds no turn of the field's loop", path);
  if (s == VS_OK)
    printf("%lld turns computed again with %s: the same commands, bit for bit; %lld decisions, %lld turns stopped, "
           "%lld without an answer of the player\n",
           (long long)c->turns, c->setup.policy, (long long)c->decided, (long long)c->stopped, (long long)c->failures);
  vs_field_free(c->field);
  if (c->calib_file >= 0) close(c->calib_file);
  free(c);
  return s;
}
