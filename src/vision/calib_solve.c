// From measurements to a calibration, by OpenCV's solvers.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vision/opencv.h"
#include "vsss/calib.h"

// Deviation of the points from their best line: near 0, the camera could turn around it freely.
static double spread_m(const vs_calib_point *p, int n) {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (int i = 0; i < n; i++) x += p[i].x_m / n, y += p[i].y_m / n;
  for (int i = 0; i < n; i++) {
    double dx = p[i].x_m - x, dy = p[i].y_m - y;
    xx += dx * dx / n, xy += dx * dy / n, yy += dy * dy / n;
  }
  double half = 0.5 * (xx + yy);
  return sqrt(fmax(half - hypot(0.5 * (xx - yy), xy), 0));
}

static void report(vs_calib *c, const vs_calib_point *points, int count) {
  double sum = 0;
  c->points = count;
  c->worst_mm = 0;
  for (int i = 0; i < count; i++) {
    double e = vs_calib_error_mm(c, &points[i]);
    sum += e * e;
    c->worst_mm = fmax(c->worst_mm, e);
  }
  c->rms_mm = sqrt(sum / count);
}

vs_status vs_calib_solve_pose(vs_calib *calib, const vs_calib_point *points, int count, vs_error *err) {
  if (count < 4) return vs_fail(err, VS_FAIL, "%d points: at least 4 are needed", count);
  if (spread_m(points, count) < 0.05)
    return vs_fail(err, VS_FAIL, "the %d points lie on one line: add some beside it", count);
  const vs_opencv *cv = NULL;
  vs_status s = vs_opencv_load(&cv, err);
  if (s != VS_OK) return s;
  double *numbers = malloc(5 * count * sizeof *numbers);
  if (!numbers) return vs_fail(err, VS_FAIL, "out of memory");
  double *world = numbers, *picture = numbers + 3 * count;
  for (int i = 0; i < count; i++) {
    world[3 * i] = points[i].x_m, world[3 * i + 1] = points[i].y_m, world[3 * i + 2] = points[i].z_m;
    picture[2 * i] = points[i].x_px, picture[2 * i + 1] = points[i].y_px;
  }
  double camera[4] = {calib->fx_px, calib->fy_px, calib->cx_px, calib->cy_px};
  double distortion[5] = {calib->k1, calib->k2, calib->p1, calib->p2, calib->k3};
  vs_calib solved = *calib;
  s = cv->solve_pose(world, picture, count, camera, distortion, &solved.rotation[0][0], solved.translation_m, err);
  free(numbers);
  if (s != VS_OK) return s;
  double lens[3];
  vs_calib_lens(&solved, lens);
  report(&solved, points, count);
  // A wrong sign or two swapped rows put the camera under the floor or leave decimetres.
  if (!(lens[2] > 0.1) || !(solved.rms_mm < 50))
    return vs_fail(err, VS_FAIL,
                   "no camera over the field explains the points (lens at z = %.2f m, error %.0f mm): "
                   "look for swapped points or signs",
                   lens[2], solved.rms_mm);
  *calib = solved;
  return VS_OK;
}

vs_status vs_calib_solve_from_height(vs_calib *calib, const vs_calib_point *points, int count, double height_m,
                                     vs_error *err) {
  vs_calib c = *calib;
  c.cx_px = 0.5 * c.width, c.cy_px = 0.5 * c.height;
  c.k1 = c.k2 = c.k3 = c.p1 = c.p2 = 0;
  c.fx_px = c.fy_px = c.width;
  // Seen from above, the height found is nearly proportional to the focal length assumed.
  for (int round = 0; round < 20; round++) {
    vs_status s = vs_calib_solve_pose(&c, points, count, err);
    if (s != VS_OK) return s;
    double lens[3];
    vs_calib_lens(&c, lens);
    if (fabs(lens[2] - height_m) < 1e-4) {
      *calib = c;
      return VS_OK;
    }
    c.fx_px = c.fy_px = c.fx_px * height_m / lens[2];
  }
  return vs_fail(err, VS_FAIL, "no focal length puts the lens %.2f m over the floor: is that its height?", height_m);
}

enum { MOST_PICTURES = 200 };

struct vs_calib_board {
  int columns, rows, width, height, pictures;
  double square_m;
  double *corners; // [MOST_PICTURES][columns * rows][2]
  const vs_opencv *cv;
};

vs_status vs_calib_board_new(int columns, int rows, double square_m, vs_calib_board **out, vs_error *err) {
  *out = NULL;
  if (columns < 3 || rows < 3 || columns > 50 || rows > 50 || !(square_m > 0 && square_m < 1))
    return vs_fail(err, VS_USAGE, "a board of %d x %d inner corners, squares of %g m: allowed are 3 to 50 and 0 to 1 m",
                   columns, rows, square_m);
  const vs_opencv *cv = NULL;
  vs_status s = vs_opencv_load(&cv, err);
  if (s != VS_OK) return s;
  vs_calib_board *b = calloc(1, sizeof *b);
  if (b) b->corners = malloc((size_t)MOST_PICTURES * columns * rows * 2 * sizeof *b->corners);
  if (!b || !b->corners) {
    free(b);
    return vs_fail(err, VS_FAIL, "out of memory");
  }
  b->columns = columns, b->rows = rows, b->square_m = square_m, b->cv = cv;
  *out = b;
  return VS_OK;
}

void vs_calib_board_free(vs_calib_board *board) {
  if (!board) return;
  free(board->corners);
  free(board);
}

vs_status vs_calib_board_add(vs_calib_board *b, const unsigned char *grey, int stride, int width, int height,
                             bool *found, vs_error *err) {
  *found = false;
  if (b->pictures == 0) b->width = width, b->height = height;
  if (width != b->width || height != b->height)
    return vs_fail(err, VS_FAIL, "a picture of %d x %d after some of %d x %d: all must have one size", width, height,
                   b->width, b->height);
  if (b->pictures == MOST_PICTURES) return vs_fail(err, VS_FAIL, "more than %d pictures", MOST_PICTURES);
  double *corners = b->corners + (size_t)b->pictures * b->columns * b->rows * 2;
  vs_status s = b->cv->board_find(grey, stride, width, height, b->columns, b->rows, corners, found, err);
  if (s == VS_OK && *found) b->pictures++;
  return s;
}

vs_status vs_calib_board_solve(vs_calib_board *b, vs_calib *calib, vs_error *err) {
  if (b->pictures < 3)
    return vs_fail(err, VS_FAIL, "the board was found in %d pictures: at least 3 are needed", b->pictures);
  double camera[4], distortion[5], rms_px;
  vs_status s = b->cv->board_solve(b->corners, b->pictures, b->columns, b->rows, b->square_m, b->width, b->height,
                                   camera, distortion, &rms_px, err);
  if (s != VS_OK) return s;
  calib->width = b->width, calib->height = b->height;
  calib->fx_px = camera[0], calib->fy_px = camera[1], calib->cx_px = camera[2], calib->cy_px = camera[3];
  calib->k1 = distortion[0], calib->k2 = distortion[1], calib->p1 = distortion[2], calib->p2 = distortion[3];
  calib->k3 = distortion[4];
  calib->intrinsics_rms_px = rms_px;
  return VS_OK;
}
