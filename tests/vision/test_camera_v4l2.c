// src/vision/camera_v4l2.c, against a kernel of our own
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include <linux/videodev2.h>

#include "assert_near.h"
#include "vision/camera_v4l2.h"
#include "vsss/image.h"

// A driver with one format, a queue of filled buffers, and a memory of what it was asked.
enum { FD = 77, SLOTS = 3, MOST = 8 };
static struct {
  int open_errno, caps, no_exposure, gone, streamon_errno;
  unsigned format; // the only one it gives
  int width, height, padding;
  unsigned stamp_flags;
  unsigned char memory[SLOTS][640 * 480 * 2 + 4096];
  bool queued[SLOTS], mapped[SLOTS], opened, streaming;
  struct v4l2_buffer filled[MOST]; // oldest first
  int fills, exposure, exposure_auto, asked_fps, closes, gain, kelvin, auto_white;
  // What it lists, if anything: then S_FMT gives what is asked.
  int listed;
  struct {
    unsigned pixel;
    int width, height, fps;
  } mode[8];
} driver;

static void reset_driver(void) {
  memset(&driver, 0, sizeof driver);
  driver.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  driver.format = V4L2_PIX_FMT_YUYV;
  driver.width = 640, driver.height = 480;
  driver.stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  driver.exposure = 156; // 15.6 ms
}

static int errno_is(int number) {
  errno = number;
  return -1;
}

static int fake_open(const char *path, int flags) {
  (void)path, (void)flags;
  if (driver.open_errno) return errno_is(driver.open_errno);
  driver.opened = true;
  return FD;
}
static int fake_close(int fd) {
  assert_int_equal(fd, FD);
  driver.opened = false;
  driver.closes++;
  return 0;
}

static int control(struct v4l2_control *c, bool set) {
  if (driver.no_exposure) return errno_is(EINVAL);
  if (c->id == V4L2_CID_EXPOSURE_AUTO && set) return driver.exposure_auto = c->value, 0;
  if (c->id == V4L2_CID_EXPOSURE_ABSOLUTE) {
    if (set) driver.exposure = c->value;
    c->value = driver.exposure;
    return 0;
  }
  int *value = c->id == V4L2_CID_GAIN                        ? &driver.gain
               : c->id == V4L2_CID_WHITE_BALANCE_TEMPERATURE ? &driver.kelvin
               : c->id == V4L2_CID_AUTO_WHITE_BALANCE        ? &driver.auto_white
                                                             : NULL;
  if (!value || (value != &driver.auto_white && !*value)) return errno_is(EINVAL); // no focus; gain 0: none
  if (set) *value = c->value;
  c->value = *value;
  return 0;
}

static int list_format(struct v4l2_fmtdesc *about) {
  unsigned known = 0, last = 0;
  for (int i = 0; i < driver.listed; i++) {
    if (driver.mode[i].pixel == last) continue;
    last = driver.mode[i].pixel;
    if (known++ == about->index) return about->pixelformat = last, 0;
  }
  return errno_is(EINVAL);
}

static int list_rate(struct v4l2_frmivalenum *r) {
  for (int i = 0; i < driver.listed; i++) {
    if (driver.mode[i].pixel != r->pixel_format || driver.mode[i].width != (int)r->width || r->index > 0) continue;
    r->type = V4L2_FRMIVAL_TYPE_DISCRETE;
    r->discrete = (struct v4l2_fract){1, (unsigned)driver.mode[i].fps};
    return 0;
  }
  return errno_is(EINVAL);
}

static int dequeue(struct v4l2_buffer *b) {
  if (driver.gone) return errno_is(ENODEV);
  if (!driver.fills) return errno_is(EAGAIN);
  *b = driver.filled[0];
  memmove(driver.filled, driver.filled + 1, (size_t)--driver.fills * sizeof *driver.filled);
  return 0;
}

static int fake_ioctl(int fd, unsigned long request, void *argument) {
  assert_int_equal(fd, FD);
  static int interruptions;
  if (++interruptions % 5 == 0) return errno_is(EINTR); // a signal now and then must not matter
  switch (request) {
  case VIDIOC_QUERYCAP: {
    struct v4l2_capability *c = argument;
    memcpy(c->card, "Fake Cam", 9);
    c->capabilities = V4L2_CAP_DEVICE_CAPS;
    c->device_caps = (unsigned)driver.caps;
    return 0;
  }
  case VIDIOC_S_FMT: {
    struct v4l2_pix_format *f = &((struct v4l2_format *)argument)->fmt.pix;
    if (driver.listed) {
      driver.format = f->pixelformat;
      driver.width = (int)f->width, driver.height = (int)f->height;
    }
    f->pixelformat = driver.format;
    f->width = (unsigned)driver.width, f->height = (unsigned)driver.height;
    f->bytesperline = driver.format == V4L2_PIX_FMT_YUYV ? (unsigned)(2 * driver.width + driver.padding) : 0;
    return 0;
  }
  case VIDIOC_ENUM_FMT: return driver.listed ? list_format(argument) : errno_is(ENOTTY);
  case VIDIOC_ENUM_FRAMEINTERVALS: return list_rate(argument);
  case VIDIOC_S_PARM: {
    struct v4l2_captureparm *p = &((struct v4l2_streamparm *)argument)->parm.capture;
    driver.asked_fps = (int)(p->timeperframe.denominator / p->timeperframe.numerator);
    p->timeperframe = (struct v4l2_fract){1, 30};
    return 0;
  }
  case VIDIOC_S_CTRL: return control(argument, true);
  case VIDIOC_G_CTRL: return control(argument, false);
  case VIDIOC_REQBUFS: return 0;
  case VIDIOC_QUERYBUF: {
    struct v4l2_buffer *b = argument;
    b->length = sizeof driver.memory[0];
    b->m.offset = b->index;
    return 0;
  }
  case VIDIOC_QBUF: {
    unsigned index = ((struct v4l2_buffer *)argument)->index;
    assert_true(index < SLOTS && !driver.queued[index]);
    driver.queued[index] = true;
    return 0;
  }
  case VIDIOC_DQBUF: return dequeue(argument);
  case VIDIOC_STREAMON:
    if (driver.streamon_errno) return errno_is(driver.streamon_errno);
    driver.streaming = true;
    return 0;
  case VIDIOC_STREAMOFF:
    driver.streaming = false;
    memset(driver.queued, 0, sizeof driver.queued); // as a driver gives all buffers back
    return 0;
  }
  return errno_is(ENOTTY);
}
static void *fake_mmap(size_t length, int fd, off_t offset) {
  assert_int_equal(fd, FD);
  assert_int_equal(length, sizeof driver.memory[0]);
  driver.mapped[offset] = true;
  return driver.memory[offset];
}
static int fake_munmap(void *start, size_t length) {
  (void)length;
  for (int i = 0; i < SLOTS; i++)
    if (start == driver.memory[i]) driver.mapped[i] = false;
  return 0;
}
static int fake_poll(struct pollfd *fds, nfds_t count, int timeout_ms) {
  (void)count, (void)timeout_ms;
  fds->revents = driver.gone ? POLLERR : driver.fills ? POLLIN : 0;
  return driver.gone || driver.fills;
}
static const vs_v4l2_kernel kernel = {fake_open, fake_close, fake_ioctl, fake_mmap, fake_munmap, fake_poll};

// The driver fills a queued buffer with one grey.
static void fill(int slot, int grey, uint32_t sequence, int64_t stamp_us, unsigned flags) {
  assert_true(driver.queued[slot]);
  driver.queued[slot] = false;
  int stride = 2 * driver.width + driver.padding;
  for (int i = 0; i < stride * driver.height; i++) driver.memory[slot][i] = (unsigned char)(i % 2 ? 128 : grey);
  driver.filled[driver.fills++] = (struct v4l2_buffer){.index = (unsigned)slot,
                                                       .bytesused = (unsigned)(stride * driver.height),
                                                       .length = sizeof driver.memory[0],
                                                       .sequence = sequence,
                                                       .flags = driver.stamp_flags | flags,
                                                       .timestamp = {stamp_us / 1000000, stamp_us % 1000000}};
}

static vs_v4l2 *open_it(vs_camera_info *info) {
  vs_v4l2 *camera;
  vs_camera_def def = vs_camera_def_default();
  assert_ok(vs_v4l2_open(&kernel, "/dev/video0", &def, &camera, info, err));
  return camera;
}

static void opening_asks_for_manual_exposure_and_says_what_was_obtained(void **state) {
  (void)state;
  reset_driver();
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  assert_string_equal(info.name, "Fake Cam");
  assert_int_equal(info.width, 640);
  assert_int_equal(info.height, 480);
  assert_near(info.fps, 30, 0);
  assert_int_equal(driver.asked_fps, 60);
  assert_int_equal(driver.exposure_auto, V4L2_EXPOSURE_MANUAL);
  assert_int_equal(driver.exposure, 40); // 4 ms in 0.1 ms
  assert_near(info.exposure_ms, 4, 1e-9);
  assert_non_null(strstr(info.note, "YUYV 640 x 480"));
  assert_true(driver.streaming);
  vs_v4l2_close(camera);
  assert_false(driver.streaming);
  assert_false(driver.opened);
  for (int i = 0; i < SLOTS; i++) assert_false(driver.mapped[i]);
}

static void a_camera_without_manual_exposure_plays_on_and_says_so(void **state) {
  (void)state;
  reset_driver();
  driver.no_exposure = 1;
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  assert_non_null(strstr(info.note, "no manual exposure"));
  assert_near(info.exposure_ms, 0, 0);
  vs_v4l2_close(camera);
}

static void the_newest_frame_is_given_and_the_older_buffers_go_back(void **state) {
  (void)state;
  reset_driver();
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  fill(0, 50, 5, 1000000, 0);
  fill(1, 100, 6, 1033333, 0);
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_int_equal(frame.seq, 6);
  assert_int_equal(frame.grey[320 * 240], 100);
  assert_int_equal(frame.capture_us, 1033333 + 2000); // start of exposure plus half of 4 ms
  for (int i = 0; i < SLOTS; i++) assert_true(driver.queued[i]);
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_TIMEOUT);
  vs_v4l2_close(camera);
}

static void a_stamp_of_the_end_of_a_frame_is_moved_back_to_mid_exposure(void **state) {
  (void)state;
  reset_driver();
  driver.stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  fill(2, 50, 1, 7000000, 0);
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(frame.capture_us, 7000000 - 2000);
  vs_v4l2_close(camera);
}

static void broken_frames_are_skipped_and_their_buffers_go_back(void **state) {
  (void)state;
  reset_driver();
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  vs_frame frame;
  vs_camera_got got;
  fill(0, 60, 1, 1000000, 0);
  fill(1, 70, 2, 1033333, V4L2_BUF_FLAG_ERROR);
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(frame.seq, 1);
  fill(0, 80, 3, 1066666, 0);
  driver.filled[0].bytesused = 1000; // a frame cut short
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_TIMEOUT);
  for (int i = 0; i < SLOTS; i++) assert_true(driver.queued[i]);
  vs_v4l2_close(camera);
}

static void rows_with_padding_are_read_at_their_stride(void **state) {
  (void)state;
  reset_driver();
  driver.width = 320, driver.height = 200, driver.padding = 64;
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info); // another size than asked for: taken as it is
  assert_int_equal(info.width, 320);
  fill(1, 90, 1, 1000000, 0);
  memset(driver.memory[1] + 199 * (640 + 64), 200, 640); // the last row
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(frame.grey[198 * 320 + 319], 90);
  assert_int_equal(frame.grey[199 * 320], 200);
  vs_v4l2_close(camera);
}

static void mjpg_frames_are_decoded_and_damaged_ones_lost(void **state) {
  (void)state;
  reset_driver();
  driver.format = V4L2_PIX_FMT_MJPEG;
  driver.width = 64, driver.height = 48;
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  assert_non_null(strstr(info.note, "MJPG"));
  static uint8_t bgr[48][64][3];
  memset(bgr, 140, sizeof bgr);
  size_t size;
  fill(0, 0, 1, 1000000, 0);
  assert_ok(vs_image_jpeg(&(vs_image){&bgr[0][0][0], 64, 48, 192}, &(vs_jpeg_def){90, 1}, driver.memory[0],
                          sizeof driver.memory[0], &size, err));
  driver.filled[0].bytesused = (unsigned)size;
  vs_frame frame;
  vs_camera_got got;
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_FRAME);
  assert_near(frame.grey[64 * 20 + 20], 140, 3);
  fill(0, 33, 2, 1033333, 0); // no JPEG at all
  assert_ok(vs_v4l2_read(camera, 100, &frame, &got, err));
  assert_int_equal(got, VS_CAMERA_TIMEOUT);
  vs_v4l2_close(camera);
}

// The rate asked for goes before the size, the size before cheap decoding, colours before everything.
static void the_format_is_chosen_by_frame_rate(void **state) {
  (void)state;
  const struct {
    int fps; // asked for; 0: 60
    struct {
      unsigned pixel;
      int width, height, fps;
    } mode[6];
    const char *says;
  } rows[] = {
      {0,
       {{V4L2_PIX_FMT_YUYV, 1280, 720, 10},
        {V4L2_PIX_FMT_YUYV, 640, 480, 30},
        {V4L2_PIX_FMT_MJPEG, 1280, 720, 30},
        {V4L2_PIX_FMT_MJPEG, 640, 480, 60}},
       "MJPG 640 x 480"},
      {30,
       {{V4L2_PIX_FMT_YUYV, 1280, 720, 10}, {V4L2_PIX_FMT_YUYV, 640, 480, 30}, {V4L2_PIX_FMT_MJPEG, 1280, 720, 30}},
       "MJPG 1280 x 720"},
      {0, {{V4L2_PIX_FMT_UYVY, 640, 480, 60}, {V4L2_PIX_FMT_MJPEG, 640, 480, 60}}, "UYVY 640 x 480"},
      {0, {{V4L2_PIX_FMT_NV12, 640, 480, 120}, {V4L2_PIX_FMT_MJPEG, 640, 480, 30}}, "NV12 640 x 480"},
      {0, {{V4L2_PIX_FMT_GREY, 640, 480, 60}, {V4L2_PIX_FMT_YUYV, 640, 480, 15}}, "YUYV 640 x 480"},
      {0, {{V4L2_PIX_FMT_GREY, 640, 480, 60}}, "GREY 640 x 480"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    reset_driver();
    for (; driver.listed < 6 && rows[i].mode[driver.listed].pixel; driver.listed++)
      memcpy(&driver.mode[driver.listed], &rows[i].mode[driver.listed], sizeof driver.mode[0]);
    vs_v4l2 *camera;
    vs_camera_info info;
    vs_camera_def def = vs_camera_def_default();
    def.fps = rows[i].fps;
    assert_ok(vs_v4l2_open(&kernel, "/dev/video0", &def, &camera, &info, err));
    if (!strstr(info.note, rows[i].says)) fail_msg("row %zu: %s", i, info.note);
    vs_v4l2_close(camera);
  }
}

static void gain_and_white_balance_are_set_and_read_back(void **state) {
  (void)state;
  reset_driver();
  driver.gain = 5, driver.kelvin = 4000, driver.auto_white = 1;
  vs_v4l2 *camera;
  vs_camera_info info;
  vs_camera_def def = vs_camera_def_default();
  assert_ok(vs_v4l2_open(&kernel, "/dev/video0", &def, &camera, &info, err));
  vs_v4l2_close(camera);
  assert_true(driver.gain == 5 && driver.kelvin == 4000 && driver.auto_white == 0); // held
  def.gain = 30, def.white_balance_k = 5200;
  assert_ok(vs_v4l2_open(&kernel, "/dev/video0", &def, &camera, &info, err));
  vs_v4l2_close(camera);
  assert_true(driver.gain == 30 && driver.kelvin == 5200);
  assert_near(info.gain, 30, 0);
  assert_near(info.white_balance_k, 5200, 0);
  assert_non_null(strstr(info.note, "gain 30, white balance 5200 K"));
  driver.gain = 0;
  assert_ok(vs_v4l2_open(&kernel, "/dev/video0", &def, &camera, &info, err));
  vs_v4l2_close(camera);
  assert_non_null(strstr(info.note, "refuses the gain"));
}

static void a_camera_pulled_out_is_an_error_that_names_it(void **state) {
  (void)state;
  reset_driver();
  vs_camera_info info;
  vs_v4l2 *camera = open_it(&info);
  driver.gone = 1;
  vs_frame frame;
  vs_camera_got got;
  vs_error err;
  assert_int_equal(vs_v4l2_read(camera, 100, &frame, &got, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/video0: the camera is gone"));
  vs_v4l2_close(camera);
}

static void each_way_to_fail_to_open_says_why_and_leaves_nothing_open(void **state) {
  (void)state;
  const struct {
    int open_errno, caps, streamon_errno;
    unsigned format;
    const char *says;
  } rows[] = {{EACCES, 0, 0, 0, "group video"},
              {ENOENT, 0, 0, 0, "no such camera"},
              {EBUSY, 0, 0, 0, "another program"},
              {0, V4L2_CAP_VIDEO_OUTPUT, 0, 0, "captures no video"},
              {0, 0, 0, V4L2_PIX_FMT_SBGGR8, "none of YUYV, UYVY, NV12, MJPG, GREY"},
              {0, 0, ENOSPC, 0, "USB bandwidth"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    reset_driver();
    driver.open_errno = rows[i].open_errno;
    driver.streamon_errno = rows[i].streamon_errno;
    if (rows[i].caps) driver.caps = rows[i].caps;
    if (rows[i].format) driver.format = rows[i].format;
    vs_v4l2 *camera;
    vs_camera_info info;
    vs_error err;
    vs_camera_def def = vs_camera_def_default();
    assert_int_equal(vs_v4l2_open(&kernel, "/dev/video3", &def, &camera, &info, &err), VS_FAIL);
    assert_null(camera);
    if (!strstr(err.text, rows[i].says) || !strstr(err.text, "/dev/video3")) fail_msg("row %zu: %s", i, err.text);
    assert_false(driver.opened);
    for (int k = 0; k < SLOTS; k++) assert_false(driver.mapped[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(opening_asks_for_manual_exposure_and_says_what_was_obtained),
      cmocka_unit_test(a_camera_without_manual_exposure_plays_on_and_says_so),
      cmocka_unit_test(the_newest_frame_is_given_and_the_older_buffers_go_back),
      cmocka_unit_test(a_stamp_of_the_end_of_a_frame_is_moved_back_to_mid_exposure),
      cmocka_unit_test(broken_frames_are_skipped_and_their_buffers_go_back),
      cmocka_unit_test(rows_with_padding_are_read_at_their_stride),
      cmocka_unit_test(mjpg_frames_are_decoded_and_damaged_ones_lost),
      cmocka_unit_test(the_format_is_chosen_by_frame_rate),
      cmocka_unit_test(gain_and_white_balance_are_set_and_read_back),
      cmocka_unit_test(a_camera_pulled_out_is_an_error_that_names_it),
      cmocka_unit_test(each_way_to_fail_to_open_says_why_and_leaves_nothing_open),
  };
  return cmocka_run_group_tests_name("vision/camera_v4l2", tests, NULL, NULL);
}
