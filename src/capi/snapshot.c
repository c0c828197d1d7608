// Snapshots in the caller's memory: a head that says of what they are, then the state of whatever was copied.
#include <stdlib.h>
#include <string.h>

#include "capi_internal.h"

#define MAGIC UINT64_C(0x70616e7373737376) // "vsssnap" and a p

typedef struct head {
  uint64_t magic, settings, size; // size: of all
} head;

static vs_status check(const void *from, size_t size, size_t expected, uint64_t settings, vs_error *err) {
  head h = {0};
  if (size >= sizeof h) memcpy(&h, from, sizeof h);
  if (h.magic != MAGIC) return vs_fail(err, VS_USAGE, "this is not a snapshot");
  if (h.settings != settings)
    return vs_fail(err, VS_USAGE, "the snapshot is of an environment with other settings or another release");
  if (size != expected || h.size != expected)
    return vs_fail(err, VS_USAGE, "the snapshot has %zu bytes, %zu are expected: other players, or it was cut short",
                   size, expected);
  return VS_OK;
}

static vs_status whole_size(const capi_subject *subject, size_t *size, vs_error *err) {
  size_t inner = subject->kind->state_size(subject->self);
  if (inner == 0)
    return vs_fail(err, VS_USAGE, "a player here cannot be copied (a plugin, a function): no snapshot of its matches");
  *size = sizeof(head) + inner;
  return VS_OK;
}

// One of from and to is NULL. The state wants to be aligned; the caller's block need not be.
static vs_status copy(const capi_subject *subject, const char *from, char *to, size_t size, vs_error *err) {
  size_t expected = 0;
  uint64_t settings = subject->kind->settings(subject->self);
  vs_status s = whole_size(subject, &expected, err);
  if (s == VS_OK && from) s = check(from, size, expected, settings, err);
  if (s == VS_OK && size != expected) s = vs_fail(err, VS_USAGE, "%zu bytes for a snapshot of %zu", size, expected);
  if (s != VS_OK) return s;
  size_t inner = expected - sizeof(head);
  void *block = aligned_alloc(64, (inner + 63) / 64 * 64);
  if (!block) return vs_fail(err, VS_FAIL, "out of memory for a snapshot");
  if (from) {
    memcpy(block, from + sizeof(head), inner);
    s = subject->kind->restore(subject->self, block, err);
  } else {
    memset(block, 0, inner); // gaps too: equal states, equal bytes
    subject->kind->save(subject->self, block);
    memcpy(to, &(head){MAGIC, settings, expected}, sizeof(head));
    memcpy(to + sizeof(head), block, inner);
  }
  free(block);
  return s;
}

int vs_capi_snapshot_size(capi_subject subject, size_t *size, char *error, size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(subject.guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = whole_size(&subject, size, &err);
  vs_capi_leave(subject.guard);
  return vs_capi_told(s, &err, error, error_size);
}

int vs_capi_snapshot_copy(capi_subject subject, const void *from, void *to, size_t size, char *error,
                          size_t error_size) {
  vs_error err = {0};
  vs_status s = vs_capi_enter(subject.guard, &err);
  if (s != VS_OK) return vs_capi_told(s, &err, error, error_size);
  s = copy(&subject, from, to, size, &err);
  vs_capi_leave(subject.guard);
  return vs_capi_told(s, &err, error, error_size);
}
