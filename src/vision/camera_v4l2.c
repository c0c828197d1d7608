// A V4L2 camera: mapped buffers, each frame with the driver's own monotonic stamp and sequence number, always the newest.
// Pixel formats are in camera_v4l2_format.c.
#include "vision/camera_v4l2.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <linux/videodev2.h>

#include "vision/camera_sources.h"
#include "vision/jpeg.h"
#include "vsss/clock.h"
#include "vsss/image.h"

// Three: one being filled, one waiting, one read. More would only hold older pictures.
enum { BUFFERS = 3 };

struct vs_v4l2 {
  vs_v4l2_kernel kernel;
  int fd;
  char path[64];
  int width, height, stride;
  bool streaming;
  const vs_v4l2_format *format;
  double exposure_ms;
  vs_jpeg *jpeg; // for MJPG; NULL: none can be read
  int buffers;
  void *map[BUFFERS];
  size_t length[BUFFERS];
  uint8_t *bgr, *grey;
};

static int call(const vs_v4l2 *c, unsigned long request, void *argument) {
  int result;
  do result = c->kernel.ioctl(c->fd, request, argument);
  while (result < 0 && errno == EINTR);
  return result;
}

static vs_status open_device(vs_v4l2 *c, vs_camera_info *info, vs_error *err) {
  c->fd = c->kernel.open(c->path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (c->fd < 0) {
    const char *fix = errno == EACCES   ? " (add yourself to the group video)"
                      : errno == ENOENT ? " (no such camera: ls /dev/video*)"
                      : errno == EBUSY  ? " (another program uses it)"
                                        : "";
    return vs_fail(err, VS_FAIL, "%s: %s%s", c->path, strerror(errno), fix);
  }
  struct v4l2_capability about = {0};
  if (call(c, VIDIOC_QUERYCAP, &about) < 0)
    return vs_fail(err, VS_FAIL, "%s: not a V4L2 camera (%s)", c->path, strerror(errno));
  unsigned what = about.capabilities & V4L2_CAP_DEVICE_CAPS ? about.device_caps : about.capabilities;
  if (!(what & V4L2_CAP_VIDEO_CAPTURE) || !(what & V4L2_CAP_STREAMING))
    return vs_fail(err, VS_FAIL, "%s: '%.32s' captures no video: try the next /dev/videoN", c->path, about.card);
  snprintf(info->name, sizeof info->name, "%.32s", (const char *)about.card);
  return VS_OK;
}

// Asks for one size and pixel format; true: the driver gives a format we read (perhaps of another size).
static bool try_format(vs_v4l2 *c, const vs_v4l2_format *format, int width, int height) {
  struct v4l2_format f = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
  f.fmt.pix.width = (unsigned)width;
  f.fmt.pix.height = (unsigned)height;
  f.fmt.pix.pixelformat = format->pixel;
  f.fmt.pix.field = V4L2_FIELD_NONE;
  if (call(c, VIDIOC_S_FMT, &f) < 0 || f.fmt.pix.pixelformat != format->pixel) return false;
  c->width = (int)f.fmt.pix.width & ~1;
  c->height = (int)f.fmt.pix.height;
  if (format->pixel == V4L2_PIX_FMT_NV12) c->height &= ~1;
  c->stride = f.fmt.pix.bytesperline ? (int)f.fmt.pix.bytesperline : c->width * format->half_bytes / 2;
  c->format = format;
  return c->width > 0 && c->height > 0;
}

static vs_status choose_format(vs_v4l2 *c, const vs_camera_def *def, vs_error *err) {
  vs_error no_jpeg = {0};
  bool jpeg = vs_jpeg_new(&c->jpeg, &no_jpeg) == VS_OK;
  vs_v4l2_wish wish[VS_V4L2_WISHES];
  int wishes = vs_v4l2_wishes(&c->kernel, c->fd, def, jpeg, wish);
  for (int i = 0; i < wishes; i++)
    if (try_format(c, wish[i].format, wish[i].width, wish[i].height) && c->width == wish[i].width &&
        c->height == wish[i].height)
      return VS_OK;
  // No wish is met exactly: whatever size comes nearest.
  static const unsigned any[] = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_UYVY, V4L2_PIX_FMT_NV12, V4L2_PIX_FMT_MJPEG,
                                 V4L2_PIX_FMT_GREY};
  int width = def->width > 0 ? def->width : 640, height = def->height > 0 ? def->height : 480;
  for (size_t i = 0; i < sizeof any / sizeof *any; i++)
    if ((any[i] != V4L2_PIX_FMT_MJPEG || jpeg) && try_format(c, vs_v4l2_format_of(any[i]), width, height)) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: gives none of YUYV, UYVY, NV12, MJPG, GREY%s%s", c->path, jpeg ? "" : "; ",
                 jpeg ? "" : no_jpeg.text);
}

static double set_rate(vs_v4l2 *c, double fps) {
  struct v4l2_streamparm p = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
  p.parm.capture.timeperframe = (struct v4l2_fract){1000, (unsigned)(1000 * (fps > 0 ? fps : 60.0))};
  if (call(c, VIDIOC_S_PARM, &p) < 0 || !p.parm.capture.timeperframe.numerator) return 0.0;
  return (double)p.parm.capture.timeperframe.denominator / p.parm.capture.timeperframe.numerator;
}

static bool set_control(const vs_v4l2 *c, unsigned id, int value) {
  struct v4l2_control control = {.id = id, .value = value};
  return call(c, VIDIOC_S_CTRL, &control) == 0;
}

// By control id: the names change between kernels. What the camera does not have is said, not fatal.
static void set_exposure(vs_v4l2 *c, const vs_camera_def *def, vs_camera_info *info) {
  if (def->exposure_ms <= 0) return;
  bool manual = set_control(c, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
  set_control(c, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0); // else the driver lowers the frame rate in the dark
  bool set = set_control(c, V4L2_CID_EXPOSURE_ABSOLUTE, (int)(10 * def->exposure_ms + 0.5)); // unit 0.1 ms
  set_control(c, V4L2_CID_FOCUS_AUTO, 0);
  struct v4l2_control now = {.id = V4L2_CID_EXPOSURE_ABSOLUTE};
  if (manual && set && call(c, VIDIOC_G_CTRL, &now) == 0) c->exposure_ms = 0.1 * now.value;
  size_t used = strlen(info->note);
  if (c->exposure_ms <= 0)
    snprintf(info->note + used, sizeof info->note - used, "; no manual exposure: tags may blur");
  else if (c->exposure_ms > 5)
    snprintf(info->note + used, sizeof info->note - used, "; exposure %.1f ms is above 5: tags will blur",
             c->exposure_ms);
}

static double read_control(const vs_v4l2 *c, unsigned id) {
  struct v4l2_control now = {.id = id};
  return call(c, VIDIOC_G_CTRL, &now) == 0 ? now.value : 0.0;
}

// Colours that were learnt stay what they were only under a white balance and a gain that stay.
static void set_colours(const vs_v4l2 *c, const vs_camera_def *def, vs_camera_info *info) {
  set_control(c, V4L2_CID_AUTO_WHITE_BALANCE, 0);
  bool white = def->white_balance_k <= 0 ||
               set_control(c, V4L2_CID_WHITE_BALANCE_TEMPERATURE, (int)(def->white_balance_k + 0.5));
  if (def->gain > 0) set_control(c, V4L2_CID_AUTOGAIN, 0);
  bool gain = def->gain <= 0 || set_control(c, V4L2_CID_GAIN, (int)(def->gain + 0.5));
  info->white_balance_k = read_control(c, V4L2_CID_WHITE_BALANCE_TEMPERATURE);
  info->gain = read_control(c, V4L2_CID_GAIN);
  size_t used = strlen(info->note);
  if (info->gain > 0 || info->white_balance_k > 0)
    snprintf(info->note + used, sizeof info->note - used, "; gain %g, white balance %g K", info->gain,
             info->white_balance_k);
  used = strlen(info->note);
  if (!white || !gain)
    snprintf(info->note + used, sizeof info->note - used, "; the camera refuses %s",
             gain    ? "the white balance"
             : white ? "the gain"
                     : "gain and white balance");
}

static vs_status map_buffers(vs_v4l2 *c, vs_error *err) {
  struct v4l2_requestbuffers ask = {.count = BUFFERS, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
  if (call(c, VIDIOC_REQBUFS, &ask) < 0 || ask.count < 2)
    return vs_fail(err, VS_FAIL, "%s: no buffers (%s)", c->path, errno == EBUSY ? "another program uses it" : "driver");
  for (unsigned i = 0; i < ask.count && i < BUFFERS; i++) {
    struct v4l2_buffer b = {.index = i, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    if (call(c, VIDIOC_QUERYBUF, &b) < 0) return vs_fail(err, VS_FAIL, "%s: %s", c->path, strerror(errno));
    void *map = c->kernel.mmap(b.length, c->fd, (off_t)b.m.offset);
    if (map == MAP_FAILED) return vs_fail(err, VS_FAIL, "%s: mmap: %s", c->path, strerror(errno));
    c->map[i] = map;
    c->length[i] = b.length;
    c->buffers++;
    if (call(c, VIDIOC_QBUF, &b) < 0) return vs_fail(err, VS_FAIL, "%s: %s", c->path, strerror(errno));
  }
  return VS_OK;
}

static vs_status start(vs_v4l2 *c, vs_error *err) {
  c->bgr = malloc((size_t)c->width * c->height * 3);
  c->grey = malloc((size_t)c->width * c->height);
  if (!c->bgr || !c->grey) return vs_fail(err, VS_FAIL, "%s: out of memory", c->path);
  vs_status s = map_buffers(c, err);
  if (s != VS_OK) return s;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (call(c, VIDIOC_STREAMON, &type) < 0)
    return vs_fail(err, VS_FAIL, "%s: cannot start: %s", c->path,
                   errno == ENOSPC ? "not enough USB bandwidth; plug it into another port" : strerror(errno));
  c->streaming = true;
  return VS_OK;
}

vs_status vs_v4l2_open(const vs_v4l2_kernel *kernel, const char *path, const vs_camera_def *def, vs_v4l2 **out,
                       vs_camera_info *info, vs_error *err) {
  *out = NULL;
  *info = (vs_camera_info){0};
  vs_v4l2 *c = calloc(1, sizeof *c);
  if (!c) return vs_fail(err, VS_FAIL, "out of memory");
  c->kernel = *kernel;
  c->fd = -1;
  snprintf(c->path, sizeof c->path, "%s", path);
  vs_status s = open_device(c, info, err);
  if (s == VS_OK) s = choose_format(c, def, err);
  if (s == VS_OK) {
    info->fps = set_rate(c, def->fps);
    snprintf(info->note, sizeof info->note, "%s %d x %d at %.0f fps", c->format->name, c->width, c->height, info->fps);
    set_exposure(c, def, info);
    set_colours(c, def, info);
    s = start(c, err);
  }
  if (s != VS_OK) {
    vs_v4l2_close(c);
    return s;
  }
  info->width = c->width;
  info->height = c->height;
  info->exposure_ms = c->exposure_ms;
  *out = c;
  return VS_OK;
}

void vs_v4l2_close(vs_v4l2 *c) {
  if (!c) return;
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (c->streaming) call(c, VIDIOC_STREAMOFF, &type);
  for (int i = 0; i < c->buffers; i++) c->kernel.munmap(c->map[i], c->length[i]);
  if (c->fd >= 0) c->kernel.close(c->fd);
  vs_jpeg_free(c->jpeg);
  free(c->bgr);
  free(c->grey);
  free(c);
}

// Drivers stamp the start or the end of a frame; we mean the middle of its exposure.
static int64_t mid_exposure_us(const vs_v4l2 *c, const struct v4l2_buffer *b) {
  if ((b->flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) return vs_clock_monotonic_us();
  int64_t stamp = (int64_t)b->timestamp.tv_sec * 1000000 + b->timestamp.tv_usec;
  int64_t half = (int64_t)(500 * c->exposure_ms);
  return (b->flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE ? stamp + half : stamp - half;
}

// Takes all filled buffers out of the queue and keeps the newest whole one. 1: one is held, 0: none, -1: errno.
static int newest(const vs_v4l2 *c, struct v4l2_buffer *held) {
  int have = 0;
  for (int taken = 0; taken < 4 * BUFFERS; taken++) {
    struct v4l2_buffer b = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    if (call(c, VIDIOC_DQBUF, &b) < 0) {
      if (errno == EAGAIN) break;
      return -1;
    }
    struct v4l2_buffer *give_back = b.flags & V4L2_BUF_FLAG_ERROR ? &b : have ? held : NULL;
    if (give_back && call(c, VIDIOC_QBUF, give_back) < 0) return -1;
    if (give_back == &b) continue; // a broken frame: a USB packet was lost
    *held = b;
    have = 1;
  }
  return have;
}

static vs_status convert(vs_v4l2 *c, const struct v4l2_buffer *b, vs_error *err) {
  const uint8_t *pixels = c->map[b->index];
  size_t used = b->bytesused ? b->bytesused : b->length;
  if (!c->format->convert) return vs_jpeg_decode(c->jpeg, pixels, used, c->width, c->height, c->bgr, c->grey, err);
  int rows = c->format->pixel == V4L2_PIX_FMT_NV12 ? c->height * 3 / 2 : c->height;
  if (used < (size_t)c->stride * (rows - 1) + (size_t)c->width * c->format->half_bytes / 2)
    return vs_fail(err, VS_FAIL, "a frame of %zu bytes is too short", used);
  c->format->convert(pixels, c->stride, c->width, c->height, c->grey, c->width, c->bgr, 3 * c->width);
  return VS_OK;
}

vs_status vs_v4l2_read(vs_v4l2 *c, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  *got = VS_CAMERA_TIMEOUT;
  struct pollfd wait = {.fd = c->fd, .events = POLLIN};
  int ready = c->kernel.poll(&wait, 1, timeout_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return VS_OK;
  struct v4l2_buffer b = {0};
  int have = ready < 0 || wait.revents & (POLLERR | POLLNVAL) ? -1 : newest(c, &b);
  if (have < 0)
    return vs_fail(err, VS_FAIL, "%s: the camera is gone (%s): plug it in and start again", c->path, strerror(errno));
  if (!have) return VS_OK;
  // A frame that cannot be decoded is a lost frame, not a lost camera: seq shows the gap.
  bool whole = b.index < (unsigned)c->buffers && convert(c, &b, NULL) == VS_OK;
  int64_t capture_us = mid_exposure_us(c, &b);
  if (call(c, VIDIOC_QBUF, &b) < 0)
    return vs_fail(err, VS_FAIL, "%s: the camera is gone (%s): plug it in and start again", c->path, strerror(errno));
  if (!whole) return VS_OK;
  *out = (vs_frame){c->grey, c->bgr, c->width, c->height, c->width, 3 * c->width, capture_us, b.sequence};
  *got = VS_CAMERA_FRAME;
  return VS_OK;
}

// The real kernel.
static int real_open(const char *path, int flags) { return open(path, flags); }
static int real_ioctl(int fd, unsigned long request, void *argument) { return ioctl(fd, request, argument); }
static void *real_mmap(size_t length, int fd, off_t offset) {
  return mmap(NULL, length, PROT_READ | PROT_WRITE, MAP_SHARED, fd, offset);
}
static const vs_v4l2_kernel real_kernel = {real_open, close, real_ioctl, real_mmap, munmap, poll};

static vs_status device_open(const char *path, const vs_camera_def *def, void **handle, vs_camera_info *info,
                             vs_error *err) {
  vs_v4l2 *camera;
  vs_status s = vs_v4l2_open(&real_kernel, path, def, &camera, info, err);
  *handle = camera;
  return s;
}
static vs_status device_read(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  return vs_v4l2_read(handle, timeout_ms, out, got, err);
}
static void device_close(void *handle) { vs_v4l2_close(handle); }

const vs_camera_api vs_camera_v4l2 = {"/dev/video", "a V4L2 camera", device_open, device_read, device_close};
