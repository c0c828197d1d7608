// A calibration checked: at measured points, by tags laid on marked points, by the field's own lines.
#include <math.h>
#include <stdio.h>

#include "calibrate.h"
#include "vsss/calib_watch.h"
#include "vsss/geom.h"
#include "vsss/detect.h"

static vs_status judge(const calibrate_request *r, double worst_mm, vs_error *err) {
  if (worst_mm <= r->tolerance_mm) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: %.1f mm at worst, %.1f are allowed: calibrate anew", r->calib, worst_mm,
                 r->tolerance_mm);
}

vs_status calibrate_check_points(const calibrate_request *r, vs_error *err) {
  static calibrate_measured m;
  vs_status s = calibrate_read(r, &m, err);
  if (s != VS_OK) return s;
  if (m.count == 0) return vs_fail(err, VS_FAIL, "%s: holds no points", r->points);
  double sum = 0, worst = 0;
  for (int i = 0; i < m.count; i++) {
    double e = vs_calib_error_mm(&m.calib, &m.point[i]);
    sum += e * e / m.count;
    worst = fmax(worst, e);
  }
  calibrate_print_points(&m);
  printf("%d points: error %.2f mm rms, %.2f mm at worst\n", m.count, sqrt(sum), worst);
  return judge(r, worst, err);
}

// By the field's own lines, or its walls.
vs_status calibrate_check_field(const calibrate_request *r, vs_error *err) {
  vs_calib c;
  vs_camera *camera = NULL;
  vs_calib_watch *watch = NULL;
  vs_frame frame;
  vs_status s = vs_calib_load(r->calib, &c, err);
  if (s == VS_OK) s = calibrate_settled_picture(r->camera, &camera, &frame, err);
  if (s == VS_OK) s = vs_calib_check_size(&c, r->calib, frame.width, frame.height, err);
  if (s == VS_OK) s = vs_calib_watch_new(&c, &watch, err);
  vs_calib_watch_result found = {0};
  if (s == VS_OK) found = vs_calib_watch_check(watch, &frame);
  vs_calib_watch_free(watch);
  vs_camera_close(camera);
  if (s != VS_OK) return s;
  if (!found.sure)
    return vs_fail(err, VS_FAIL, "%s: neither lines nor walls of the field stand out: check with --points or --at",
                   r->camera);
  printf("by the field's %s: shifted %.0f, %.0f mm, turned %.1f degrees; %.0f mm at worst\n",
         found.lines ? "lines" : "walls", 1000 * found.x_m, 1000 * found.y_m, found.turn_rad * 180 / VS_PI,
         found.error_mm);
  double allowed_mm = fmax(r->tolerance_mm, VS_CALIB_WATCH_WARN_MM);
  if (found.error_mm > allowed_mm)
    return vs_fail(err, VS_FAIL, "%s: %.0f mm at worst, %.0f are allowed: the camera has moved, calibrate anew",
                   r->calib, found.error_mm, allowed_mm);
  return VS_OK;
}

// Tags laid on marked points.
typedef struct mark {
  int id, seen;
  double x_m, y_m, sum_x, sum_y;
} mark;

static vs_status parse_marks(const vs_flag_list *at, mark *marks, vs_error *err) {
  for (int i = 0; i < at->count; i++) {
    char end;
    marks[i] = (mark){0};
    if (sscanf(at->value[i], "%d=%lf,%lf%c", &marks[i].id, &marks[i].x_m, &marks[i].y_m, &end) != 3)
      return vs_fail(err, VS_USAGE, "--at %s: expected ID=X,Y in metres, such as 0=0.375,0.4", at->value[i]);
  }
  return VS_OK;
}

static vs_status watch_marks(const calibrate_request *r, const vs_calib *c, vs_camera *camera,
                             vs_tag_detector *detector, mark *marks, vs_error *err) {
  vs_camera_got got = VS_CAMERA_FRAME;
  for (int k = 0; k < r->pictures && got != VS_CAMERA_END; k++) {
    vs_frame frame;
    vs_tag tag[VS_MAX_TAGS];
    int count;
    vs_status s = vs_camera_read(camera, 2000, &frame, &got, err);
    if (s != VS_OK) return s;
    if (got != VS_CAMERA_FRAME) continue;
    if ((s = vs_tag_detect(detector, &frame, tag, VS_MAX_TAGS, &count, err)) != VS_OK) return s;
    for (int i = 0; i < r->at.count; i++)
      for (int j = 0; j < count; j++) {
        double x, y, theta;
        if (tag[j].id != marks[i].id || !vs_calib_square(c, tag[j].corner_px, 1e-3 * r->tag_height_mm, &x, &y, &theta))
          continue;
        marks[i].sum_x += x, marks[i].sum_y += y, marks[i].seen++;
      }
  }
  return VS_OK;
}

vs_status calibrate_check_tags(const calibrate_request *r, vs_error *err) {
  mark marks[VS_FLAG_LIST_MAX];
  vs_calib c = {0};
  vs_camera *camera = NULL;
  vs_tag_detector *detector = NULL;
  vs_tag_def def = vs_tag_def_field();
  def.family = r->family;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--at needs --camera SOURCE");
  vs_status s = parse_marks(&r->at, marks, err);
  if (s == VS_OK) s = vs_calib_load(r->calib, &c, err);
  if (s == VS_OK) s = calibrate_open_camera(r->camera, true, &camera, err);
  if (s == VS_OK)
    s = vs_calib_check_size(&c, r->calib, vs_camera_about(camera)->width, vs_camera_about(camera)->height, err);
  if (s == VS_OK) s = vs_tag_detector_new(&def, &detector, err);
  if (s == VS_OK) s = watch_marks(r, &c, camera, detector, marks, err);
  vs_tag_detector_free(detector);
  vs_camera_close(camera);
  if (s != VS_OK) return s;
  double worst = 0;
  printf("%4s   %7s %7s   %7s %7s   %8s  %s\n", "tag", "x m", "y m", "seen x", "seen y", "error mm", "times");
  for (int i = 0; i < r->at.count; i++) {
    const mark *m = &marks[i];
    if (!m->seen) return vs_fail(err, VS_FAIL, "tag %d is not seen by %s", m->id, r->camera);
    double x = m->sum_x / m->seen, y = m->sum_y / m->seen, e = 1000 * hypot(x - m->x_m, y - m->y_m);
    printf("%4d   %7.3f %7.3f   %7.3f %7.3f   %8.2f  %d\n", m->id, m->x_m, m->y_m, x, y, e, m->seen);
    worst = fmax(worst, e);
  }
  return judge(r, worst, err);
}
