// Recordings as cameras: a picture, a folder of pictures in the order of their names, a video. Played at their own pace
// against the monotonic clock, newest frame first like a device, or frame by frame (vs_camera_def.every_frame).
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "vision/camera_sources.h"
#include "vision/opencv.h"
#include "vsss/clock.h"
#include "vsss/image.h"

typedef struct recording {
  const vs_opencv *cv;
  vs_video *video; // or NULL: pictures
  char **path;     // pictures, [count]
  int count;       // pictures; a video's is not known before its end
  int next;        // index of the frame that was not given yet
  int width, height;
  double fps;
  bool every_frame;
  int64_t start_us;    // of the first read: time spent before it skips nothing
  uint8_t *bgr, *grey; // of the last frame given
  bool decoded;        // a picture's first frame was read on opening
} recording;

static void recording_close(void *handle) {
  recording *r = handle;
  if (!r) return;
  if (r->video) r->cv->video_close(r->video);
  for (int i = 0; i < r->count; i++) free(r->path[i]);
  free(r->path);
  free(r->bgr);
  free(r->grey);
  free(r);
}

static vs_status read_picture(recording *r, const char *path, vs_error *err) {
  uint8_t *bgr;
  int width, height;
  vs_status s = r->cv->picture_read(path, &bgr, &width, &height, err);
  if (s != VS_OK) return s;
  if (r->bgr && (width != r->width || height != r->height))
    s = vs_fail(err, VS_FAIL, "%s: %d x %d, but the pictures before are %d x %d", path, width, height, r->width,
                r->height);
  if (s == VS_OK && !r->bgr) {
    r->bgr = malloc((size_t)width * height * 3);
    r->width = width, r->height = height;
    if (!r->bgr) s = vs_fail(err, VS_FAIL, "%s: out of memory", path);
  }
  if (s == VS_OK) memcpy(r->bgr, bgr, (size_t)width * height * 3);
  r->cv->release(bgr);
  return s;
}

static vs_status begin(recording *r, const char *path, const vs_camera_def *def, vs_camera_info *info, vs_error *err) {
  if (!(r->fps > 0 && r->fps < 1000)) r->fps = def->fps > 0 ? def->fps : 30.0;
  if (r->width <= 0 || r->height <= 0) return vs_fail(err, VS_FAIL, "%s: holds no picture", path);
  if (!r->bgr) r->bgr = malloc((size_t)r->width * r->height * 3);
  r->grey = malloc((size_t)r->width * r->height);
  if (!r->bgr || !r->grey) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  r->every_frame = def->every_frame;
  const char *slash = strrchr(path, '/');
  *info = (vs_camera_info){.width = r->width, .height = r->height, .fps = r->fps};
  snprintf(info->name, sizeof info->name, "%s", slash && slash[1] ? slash + 1 : path);
  return VS_OK;
}

static vs_status add_path(recording *r, const char *path, vs_error *err) {
  char **grown = realloc(r->path, (r->count + 1) * sizeof *grown);
  char *copy = strdup(path);
  if (grown) r->path = grown;
  if (!grown || !copy) {
    free(copy);
    return vs_fail(err, VS_FAIL, "out of memory");
  }
  r->path[r->count++] = copy;
  return VS_OK;
}

static bool ends_like_a_picture(const char *name) {
  static const char *const endings[] = {".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".pgm", ".tif", ".tiff", ".webp"};
  const char *dot = strrchr(name, '.');
  for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
    if (!strcasecmp(dot, endings[i])) return true;
  return false;
}

static vs_status begin_pictures(recording *r, const char *path, const vs_camera_def *def, vs_camera_info *info,
                                vs_error *err) {
  vs_status s = read_picture(r, r->path[0], err);
  if (s != VS_OK) return s;
  r->decoded = true;
  r->fps = def->fps;
  return begin(r, path, def, info, err);
}

static vs_status new_recording(recording **out, vs_error *err) {
  const vs_opencv *cv = NULL;
  vs_status s = vs_opencv_load(&cv, err);
  if (s != VS_OK) return s;
  *out = calloc(1, sizeof **out);
  if (!*out) return vs_fail(err, VS_FAIL, "out of memory");
  (*out)->cv = cv;
  return VS_OK;
}

static vs_status file_open(const char *path, const vs_camera_def *def, void **handle, vs_camera_info *info,
                           vs_error *err) {
  recording *r = NULL;
  vs_status s = new_recording(&r, err);
  if (s == VS_OK && ends_like_a_picture(path)) {
    s = add_path(r, path, err);
    if (s == VS_OK) s = begin_pictures(r, path, def, info, err);
  } else if (s == VS_OK) {
    s = r->cv->video_open(path, &r->video, &r->width, &r->height, &r->fps, err);
    if (s == VS_OK) s = begin(r, path, def, info, err);
  }
  if (s != VS_OK) recording_close(r);
  *handle = s == VS_OK ? r : NULL;
  return s;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static vs_status list_pictures(recording *r, const char *folder, vs_error *err) {
  DIR *dir = opendir(folder);
  if (!dir) return vs_fail(err, VS_FAIL, "%s: %s", folder, strerror(errno));
  vs_status s = VS_OK;
  char path[4096];
  for (struct dirent *e; s == VS_OK && (e = readdir(dir));) {
    if (!ends_like_a_picture(e->d_name)) continue;
    if (snprintf(path, sizeof path, "%s/%s", folder, e->d_name) >= (int)sizeof path)
      s = vs_fail(err, VS_FAIL, "%s/%s: path too long", folder, e->d_name);
    else
      s = add_path(r, path, err);
  }
  closedir(dir);
  if (s == VS_OK && r->count == 0)
    s = vs_fail(err, VS_FAIL, "%s: no picture in this folder (.png .jpg .bmp .ppm .tif .webp)", folder);
  if (s == VS_OK) qsort(r->path, r->count, sizeof *r->path, by_name);
  return s;
}

static vs_status folder_open(const char *path, const vs_camera_def *def, void **handle, vs_camera_info *info,
                             vs_error *err) {
  recording *r = NULL;
  vs_status s = new_recording(&r, err);
  if (s == VS_OK) s = list_pictures(r, path, err);
  if (s == VS_OK) s = begin_pictures(r, path, def, info, err);
  if (s != VS_OK) recording_close(r);
  *handle = s == VS_OK ? r : NULL;
  return s;
}

static int64_t due_us(const recording *r, int index) { return r->start_us + (int64_t)(1e6 * index / r->fps); }

// Waits for the next frame's time and chooses the newest that is due. false: not within timeout_ms.
static bool wait_for_newest(const recording *r, int timeout_ms, int *index) {
  int64_t now = vs_clock_monotonic_us(), due = due_us(r, r->next), last = now + 1000 * (int64_t)timeout_ms;
  *index = r->next;
  if (due > now) {
    vs_clock_sleep_until_us(due < last ? due : last);
    return due <= last;
  }
  while (due_us(r, *index + 1) <= now) ++*index;
  return true;
}

// Frame index into r->bgr. *end: there is none.
static vs_status decode(recording *r, int index, bool *end, vs_error *err) {
  *end = false;
  if (r->video) return r->cv->video_read(r->video, index - r->next, r->bgr, end, err);
  bool have = r->decoded && index == 0;
  return have ? VS_OK : read_picture(r, r->path[index], err);
}

static vs_status recording_read(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  recording *r = handle;
  int index = r->next;
  bool end = !r->video && r->next >= r->count;
  *got = VS_CAMERA_END;
  if (end) return VS_OK;
  if (!r->start_us) r->start_us = vs_clock_monotonic_us();
  *got = VS_CAMERA_TIMEOUT;
  if (!r->every_frame && !wait_for_newest(r, timeout_ms, &index)) return VS_OK;
  if (!r->video && index >= r->count) index = r->count - 1; // late: the last one is the newest
  vs_status s = decode(r, index, &end, err);
  if (s != VS_OK) return s;
  r->next = index + 1;
  if (end) return *got = VS_CAMERA_END, VS_OK;
  vs_image_grey(r->bgr, 3 * r->width, r->width, r->height, r->grey, r->width);
  *out = (vs_frame){r->grey, r->bgr, r->width, r->height, r->width, 3 * r->width, due_us(r, index), (uint32_t)index};
  *got = VS_CAMERA_FRAME;
  return VS_OK;
}

const vs_camera_api vs_camera_file = {"file", "a video or picture file", file_open, recording_read, recording_close};
const vs_camera_api vs_camera_folder = {"folder", "a folder of pictures", folder_open, recording_read, recording_close};
