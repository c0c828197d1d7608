#include "venue.h"

#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vsss/calib.h"
#include "vsss/paths.h"

static bool is_ours(const char *path, mode_t type) {
  struct stat info;
  return lstat(path, &info) == 0 && (info.st_mode & S_IFMT) == type && info.st_uid == geteuid();
}

static bool is_radio(const char *path) {
  static const char terminals[] = "/dev/pts/";
  char target[sizeof terminals] = "";
  return is_ours(path, S_IFLNK) && readlink(path, target, sizeof target - 1) >= (ssize_t)sizeof terminals - 1 &&
         !strncmp(target, terminals, sizeof terminals - 1);
}

static bool is_calib(const char *path) {
  vs_calib calib;
  return is_ours(path, S_IFREG) && vs_calib_load(path, &calib, NULL) == VS_OK && !strcmp(calib.camera, "rig");
}

// Nothing is taken away before everything is known to be ours.
static vs_status check(const char *path, bool left, vs_error *err) {
  struct stat info;
  if (left || lstat(path, &info) != 0) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: is already there and no rig left it; move it away or give another --dir", path);
}

vs_status vs_venue_open(vs_venue *v, const char *folder, const char *camera, const char *radio, const char *calib,
                        vs_error *err) {
  vs_status s = vs_path_own_folder(folder, true, &v->folder, err);
  if (s != VS_OK) return s;
  if (flock(v->folder, LOCK_EX | LOCK_NB) != 0)
    return vs_fail(err, VS_FAIL, "%s: in use by another rig; stop it or give another --dir", folder);
  bool killed = is_ours(camera, S_IFSOCK);
  bool old_radio = killed && is_radio(radio), old_calib = killed && is_calib(calib);
  s = check(camera, killed, err);
  if (s == VS_OK) s = check(radio, old_radio, err);
  if (s == VS_OK) s = check(calib, old_calib, err);
  if (s != VS_OK) return s;
  if (old_radio) unlink(radio);
  if (old_calib) unlink(calib);
  return VS_OK;
}

void vs_venue_close(vs_venue *v) {
  if (v->folder > 0) close(v->folder);
  v->folder = 0;
}

void vs_venue_mine(const char *path, vs_venue_file *file) {
  struct stat info;
  *file = (vs_venue_file){0};
  if (lstat(path, &info) == 0) *file = (vs_venue_file){info.st_dev, info.st_ino};
}

void vs_venue_remove(const char *path, const vs_venue_file *file) {
  struct stat info;
  if (file->inode && lstat(path, &info) == 0 && info.st_dev == file->device && info.st_ino == file->inode) unlink(path);
}
