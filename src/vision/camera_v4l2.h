// The kernel calls a V4L2 camera makes, as a table: the tests put a kernel of their own behind it.
#ifndef VSSS_VISION_CAMERA_V4L2_H
#define VSSS_VISION_CAMERA_V4L2_H

#include <poll.h>
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

typedef struct vs_v4l2 vs_v4l2;
vs_status vs_v4l2_open(const vs_v4l2_kernel *kernel, const char *path, const vs_camera_def *def, vs_v4l2 **out,
                       vs_camera_info *info, vs_error *err);
vs_status vs_v4l2_read(vs_v4l2 *camera, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err);
void vs_v4l2_close(vs_v4l2 *camera);

#endif
