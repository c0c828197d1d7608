#include "vsss/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static vs_status write_all(int file, const char *path, const uint8_t *data, size_t size, vs_error *err) {
  while (size > 0) {
    ssize_t n = write(file, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
    data += n;
    size -= (size_t)n;
  }
  if (fsync(file) != 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  return VS_OK;
}

vs_status vs_file_replace(const char *path, const void *data, size_t size, vs_error *err) {
  char temporary[PATH_MAX];
  if ((size_t)snprintf(temporary, sizeof temporary, "%s.tmp", path) >= sizeof temporary)
    return vs_fail(err, VS_FAIL, "%.300s: path too long", path);
  int file = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return vs_fail(err, VS_FAIL, "%s: %s", temporary, strerror(errno));
  vs_status s = write_all(file, temporary, data, size, err);
  if (close(file) != 0 && s == VS_OK) s = vs_fail(err, VS_FAIL, "%s: %s", temporary, strerror(errno));
  if (s == VS_OK && rename(temporary, path) != 0) s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (s != VS_OK) unlink(temporary);
  return s;
}
