// The reader's end of a frame stream, as a camera.
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "frame_wire.h"
#include "vsss/clock.h"
#include "vsss/frame_stream.h"
#include "vsss/image.h"
#include "vsss/paths.h"

#define HELLO_MS 1000 // how long the server may take to say its hello

typedef struct client {
  char path[108];
  int fd, width, height;
  size_t bytes; // of a picture
  uint8_t *bgr, *grey;
  // The picture that is arriving: however slowly it comes, nobody waits for the rest of it.
  vs_wire_frame head;
  uint8_t *arriving;
  size_t have; // bytes of head and picture
} client;

void vs_rig_default_path(const char *file, char *out, unsigned long out_size) {
  const char *runtime = getenv("XDG_RUNTIME_DIR");
  if (runtime && *runtime)
    snprintf(out, out_size, "%s/vsss-rig/%s", runtime, file);
  else
    snprintf(out, out_size, "%s/vsss-rig-%u/%s", P_tmpdir, (unsigned)getuid(), file);
}

typedef enum arrival { ARRIVED, NOTHING, GONE } arrival;

// Waits until the socket can be read; NOTHING: not by until_us, or a signal came and the caller shall see it.
static arrival await(int fd, int64_t until_us) {
  int64_t left_us = until_us - vs_clock_monotonic_us();
  struct pollfd wait = {.fd = fd, .events = POLLIN};
  return poll(&wait, 1, left_us > 0 ? (int)((left_us + 999) / 1000) : 0) > 0 ? ARRIVED : NOTHING;
}

// Reads on from *have to size.
static arrival receive(int fd, void *out, size_t size, size_t *have, int64_t until_us) {
  while (*have < size) {
    if (await(fd, until_us) == NOTHING) return NOTHING;
    ssize_t n = recv(fd, (uint8_t *)out + *have, size - *have, MSG_DONTWAIT);
    if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (n <= 0) return GONE;
    *have += (size_t)n;
  }
  return ARRIVED;
}

static void close_client(void *handle) {
  client *c = handle;
  if (c->fd >= 0) close(c->fd);
  free(c->bgr);
  free(c->grey);
  free(c->arriving);
  free(c);
}

static vs_status shake_hands(client *c, vs_camera_info *info, vs_error *err) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  snprintf(address.sun_path, sizeof address.sun_path, "%s", c->path);
  c->fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (c->fd < 0 || connect(c->fd, (struct sockaddr *)&address, sizeof address))
    return vs_fail(err, VS_FAIL, "rig:%s: %s; start it with 'vsss rig'", c->path, strerror(errno));
  vs_wire_hello hello;
  size_t have = 0;
  arrival got = receive(c->fd, &hello, sizeof hello, &have, vs_clock_monotonic_us() + 1000 * HELLO_MS);
  if (got == NOTHING) return vs_fail(err, VS_FAIL, "rig:%s: busy with another viewer", c->path);
  if (got == GONE || hello.magic != VS_WIRE_HELLO || hello.width_px < 1 || hello.width_px > 8192 ||
      hello.height_px < 1 || hello.height_px > 8192)
    return vs_fail(err, VS_FAIL, "rig:%s: not a rig of this version", c->path);
  c->width = (int)hello.width_px;
  c->height = (int)hello.height_px;
  c->bytes = (size_t)c->width * (size_t)c->height * 3;
  c->bgr = malloc(c->bytes);
  c->grey = malloc(c->bytes / 3);
  c->arriving = malloc(c->bytes);
  if (!c->bgr || !c->grey || !c->arriving) return vs_fail(err, VS_FAIL, "out of memory");
  *info = (vs_camera_info){.width = c->width, .height = c->height, .fps = hello.fps};
  snprintf(info->name, sizeof info->name, "rig");
  return VS_OK;
}

// In the folder for passing files anybody may have made one of this name.
static vs_status default_camera(client *c, vs_error *err) {
  char folder[sizeof c->path];
  int fd;
  vs_rig_default_path("camera", c->path, sizeof c->path);
  vs_rig_default_path("", folder, sizeof folder);
  if (access(folder, F_OK) != 0) return VS_OK; // no rig: told where the camera is missing
  vs_status s = vs_path_own_folder(folder, false, &fd, err);
  if (s == VS_OK) close(fd);
  return s;
}

static vs_status open_client(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                             vs_error *err) {
  (void)def; // the rig's own size and pace
  client *c = calloc(1, sizeof *c);
  if (!c) return vs_fail(err, VS_FAIL, "out of memory");
  c->fd = -1;
  vs_status s = VS_OK;
  if (*rest)
    snprintf(c->path, sizeof c->path, "%s", rest);
  else
    s = default_camera(c, err);
  if (s == VS_OK) s = shake_hands(c, info, err);
  if (s != VS_OK) {
    close_client(c);
    return s;
  }
  *handle = c;
  return VS_OK;
}

static void swap_red_and_blue(uint8_t *pixel, size_t pixels) {
  for (size_t i = 0; i < pixels; i++, pixel += 3) {
    uint8_t red = pixel[0];
    pixel[0] = pixel[2];
    pixel[2] = red;
  }
}

// Takes in what is there of the next picture.
static arrival next_picture(client *c, int64_t until_us) {
  size_t head = c->have < sizeof c->head ? c->have : sizeof c->head;
  arrival a = receive(c->fd, &c->head, sizeof c->head, &head, until_us);
  if (c->have < sizeof c->head) c->have = head;
  if (a != ARRIVED) return a;
  if (c->head.magic != VS_WIRE_FRAME) return GONE;
  size_t pixels = c->have - sizeof c->head;
  a = receive(c->fd, c->arriving, c->bytes, &pixels, until_us);
  c->have = sizeof c->head + pixels;
  return a;
}

static vs_status read_client(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  client *c = handle;
  // More than one may wait: the newest counts.
  bool have = false;
  int64_t until_us = vs_clock_monotonic_us() + 1000LL * timeout_ms;
  for (;;) {
    arrival a = next_picture(c, have ? 0 : until_us);
    if (a == NOTHING) break;
    if (a == GONE) return vs_fail(err, VS_FAIL, "rig:%s: the rig is gone", c->path);
    uint8_t *whole = c->arriving;
    c->arriving = c->bgr;
    c->bgr = whole;
    c->have = 0;
    out->capture_us = c->head.capture_us;
    out->seq = c->head.seq;
    have = true;
  }
  *got = have ? VS_CAMERA_FRAME : VS_CAMERA_TIMEOUT;
  if (!have) return VS_OK;
  swap_red_and_blue(c->bgr, c->bytes / 3);
  vs_image_grey(c->bgr, 3 * c->width, c->width, c->height, c->grey, c->width);
  out->bgr = c->bgr;
  out->grey = c->grey;
  out->width = c->width;
  out->height = c->height;
  out->bgr_stride = 3 * c->width;
  out->grey_stride = c->width;
  return VS_OK;
}

const vs_camera_api *vs_frame_stream_camera(void) {
  static const vs_camera_api api = {
      .scheme = "rig",
      .help = "rig:SOCKET the venue of 'vsss rig'",
      .open = open_client,
      .read = read_client,
      .close = close_client,
  };
  return &api;
}
