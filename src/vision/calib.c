// Pixels <-> metres: pure arithmetic. Files are in calib_file.c, solvers in calib_solve.c.
#include "vsss/calib.h"

#include <math.h>

vs_calib vs_calib_overhead(int width, int height, double height_m, double vertical_fov_rad) {
  double f = 0.5 * height / tan(0.5 * vertical_fov_rad);
  // Camera x is field x, camera y (down the picture) is field -y, camera z (into the picture) is field -z.
  return (vs_calib){.width = width,
                    .height = height,
                    .fx_px = f,
                    .fy_px = f,
                    .cx_px = 0.5 * width,
                    .cy_px = 0.5 * height,
                    .rotation = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                    .translation_m = {0, 0, height_m}};
}

vs_status vs_calib_check_size(const vs_calib *calib, const char *path, int width, int height, vs_error *err) {
  if (calib->width == width && calib->height == height) return VS_OK;
  return vs_fail(err, VS_FAIL,
                 "%s: made for pictures of %d x %d, this camera gives %d x %d; run `vsss calibrate` for it", path,
                 calib->width, calib->height, width, height);
}

// Where the lens puts the direction (x, y, 1): Brown's model, OpenCV's order of coefficients.
static void distort(const vs_calib *c, double x, double y, double *xd, double *yd) {
  double r2 = x * x + y * y, radial = 1 + r2 * (c->k1 + r2 * (c->k2 + r2 * c->k3));
  *xd = x * radial + 2 * c->p1 * x * y + c->p2 * (r2 + 2 * x * x);
  *yd = y * radial + c->p1 * (r2 + 2 * y * y) + 2 * c->p2 * x * y;
}

// The inverse has no closed form: Newton's method with the Jacobian by differences, exact to 1e-10 in 3 to 5 rounds.
static void undistort(const vs_calib *c, double xd, double yd, double *x, double *y) {
  *x = xd, *y = yd;
  if (c->k1 == 0 && c->k2 == 0 && c->p1 == 0 && c->p2 == 0 && c->k3 == 0) return;
  const double h = 1e-6;
  for (int round = 0; round < 10; round++) {
    double fx, fy, ax, ay, bx, by;
    distort(c, *x, *y, &fx, &fy);
    double ex = xd - fx, ey = yd - fy;
    if (fabs(ex) + fabs(ey) < 1e-11) return;
    distort(c, *x + h, *y, &ax, &ay);
    distort(c, *x, *y + h, &bx, &by);
    double j00 = (ax - fx) / h, j10 = (ay - fy) / h, j01 = (bx - fx) / h, j11 = (by - fy) / h;
    double det = j00 * j11 - j01 * j10;
    if (fabs(det) < 1e-9) return;
    *x += (j11 * ex - j01 * ey) / det;
    *y += (j00 * ey - j10 * ex) / det;
  }
}

void vs_calib_lens(const vs_calib *c, double lens_m[3]) {
  for (int i = 0; i < 3; i++) {
    lens_m[i] = 0;
    for (int j = 0; j < 3; j++) lens_m[i] -= c->rotation[j][i] * c->translation_m[j];
  }
}

bool vs_calib_to_field(const vs_calib *c, double x_px, double y_px, double h_m, double *x_m, double *y_m) {
  double ray[3] = {0, 0, 1}, lens[3], way[3] = {0};
  undistort(c, (x_px - c->cx_px) / c->fx_px, (y_px - c->cy_px) / c->fy_px, &ray[0], &ray[1]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) way[i] += c->rotation[j][i] * ray[j];
  vs_calib_lens(c, lens);
  double t = (h_m - lens[2]) / way[2];
  if (!(t > 0) || !isfinite(t)) return false;
  *x_m = lens[0] + t * way[0];
  *y_m = lens[1] + t * way[1];
  return true;
}

bool vs_calib_to_pixel(const vs_calib *c, double x_m, double y_m, double z_m, double *x_px, double *y_px) {
  double p[3] = {x_m, y_m, z_m}, q[3], xd, yd;
  for (int i = 0; i < 3; i++) {
    q[i] = c->translation_m[i];
    for (int j = 0; j < 3; j++) q[i] += c->rotation[i][j] * p[j];
  }
  if (!(q[2] > 1e-6)) return false;
  distort(c, q[0] / q[2], q[1] / q[2], &xd, &yd);
  *x_px = c->cx_px + c->fx_px * xd;
  *y_px = c->cy_px + c->fy_px * yd;
  return true;
}

bool vs_calib_square(const vs_calib *c, const double corner_px[4][2], double h_m, double *x_m, double *y_m,
                     double *theta_rad) {
  double x[4], y[4];
  for (int i = 0; i < 4; i++)
    if (!vs_calib_to_field(c, corner_px[i][0], corner_px[i][1], h_m, &x[i], &y[i])) return false;
  *x_m = 0.25 * (x[0] + x[1] + x[2] + x[3]);
  *y_m = 0.25 * (y[0] + y[1] + y[2] + y[3]);
  // Both pairs of sides count: the top lies ahead of the bottom, and the right a quarter turn clockwise of that.
  double up_x = x[3] + x[2] - x[0] - x[1], up_y = y[3] + y[2] - y[0] - y[1];
  double right_x = x[1] + x[2] - x[0] - x[3], right_y = y[1] + y[2] - y[0] - y[3];
  *theta_rad = atan2(up_y + right_x, up_x - right_y);
  return true;
}

double vs_calib_px_per_m(const vs_calib *c, double h_m) {
  // The root of the area of a small square: the same however the camera is turned.
  const double half = 0.01;
  double x[4], y[4];
  for (int i = 0; i < 4; i++)
    if (!vs_calib_to_pixel(c,
                           i == 0   ? half
                           : i == 1 ? -half
                                    : 0,
                           i == 2   ? half
                           : i == 3 ? -half
                                    : 0,
                           h_m, &x[i], &y[i]))
      return 0;
  double cross = (x[0] - x[1]) * (y[2] - y[3]) - (y[0] - y[1]) * (x[2] - x[3]);
  return sqrt(fabs(cross)) / (2 * half);
}

double vs_calib_error_mm(const vs_calib *calib, const vs_calib_point *point) {
  double x, y;
  if (!vs_calib_to_field(calib, point->x_px, point->y_px, point->z_m, &x, &y)) return INFINITY;
  return 1000 * hypot(x - point->x_m, y - point->y_m);
}
