// What the OpenCV module (build/lib/vsss_opencv.so, from the *_opencv.cpp here) offers: one table, fetched when a
// picture file, a video, MJPG or a solver is needed. Buffers are the caller's, sizes in pixels unless named.
#ifndef VSSS_VISION_OPENCV_H
#define VSSS_VISION_OPENCV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/image.h"
#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_video vs_video;

typedef struct vs_opencv {
  // A picture file -> *bgr, packed rows, to be released with release.
  vs_status (*picture_read)(const char *path, uint8_t **bgr, int *width, int *height, vs_error *err);
  void (*release)(uint8_t *bgr);
  vs_status (*picture_write)(const char *path, const uint8_t *bgr, int stride, int width, int height, vs_error *err);
  vs_status (*jpeg_encode)(const vs_image *image, const vs_jpeg_def *def, uint8_t *out, size_t capacity, size_t *size,
                           vs_error *err); // vs_image_jpeg
  // A JPEG that must be width x height -> bgr, packed rows.
  vs_status (*jpeg_decode)(const uint8_t *jpeg, size_t size, uint8_t *bgr, int width, int height, vs_error *err);

  vs_status (*video_open)(const char *path, vs_video **out, int *width, int *height, double *fps, vs_error *err);
  void (*video_close)(vs_video *video);
  // skip frames passed over, then one decoded into bgr (packed rows); *end: there was none left.
  vs_status (*video_read)(vs_video *video, int skip, uint8_t *bgr, bool *end, vs_error *err);

  // Points: world double[count][3] in m, picture double[count][2] in px. camera: fx, fy, cx, cy; distortion k1 k2 p1 p2
  // k3. rotation row-major 3 x 3.
  vs_status (*solve_pose)(const double *world, const double *picture, int count, const double camera[4],
                          const double distortion[5], double rotation[9], double translation[3], vs_error *err);
  // corners double[columns * rows][2]
  vs_status (*board_find)(const uint8_t *grey, int stride, int width, int height, int columns, int rows,
                          double *corners, bool *found, vs_error *err);
  // corners double[pictures][columns * rows][2]
  vs_status (*board_solve)(const double *corners, int pictures, int columns, int rows, double square_m, int width,
                           int height, double camera[4], double distortion[5], double *rms_px, vs_error *err);
} vs_opencv;

// The module's one exported function.
const vs_opencv *vsss_opencv(void);

// Loads the module (once, then cheap). VS_FAIL says what to install.
vs_status vs_opencv_load(const vs_opencv **out, vs_error *err);

// The parts of the table, one per shim.
void vs_opencv_fill_camera(vs_opencv *table);
void vs_opencv_fill_calib(vs_opencv *table);

#ifdef __cplusplus
}
#endif
#endif
