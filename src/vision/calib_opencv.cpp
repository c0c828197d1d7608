// OpenCV for calibration: a camera's pose from measured points, its lens from a checkerboard. Table and units: opencv.h.
// OpenCV counts from the middle of the first pixel, we from its corner: half a pixel is taken off going in and put back.
#include "vision/opencv.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace {

constexpr double HALF = 0.5;

vs_status solve_pose(const double *world, const double *picture, int count, const double camera[4],
                     const double distortion[5], double rotation[9], double translation[3], vs_error *err) try {
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (int i = 0; i < count; i++) {
    object.emplace_back(world[3 * i], world[3 * i + 1], world[3 * i + 2]);
    image.emplace_back(picture[2 * i] - HALF, picture[2 * i + 1] - HALF);
  }
  cv::Matx33d k(camera[0], 0, camera[2] - HALF, 0, camera[1], camera[3] - HALF, 0, 0, 1);
  cv::Mat d(1, 5, CV_64F, const_cast<double *>(distortion));
  cv::Vec3d r, t;
  // SQPNP takes points in a plane and out of it alike; the refinement then minimises the error in the picture.
  if (!cv::solvePnP(object, image, k, d, r, t, false, cv::SOLVEPNP_SQPNP))
    return vs_fail(err, VS_FAIL, "no camera pose explains the points");
  cv::solvePnPRefineLM(object, image, k, d, r, t);
  cv::Matx33d m;
  cv::Rodrigues(r, m);
  for (int i = 0; i < 9; i++) rotation[i] = m.val[i];
  for (int i = 0; i < 3; i++) translation[i] = t[i];
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "solvePnP: %s", e.what());
}

vs_status board_find(const uint8_t *grey, int stride, int width, int height, int columns, int rows, double *corners,
                     bool *found, vs_error *err) try {
  cv::Mat image(height, width, CV_8UC1, const_cast<uint8_t *>(grey), (size_t)stride);
  std::vector<cv::Point2f> points;
  *found =
      cv::findChessboardCorners(image, cv::Size(columns, rows), points,
                                cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK);
  if (!*found) return VS_OK;
  cv::cornerSubPix(image, points, cv::Size(5, 5), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 0.001));
  for (size_t i = 0; i < points.size(); i++) {
    corners[2 * i] = points[i].x + HALF;
    corners[2 * i + 1] = points[i].y + HALF;
  }
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "checkerboard: %s", e.what());
}

vs_status board_solve(const double *corners, int pictures, int columns, int rows, double square_m, int width,
                      int height, double camera[4], double distortion[5], double *rms_px, vs_error *err) try {
  std::vector<cv::Point3f> board;
  for (int y = 0; y < rows; y++)
    for (int x = 0; x < columns; x++) board.emplace_back((float)(x * square_m), (float)(y * square_m), 0.0f);
  std::vector<std::vector<cv::Point3f>> objects(pictures, board);
  std::vector<std::vector<cv::Point2f>> images(pictures);
  for (int i = 0; i < pictures; i++)
    for (int j = 0; j < columns * rows; j++, corners += 2)
      images[i].emplace_back((float)(corners[0] - HALF), (float)(corners[1] - HALF));
  cv::Mat k, d;
  std::vector<cv::Mat> r, t;
  *rms_px = cv::calibrateCamera(objects, images, cv::Size(width, height), k, d, r, t);
  camera[0] = k.at<double>(0, 0);
  camera[1] = k.at<double>(1, 1);
  camera[2] = k.at<double>(0, 2) + HALF;
  camera[3] = k.at<double>(1, 2) + HALF;
  for (int i = 0; i < 5; i++) distortion[i] = d.at<double>(i);
  return VS_OK;
} catch (const std::exception &e) {
  return vs_fail(err, VS_FAIL, "calibrateCamera: %s", e.what());
}

} // namespace

void vs_opencv_fill_calib(vs_opencv *table) {
  table->solve_pose = solve_pose;
  table->board_find = board_find;
  table->board_solve = board_solve;
}
