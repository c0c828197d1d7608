#include "record.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/config.h"
#include "vsss/mark.h"

_Static_assert((int)VS_MAX_TAGS <= (int)VS_TICK_ROWS && (int)VS_MAX_BLOBS <= (int)VS_TICK_ROWS,
               "all that is seen fits into a tick");

enum { TEXT_MAX = 60000 }; // of a settings or calibration file, one message

// A record is passed on to others; the radio's key is not: its value goes.
static size_t without_key(char *text, size_t size) {
  size_t kept = 0;
  for (size_t at = 0; at < size;) {
    const char *end = memchr(text + at, '\n', size - at);
    size_t length = end ? (size_t)(end - (text + at)) + 1 : size - at, start = strspn(text + at, " \t");
    char after = text[at + start + 3 < size ? at + start + 3 : size - 1];
    bool key = length >= start + 4 && !strncmp(text + at + start, "key", 3) && after && strchr(" \t=", after);
    memmove(text + kept, key ? "key=\n" : text + at, key ? 5 : length);
    kept += key ? 5 : length;
    at += length;
  }
  return kept;
}

static vs_status put_file(vs_record *r, const char *channel, const char *path, vs_error *err) {
  FILE *f = fopen(path, "rb");
  char *text = malloc(TEXT_MAX + 1);
  size_t n = f && text ? fread(text, 1, TEXT_MAX + 1, f) : 0;
  vs_status s = VS_OK;
  if (!text)
    s = vs_fail(err, VS_FAIL, "out of memory");
  else if (!f || ferror(f))
    s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  else if (n > TEXT_MAX)
    s = vs_fail(err, VS_FAIL, "%s: larger than %d bytes, which a record does not take", path, TEXT_MAX);
  else
    s = vs_bus_publish_raw(r->bus, channel, (const uint8_t *)text, (text[n] = '\0', without_key(text, n)), err);
  if (f) fclose(f);
  free(text);
  return s;
}

static int put_text(char *out, size_t size, const char *key, const char *value) {
  char quoted[600];
  vs_config_quote(value ? value : "", quoted, sizeof quoted);
  return snprintf(out, size, "%s = %s\n", key, quoted);
}

static vs_status put_setup(vs_record *r, const vs_field_def *d, const vs_field_rerun *start, vs_error *err) {
  char text[4096];
  size_t n = 0;
  n += (size_t)snprintf(text, sizeof text, "# How `vsss field` was started.\n[setup]\nversion = 1\n");
  n += (size_t)put_text(text + n, sizeof text - n, "policy", d->policy);
  n += (size_t)put_text(text + n, sizeof text - n, "fallback", d->fallback);
  n += (size_t)put_text(text + n, sizeof text - n, "policy_hash", vs_field_policy_hash(d->policy, (char[20]){0}));
  n += (size_t)put_text(text + n, sizeof text - n, "fallback_hash", vs_field_policy_hash(d->fallback, (char[20]){0}));
  n += (size_t)put_text(text + n, sizeof text - n, "camera", d->camera);
  n += (size_t)snprintf(text + n, sizeof text - n,
                        "team = %s\nattack_plus_x = %s\nown_tags = %s\ntheir_tags = %s\ngo = %s\nreferee_goes = %s\n"
                        "calibrated = %s\nseed = %" PRIu64 "\n",
                        vs_team_name(d->team), d->tracker.attack_plus_x ? "true" : "false",
                        vs_mark_name(d->tracker.own), vs_mark_name(d->tracker.their), d->go ? "true" : "false",
                        d->referee_goes ? "true" : "false", d->calib ? "true" : "false", d->seed);
  n += (size_t)snprintf(text + n, sizeof text - n, "width_px = %d\nheight_px = %d\nstart_us = %" PRIu64 "\n",
                        start->width_px, start->height_px, (uint64_t)start->start_us);
  if (n >= sizeof text) return vs_fail(err, VS_FAIL, "the names of policy and camera are too long for a record");
  return vs_bus_publish_raw(r->bus, VS_SETUP_CHANNEL, (const uint8_t *)text, n, err);
}

vs_status vs_record_open(vs_record *r, const vs_field_def *def, const vs_field_rerun *start, vs_error *err) {
  char url[480];
  memset(r, 0, sizeof *r);
  if (snprintf(url, sizeof url, "file://%s?mode=w", def->record) >= (int)sizeof url)
    return vs_fail(err, VS_USAGE, "--record %.60s...: the path is too long", def->record);
  vs_status s = vs_bus_open(url, &r->bus, err);
  if (s != VS_OK) return s;
  s = put_setup(r, def, start, err);
  if (s == VS_OK && def->config_file) s = put_file(r, VS_CONFIG_CHANNEL, def->config_file, err);
  if (s == VS_OK && def->calib) s = put_file(r, VS_CALIB_CHANNEL, def->calib, err);
  r->lost += s != VS_OK; // a full disk does not keep us from playing; it is told at the end
  return VS_OK;
}

void vs_record_close(vs_record *r) {
  vs_bus_close(r->bus);
  r->bus = NULL;
}

void vs_record_tick(vs_record *r, vs_tick *t) {
  if (!r->bus) return;
  t->seq = r->seq++;
  int64_t now_us = vs_clock_wall_us();
  int64_t capture_us = t->frame ? t->capture_us + now_us - vs_clock_monotonic_us() : 0;
  size_t size = vs_tick_encode(t, now_us, capture_us, r->bytes, sizeof r->bytes);
  if (!size || vs_bus_publish_raw(r->bus, VS_TICK_CHANNEL, r->bytes, size, NULL) != VS_OK) r->lost++;
}

static void blobs_out(const vs_blob *from, int n, vs_tick_blob *to) {
  for (int i = 0; i < n; i++)
    to[i] = (vs_tick_blob){from[i].x_px,       from[i].y_px,       from[i].area_px,
                           from[i].elongation, from[i].confidence, from[i].angle_rad};
}

static void blobs_in(const vs_tick_blob *from, int n, vs_blob *to) {
  for (int i = 0; i < n; i++)
    to[i] = (vs_blob){from[i].x_px,       from[i].y_px,       from[i].area_px,
                      from[i].elongation, from[i].confidence, from[i].angle_rad};
}

void vs_record_seen(const vs_detections *seen, vs_tick *t) {
  t->n_tags = seen->tags;
  for (int i = 0; i < seen->tags; i++) {
    const vs_tag *tag = &seen->tag[i];
    t->tag[i] = (vs_tick_tag){.kind = tag->kind, .id = tag->id, .hamming = tag->hamming, .margin = tag->margin};
    memcpy(t->tag[i].centre_px, tag->centre_px, sizeof tag->centre_px);
    memcpy(t->tag[i].corner_px, tag->corner_px, sizeof tag->corner_px);
  }
  t->n_balls = seen->balls;
  blobs_out(seen->ball, seen->balls, t->ball);
  t->n_adversaries = seen->adversaries;
  blobs_out(seen->adversary, seen->adversaries, t->adversary);
}

void vs_record_see_again(const vs_tick *t, vs_detections *seen) {
  memset(seen, 0, sizeof *seen);
  seen->capture_us = t->capture_us;
  seen->seq = t->frame_seq;
  seen->tags = t->n_tags;
  for (int i = 0; i < t->n_tags; i++) {
    vs_tag *tag = &seen->tag[i];
    *tag = (vs_tag){
        .kind = (vs_mark)t->tag[i].kind, .id = t->tag[i].id, .hamming = t->tag[i].hamming, .margin = t->tag[i].margin};
    memcpy(tag->centre_px, t->tag[i].centre_px, sizeof tag->centre_px);
    memcpy(tag->corner_px, t->tag[i].corner_px, sizeof tag->corner_px);
  }
  seen->balls = t->n_balls;
  blobs_in(t->ball, t->n_balls, seen->ball);
  seen->adversaries = t->n_adversaries;
  blobs_in(t->adversary, t->n_adversaries, seen->adversary);
}

// Of the file behind the scheme; the built-in players have none, they are this program's.
const char *vs_field_policy_hash(const char *uri, char out[20]) {
  const char *path = uri ? strchr(uri, ':') : NULL;
  out[0] = '\0';
  if (!path) return out;
  char name[512];
  snprintf(name, sizeof name, "%.*s", (int)strcspn(path + 1, "?"), path + 1);
  FILE *f = *name ? fopen(name, "rb") : NULL;
  if (!f) return out;
  uint64_t hash = VS_HASH_START;
  uint8_t bytes[4096];
  for (size_t n; (n = fread(bytes, 1, sizeof bytes, f)) > 0;) hash = vs_hash_bytes(hash, bytes, n);
  fclose(f);
  snprintf(out, 20, "%016" PRIx64, hash);
  return out;
}
