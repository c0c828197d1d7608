#include "vsss/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
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

// A file that nobody had before: no link is followed, none that is there is written into.
static vs_status write_new(const char *path, mode_t mode, const void *data, size_t size, vs_error *err) {
  int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (file < 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  vs_status s = write_all(file, path, data, size, err);
  if (close(file) != 0 && s == VS_OK) s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (s != VS_OK) unlink(path);
  return s;
}

vs_status vs_file_create(const char *path, const void *data, size_t size, vs_error *err) {
  return write_new(path, 0600, data, size, err);
}

vs_status vs_file_replace(const char *path, const void *data, size_t size, vs_error *err) {
  char temporary[PATH_MAX];
  if ((size_t)snprintf(temporary, sizeof temporary, "%s.tmp", path) >= sizeof temporary)
    return vs_fail(err, VS_FAIL, "%.300s: path too long", path);
  struct stat old;
  bool kept = lstat(path, &old) == 0 && S_ISREG(old.st_mode);
  unlink(temporary); // of a writer that died
  vs_status s = write_new(temporary, 0644, data, size, err);
  if (s != VS_OK) return s;
  if (kept && chmod(temporary, old.st_mode & 0777) != 0)
    s = vs_fail(err, VS_FAIL, "%s: %s", temporary, strerror(errno));
  if (s == VS_OK && rename(temporary, path) != 0) s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (s != VS_OK) unlink(temporary);
  return s;
}
