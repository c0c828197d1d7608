// vsss calibrate: its flags, pictures to read points off, tags to print.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "calibrate.h"
#include "commands.h"
#include "vsss/field.h"
#include "vsss/frame_stream.h"
#include "vsss/image.h"
#include "vsss/mark.h"
#include "vsss/tag.h"

static vs_status print_tags(const calibrate_request *r, vs_error *err) {
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

static vs_status snapshot(const calibrate_request *r, vs_error *err) {
  vs_camera *camera = NULL;
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_TIMEOUT;
  vs_status s = calibrate_open_camera(r->camera, false, &camera, err);
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

static vs_status act(const calibrate_request *r, vs_error *err) {
  if (r->print_tags) return print_tags(r, err);
  if (r->colours) return calibrate_colours(r, err);
  if (r->board) return calibrate_lens(r, err);
  if (r->snapshot) return r->camera ? snapshot(r, err) : vs_fail(err, VS_USAGE, "--snapshot needs --camera SOURCE");
  if ((r->check || r->at.count) && !r->calib)
    return vs_fail(err, VS_USAGE, "a check needs --calib FILE, the calibration to be checked");
  if (r->at.count) return calibrate_check_tags(r, err);
  if (r->points) return r->check ? calibrate_check_points(r, err) : calibrate_points(r, err);
  if (r->check && r->camera) return calibrate_check_field(r, err);
  return vs_fail(err, VS_USAGE,
                 "nothing to do: give --points, --checkerboard, --colours, --snapshot, --at or --print-tags");
}

int cmd_calibrate(int argc, char **argv) {
  vs_camera_register(vs_frame_stream_camera());
  calibrate_request r = {.family = VS_TAG_FAMILY,
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
