#include "archive.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/file.h"
#include "vsss/world.h"

static const char magic[8] = "VSSSCKP1";

typedef struct header {
  char name[VS_ARCHIVE_NAME];
  uint32_t version; // 0 in files from before there were any
  uint64_t size;
} header;

void vs_archive_begin(vs_bytes *archive) { vs_bytes_append(archive, magic, sizeof magic); }

void vs_archive_section(vs_bytes *archive, const vs_section *section, const void *data, size_t size) {
  void *room = vs_archive_room(archive, section, size);
  if (room && size) memcpy(room, data, size);
}

void *vs_archive_room(vs_bytes *archive, const vs_section *section, size_t size) {
  header head = {.version = section->version, .size = size};
  snprintf(head.name, sizeof head.name, "%s", section->name);
  vs_bytes_append(archive, &head, sizeof head);
  return vs_bytes_room(archive, size);
}

vs_status vs_archive_write(vs_bytes *archive, const char *path, vs_error *err) {
  uint64_t hash = vs_hash_bytes(VS_HASH_START, archive->data, archive->size);
  vs_bytes_append(archive, &hash, sizeof hash);
  vs_status s = VS_OK;
  char previous[PATH_MAX], next[PATH_MAX];
  if (archive->failed || (size_t)snprintf(previous, sizeof previous, "%s.previous", path) >= sizeof previous ||
      (size_t)snprintf(next, sizeof next, "%s.next", path) >= sizeof next)
    s = vs_fail(err, VS_FAIL, "%.300s: out of memory, or the path is too long", path);
  // The new file is whole on the disk before the old one is touched.
  if (s == VS_OK) s = vs_file_replace(next, archive->data, archive->size, err);
  if (s == VS_OK && rename(path, previous) != 0 && errno != ENOENT)
    s = vs_fail(err, VS_FAIL, "%s: %s", previous, strerror(errno));
  if (s == VS_OK && rename(next, path) != 0) s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  vs_bytes_free(archive);
  return s;
}

static vs_status read_all(const char *path, vs_bytes *out, vs_error *err) {
  FILE *f = fopen(path, "rb");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  char block[65536];
  size_t n;
  while ((n = fread(block, 1, sizeof block, f)) > 0) vs_bytes_append(out, block, n);
  bool failed = ferror(f);
  fclose(f);
  if (failed) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  return out->failed ? vs_fail(err, VS_FAIL, "%s: out of memory", path) : VS_OK;
}

static vs_status check_sections(const vs_bytes *archive, const char *path, vs_error *err) {
  size_t at = sizeof magic, end = archive->size - sizeof(uint64_t);
  while (at < end) {
    header head;
    if (end - at < sizeof head) return vs_fail(err, VS_FAIL, "%s: damaged", path);
    memcpy(&head, archive->data + at, sizeof head);
    at += sizeof head;
    if (head.size > end - at) return vs_fail(err, VS_FAIL, "%s: damaged", path);
    at += head.size;
  }
  return VS_OK;
}

vs_status vs_archive_read(const char *path, vs_bytes *archive, vs_error *err) {
  *archive = (vs_bytes){0};
  vs_status s = read_all(path, archive, err);
  uint64_t hash = 0;
  size_t smallest = sizeof magic + sizeof hash;
  if (s == VS_OK && (archive->size < smallest || memcmp(archive->data, magic, sizeof magic) != 0))
    s = vs_fail(err, VS_FAIL, "%s: not a checkpoint of vsss, or cut off at its start", path);
  if (s == VS_OK) {
    size_t body = archive->size - sizeof hash;
    memcpy(&hash, archive->data + body, sizeof hash);
    if (hash != vs_hash_bytes(VS_HASH_START, archive->data, body))
      s = vs_fail(err, VS_FAIL, "%s: truncated or damaged (its checksum is wrong)", path);
  }
  if (s == VS_OK) s = check_sections(archive, path, err);
  if (s != VS_OK) vs_bytes_free(archive);
  return s;
}

bool vs_archive_has(const vs_bytes *archive, const char *name, vs_found *out) {
  size_t at = sizeof magic, end = archive->size - sizeof(uint64_t);
  while (at < end) {
    header head;
    memcpy(&head, archive->data + at, sizeof head);
    at += sizeof head;
    if (strncmp(head.name, name, sizeof head.name) == 0) {
      *out = (vs_found){archive->data + at, head.size, head.version ? head.version : 1};
      return true;
    }
    at += head.size;
  }
  return false;
}

vs_status vs_archive_find(const vs_bytes *archive, const char *path, const vs_section *section, size_t size,
                          vs_found *out, vs_error *err) {
  if (!vs_archive_has(archive, section->name, out))
    return vs_fail(err, VS_FAIL, "%s: no '%s' in it: made by another version", path, section->name);
  if (out->version > section->version)
    return vs_fail(err, VS_FAIL,
                   "%s: '%s' is too new (version %u, this vsss reads up to %u): use the vsss that wrote it", path,
                   section->name, out->version, section->version);
  if (out->version < section->oldest)
    return vs_fail(err, VS_FAIL,
                   "%s: '%s' is too old (version %u, this vsss reads from %u on): use the vsss that wrote it", path,
                   section->name, out->version, section->oldest);
  if (size && out->size != size)
    return vs_fail(err, VS_FAIL, "%s: '%s' has %zu bytes, expected %zu: made with other settings or another version",
                   path, section->name, out->size, size);
  return VS_OK;
}
