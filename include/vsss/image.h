// Pictures in memory: colour conversion, drawing and files. BGR is blue, green, red bytes per pixel, row 0 at the top.
#ifndef VSSS_IMAGE_H
#define VSSS_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_image {
  uint8_t *bgr;      // caller's, [height][stride]
  int width, height; // pixels
  int stride;        // bytes per row, >= 3 * width
} vs_image;

// Luma of ITU-R BT.601 (0.299 R + 0.587 G + 0.114 B), the weights V4L2 and JPEG use.
void vs_image_grey(const uint8_t *bgr, int bgr_stride, int width, int height, uint8_t *grey, int grey_stride);
// Pixels of V4L2 (BT.601, limited range) into both planes a frame needs: packed 4:2:2 Y U Y V and U Y V Y; NV12, a plane of
// luma and one of U V at half size below it, both of stride bytes a row; grey alone, whose colours are grey, too. width
// even, for NV12 height too.
void vs_image_from_yuyv(const uint8_t *yuyv, int yuyv_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride);
void vs_image_from_uyvy(const uint8_t *uyvy, int uyvy_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride);
void vs_image_from_nv12(const uint8_t *nv12, int nv12_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride);
void vs_image_from_grey(const uint8_t *luma, int luma_stride, int width, int height, uint8_t *grey, int grey_stride,
                        uint8_t *bgr, int bgr_stride);

// Lines and discs clipped to the picture; colour is {blue, green, red}.
void vs_image_line(vs_image *image, double x0_px, double y0_px, double x1_px, double y1_px, int width_px,
                   const uint8_t colour[3]);
void vs_image_disc(vs_image *image, double x_px, double y_px, double radius_px, const uint8_t colour[3]);
// A filled box, its upper left corner at (x_px, y_px), clipped too.
void vs_image_box(vs_image *image, int x_px, int y_px, int width_px, int height_px, const uint8_t colour[3]);
// Capitals, digits and . , : - + / % ( ) of 5 by 7 dots, a step of 6, from the upper left corner; others are question marks.
void vs_image_text(vs_image *image, int x_px, int y_px, int dot_px, const char *text, const uint8_t colour[3]);

// The following need OpenCV (module "opencv"): without it VS_FAIL says what to install.
// Writes a picture; the ending of path chooses PNG or JPEG.
vs_status vs_image_save(const char *path, const uint8_t *bgr, int stride, int width, int height, vs_error *err);
// JPEG of quality 1 to 100 into out[capacity], its length into *size. VS_FAIL where it does not fit. shrink: 1 full size,
// 2 half, ... The picture is only read.
typedef struct vs_jpeg_def {
  int quality, shrink;
} vs_jpeg_def;
vs_status vs_image_jpeg(const vs_image *image, const vs_jpeg_def *def, uint8_t *out, size_t capacity, size_t *size,
                        vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
