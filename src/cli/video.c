#define _GNU_SOURCE // pipe2, F_SETPIPE_SZ

#include "video.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

#include "child.h"

struct vs_video {
  char path[512], file[520]; // file: as ffmpeg takes it, whatever the name begins with
  size_t frame_bytes;
  pid_t ffmpeg;
  int pipe;       // raw frames
  FILE *messages; // what ffmpeg says
};

static void release(vs_video *v) {
  if (v->pipe >= 0) close(v->pipe);
  if (v->messages) fclose(v->messages);
  free(v);
}

// Containers that hold H.264, by the ending that ffmpeg goes by.
static bool is_container(const char *path) {
  static const char *const endings[] = {".mp4", ".mkv", ".mov", ".avi"};
  size_t length = strlen(path);
  for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
    if (length > 4 && strcasecmp(path + length - 4, endings[i]) == 0) return true;
  return false;
}

// Before the first frame, and without touching a video that is there.
static vs_status check_path(const char *path, vs_error *err) {
  if (!is_container(path))
    return vs_fail(err, VS_USAGE, "%s: the name of a video ends in .mp4, .mkv, .mov or .avi", path);
  bool was_there = access(path, F_OK) == 0;
  int file = open(path, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return vs_fail(err, VS_FAIL, "%s: cannot be written: %s", path, strerror(errno));
  close(file);
  if (!was_there) unlink(path);
  return VS_OK;
}

vs_status vs_video_open(const char *path, int width_px, int height_px, int fps, vs_video **out, vs_error *err) {
  *out = NULL;
  if (width_px % 2 || height_px % 2)
    return vs_fail(err, VS_USAGE, "video of %d x %d pixels: both must be even", width_px, height_px);
  vs_status checked = check_path(path, err);
  if (checked != VS_OK) return checked;
  vs_video *v = calloc(1, sizeof *v);
  if (!v) return vs_fail(err, VS_FAIL, "out of memory");
  snprintf(v->path, sizeof v->path, "%s", path);
  snprintf(v->file, sizeof v->file, "file:%s", path);
  v->frame_bytes = (size_t)width_px * (size_t)height_px * 3;
  v->pipe = -1;
  v->messages = tmpfile();
  int ends[2];
  if (!v->messages || pipe2(ends, O_CLOEXEC)) {
    vs_status s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
    release(v);
    return s;
  }
  v->pipe = ends[1];
  fcntl(v->pipe, F_SETPIPE_SZ, 1 << 20); // fewer switches between us and ffmpeg; the smaller default works too

  char size[32], rate[16];
  snprintf(size, sizeof size, "%dx%d", width_px, height_px);
  snprintf(rate, sizeof rate, "%d", fps);
  char *argv[] = {"ffmpeg",     "-nostdin", "-y",       "-loglevel", "error", "-f",       "rawvideo", "-pixel_format",
                  "rgb24",      "-s",       size,       "-r",        rate,    "-i",       "-",        "-c:v",
                  "libx264",    "-preset",  "veryfast", "-crf",      "20",    "-pix_fmt", "yuv420p",  "-movflags",
                  "+faststart", v->file,    NULL};
  // Its own process group, so that Ctrl-C lets us end the file properly.
  const vs_child_def child = {.argv = argv, .in = ends[0], .err = fileno(v->messages), .own_group = true};
  int failed = vs_child_start(&child, &v->ffmpeg);
  close(ends[0]);
  if (failed) {
    vs_status s = failed == ENOENT
                      ? vs_fail(err, VS_FAIL, "%s: writing a video needs the program ffmpeg; install ffmpeg", path)
                      : vs_fail(err, VS_FAIL, "%s: ffmpeg does not start: %s", path, strerror(failed));
    release(v);
    return s;
  }
  *out = v;
  return VS_OK;
}

// The first line ffmpeg wrote, or what to think where it wrote none.
static void reason(vs_video *v, char *text, size_t size) {
  rewind(v->messages);
  if (!fgets(text, (int)size, v->messages)) snprintf(text, size, "ffmpeg ended without a reason");
  text[strcspn(text, "\n")] = '\0';
}

vs_status vs_video_frame(vs_video *v, const uint8_t *rgb, vs_error *err) {
  for (size_t done = 0; done < v->frame_bytes;) {
    ssize_t n = write(v->pipe, rgb + done, v->frame_bytes - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      char why[200];
      waitpid(v->ffmpeg, NULL, 0);
      v->ffmpeg = 0;
      reason(v, why, sizeof why);
      return vs_fail(err, VS_FAIL, "%s: %s", v->path, why);
    }
    done += (size_t)n;
  }
  return VS_OK;
}

vs_status vs_video_close(vs_video *v, vs_error *err) {
  if (!v) return VS_OK;
  close(v->pipe);
  v->pipe = -1;
  int status = 0;
  vs_status s = VS_OK;
  while (v->ffmpeg && waitpid(v->ffmpeg, &status, 0) < 0 && errno == EINTR)
    ;
  if (!v->ffmpeg || status) { // ended before its time, or reports an error
    char why[200];
    reason(v, why, sizeof why);
    s = vs_fail(err, VS_FAIL, "%s: %s", v->path, why);
  }
  release(v);
  return s;
}
