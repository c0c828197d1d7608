#define _GNU_SOURCE // pipe2, F_SETPIPE_SZ

#include "video.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

struct vs_video {
  char path[512];
  size_t frame_bytes;
  pid_t ffmpeg;
  int pipe;       // raw frames
  FILE *messages; // what ffmpeg says
};

// ffmpeg gets its own process group, so that Ctrl-C lets us end the file properly.
static int start(vs_video *v, char *const argv[], int frames_fd) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, frames_fd, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(v->messages), STDERR_FILENO);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  int failed = posix_spawnp(&v->ffmpeg, "ffmpeg", &actions, &attributes, argv, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

static void release(vs_video *v) {
  if (v->pipe >= 0) close(v->pipe);
  if (v->messages) fclose(v->messages);
  free(v);
}

vs_status vs_video_open(const char *path, int width_px, int height_px, int fps, vs_video **out, vs_error *err) {
  *out = NULL;
  if (width_px % 2 || height_px % 2)
    return vs_fail(err, VS_USAGE, "video of %d x %d pixels: both must be even", width_px, height_px);
  vs_video *v = calloc(1, sizeof *v);
  if (!v) return vs_fail(err, VS_FAIL, "out of memory");
  snprintf(v->path, sizeof v->path, "%s", path);
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
  signal(SIGPIPE, SIG_IGN);              // a dead ffmpeg is an error of write(2)

  char size[32], rate[16];
  snprintf(size, sizeof size, "%dx%d", width_px, height_px);
  snprintf(rate, sizeof rate, "%d", fps);
  char *argv[] = {"ffmpeg",     "-nostdin", "-y",       "-loglevel", "error", "-f",       "rawvideo", "-pixel_format",
                  "rgb24",      "-s",       size,       "-r",        rate,    "-i",       "-",        "-c:v",
                  "libx264",    "-preset",  "veryfast", "-crf",      "20",    "-pix_fmt", "yuv420p",  "-movflags",
                  "+faststart", v->path,    NULL};
  int failed = start(v, argv, ends[0]);
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
