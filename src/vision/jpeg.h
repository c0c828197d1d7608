// JPEG pictures of a camera into both planes of a frame. libjpeg-turbo where it is (jpeg.c), else OpenCV (jpeg_stub.c).
#ifndef VSSS_VISION_JPEG_H
#define VSSS_VISION_JPEG_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/status.h"

typedef struct vs_jpeg vs_jpeg;
vs_status vs_jpeg_new(vs_jpeg **out, vs_error *err);
void vs_jpeg_free(vs_jpeg *jpeg); // NULL is allowed
// Packed rows, bgr[height][width][3] and grey[height][width]. VS_FAIL: broken, or of another size.
vs_status vs_jpeg_decode(vs_jpeg *jpeg, const uint8_t *data, size_t size, int width, int height, uint8_t *bgr,
                         uint8_t *grey, vs_error *err);

#endif
