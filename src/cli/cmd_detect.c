// vsss detect: what the eyes see in one picture.
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "field_config.h"
#include "vsss/calib.h"
#include "vsss/camera.h"
#include "vsss/detect.h"
#include "vsss/frame_stream.h"
#include "vsss/image.h"
#include "vsss/tag.h"

enum { MOST = 256 };

// What was found in a picture.
typedef struct finding {
  int tags;
  vs_tag tag[MOST];
  int blobs[3]; // ball, blue, yellow
  vs_blob blob[3][VS_MAX_BLOBS];
} finding;

static const char *const blob_names[3] = {"ball", "blue", "yellow"};

static void print_text(const finding *f, bool colours) {
  for (int i = 0; i < f->tags; i++) {
    const vs_tag *t = &f->tag[i];
    printf("tag %d  centre %.4f %.4f  corners", t->id, t->centre_px[0], t->centre_px[1]);
    for (int k = 0; k < 4; k++) printf(" (%.4f %.4f)", t->corner_px[k][0], t->corner_px[k][1]);
    printf("  hamming %d  margin %.1f\n", t->hamming, t->margin);
  }
  for (int kind = 0; kind < 3; kind++)
    for (int i = 0; i < f->blobs[kind]; i++) {
      const vs_blob *b = &f->blob[kind][i];
      printf("%s  centre %.2f %.2f  area %.0f  elongation %.2f\n", blob_names[kind], b->x_px, b->y_px, b->area_px,
             b->elongation);
    }
  printf("%d tag%s", f->tags, f->tags == 1 ? "" : "s");
  for (int kind = 0; colours && kind < 3; kind++) printf(", %d %s", f->blobs[kind], blob_names[kind]);
  printf("\n");
}

static void print_json(const finding *f, const vs_frame *frame) {
  printf("{\"width\": %d, \"height\": %d, \"tags\": [", frame->width, frame->height);
  for (int i = 0; i < f->tags; i++) {
    const vs_tag *t = &f->tag[i];
    printf("%s\n  {\"id\": %d, \"hamming\": %d, \"margin\": %.2f, \"centre\": [%.4f, %.4f], \"corners\": [",
           i ? "," : "", t->id, t->hamming, t->margin, t->centre_px[0], t->centre_px[1]);
    for (int k = 0; k < 4; k++) printf("%s[%.4f, %.4f]", k ? ", " : "", t->corner_px[k][0], t->corner_px[k][1]);
    printf("]}");
  }
  printf("], \"blobs\": [");
  bool first = true;
  for (int kind = 0; kind < 3; kind++)
    for (int i = 0; i < f->blobs[kind]; i++, first = false) {
      const vs_blob *b = &f->blob[kind][i];
      printf("%s\n  {\"colour\": \"%s\", \"centre\": [%.2f, %.2f], \"area\": %.0f, \"elongation\": %.3f}",
             first ? "" : ",", blob_names[kind], b->x_px, b->y_px, b->area_px, b->elongation);
    }
  printf("]}\n");
}

static vs_status draw(const finding *f, const vs_frame *frame, const char *path, vs_error *err) {
  static const uint8_t edge[3] = {60, 220, 60}, front[3] = {60, 60, 240}, ring[3] = {240, 80, 240};
  // The frame is a recording's own buffer, about to be closed: drawing over it harms nobody.
  vs_image image = {(uint8_t *)frame->bgr, frame->width, frame->height, frame->bgr_stride};
  for (int i = 0; i < f->tags; i++)
    for (int k = 0; k < 4; k++) {
      const double *a = f->tag[i].corner_px[k], *b = f->tag[i].corner_px[(k + 1) % 4];
      vs_image_line(&image, a[0], a[1], b[0], b[1], 2, k == 2 ? front : edge);
    }
  for (int kind = 0; kind < 3; kind++)
    for (int i = 0; i < f->blobs[kind]; i++) {
      const vs_blob *b = &f->blob[kind][i];
      vs_image_line(&image, b->x_px - 6, b->y_px, b->x_px + 6, b->y_px, 1, ring);
      vs_image_line(&image, b->x_px, b->y_px - 6, b->x_px, b->y_px + 6, 1, ring);
    }
  return vs_image_save(path, frame->bgr, frame->bgr_stride, frame->width, frame->height, err);
}

// The detector looks for one team's colour at a time: two rounds give both.
static vs_status find_colours(const vs_frame *frame, const vs_tag_def *tag, const vs_detector_def *colours, finding *f,
                              vs_error *err) {
  for (int team = VS_BLUE; team <= VS_YELLOW; team++) {
    vs_detector_def def = *colours;
    def.tag = *tag;
    def.adversary = (vs_team)team;
    vs_detector *detector;
    vs_detections seen;
    vs_status s = vs_detector_new(&def, &detector, err);
    if (s != VS_OK) return s;
    s = vs_detect(detector, frame, &seen, err);
    vs_detector_free(detector);
    if (s != VS_OK) return s;
    f->blobs[0] = seen.balls;
    memcpy(f->blob[0], seen.ball, sizeof seen.ball);
    f->blobs[1 + team] = seen.adversaries;
    memcpy(f->blob[1 + team], seen.adversary, sizeof seen.adversary);
  }
  return VS_OK;
}

// The colours of the field's configuration, and the sizes that a calibration gives them.
static vs_status load_colours(const char *config, const char *calib, const vs_camera_info *info, vs_detector_def *out,
                              vs_error *err) {
  static vs_field_config file;
  vs_calib c;
  vs_status s = vs_field_config_load(config, &file, err);
  if (s == VS_OK) *out = file.def.detector;
  out->own = VS_MARK_APRIL, out->their = VS_MARK_PATCH;
  if (s != VS_OK || !calib) return s;
  s = vs_calib_load(calib, &c, err);
  if (s == VS_OK) s = vs_calib_check_size(&c, calib, info->width, info->height, err);
  if (s == VS_OK) out->px_per_m = vs_calib_px_per_m(&c, file.def.tracker.patch_height_m);
  return s;
}

// What was asked.
typedef struct request {
  const char *source, *drawing, *config, *calib;
  bool colours, json;
} request;

static vs_status look(const request *r, const vs_tag_def *def, vs_error *err) {
  const char *source = r->source, *drawing = r->drawing;
  bool colours = r->colours, json = r->json;
  vs_detector_def colours_def = vs_detector_def_default();
  vs_camera_def camera_def = vs_camera_def_default();
  camera_def.every_frame = true;
  vs_camera *camera = NULL;
  vs_tag_detector *detector = NULL;
  vs_frame frame;
  vs_camera_got got = VS_CAMERA_TIMEOUT;
  finding found = {0};
  vs_status s = vs_camera_open(source, &camera_def, &camera, err);
  if (s == VS_OK) s = vs_tag_detector_new(def, &detector, err);
  if (s == VS_OK) s = vs_camera_read(camera, 5000, &frame, &got, err);
  if (s == VS_OK && got != VS_CAMERA_FRAME) s = vs_fail(err, VS_FAIL, "%s: gives no picture within 5 s", source);
  if (s == VS_OK) s = vs_tag_detect(detector, &frame, found.tag, MOST, &found.tags, err);
  if (s == VS_OK && colours) s = load_colours(r->config, r->calib, vs_camera_about(camera), &colours_def, err);
  if (s == VS_OK && colours) s = find_colours(&frame, def, &colours_def, &found, err);
  if (s == VS_OK && json) print_json(&found, &frame);
  if (s == VS_OK && !json) print_text(&found, colours);
  if (s == VS_OK && drawing) s = draw(&found, &frame, drawing, err);
  vs_tag_detector_free(detector);
  vs_camera_close(camera);
  return s;
}

int cmd_detect(int argc, char **argv) {
  vs_camera_register(vs_frame_stream_camera());
  vs_tag_def def = vs_tag_def_photo();
  request r = {0};
  bool field = false, help;
  const char *family = def.family;
  double min_margin = -1;
  int contrast = 0;
  const vs_flag flags[] = {
      {"family", VS_FLAG_TEXT, &family, "NAME", "tag family", 0, 0},
      {"decimate", VS_FLAG_REAL, &def.decimate, "N", "search in a picture smaller by N", 1, 8},
      {"bits", VS_FLAG_INT, &def.bits_corrected, "N", "bits the decoder may correct", 0, 2},
      {"max-hamming", VS_FLAG_INT, &def.max_hamming, "N", "corrected bits accepted", 0, 2},
      {"min-margin", VS_FLAG_REAL, &min_margin, "M", "decision margin accepted (0; with --field 40)", 0, 255},
      {"contrast", VS_FLAG_INT, &contrast, "N", "least black to white in grey levels (5; with --field 40)", 1, 255},
      {"field", VS_FLAG_SWITCH, &field, NULL, "the thresholds of the field's camera instead of a photograph's", 0, 0},
      {"colours", VS_FLAG_SWITCH, &r.colours, NULL, "also orange, blue and yellow blobs, by --config", 0, 0},
      {"config", VS_FLAG_TEXT, &r.config, "FILE", "colours: instead of deploy/config/field.ini", 0, 0},
      {"calib", VS_FLAG_TEXT, &r.calib, "FILE", "colours: of the camera, to know the sizes of things", 0, 0},
      {"json", VS_FLAG_SWITCH, &r.json, NULL, "print JSON", 0, 0},
      {"draw", VS_FLAG_TEXT, &r.drawing, "FILE", "write the picture with what was found (.png, .jpg)", 0, 0},
      {NULL, VS_FLAG_SWITCH, NULL, NULL, NULL, 0, 0}};
  vs_flag_list words = {0};
  vs_error err;
  vs_status s =
      vs_args_parse(argc, argv, "detect IMAGE [flags]",
                    "Finds AprilTags in a picture (or the first frame of a camera) and prints their corners in\n"
                    "pixels: bottom left, bottom right, top right, top left of the printed pattern.",
                    flags, &words, &help, &err);
  if (s != VS_OK) return vs_cli_error("detect", &err);
  if (help) return 0;
  if (words.count != 1) {
    vs_fail(&err, VS_USAGE, "give one picture: vsss detect IMAGE (families: %s)", vs_tag_families());
    return vs_cli_error("detect", &err);
  }
  vs_tag_def thresholds = field ? vs_tag_def_field() : vs_tag_def_photo();
  def.family = family;
  def.min_margin = min_margin >= 0 ? min_margin : thresholds.min_margin;
  def.min_white_black_diff = contrast > 0 ? contrast : thresholds.min_white_black_diff;
  r.source = words.value[0];
  s = look(&r, &def, &err);
  return s == VS_OK ? 0 : vs_cli_error("detect", &err);
}
