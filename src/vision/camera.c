// The table of sources: which module opens what. Recordings are in camera_recording.c, devices in camera_v4l2.c.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "vision/camera_sources.h"

vs_camera_def vs_camera_def_default(void) { return (vs_camera_def){.exposure_ms = 4.0}; }

struct vs_camera {
  const vs_camera_api *api;
  void *handle;
  vs_camera_info info;
};

// Registered by the program at its start, before there are threads.
enum { MOST_SCHEMES = 8 };
static const vs_camera_api *registered[MOST_SCHEMES];
static int registered_count;

void vs_camera_register(const vs_camera_api *api) {
  for (int i = 0; i < registered_count; i++)
    if (registered[i] == api) return;
  if (registered_count < MOST_SCHEMES) registered[registered_count++] = api;
}

const char *vs_camera_sources(void) {
  static _Thread_local char text[512];
  size_t used = (size_t)snprintf(text, sizeof text, "/dev/videoN, a video file, a picture, a folder of pictures");
  for (int i = 0; i < registered_count && used < sizeof text; i++)
    used += (size_t)snprintf(text + used, sizeof text - used, ", %s", registered[i]->help);
  return text;
}

static const vs_camera_api *find_scheme(const char *source, size_t length) {
  for (int i = 0; i < registered_count; i++)
    if (strlen(registered[i]->scheme) == length && !strncmp(registered[i]->scheme, source, length))
      return registered[i];
  return NULL;
}

// A scheme is letters before the first colon; a path with a colon after a slash is a path.
static size_t scheme_length(const char *source) {
  size_t n = strspn(source, "abcdefghijklmnopqrstuvwxyz0123456789");
  return source[n] == ':' ? n : 0;
}

static vs_status choose(const char *source, const vs_camera_api **api, const char **rest, vs_error *err) {
  size_t length = scheme_length(source);
  struct stat about;
  *rest = source;
  if (length) {
    *api = find_scheme(source, length);
    *rest = source + length + 1;
    return *api ? VS_OK : vs_fail(err, VS_USAGE, "unknown camera '%s'; a source is %s", source, vs_camera_sources());
  }
  if (!strncmp(source, "/dev/video", 10)) return *api = &vs_camera_v4l2, VS_OK;
  if (stat(source, &about) != 0)
    return vs_fail(err, VS_FAIL, "camera '%s': %s; a source is %s", source, strerror(errno), vs_camera_sources());
  *api = S_ISDIR(about.st_mode) ? &vs_camera_folder : S_ISCHR(about.st_mode) ? &vs_camera_v4l2 : &vs_camera_file;
  return VS_OK;
}

vs_status vs_camera_open(const char *source, const vs_camera_def *def, vs_camera **out, vs_error *err) {
  *out = NULL;
  vs_camera_def fallback = vs_camera_def_default();
  const vs_camera_api *api = NULL;
  const char *rest;
  vs_status s = choose(source, &api, &rest, err);
  if (s != VS_OK) return s;
  vs_camera *camera = calloc(1, sizeof *camera);
  if (!camera) return vs_fail(err, VS_FAIL, "out of memory");
  camera->api = api;
  s = api->open(rest, def ? def : &fallback, &camera->handle, &camera->info, err);
  if (s != VS_OK) {
    free(camera);
    return s;
  }
  *out = camera;
  return VS_OK;
}

void vs_camera_close(vs_camera *camera) {
  if (!camera) return;
  camera->api->close(camera->handle);
  free(camera);
}

const vs_camera_info *vs_camera_about(const vs_camera *camera) { return &camera->info; }

vs_status vs_camera_read(vs_camera *camera, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  *got = VS_CAMERA_TIMEOUT;
  return camera->api->read(camera->handle, timeout_ms, out, got, err);
}
