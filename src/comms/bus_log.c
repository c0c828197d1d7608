// The log format of LCM: per event a head of 28 bytes, all numbers big-endian: magic u32, number i64, time i64,
// length of the channel's name i32, length of the data i32; then the name and the data.
#include "vsss/bus_log.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define MAGIC     0xEDA1DA01u
#define HEAD_SIZE 28

struct vs_bus_log {
  FILE *file;
  char path[512];
  int64_t size, at;
  int64_t count;
  uint8_t *data;
  size_t capacity;
};

static uint64_t big_endian(const uint8_t *p, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; i++) value = value << 8 | p[i];
  return value;
}

vs_status vs_bus_log_open(const char *path, vs_bus_log **out, vs_error *err) {
  *out = NULL;
  FILE *file = fopen(path, "rb");
  if (!file) return vs_fail(err, VS_FAIL, "%.200s: %s", path, strerror(errno));
  struct stat info;
  uint8_t magic[4];
  vs_status s = VS_OK;
  if (fstat(fileno(file), &info) != 0 || !S_ISREG(info.st_mode))
    s = vs_fail(err, VS_FAIL, "%.200s: not a file", path);
  else if (info.st_size == 0)
    s = vs_fail(err, VS_FAIL, "%.200s: empty", path);
  else if (fread(magic, 1, 4, file) != 4 || big_endian(magic, 4) != MAGIC)
    s = vs_fail(err, VS_FAIL, "%.200s: not a log of LCM (lcm-logger makes them)", path);
  vs_bus_log *log = s == VS_OK ? calloc(1, sizeof *log) : NULL;
  if (s == VS_OK && !log) s = vs_fail(err, VS_FAIL, "out of memory");
  if (s != VS_OK) {
    fclose(file);
    return s;
  }
  log->file = file;
  log->size = info.st_size;
  snprintf(log->path, sizeof log->path, "%s", path);
  vs_bus_log_rewind(log);
  *out = log;
  return VS_OK;
}

void vs_bus_log_close(vs_bus_log *log) {
  if (!log) return;
  fclose(log->file);
  free(log->data);
  free(log);
}

void vs_bus_log_rewind(vs_bus_log *log) {
  rewind(log->file);
  log->at = 0;
  log->count = 0;
}

double vs_bus_log_fraction(const vs_bus_log *log) { return (double)log->at / (double)log->size; }

static vs_status cut_off(const vs_bus_log *log, vs_error *err) {
  return vs_fail(err, VS_FAIL, "%.200s: cut off in event %lld, which starts at byte %lld (was the logger killed?)",
                 log->path, (long long)log->count, (long long)log->at);
}

static vs_status damaged(const vs_bus_log *log, vs_error *err) {
  return vs_fail(err, VS_FAIL, "%.200s: damaged at byte %lld: event %lld does not start there", log->path,
                 (long long)log->at, (long long)log->count);
}

vs_status vs_bus_log_next(vs_bus_log *log, vs_log_event *event, bool *end, vs_error *err) {
  int64_t left = log->size - log->at;
  *end = left == 0;
  if (*end) return VS_OK;
  uint8_t head[HEAD_SIZE];
  if (left < HEAD_SIZE) return cut_off(log, err);
  if (fread(head, 1, HEAD_SIZE, log->file) != HEAD_SIZE) return cut_off(log, err);
  uint64_t name = big_endian(head + 20, 4), size = big_endian(head + 24, 4);
  if (big_endian(head, 4) != MAGIC || name == 0 || name >= sizeof event->channel) return damaged(log, err);
  if ((int64_t)(HEAD_SIZE + name + size) > left) return cut_off(log, err);
  if (size > log->capacity) {
    uint8_t *grown = realloc(log->data, size);
    if (!grown) return vs_fail(err, VS_FAIL, "out of memory");
    log->data = grown;
    log->capacity = size;
  }
  if (fread(event->channel, 1, name, log->file) != name || fread(log->data, 1, size, log->file) != size)
    return cut_off(log, err);
  event->channel[name] = '\0';
  event->number = log->count++;
  event->utime_us = (int64_t)big_endian(head + 12, 8);
  event->data = log->data;
  event->size = size;
  log->at += (int64_t)(HEAD_SIZE + name + size);
  return VS_OK;
}
