// The kernel calls a V4L2 camera makes, as a table: the tests put a kernel of their own behind it.
#ifndef VSSS_VISION_CAMERA_V4L2_H
#define VSSS_VISION_CAMERA_V4L2_H

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "vsss/camera.h"

typedef struct vs_v4l2_kernel {
  int (*open)(const char *path, int flags);
  int (*close)(int fd);
  int (*ioctl)(int fd, unsigned long request, void *argument);
  void *(*mmap)(size_t length, int fd, off_t offset);
  int (*munmap)(void *start, size_t length);
  int (*poll)(struct pollfd *fds, nfds_t count, int timeout_ms);
} vs_v4l2_kernel;

// A pixel format that is read.
typedef struct vs_v4l2_format {
  unsigned pixel; // V4L2_PIX_FMT_...
  const char *name;
  int half_bytes; // a row's bytes are half of this times the width, where the driver does not say; 0: compressed
  void (*convert)(const uint8_t *pixels, int stride, int width, int height, uint8_t *grey, int grey_stride,
                  uint8_t *bgr, int bgr_stride); // NULL: JPEG
} vs_v4l2_format;
const vs_v4l2_format *vs_v4l2_format_of(unsigned pixel); // NULL: not read

// Formats and sizes worth asking for, best first: the rate that def asks for (60) goes before 1280x720.
enum { VS_V4L2_WISHES = 16 };
typedef struct vs_v4l2_wish {
  const vs_v4l2_format *format;
  int width, height;
  double fps; // no more than asked for; 0: not known
} vs_v4l2_wish;
int vs_v4l2_wishes(const vs_v4l2_kernel *kernel, int fd, const vs_camera_def *def, bool jpeg,
                   vs_v4l2_wish out[VS_V4L2_WISHES]);

typedef struct vs_v4l2 vs_v4l2;
vs_status vs_v4l2_open(const vs_v4l2_kernel *kernel, const char *path, const vs_camera_def *def, vs_v4l2 **out,
                       vs_camera_info *info, vs_error *err);
vs_status vs_v4l2_read(vs_v4l2 *camera, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err);
void vs_v4l2_close(vs_v4l2 *camera);

#endif
