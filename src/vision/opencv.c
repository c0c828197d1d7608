// The OpenCV module's door, and the picture files behind it.
#include "vision/opencv.h"

#include <dlfcn.h>

#include "vsss/image.h"
#include "vsss/paths.h"

vs_status vs_opencv_load(const vs_opencv **out, vs_error *err) {
  void *handle;
  vs_status s = vs_module_load("opencv", "libopencv-dev", &handle, err);
  if (s != VS_OK) return s;
  const vs_opencv *(*entry)(void);
  *(void **)&entry = dlsym(handle, "vsss_opencv");
  if (!entry) return vs_fail(err, VS_FAIL, "build/lib/vsss_opencv.so: vsss_opencv is missing; run make again");
  *out = entry();
  return VS_OK;
}

vs_status vs_image_save(const char *path, const uint8_t *bgr, int stride, int width, int height, vs_error *err) {
  const vs_opencv *cv = NULL;
  vs_status s = vs_opencv_load(&cv, err);
  return s == VS_OK ? cv->picture_write(path, bgr, stride, width, height, err) : s;
}

vs_status vs_image_jpeg(const vs_image *image, const vs_jpeg_def *def, uint8_t *out, size_t capacity, size_t *size,
                        vs_error *err) {
  const vs_opencv *cv = NULL;
  vs_status s = vs_opencv_load(&cv, err);
  return s == VS_OK ? cv->jpeg_encode(image, def, out, capacity, size, err) : s;
}
