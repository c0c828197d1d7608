#include "vsss/league_log.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 8 + 4 + 4 };

struct vs_league_log {
  FILE *file;
  long at; // of the next entry
  char path[256];
};

static vs_status open_file(const char *path, const char *mode, vs_league_log **out, vs_error *err) {
  vs_league_log *log = calloc(1, sizeof *log);
  if (!log) return vs_fail(err, VS_FAIL, "out of memory for a log");
  snprintf(log->path, sizeof log->path, "%s", path);
  log->file = fopen(path, mode);
  if (!log->file) {
    free(log);
    return vs_fail(err, VS_FAIL, "%.200s: %s", path, strerror(errno));
  }
  *out = log;
  return VS_OK;
}

vs_status vs_league_log_create(const char *path, vs_league_log **out, vs_error *err) {
  return open_file(path, "wbe", out, err);
}

vs_status vs_league_log_open(const char *path, vs_league_log **out, vs_error *err) {
  return open_file(path, "rbe", out, err);
}

vs_status vs_league_log_close(vs_league_log *log, vs_error *err) {
  if (!log) return VS_OK;
  bool bad = ferror(log->file) != 0;
  bad = fclose(log->file) != 0 || bad;
  vs_status s = bad ? vs_fail(err, VS_FAIL, "%.200s: cannot be written; is the disk full?", log->path) : VS_OK;
  free(log);
  return s;
}

static void put_number(uint8_t *out, uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; i--, value >>= 8) out[i] = (uint8_t)value;
}

static uint64_t get_number(const uint8_t *in, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; i++) value = value << 8 | in[i];
  return value;
}

void vs_league_log_put(vs_league_log *log, int64_t time_ms, vs_league_kind kind, const uint8_t *data, size_t size) {
  uint8_t head[HEAD];
  put_number(head, (uint64_t)time_ms, 8);
  put_number(head + 8, (uint64_t)kind, 4);
  put_number(head + 12, size, 4);
  fwrite(head, 1, sizeof head, log->file);
  if (size) fwrite(data, 1, size, log->file); // an empty one may have no data at all
}

vs_status vs_league_log_next(vs_league_log *log, vs_league_entry *out, bool *end, vs_error *err) {
  uint8_t head[HEAD];
  size_t n = fread(head, 1, sizeof head, log->file);
  *end = n == 0 && feof(log->file);
  if (*end) return VS_OK;
  uint64_t kind = get_number(head + 8, 4), size = get_number(head + 12, 4);
  if (n != sizeof head) return vs_fail(err, VS_FAIL, "%.200s: cut at byte %ld", log->path, log->at);
  if (kind > VS_LEAGUE_VISION || size > sizeof out->data)
    return vs_fail(err, VS_FAIL, "%.200s: byte %ld is no entry of a league's log", log->path, log->at);
  *out = (vs_league_entry){.time_ms = (int64_t)get_number(head, 8), .kind = (vs_league_kind)kind, .size = (size_t)size};
  if (fread(out->data, 1, out->size, log->file) != out->size)
    return vs_fail(err, VS_FAIL, "%.200s: cut at byte %ld", log->path, log->at);
  log->at += HEAD + (long)out->size;
  return VS_OK;
}
