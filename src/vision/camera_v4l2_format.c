// Which pixel format and size to ask a V4L2 camera for.
#include <errno.h>
#include <math.h>
#include <stdlib.h>

#include <linux/videodev2.h>

#include "vision/camera_v4l2.h"
#include "vsss/image.h"

// What is read, the cheaper to decode first. Grey shows no team colours: only where there is nothing else.
static const vs_v4l2_format formats[] = {
    {V4L2_PIX_FMT_YUYV, "YUYV", 4, vs_image_from_yuyv}, {V4L2_PIX_FMT_UYVY, "UYVY", 4, vs_image_from_uyvy},
    {V4L2_PIX_FMT_NV12, "NV12", 2, vs_image_from_nv12}, {V4L2_PIX_FMT_MJPEG, "MJPG", 0, NULL},
    {V4L2_PIX_FMT_GREY, "GREY", 2, vs_image_from_grey},
};
enum { FORMATS = sizeof formats / sizeof *formats };

const vs_v4l2_format *vs_v4l2_format_of(unsigned pixel) {
  for (int i = 0; i < FORMATS; i++)
    if (formats[i].pixel == pixel) return &formats[i];
  return NULL;
}

static int call(const vs_v4l2_kernel *kernel, int fd, unsigned long request, void *argument) {
  int result;
  do result = kernel->ioctl(fd, request, argument);
  while (result < 0 && errno == EINTR);
  return result;
}

static bool gives(const vs_v4l2_kernel *kernel, int fd, unsigned pixel, bool *listed) {
  for (unsigned i = 0;; i++) {
    struct v4l2_fmtdesc about = {.index = i, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    if (call(kernel, fd, VIDIOC_ENUM_FMT, &about) < 0) return false;
    *listed = true;
    if (about.pixelformat == pixel) return true;
  }
}

// The highest rate at a size; 0: the driver does not say, -1: it does not have the size.
static double best_fps(const vs_v4l2_kernel *kernel, int fd, unsigned pixel, int width, int height) {
  double best = 0;
  for (unsigned i = 0;; i++) {
    struct v4l2_frmivalenum rate = {
        .index = i, .pixel_format = pixel, .width = (unsigned)width, .height = (unsigned)height};
    if (call(kernel, fd, VIDIOC_ENUM_FRAMEINTERVALS, &rate) < 0) return i > 0 ? best : errno == EINVAL ? -1 : 0;
    struct v4l2_fract step = rate.type == V4L2_FRMIVAL_TYPE_DISCRETE ? rate.discrete : rate.stepwise.min;
    if (step.numerator) best = fmax(best, (double)step.denominator / step.numerator);
    if (rate.type != V4L2_FRMIVAL_TYPE_DISCRETE) return best;
  }
}

// Colours before none, the rate asked for before size, size before cheap decoding.
static int better_first(const void *a, const void *b) {
  const vs_v4l2_wish *p = a, *q = b;
  bool grey_p = p->format->pixel == V4L2_PIX_FMT_GREY, grey_q = q->format->pixel == V4L2_PIX_FMT_GREY;
  if (grey_p != grey_q) return grey_p ? 1 : -1;
  if (fabs(p->fps - q->fps) > 1) return p->fps > q->fps ? -1 : 1;
  if (p->width != q->width) return p->width > q->width ? -1 : 1;
  return (p->format > q->format) - (p->format < q->format);
}

int vs_v4l2_wishes(const vs_v4l2_kernel *kernel, int fd, const vs_camera_def *def, bool jpeg,
                   vs_v4l2_wish out[VS_V4L2_WISHES]) {
  static const int sizes[][2] = {{1280, 720}, {640, 480}};
  double wanted = def->fps > 0 ? def->fps : 60;
  int n = 0, sized = def->width > 0 && def->height > 0 ? 1 : 2;
  bool listed = false;
  for (int f = 0; f < FORMATS; f++) {
    if ((formats[f].pixel == V4L2_PIX_FMT_MJPEG && !jpeg) || !gives(kernel, fd, formats[f].pixel, &listed)) continue;
    for (int s = 0; s < sized; s++) {
      int width = def->width > 0 ? def->width : sizes[s][0], height = def->height > 0 ? def->height : sizes[s][1];
      double fps = best_fps(kernel, fd, formats[f].pixel, width, height);
      if (fps < 0) continue;
      out[n++] = (vs_v4l2_wish){&formats[f], width, height, fmin(fps > 0 ? fps : 30, wanted)};
    }
  }
  if (listed) {
    qsort(out, (size_t)n, sizeof *out, better_first);
    return n;
  }
  // A driver that lists nothing: USB 2 carries 720p at speed as MJPG only; at 640x480 YUYV spares the decoding.
  static const struct { int format, size; } usual[] = {{3, 0}, {0, 1}, {3, 1}};
  for (int i = 0; i < 3; i++) {
    const vs_v4l2_format *f = &formats[usual[i].format];
    if (!f->convert && !jpeg) continue;
    int s = usual[i].size;
    out[n++] =
        (vs_v4l2_wish){f, def->width > 0 ? def->width : sizes[s][0], def->height > 0 ? def->height : sizes[s][1], 0};
  }
  return n;
}
