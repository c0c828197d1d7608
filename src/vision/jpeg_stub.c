// Stands in for jpeg.c where libjpeg-turbo is missing.
#include <stdlib.h>

#include "vision/jpeg.h"
#include "vision/opencv.h"
#include "vsss/image.h"

struct vs_jpeg {
  const vs_opencv *cv;
};

vs_status vs_jpeg_new(vs_jpeg **out, vs_error *err) {
  *out = calloc(1, sizeof **out);
  if (!*out) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = vs_opencv_load(&(*out)->cv, err);
  if (s != VS_OK) free(*out), *out = NULL;
  return s;
}

void vs_jpeg_free(vs_jpeg *jpeg) { free(jpeg); }

vs_status vs_jpeg_decode(vs_jpeg *j, const uint8_t *data, size_t size, int width, int height, uint8_t *bgr,
                         uint8_t *grey, vs_error *err) {
  vs_status s = j->cv->jpeg_decode(data, size, bgr, width, height, err);
  if (s == VS_OK) vs_image_grey(bgr, 3 * width, width, height, grey, width);
  return s;
}
