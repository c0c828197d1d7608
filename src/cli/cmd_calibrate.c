// vsss calibrate: from measured points to a calibration file, its check, and tags to print.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "vsss/calib.h"
#include "vsss/calib_watch.h"
#include "vsss/camera.h"
#include "vsss/clock.h"
#include "vsss/colours.h"
#include "vsss/detect.h"
#include "vsss/field.h"
#include "vsss/frame_stream.h"
#include "vsss/geom.h"
#include "vsss/image.h"
#include "vsss/paths.h"
#include "vsss/tag.h"

enum { MOST_POINTS = 256 };

typedef struct request {
  const char *camera, *points, *calib, *out, *size, *board, *print_tags, *family, *snapshot, *colours, *config;
  double height_m, square_mm, paper_mm, tolerance_mm, tag_height_mm;
  int pictures;
  bool check;
  vs_flag_list at;
} request;

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

static vs_status open_camera(const char *source, bool every_frame, vs_camera **camera, vs_error *err) {
  vs_camera_def def = vs_camera_def_default();
  def.every_frame = every_frame;
  vs_status s = vs_camera_open(source, &def, camera, err);
  if (s == VS_OK && vs_camera_about(*camera)->note[0]) printf("%s\n", vs_camera_about(*camera)->note);
  return s;
}

static vs_status print_tags(const request *r, vs_error *err) {
  int ids[64], count = 0;
  for (const char *p = r->print_tags; *p;) {
    char *end;
    long id = strtol(p, &end, 10);
    if (end == p || (*end && *end != ',') || id < 0 || id > 100000 || count == 64)
      return vs_fail(err, VS_USAGE, "--print-tags %s: expected ids such as 0,1,2", r->print_tags);
    ids[count++] = (int)id;
    p = *end ? end + 1 : end;
  }
  if (!r->out) return vs_fail(err, VS_USAGE, "--print-tags needs --out FILE.pdf or .png");
  double paper_m = r->paper_mm > 0                    ? 1e-3 * r->paper_mm
                   : !strcmp(r->family, VS_TAG_ARUCO) ? VS_ARUCO_SIDE_M
                   : !strcmp(r->family, "colour")     ? VS_PLATE_SIDE_M
                                                      : VS_TAG_PAPER_M;
  vs_status s = vs_tag_sheet(r->out, r->family, ids, count, paper_m, err);
  if (s == VS_OK)
    printf("%s: %d tags of %g mm, on A4. Print at 100 %% and measure the 100 mm bar.\n", r->out, count, 1000 * paper_m);
  return s;
}

static vs_status snapshot(const request *r, vs_error *err) {
  vs_camera *camera = NULL;
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_TIMEOUT;
  vs_status s = open_camera(r->camera, false, &camera, err);
  // A device's first pictures are of its old exposure.
  for (int i = 0; s == VS_OK && i < 10 && got != VS_CAMERA_END; i++) {
    s = vs_camera_read(camera, 2000, &frame, &got, err);
    if (s == VS_OK && got == VS_CAMERA_TIMEOUT) s = vs_fail(err, VS_FAIL, "%s: no picture within 2 s", r->camera);
    if (s == VS_OK && got == VS_CAMERA_FRAME)
      s = vs_image_save(r->snapshot, frame.bgr, frame.bgr_stride, frame.width, frame.height, err);
  }
  if (s == VS_OK) printf("%s: read the pixels of known points off it, (0, 0) is its top left corner\n", r->snapshot);
  vs_camera_close(camera);
  return s;
}

// A picture worth learning from: a device's first ones are of its old exposure.
static vs_status settled_picture(const char *source, vs_camera **camera, vs_frame *frame, vs_error *err) {
  vs_status s = open_camera(source, false, camera, err);
  int wanted = !strncmp(source, "/dev/", 5) ? 10 : 1;
  for (int i = 0; s == VS_OK && i < wanted; i++) {
    vs_camera_got got;
    s = vs_camera_read(*camera, 2000, frame, &got, err);
    if (s == VS_OK && got != VS_CAMERA_FRAME) s = vs_fail(err, VS_FAIL, "%s: no picture within 2 s", source);
  }
  return s;
}

static void print_colours(const vs_detector_def *d) {
  const char *const names[] = {"ball", "blue", "yellow"};
  const vs_colour *const ranges[] = {&d->ball, &d->team[VS_BLUE], &d->team[VS_YELLOW]};
  for (int i = 0; i < 3; i++)
    printf("%-7s hue %3.0f to %3.0f, saturation from %.2f, value from %.2f\n", names[i], ranges[i]->hue_min_deg,
           ranges[i]->hue_max_deg, ranges[i]->saturation_min, ranges[i]->value_min);
  for (int i = 0; i < VS_PLATE_COLOURS; i++)
    printf("%-7s hue %3.0f, saturation %.2f\n", vs_plate_colour_name((vs_plate_colour)i), d->square[i].hue_deg,
           d->square[i].saturation);
}

static vs_status learn_colours(const request *r, vs_error *err) {
  static vs_field_config config;
  static vs_colour_point points[MOST_POINTS];
  char from[512];
  int count;
  vs_camera *camera = NULL;
  vs_frame frame;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--colours needs --camera SOURCE (a picture will do)");
  if (!r->out) return vs_fail(err, VS_USAGE, "--colours needs --out FILE.ini, for `vsss field --config`");
  vs_status s = vs_colours_load_points(r->colours, points, MOST_POINTS, &count, err);
  if (s == VS_OK) s = vs_field_config_load(r->config, &config, err);
  if (s == VS_OK && !r->config) s = vs_path_find("deploy/config/field.ini", from, sizeof from, err);
  if (s == VS_OK) s = settled_picture(r->camera, &camera, &frame, err);
  if (s == VS_OK && vs_colours_learn(&frame, points, count, &config.def.detector, err) != VS_OK)
    s = vs_fail_prefix(err, "%s", r->colours);
  if (s == VS_OK) print_colours(&config.def.detector);
  if (s == VS_OK) s = vs_colours_save(r->out, r->config ? r->config : from, &config.def.detector, err);
  if (s == VS_OK)
    printf("saved as %s: vsss detect PICTURE --colours --config %s tries it, vsss field --config %s plays with it\n",
           r->out, r->out, r->out);
  vs_camera_close(camera);
  return s;
}

static vs_status collect_boards(const request *r, vs_camera *camera, vs_calib_board *board, int *seen, vs_error *err) {
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

static vs_status checkerboard(const request *r, vs_error *err) {
  int columns, rows, seen = 0;
  vs_status s = parse_pair("checkerboard", r->board, 3, 50, &columns, &rows, err);
  if (s != VS_OK) return s;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--checkerboard needs --camera SOURCE (a folder of pictures will do)");
  vs_camera *camera = NULL;
  vs_calib_board *board = NULL;
  vs_calib c = vs_calib_overhead(640, 480, 2.2, 0.7); // a pose to be measured at the venue
  s = vs_calib_board_new(columns, rows, 1e-3 * r->square_mm, &board, err);
  if (s == VS_OK) s = open_camera(r->camera, true, &camera, err);
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

// The picture's size: from --calib, --size or the camera.
static vs_status start_calib(const request *r, vs_calib *c, char name[96], vs_error *err) {
  name[0] = '\0';
  if (r->camera) {
    vs_camera *camera;
    vs_status s = open_camera(r->camera, false, &camera, err);
    if (s != VS_OK) return s;
    snprintf(name, 96, "%s", vs_camera_about(camera)->name);
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

static void print_points(const vs_calib *c, const vs_calib_point *points, int count) {
  printf("%9s %9s   %7s %7s %6s   %8s\n", "x px", "y px", "x m", "y m", "z m", "error mm");
  for (int i = 0; i < count; i++)
    printf("%9.2f %9.2f   %7.3f %7.3f %6.3f   %8.2f\n", points[i].x_px, points[i].y_px, points[i].x_m, points[i].y_m,
           points[i].z_m, vs_calib_error_mm(c, &points[i]));
}

static vs_status from_points(const request *r, vs_error *err) {
  static vs_calib_point points[MOST_POINTS];
  vs_calib c = {0};
  char name[96];
  int count;
  vs_status s = vs_calib_load_points(r->points, points, MOST_POINTS, &count, err);
  if (s == VS_OK) s = start_calib(r, &c, name, err);
  if (s == VS_OK && !r->calib && r->height_m <= 0)
    s = vs_fail(err, VS_USAGE, "the lens is not known: give --calib FILE (of --checkerboard) or --height-m, by tape");
  if (s == VS_OK)
    s = r->calib ? vs_calib_solve_pose(&c, points, count, err)
                 : vs_calib_solve_from_height(&c, points, count, r->height_m, err);
  if (s != VS_OK) return s;
  double lens[3];
  vs_calib_lens(&c, lens);
  print_points(&c, points, count);
  printf("%d points: error %.2f mm rms, %.2f mm at worst; lens at (%.3f, %.3f), %.3f m over the floor\n", count,
         c.rms_mm, c.worst_mm, lens[0], lens[1], lens[2]);
  stamp(&c, name[0] ? name : c.camera[0] ? NULL : "unnamed");
  return save(&c, r->out, err);
}

static vs_status check_points(const request *r, vs_error *err) {
  static vs_calib_point points[MOST_POINTS];
  vs_calib c = {0};
  char name[96];
  int count;
  vs_status s = vs_calib_load_points(r->points, points, MOST_POINTS, &count, err);
  if (s == VS_OK) s = start_calib(r, &c, name, err);
  if (s != VS_OK) return s;
  if (count == 0) return vs_fail(err, VS_FAIL, "%s: holds no points", r->points);
  double sum = 0, worst = 0;
  for (int i = 0; i < count; i++) {
    double e = vs_calib_error_mm(&c, &points[i]);
    sum += e * e / count;
    worst = fmax(worst, e);
  }
  print_points(&c, points, count);
  printf("%d points: error %.2f mm rms, %.2f mm at worst\n", count, sqrt(sum), worst);
  if (!(worst <= r->tolerance_mm))
    return vs_fail(err, VS_FAIL, "%s: %.1f mm at worst, %.1f are allowed: calibrate anew", r->calib, worst,
                   r->tolerance_mm);
  return VS_OK;
}

// By the field's own lines, or its walls.
static vs_status check_field(const request *r, vs_error *err) {
  vs_calib c;
  vs_camera *camera = NULL;
  vs_calib_watch *watch = NULL;
  vs_frame frame;
  vs_status s = vs_calib_load(r->calib, &c, err);
  if (s == VS_OK) s = settled_picture(r->camera, &camera, &frame, err);
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

static vs_status watch_marks(const request *r, const vs_calib *c, vs_camera *camera, vs_tag_detector *detector,
                             mark *marks, vs_error *err) {
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

static vs_status check_tags(const request *r, vs_error *err) {
  mark marks[VS_FLAG_LIST_MAX];
  vs_calib c = {0};
  vs_camera *camera = NULL;
  vs_tag_detector *detector = NULL;
  vs_tag_def def = vs_tag_def_field();
  def.family = r->family;
  if (!r->camera) return vs_fail(err, VS_USAGE, "--at needs --camera SOURCE");
  vs_status s = parse_marks(&r->at, marks, err);
  if (s == VS_OK) s = vs_calib_load(r->calib, &c, err);
  if (s == VS_OK) s = open_camera(r->camera, true, &camera, err);
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
  if (!(worst <= r->tolerance_mm))
    return vs_fail(err, VS_FAIL, "%s: %.1f mm at worst, %.1f are allowed: calibrate anew", r->calib, worst,
                   r->tolerance_mm);
  return VS_OK;
}

static vs_status act(const request *r, vs_error *err) {
  if (r->print_tags) return print_tags(r, err);
  if (r->colours) return learn_colours(r, err);
  if (r->board) return checkerboard(r, err);
  if (r->snapshot) return r->camera ? snapshot(r, err) : vs_fail(err, VS_USAGE, "--snapshot needs --camera SOURCE");
  if ((r->check || r->at.count) && !r->calib)
    return vs_fail(err, VS_USAGE, "a check needs --calib FILE, the calibration to be checked");
  if (r->at.count) return check_tags(r, err);
  if (r->points) return r->check ? check_points(r, err) : from_points(r, err);
  if (r->check && r->camera) return check_field(r, err);
  return vs_fail(err, VS_USAGE,
                 "nothing to do: give --points, --checkerboard, --colours, --snapshot, --at or --print-tags");
}

int cmd_calibrate(int argc, char **argv) {
  vs_camera_register(vs_frame_stream_camera());
  request r = {.family = VS_TAG_FAMILY,
               .square_mm = 25,
               .tolerance_mm = 5,
               .tag_height_mm = 1000 * VS_ROBOT_HEIGHT_M,
               .pictures = 20};
  const vs_flag flags[] = {
      {"camera", VS_FLAG_TEXT, &r.camera, "SOURCE", "camera, video or folder of pictures", 0, 0},
      {"snapshot", VS_FLAG_TEXT, &r.snapshot, "FILE", "save one picture of the camera, to read pixels off", 0, 0},
      {"points", VS_FLAG_TEXT, &r.points, "FILE", "measured points, one a line: x_px y_px x_m y_m [z_m]", 0, 0},
      {"calib", VS_FLAG_TEXT, &r.calib, "FILE", "a calibration: its lens is used, or it is checked", 0, 0},
      {"height-m", VS_FLAG_REAL, &r.height_m, "H", "instead of --calib: the lens over the floor, by tape", 0.3, 20},
      {"size", VS_FLAG_TEXT, &r.size, "WxH", "size of the picture where no camera tells it", 0, 0},
      {"out", VS_FLAG_TEXT, &r.out, "FILE", "write the calibration (or the sheet of tags)", 0, 0},
      {"check", VS_FLAG_SWITCH, &r.check, NULL,
       "only print how far --calib is off: at --points, at --at, or by the field's lines", 0, 0},
      {"at", VS_FLAG_LIST, &r.at, "ID=X,Y", "check with a tag laid on a point, metres (repeat it)", 0, 0},
      {"tag-height-mm", VS_FLAG_REAL, &r.tag_height_mm, "H", "height of those tags over the floor", 0, 300},
      {"tolerance-mm", VS_FLAG_REAL, &r.tolerance_mm, "MM", "a check that is off by more fails", 0.01, 1000},
      {"checkerboard", VS_FLAG_TEXT, &r.board, "CxR", "measure the lens by a board of CxR inner corners", 0, 0},
      {"square-mm", VS_FLAG_REAL, &r.square_mm, "MM", "side of its squares", 1, 500},
      {"pictures", VS_FLAG_INT, &r.pictures, "N", "pictures of the board or of the tags", 1, 200},
      {"colours", VS_FLAG_TEXT, &r.colours, "FILE", "learn colours from points, one a line: x_px y_px NAME", 0, 0},
      {"config", VS_FLAG_TEXT, &r.config, "FILE", "the configuration they go into; default: field.ini", 0, 0},
      {"print-tags", VS_FLAG_TEXT, &r.print_tags, "IDS", "write a sheet of tags such as 0,1,2 to --out", 0, 0},
      {"family", VS_FLAG_TEXT, &r.family, "NAME", "tag family; aruco: the league's; colour: plates such as 1,12,23,101",
       0, 0},
      {"paper-mm", VS_FLAG_REAL, &r.paper_mm, "MM", "side of a printed tag; 0: 78, of aruco 70, of colour 65", 0, 186},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  bool help;
  vs_error err;
  vs_status s = vs_args_parse(
      argc, argv, "calibrate [flags]",
      "Makes the file that turns a camera's pixels into field metres. Once per lens:\n"
      "  vsss calibrate --checkerboard 9x6 --square-mm 25 --camera /dev/video0 --out lens.ini\n"
      "At every venue, from four or more points of the field and their pixels (corner (0.75, 0.65), middle (0, 0), "
      "...):\n"
      "  vsss calibrate --camera /dev/video0 --snapshot field.png\n"
      "  vsss calibrate --points points.txt --calib lens.ini --out deploy/calibration/venue.ini\n"
      "  vsss calibrate --check --calib deploy/calibration/venue.ini --camera /dev/video0 --at 0=0.375,0.4\n"
      "Colours, from points of a picture (ball, blue, yellow, red, green, pink, cyan):\n"
      "  vsss calibrate --colours points.txt --camera field.png --out venue-field.ini\n"
      "Tags for the robots' caps: vsss calibrate --print-tags 0,1,2 --out tags.pdf\n"
      "The marks of LARC 2026: vsss calibrate --print-tags 256,272,273,955,771,939 --family aruco --out marks.pdf",
      flags, NULL, &help, &err);
  if (s == VS_OK && help) return 0;
  if (s == VS_OK) s = act(&r, &err);
  return s == VS_OK ? 0 : vs_cli_error("calibrate", &err);
}
