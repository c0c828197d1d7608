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

#define HELLO_MS 2000 // how long the server may take to answer
#define FRAME_MS 1000 // how long the rest of a begun picture may take

typedef struct client {
  char path[108];
  int fd, width, height;
  size_t bytes;
  uint8_t *bgr, *grey;
} client;

void vs_rig_default_path(const char *file, char *out, unsigned long out_size) {
  const char *runtime = getenv("XDG_RUNTIME_DIR");
  if (runtime && *runtime)
    snprintf(out, out_size, "%s/vsss-rig/%s", runtime, file);
  else
    snprintf(out, out_size, "%s/vsss-rig-%u/%s", P_tmpdir, (unsigned)getuid(), file);
}

typedef enum arrival { ARRIVED, NOTHING, GONE } arrival;

// Reads size bytes. NOTHING: none came within timeout_ms; once the first is there the rest has FRAME_MS.
static arrival receive(int fd, void *out, size_t size, int timeout_ms) {
  uint8_t *bytes = out;
  size_t have = 0;
  while (have < size) {
    struct pollfd wait = {.fd = fd, .events = POLLIN};
    int ready = poll(&wait, 1, have ? FRAME_MS : timeout_ms);
    if (ready < 0 && errno == EINTR) {
      if (have) continue;
      return NOTHING; // let the caller see its signal
    }
    if (ready == 0) return have ? GONE : NOTHING;
    ssize_t n = recv(fd, bytes + have, size - have, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return GONE;
    have += (size_t)n;
  }
  return ARRIVED;
}

static void close_client(void *handle) {
  client *c = handle;
  if (c->fd >= 0) close(c->fd);
  free(c->bgr);
  free(c->grey);
  free(c);
}

static vs_status shake_hands(client *c, vs_camera_info *info, vs_error *err) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  snprintf(address.sun_path, sizeof address.sun_path, "%s", c->path);
  c->fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (c->fd < 0 || connect(c->fd, (struct sockaddr *)&address, sizeof address))
    return vs_fail(err, VS_FAIL, "rig:%s: %s; start it with 'vsss rig'", c->path, strerror(errno));
  vs_wire_hello hello;
  arrival got = receive(c->fd, &hello, sizeof hello, HELLO_MS);
  if (got == NOTHING) return vs_fail(err, VS_FAIL, "rig:%s: busy with another viewer", c->path);
  if (got == GONE || hello.magic != VS_WIRE_HELLO || hello.width_px < 1 || hello.width_px > 8192 ||
      hello.height_px < 1 || hello.height_px > 8192)
    return vs_fail(err, VS_FAIL, "rig:%s: not a rig of this version", c->path);
  c->width = (int)hello.width_px;
  c->height = (int)hello.height_px;
  c->bytes = (size_t)c->width * (size_t)c->height * 3;
  c->bgr = malloc(c->bytes);
  c->grey = malloc(c->bytes / 3);
  if (!c->bgr || !c->grey) return vs_fail(err, VS_FAIL, "out of memory");
  *info = (vs_camera_info){.width = c->width, .height = c->height, .fps = hello.fps};
  snprintf(info->name, sizeof info->name, "rig");
  return VS_OK;
}

static vs_status open_client(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                             vs_error *err) {
  (void)def; // the rig's own size and pace
  client *c = calloc(1, sizeof *c);
  if (!c) return vs_fail(err, VS_FAIL, "out of memory");
  c->fd = -1;
  if (*rest)
    snprintf(c->path, sizeof c->path, "%s", rest);
  else
    vs_rig_default_path("camera", c->path, sizeof c->path);
  vs_status s = shake_hands(c, info, err);
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

static vs_status read_client(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  client *c = handle;
  vs_wire_frame head;
  // More than one may wait: the newest counts.
  bool have = false;
  for (;;) {
    arrival a = receive(c->fd, &head, sizeof head, have ? 0 : timeout_ms);
    if (a == NOTHING) break;
    if (a == ARRIVED) a = receive(c->fd, c->bgr, c->bytes, FRAME_MS);
    if (a == GONE || head.magic != VS_WIRE_FRAME) return vs_fail(err, VS_FAIL, "rig:%s: the rig is gone", c->path);
    out->capture_us = head.capture_us;
    out->seq = head.seq;
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
