// Calibrations made: a lens by a checkerboard, a camera's place by measured points.
#include "calibrate.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "vsss/clock.h"

static vs_status parse_pair(const char *what, const char *text, int low, int high, int *a, int *b, vs_error *err) {
  char x, end;
  if (sscanf(text, "%d%c%d%c", a, &x, b, &end) != 3 || x != 'x' || *a < low || *b < low || *a > high || *b > high)
    return vs_fail(err, VS_USAGE, "--%s %s: expected two numbers from %d to %d such as 640x480", what, text, low, high);
  return VS_OK;
}

static void stamp(vs_calib *c, const char *camera) {
  time_t now = (time_t)(vs_clock_wall_us() / 1000000);
  struct tm utc;
  gmtime_r(&now, &utc);
  strftime(c->date, sizeof c->date, "%Y-%m-%dT%H:%M:%SZ", &utc);
  if (camera) snprintf(c->camera, sizeof c->camera, "%s", camera);
}

static vs_status save(const vs_calib *c, const char *out, vs_error *err) {
  if (!out) {
    printf("not saved: give --out FILE\n");
    return VS_OK;
  }
  vs_status s = vs_calib_save(out, c, err);
  if (s == VS_OK) printf("saved as %s\n", out);
  return s;
}

vs_status calibrate_open_camera(const char *source, bool every_frame, vs_camera **camera, vs_error *err) {
  vs_camera_def def = vs_camera_def_default();
  def.every_frame = every_frame;
  vs_status s = vs_camera_open(source, &def, camera, err);
  if (s == VS_OK && vs_camera_about(*camera)->note[0]) printf("%s\n", vs_camera_about(*camera)->note);
  return s;
}

vs_status calibrate_settled_picture(const char *source, vs_camera **camera, vs_frame *frame, vs_error *err) {
  vs_status s = calibrate_open_camera(source, false, camera, err);
  int wanted = !strncmp(source, "/dev/", 5) ? 10 : 1;
  for (int i = 0; s == VS_OK && i < wanted; i++) {
    vs_camera_got got;
    s = vs_camera_read(*camera, 2000, frame, &got, err);
    if (s == VS_OK && got != VS_CAMERA_FRAME) s = vs_fail(err, VS_FAIL, "%s: no picture within 2 s", source);
  }
  return s;
}

static vs_status collect_boards(const calibrate_request *r, vs_camera *camera, vs_calib_board *board, int *seen,
                                vs_error *err) {
  vs_camera_got got = VS_CAMERA_FRAME;
  vs_frame frame;
  bool device = !strncmp(r->camera, "/dev/", 5);
  vs_cli_catch_interrupts();
  for (int64_t last_us = 0; *seen < r->pictures && got != VS_CAMERA_END && !vs_cli_interrupted();) {
    vs_status s = vs_camera_read(camera, 2000, &frame, &got, err);
    if (s != VS_OK) return s;
    // From a device two views a second: in between the board has hardly moved.
    if (got != VS_CAMERA_FRAME || (device && last_us && frame.capture_us - last_us < 500000)) continue;
    bool found;
    s = vs_calib_board_add(board, frame.grey, frame.grey_stride, frame.width, frame.height, &found, err);
    if (s != VS_OK) return s;
    if (found) last_us = frame.capture_us;
    *seen += found;
    printf("picture %u: %s (%d of %d)\n", frame.seq, found ? "board seen" : "no whole board", *seen, r->pictures);
  }
  return VS_OK;
}

vs_status calibrate_lens(const calibrate_request *r, vs_error *err) {
  int columns, rows, seen = 0;
  vs_status s = parse_pair("checkerboard", r->board, 3, 50, &columns, &rows, err);
  if (s != VS_OK) return s;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--checkerboard needs --camera SOURCE (a folder of pictures will do)");
  vs_camera *camera = NULL;
  vs_calib_board *board = NULL;
  vs_calib c = vs_calib_overhead(640, 480, 2.2, 0.7); // a pose to be measured at the venue
  s = vs_calib_board_new(columns, rows, 1e-3 * r->square_mm, &board, err);
  if (s == VS_OK) s = calibrate_open_camera(r->camera, true, &camera, err);
  if (s == VS_OK) s = collect_boards(r, camera, board, &seen, err);
  if (s == VS_OK) s = vs_calib_board_solve(board, &c, err);
  if (s == VS_OK) {
    printf("focal length %.1f x %.1f px, middle (%.1f, %.1f), k1 %.4f k2 %.4f p1 %.5f p2 %.5f k3 %.4f\n", c.fx_px,
           c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3);
    printf("error %.3f px rms over %d pictures (good: below 0.4)\n", c.intrinsics_rms_px, seen);
    stamp(&c, vs_camera_about(camera)->name);
    s = save(&c, r->out, err);
  }
  vs_camera_close(camera);
  vs_calib_board_free(board);
  return s;
}

static vs_status begin(const calibrate_request *r, calibrate_measured *m, vs_error *err) {
  vs_calib *c = &m->calib;
  if (r->camera) {
    vs_camera *camera;
    vs_status s = calibrate_open_camera(r->camera, false, &camera, err);
    if (s != VS_OK) return s;
    snprintf(m->camera, sizeof m->camera, "%s", vs_camera_about(camera)->name);
    c->width = vs_camera_about(camera)->width, c->height = vs_camera_about(camera)->height;
    vs_camera_close(camera);
  }
  if (r->size) {
    vs_status s = parse_pair("size", r->size, 16, 16384, &c->width, &c->height, err);
    if (s != VS_OK) return s;
  }
  int width = c->width, height = c->height;
  if (r->calib) {
    vs_status s = vs_calib_load(r->calib, c, err);
    return s == VS_OK && width ? vs_calib_check_size(c, r->calib, width, height, err) : s;
  }
  if (!c->width)
    return vs_fail(err, VS_USAGE, "the size of the picture is not known: give --camera, --size or --calib");
  return VS_OK;
}

vs_status calibrate_read(const calibrate_request *r, calibrate_measured *out, vs_error *err) {
  *out = (calibrate_measured){0};
  vs_status s = vs_calib_load_points(r->points, out->point, CALIBRATE_MOST_POINTS, &out->count, err);
  return s == VS_OK ? begin(r, out, err) : s;
}

void calibrate_print_points(const calibrate_measured *m) {
  printf("%9s %9s   %7s %7s %6s   %8s\n", "x px", "y px", "x m", "y m", "z m", "error mm");
  for (int i = 0; i < m->count; i++) {
    const vs_calib_point *p = &m->point[i];
    printf("%9.2f %9.2f   %7.3f %7.3f %6.3f   %8.2f\n", p->x_px, p->y_px, p->x_m, p->y_m, p->z_m,
           vs_calib_error_mm(&m->calib, p));
  }
}

vs_status calibrate_points(const calibrate_request *r, vs_error *err) {
  static calibrate_measured m;
  vs_calib *c = &m.calib;
  vs_status s = calibrate_read(r, &m, err);
  if (s == VS_OK && !r->calib && r->height_m <= 0)
    s = vs_fail(err, VS_USAGE, "the lens is not known: give --calib FILE (of --checkerboard) or --height-m, by tape");
  if (s == VS_OK)
    s = r->calib ? vs_calib_solve_pose(c, m.point, m.count, err)
                 : vs_calib_solve_from_height(c, m.point, m.count, r->height_m, err);
  if (s != VS_OK) return s;
  double lens[3];
  vs_calib_lens(c, lens);
  calibrate_print_points(&m);
  printf("%d points: error %.2f mm rms, %.2f mm at worst; lens at (%.3f, %.3f), %.3f m over the floor\n", m.count,
         c->rms_mm, c->worst_mm, lens[0], lens[1], lens[2]);
  stamp(c, m.camera[0] ? m.camera : c->camera[0] ? NULL : "unnamed");
  return save(c, r->out, err);
}
