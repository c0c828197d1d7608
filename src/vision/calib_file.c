// The calibration file: INI, made to be read and compared by people.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "point_line.h"
#include "vsss/calib.h"
#include "vsss/config.h"
#include "vsss/file.h"
#include "vsss/geom.h"

// Rotation as a vector: axis times angle. By way of the quaternion, which is well defined at half a turn, where a
// camera that looks straight down is.
static void rotation_to_vector(const double r[3][3], double v[3]) {
  double q[4] = {1 + r[0][0] + r[1][1] + r[2][2], r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]};
  for (int i = 0; i < 3; i++) { // the largest of four equivalent columns, for accuracy
    int j = (i + 1) % 3, k = (i + 2) % 3;
    double p[4];
    p[0] = r[k][j] - r[j][k];
    p[1 + i] = 1 + r[i][i] - r[j][j] - r[k][k];
    p[1 + j] = r[i][j] + r[j][i];
    p[1 + k] = r[i][k] + r[k][i];
    if (p[1 + i] > fabs(q[0]) && p[1 + i] > fabs(q[1]) && p[1 + i] > fabs(q[2]) && p[1 + i] > fabs(q[3]))
      memcpy(q, p, sizeof q);
  }
  if (q[0] < 0)
    for (int i = 0; i < 4; i++) q[i] = -q[i];
  double n = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]), angle = 2 * atan2(n, q[0]);
  for (int i = 0; i < 3; i++) v[i] = n > 0 ? q[1 + i] / n * angle : 0;
}

static void vector_to_rotation(const double v[3], double r[3][3]) {
  double angle = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), u[3] = {1, 0, 0};
  for (int i = 0; i < 3 && angle > 0; i++) u[i] = v[i] / angle;
  double c = cos(angle), s = sin(angle);
  double cross[3][3] = {{0, -u[2], u[1]}, {u[2], 0, -u[0]}, {-u[1], u[0], 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) r[i][j] = (i == j ? c : 0) + (1 - c) * u[i] * u[j] + s * cross[i][j];
}

vs_status vs_calib_load(const char *path, vs_calib *out, vs_error *err) {
  double lens[3] = {NAN, NAN, NAN}, v[3] = {NAN, NAN, NAN};
  *out = (vs_calib){0};
  const vs_config_key schema[] = {
      {"camera.name", VS_CONFIG_TEXT, out->camera, sizeof out->camera, 0, 0, "the camera it was made with"},
      {"camera.date", VS_CONFIG_TEXT, out->date, sizeof out->date, 0, 0, "when, UTC"},
      {"camera.width_px", VS_CONFIG_INT, &out->width, 0, 16, 16384, "size of its pictures"},
      {"camera.height_px", VS_CONFIG_INT, &out->height, 0, 16, 16384, "size of its pictures"},
      {"lens.fx_px", VS_CONFIG_REAL, &out->fx_px, 0, 10, 1e6, "focal length"},
      {"lens.fy_px", VS_CONFIG_REAL, &out->fy_px, 0, 10, 1e6, "focal length"},
      {"lens.cx_px", VS_CONFIG_REAL, &out->cx_px, 0, -16384, 32768, "principal point"},
      {"lens.cy_px", VS_CONFIG_REAL, &out->cy_px, 0, -16384, 32768, "principal point"},
      {"lens.k1", VS_CONFIG_REAL, &out->k1, 0, -10, 10, "radial distortion"},
      {"lens.k2", VS_CONFIG_REAL, &out->k2, 0, -100, 100, "radial distortion"},
      {"lens.k3", VS_CONFIG_REAL, &out->k3, 0, -1000, 1000, "radial distortion"},
      {"lens.p1", VS_CONFIG_REAL, &out->p1, 0, -1, 1, "tangential distortion"},
      {"lens.p2", VS_CONFIG_REAL, &out->p2, 0, -1, 1, "tangential distortion"},
      {"lens.rms_px", VS_CONFIG_REAL, &out->intrinsics_rms_px, 0, 0, 1000, "error of the checkerboard"},
      {"pose.x_m", VS_CONFIG_REAL, &lens[0], 0, -20, 20, "where the lens is"},
      {"pose.y_m", VS_CONFIG_REAL, &lens[1], 0, -20, 20, "where the lens is"},
      {"pose.z_m", VS_CONFIG_REAL, &lens[2], 0, 0.1, 20, "where the lens is, over the floor"},
      {"pose.rx_rad", VS_CONFIG_REAL, &v[0], 0, -10, 10, "rotation field to camera: axis times angle"},
      {"pose.ry_rad", VS_CONFIG_REAL, &v[1], 0, -10, 10, "rotation field to camera"},
      {"pose.rz_rad", VS_CONFIG_REAL, &v[2], 0, -10, 10, "rotation field to camera"},
      {"venue.points", VS_CONFIG_INT, &out->points, 0, 0, 100000, "measured pairs"},
      {"venue.rms_mm", VS_CONFIG_REAL, &out->rms_mm, 0, 0, 1e5, "their error"},
      {"venue.worst_mm", VS_CONFIG_REAL, &out->worst_mm, 0, 0, 1e5, "their error"},
      {NULL, VS_CONFIG_INT, NULL, 0, 0, 0, NULL}};
  vs_status s = vs_config_load(path, schema, err);
  if (s != VS_OK) return s;
  const char *missing = !out->width || !out->height                          ? "camera.width_px and height_px"
                        : !out->fx_px || !out->fy_px                         ? "lens.fx_px and fy_px"
                        : isnan(lens[0]) || isnan(lens[1]) || isnan(lens[2]) ? "pose.x_m, y_m and z_m"
                        : isnan(v[0]) || isnan(v[1]) || isnan(v[2])          ? "pose.rx_rad, ry_rad and rz_rad"
                                                                             : NULL;
  if (missing) return vs_fail(err, VS_FAIL, "%s: %s missing: not a whole calibration file", path, missing);
  vector_to_rotation(v, out->rotation);
  for (int i = 0; i < 3; i++) {
    out->translation_m[i] = 0;
    for (int j = 0; j < 3; j++) out->translation_m[i] -= out->rotation[i][j] * lens[j];
  }
  return VS_OK;
}

// A name must not end in what the INI reader takes for a comment.
static void plain(const char *in, char *out, size_t size) {
  size_t n = 0;
  for (; *in && n + 1 < size; in++) out[n++] = *in == '#' || *in == ';' || *in == '\n' ? '_' : *in;
  out[n] = '\0';
}

static void write_calib(FILE *f, const vs_calib *c) {
  char name[sizeof c->camera];
  double lens[3], v[3];
  vs_calib_lens(c, lens);
  rotation_to_vector(c->rotation, v);
  plain(c->camera, name, sizeof name);
  fprintf(f, "# Camera calibration, written by `vsss calibrate`. Lengths in m on the field, px in the picture.\n");
  fprintf(f, "[camera]\nname = %s\ndate = %s\nwidth_px = %d\nheight_px = %d\n", name, c->date, c->width, c->height);
  fprintf(f, "\n[lens]\nfx_px = %.9g\nfy_px = %.9g\ncx_px = %.9g\ncy_px = %.9g\n", c->fx_px, c->fy_px, c->cx_px,
          c->cy_px);
  fprintf(f, "k1 = %.9g\nk2 = %.9g\np1 = %.9g\np2 = %.9g\nk3 = %.9g\n", c->k1, c->k2, c->p1, c->p2, c->k3);
  fprintf(f, "rms_px = %.4g # of the checkerboard; 0: not measured\n", c->intrinsics_rms_px);
  fprintf(f, "\n[pose]\nx_m = %.9g # where the lens is\ny_m = %.9g\nz_m = %.9g\n", lens[0], lens[1], lens[2]);
  fprintf(f, "rx_rad = %.12g # rotation field to camera: axis times angle\nry_rad = %.12g\nrz_rad = %.12g\n", v[0],
          v[1], v[2]);
  fprintf(f, "\n[venue]\npoints = %d # 0: not measured\nrms_mm = %.4g\nworst_mm = %.4g\n", c->points, c->rms_mm,
          c->worst_mm);
}

typedef vs_status (*write_file)(const char *path, const void *data, size_t size, vs_error *err);

static vs_status put(write_file write, const char *path, const vs_calib *c, vs_error *err) {
  char text[4096];
  FILE *f = fmemopen(text, sizeof text, "w");
  if (!f) return vs_fail(err, VS_FAIL, "out of memory");
  write_calib(f, c);
  long size = ftell(f);
  bool whole = !ferror(f) && size > 0 && (size_t)size < sizeof text;
  whole = !fclose(f) && whole;
  return whole ? write(path, text, (size_t)size, err) : vs_fail(err, VS_FAIL, "%s: the calibration is too long", path);
}

vs_status vs_calib_save(const char *path, const vs_calib *c, vs_error *err) {
  return put(vs_file_replace, path, c, err);
}

vs_status vs_calib_create(const char *path, const vs_calib *c, vs_error *err) {
  return put(vs_file_create, path, c, err);
}

static vs_status parse_point(const char *path, int line, const char *text, vs_calib_point *out, vs_error *err) {
  double v[5] = {0};
  int used = 0, n = 0;
  for (; n < 5; n++) {
    int step = 0;
    if (sscanf(text + used, " %lf%n", &v[n], &step) != 1 || !isfinite(v[n])) break;
    used += step;
  }
  if (n < 4 || text[used + (int)strspn(text + used, " \t\r\n")])
    return vs_fail(err, VS_USAGE, "%s:%d: '%.*s': expected x_px y_px x_m y_m [z_m]", path, line,
                   (int)strcspn(text, "\r\n"), text);
  *out = (vs_calib_point){v[0], v[1], v[2], v[3], v[4]};
  if (fabs(v[2]) > 3 || fabs(v[3]) > 3 || fabs(v[4]) > 1)
    return vs_fail(err, VS_USAGE, "%s:%d: (%g, %g, %g) is far off the field: metres are expected", path, line, v[2],
                   v[3], v[4]);
  return VS_OK;
}

vs_status vs_calib_load_points(const char *path, vs_calib_point *out, int capacity, int *count, vs_error *err) {
  *count = 0;
  FILE *f = fopen(path, "r");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  char text[512];
  vs_status s = VS_OK;
  for (int line = 1; s == VS_OK && fgets(text, sizeof text, f); line++) {
    s = vs_point_line_check(f, path, line, text, sizeof text, err);
    if (s != VS_OK) break;
    text[strcspn(text, "#")] = '\0';
    if (!text[strspn(text, " \t\r\n")]) continue;
    if (*count == capacity)
      s = vs_fail(err, VS_USAGE, "%s:%d: more than %d points", path, line, capacity);
    else
      s = parse_point(path, line, text, &out[*count], err);
    *count += s == VS_OK;
  }
  fclose(f);
  return s;
}
