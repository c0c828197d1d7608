// Cameras by source: /dev/videoN, a video file, a folder of images, one image, and what the program registers (rig:).
// Every source gives the same frame, so that everything after it cannot tell a recording from a device.
#ifndef VSSS_CAMERA_H
#define VSSS_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Pixel coordinates everywhere in vision: x right, y down, (0, 0) is the outer corner of the first pixel, so that its
// middle is (0.5, 0.5) and the middle of a picture 640 wide is x = 320 (libapriltag's convention, not OpenCV's).

// One picture. Row 0 is the top. The pixels belong to whoever filled the frame; a camera's stay whole until the next
// vs_camera_read or vs_camera_close.
typedef struct vs_frame {
  const uint8_t *grey; // [height][grey_stride], luma 0..255: what tags are found in
  const uint8_t *bgr;  // [height][bgr_stride], blue, green, red per pixel: what colours are found in
  int width, height;   // pixels
  int grey_stride;     // bytes per row, >= width
  int bgr_stride;      // bytes per row, >= 3 * width
  int64_t capture_us;  // mid-exposure, monotonic clock (clock.h); a recording counts from its first read
  uint32_t seq;        // of the source: a gap is a frame that was lost or skipped
} vs_frame;

typedef struct vs_camera_def {
  int width,
      height; // asked for; a file has its own. 0: 1280x720 if the device gives it at the rate asked for, else 640x480
  double fps; // asked for; pace of a folder of images. 0: device 60, folder 30
  double exposure_ms;     // manual exposure asked for, 0: leave it alone. Above 5 ms tags blur (field.md, Tags)
  double gain;            // of the device's own scale, asked for with white_balance_k; 0: left alone
  double white_balance_k; // colour temperature, kelvin; 0: what the device has chosen, held there
  bool every_frame; // recordings: each frame once, as fast as it is read, instead of at its own pace, newest first
} vs_camera_def;
vs_camera_def vs_camera_def_default(void); // all 0 but 4 ms of exposure

// What was really obtained.
typedef struct vs_camera_info {
  char name[96]; // device's or file's; calibration files carry it
  int width, height;
  double fps;                   // nominal; 0: not known
  double exposure_ms;           // as read back; 0: not known or automatic
  double gain, white_balance_k; // as read back; 0: not known
  char note[192];               // one line worth showing: pixel format, controls the device refused, ...; "" if nothing
} vs_camera_info;

typedef enum vs_camera_got { VS_CAMERA_FRAME, VS_CAMERA_TIMEOUT, VS_CAMERA_END } vs_camera_got;

typedef struct vs_camera vs_camera;

// VS_USAGE: unknown scheme (the text lists what is known). VS_FAIL: no such device or file, or it gives no picture.
vs_status vs_camera_open(const char *source, const vs_camera_def *def /* NULL: default */, vs_camera **out,
                         vs_error *err);
void vs_camera_close(vs_camera *camera); // NULL is allowed
const vs_camera_info *vs_camera_about(const vs_camera *camera);

// Waits up to timeout_ms for a frame that was not given before and gives the newest; older ones are dropped (seq tells
// how many). VS_CAMERA_END: a recording is over. VS_FAIL: the device is gone.
vs_status vs_camera_read(vs_camera *camera, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err);

// A kind of source. open gets what follows "scheme:" and fills info; the handle it returns is passed to the others.
// read fills all of vs_frame; its pixels stay whole until the next read or close.
typedef struct vs_camera_api {
  const char *scheme; // without the colon, "rig"
  const char *help;   // "rig:SOCKET  the venue of `vsss rig`"
  vs_status (*open)(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info, vs_error *err);
  vs_status (*read)(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err);
  void (*close)(void *handle);
} vs_camera_api;

// Adds a scheme for this process; api must outlive it. At most 8. Called once at start by the program, not by threads.
void vs_camera_register(const vs_camera_api *api);
const char *vs_camera_sources(void); // one line for messages and --help

#ifdef __cplusplus
}
#endif
#endif
