// OpenCV for pictures and videos: files to pixels and back. Table and units: opencv.h.
#include "vision/opencv.h"

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

struct vs_video {
  cv::VideoCapture capture;
  cv::Mat frame;
  std::string path;
  int width, height;
};

namespace {

vs_status picture_read(const char *path, uint8_t **bgr, int *width, int *height, vs_error *err) try {
  cv::Mat image = cv::imread(path, cv::IMREAD_COLOR);
  if (image.empty()) return vs_fail(err, VS_FAIL, "%s: not a picture OpenCV can read", path);
  size_t row = 3 * (size_t)image.cols;
  *bgr = new uint8_t[row * image.rows];
  for (int y = 0; y < image.rows; y++) std::memcpy(*bgr + row * y, image.ptr(y), row);
  *width = image.cols;
  *height = image.rows;
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "%s: %s", path, e.what());
}

void release(uint8_t *bgr) { delete[] bgr; }

cv::Mat view(const uint8_t *bgr, int stride, int width, int height) {
  return cv::Mat(height, width, CV_8UC3, const_cast<uint8_t *>(bgr), (size_t)stride);
}

vs_status picture_write(const char *path, const uint8_t *bgr, int stride, int width, int height, vs_error *err) try {
  if (!cv::imwrite(path, view(bgr, stride, width, height))) return vs_fail(err, VS_FAIL, "%s: cannot be written", path);
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "%s: %s", path, e.what());
}

vs_status jpeg_encode(const vs_image *image, const vs_jpeg_def *def, uint8_t *out, size_t capacity, size_t *size,
                      vs_error *err) try {
  cv::Mat picture = view(image->bgr, image->stride, image->width, image->height), small;
  if (def->shrink > 1) {
    cv::resize(picture, small, cv::Size(image->width / def->shrink, image->height / def->shrink), 0, 0, cv::INTER_AREA);
    picture = small;
  }
  std::vector<uint8_t> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, def->quality});
  if (bytes.size() > capacity)
    return vs_fail(err, VS_FAIL, "a JPEG of %zu bytes does not fit %zu", bytes.size(), capacity);
  std::memcpy(out, bytes.data(), bytes.size());
  *size = bytes.size();
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "JPEG: %s", e.what());
}

vs_status jpeg_decode(const uint8_t *jpeg, size_t size, uint8_t *bgr, int width, int height, vs_error *err) try {
  cv::Mat packed(1, (int)size, CV_8UC1, const_cast<uint8_t *>(jpeg));
  // Not into our buffer at once: OpenCV 4.6 then gives that buffer back for a JPEG it could not read, too.
  cv::Mat result = cv::imdecode(packed, cv::IMREAD_COLOR);
  if (result.empty()) return vs_fail(err, VS_FAIL, "a broken JPEG of %zu bytes", size);
  if (result.cols != width || result.rows != height)
    return vs_fail(err, VS_FAIL, "a JPEG of %d x %d where %d x %d was agreed", result.cols, result.rows, width, height);
  result.copyTo(view(bgr, 3 * width, width, height));
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "JPEG: %s", e.what());
}

vs_status video_open(const char *path, vs_video **out, int *width, int *height, double *fps, vs_error *err) try {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); // our errors come as vs_error
  auto video = std::make_unique<vs_video>();
  // FFmpeg only: the other backends look for cameras on every bus before they give up on a file.
  if (!video->capture.open(path, cv::CAP_FFMPEG))
    return vs_fail(err, VS_FAIL, "%s: not a picture or video OpenCV can read", path);
  video->path = path;
  *width = video->width = (int)video->capture.get(cv::CAP_PROP_FRAME_WIDTH);
  *height = video->height = (int)video->capture.get(cv::CAP_PROP_FRAME_HEIGHT);
  *fps = video->capture.get(cv::CAP_PROP_FPS);
  *out = video.release();
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "%s: %s", path, e.what());
}

void video_close(vs_video *video) { delete video; }

vs_status video_read(vs_video *video, int skip, uint8_t *bgr, bool *end, vs_error *err) try {
  *end = false;
  for (int i = 0; i < skip && !*end; i++) *end = !video->capture.grab();
  if (*end || !video->capture.read(video->frame)) return *end = true, VS_OK;
  if (video->frame.cols != video->width || video->frame.rows != video->height || video->frame.type() != CV_8UC3)
    return vs_fail(err, VS_FAIL, "%s: the picture's size or format changes within the video", video->path.c_str());
  size_t row = 3 * (size_t)video->width;
  for (int y = 0; y < video->height; y++) std::memcpy(bgr + row * y, video->frame.ptr(y), row);
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "%s: %s", video->path.c_str(), e.what());
}

} // namespace

void vs_opencv_fill_camera(vs_opencv *table) {
  table->picture_read = picture_read;
  table->release = release;
  table->picture_write = picture_write;
  table->jpeg_encode = jpeg_encode;
  table->jpeg_decode = jpeg_decode;
  table->video_open = video_open;
  table->video_close = video_close;
  table->video_read = video_read;
}

const vs_opencv *vsss_opencv(void) {
  static const vs_opencv table = [] {
    vs_opencv t;
    vs_opencv_fill_camera(&t);
    vs_opencv_fill_calib(&t);
    return t;
  }();
  return &table;
}
