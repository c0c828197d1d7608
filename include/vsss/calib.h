// Pixels <-> metres. A pinhole camera with OpenCV's five distortion coefficients and a pose over the field. A pixel
// becomes a field point by intersecting its ray with the plane z = h, which corrects parallax: 37 mm for a tag at 80 mm
// in a corner under a camera at 2.2 m (field.md, Height). Plain C at run time; only the solvers need OpenCV.
#ifndef VSSS_CALIB_H
#define VSSS_CALIB_H

#include <stdbool.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// The field frame of a calibration is field.h's, as the venue was measured: x towards the goal the points say.
typedef struct vs_calib {
  char camera[96]; // vs_camera_info.name it was made with
  char date[32];   // ISO 8601, UTC
  int width, height;
  double fx_px, fy_px, cx_px, cy_px; // coordinates as in camera.h: the middle of 640 is 320
  double k1, k2, p1, p2, k3;
  double rotation[3][3];    // field -> camera (camera: x right, y down, z into the picture)
  double translation_m[3];  // field -> camera
  double intrinsics_rms_px; // of the checkerboard; 0: not measured
  int points;               // of the venue; 0: not measured
  double rms_mm, worst_mm;  // of those points on the field
} vs_calib;

// A camera with no distortion looking straight down from height_m over the field's centre, picture top towards +y,
// picture right towards +x; vertical_fov_rad across the picture's height (MuJoCo's fovy).
vs_calib vs_calib_overhead(int width, int height, double height_m, double vertical_fov_rad);

// INI. Loading checks ranges and that the rotation is one.
vs_status vs_calib_load(const char *path, vs_calib *out, vs_error *err);
vs_status vs_calib_save(const char *path, const vs_calib *calib, vs_error *err);
// The same where nothing may be: VS_FAIL where there is something of this name, which is left as it is.
vs_status vs_calib_create(const char *path, const vs_calib *calib, vs_error *err);
// VS_FAIL where the camera's pictures have another size, naming both and the command that makes a new calibration.
vs_status vs_calib_check_size(const vs_calib *calib, const char *path, int width, int height, vs_error *err);

// Field point of a pixel on the plane z = h_m. false: the ray does not meet it (above the horizon).
bool vs_calib_to_field(const vs_calib *calib, double x_px, double y_px, double h_m, double *x_m, double *y_m);
// Pixel of a field point. false: behind the camera.
bool vs_calib_to_pixel(const vs_calib *calib, double x_m, double y_m, double z_m, double *x_px, double *y_px);
// Pose of a square that lies h_m over the floor, from its corners bottom left, bottom right, top right, top left: its
// middle, and the direction from its bottom to its top. The one way from a mark's corners to a robot. false: as above.
bool vs_calib_square(const vs_calib *calib, const double corner_px[4][2], double h_m, double *x_m, double *y_m,
                     double *theta_rad);
// Scale in the field's centre at height h_m.
double vs_calib_px_per_m(const vs_calib *calib, double h_m);
void vs_calib_lens(const vs_calib *calib, double lens_m[3]); // where the camera is

// One measured pair.
typedef struct vs_calib_point {
  double x_px, y_px;
  double x_m, y_m, z_m;
} vs_calib_point;
// Pairs from a text file, one a line: x_px y_px x_m y_m [z_m]; "#" begins a comment. VS_USAGE names the line.
vs_status vs_calib_load_points(const char *path, vs_calib_point *out, int capacity, int *count, vs_error *err);
// Error of a pair in mm on its plane: where the pixel maps to, against where it is.
double vs_calib_error_mm(const vs_calib *calib, const vs_calib_point *point);

// Extrinsics from >= 4 pairs, intrinsics as they are in calib; fills rotation, translation, points, rms_mm, worst_mm.
// VS_FAIL: too few, on a line, or no pose explains them.
vs_status vs_calib_solve_pose(vs_calib *calib, const vs_calib_point *points, int count, vs_error *err);

// The same without a measured lens: no distortion, and the focal length that puts the lens height_m over the floor, as
// a tape measure says (2 cm wrong there are 0.25 mm at 8 cm height, field.md, Height). calib needs its size only.
vs_status vs_calib_solve_from_height(vs_calib *calib, const vs_calib_point *points, int count, double height_m,
                                     vs_error *err);

// Intrinsics from pictures of a checkerboard, columns x rows inner corners, squares of square_m.
typedef struct vs_calib_board vs_calib_board;
vs_status vs_calib_board_new(int columns, int rows, double square_m, vs_calib_board **out, vs_error *err);
void vs_calib_board_free(vs_calib_board *board);
// found: the whole board was seen. All pictures must have one size.
vs_status vs_calib_board_add(vs_calib_board *board, const unsigned char *grey, int stride, int width, int height,
                             bool *found, vs_error *err);
// Fills size, intrinsics and intrinsics_rms_px; needs >= 3 pictures.
vs_status vs_calib_board_solve(vs_calib_board *board, vs_calib *calib, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
