#include "mcap.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER = 1, FOOTER = 2, SCHEMA = 3, CHANNEL = 4, MESSAGE = 5, STATISTICS = 0x0B, DATA_END = 0x0F };

static const uint8_t magic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

static void put(mcap_file *f, const void *bytes, size_t n) {
  fwrite(bytes, 1, n, f->out);
  f->at += n;
}

// Little-endian.
static void put_number(mcap_file *f, uint64_t value, int bytes) {
  for (uint8_t b; bytes > 0; bytes--, value >>= 8) put(f, (b = (uint8_t)value, &b), 1);
}

static void put_text(mcap_file *f, const char *text) {
  put_number(f, strlen(text), 4);
  put(f, text, strlen(text));
}

static void begin(mcap_file *f, int opcode, uint64_t size) {
  put_number(f, (uint64_t)opcode, 1);
  put_number(f, size, 8);
}

// Schema and channel i have the numbers i + 1 and i: a schema 0 is none.
static void put_topics(mcap_file *f) {
  for (int i = 0; i < f->n_topics; i++) {
    const mcap_topic *t = &f->topic[i];
    const char *schema_name = t->schema_name ? t->schema_name : t->name;
    begin(f, SCHEMA, 2 + 4 + strlen(schema_name) + 4 + strlen("jsonschema") + 4 + strlen(t->schema));
    put_number(f, (uint64_t)i + 1, 2);
    put_text(f, schema_name);
    put_text(f, "jsonschema");
    put_text(f, t->schema);
    begin(f, CHANNEL, 2 + 2 + 4 + strlen(t->name) + 4 + strlen("json") + 4);
    put_number(f, (uint64_t)i, 2);
    put_number(f, (uint64_t)i + 1, 2);
    put_text(f, t->name);
    put_text(f, "json");
    put_number(f, 0, 4); // no metadata
  }
}

vs_status mcap_open(const char *path, const mcap_topic *topic, int n_topics, mcap_file *f, vs_error *err) {
  *f = (mcap_file){.out = fopen(path, "wb"), .path = path, .topic = topic, .n_topics = n_topics};
  if (!f->out) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  put(f, magic, sizeof magic);
  begin(f, HEADER, 4 + 4 + strlen("vsss"));
  put_text(f, "");
  put_text(f, "vsss");
  put_topics(f);
  return VS_OK;
}

void mcap_message(mcap_file *f, int topic, uint64_t time_ns, const char *json) {
  uint64_t total = 0;
  for (int i = 0; i < f->n_topics; i++) total += f->messages[i];
  if (!total || time_ns < f->first_ns) f->first_ns = time_ns;
  if (!total || time_ns > f->last_ns) f->last_ns = time_ns;
  begin(f, MESSAGE, 2 + 4 + 8 + 8 + strlen(json));
  put_number(f, (uint64_t)topic, 2);
  put_number(f, f->messages[topic]++, 4);
  put_number(f, time_ns, 8);
  put_number(f, time_ns, 8);
  put(f, json, strlen(json));
}

static void put_statistics(mcap_file *f) {
  uint64_t total = 0;
  for (int i = 0; i < f->n_topics; i++) total += f->messages[i];
  begin(f, STATISTICS, 8 + 2 + 4 * 4 + 8 + 8 + 4 + 10 * (uint64_t)f->n_topics);
  put_number(f, total, 8);
  put_number(f, (uint64_t)f->n_topics, 2);
  put_number(f, (uint64_t)f->n_topics, 4);
  for (int i = 0; i < 3; i++) put_number(f, 0, 4); // attachments, metadata, chunks
  put_number(f, f->first_ns, 8);
  put_number(f, f->last_ns, 8);
  put_number(f, 10 * (uint64_t)f->n_topics, 4);
  for (int i = 0; i < f->n_topics; i++) {
    put_number(f, (uint64_t)i, 2);
    put_number(f, f->messages[i], 8);
  }
}

vs_status mcap_close(mcap_file *f, vs_error *err) {
  begin(f, DATA_END, 4);
  put_number(f, 0, 4); // no checksum
  uint64_t summary = f->at;
  put_topics(f);
  put_statistics(f);
  begin(f, FOOTER, 8 + 8 + 4);
  put_number(f, summary, 8);
  put_number(f, 0, 8); // no offsets, no checksum
  put_number(f, 0, 4);
  put(f, magic, sizeof magic);
  bool bad = ferror(f->out);
  bad = fclose(f->out) != 0 || bad;
  return bad ? vs_fail(err, VS_FAIL, "%s: cannot be written; is the disk full?", f->path) : VS_OK;
}
