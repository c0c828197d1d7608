// One frame -> tags, balls and adversaries in pixels.
#include "vsss/detect.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vision/blobs.h"
#include "vision/plates.h"
#include "vsss/field.h"
#include "vsss/tag.h"

enum { BALL = 1, TEAM = 2 /* shifted by the team */, MOST_BARS = 8 };

// Teams cut their colour from 30 mm upwards, whatever patch_m says, and a camera blurs its rim away.
#define SMALLEST_PATCH_M 0.03
// Middles of two patches on one cap are nearer than this.
#define PATCHES_APART_M 0.055

vs_tag_def vs_tag_def_field(void) {
  return (vs_tag_def){.family = VS_TAG_FAMILY,
                      .decimate = 2.0,
                      .sharpening = 0.25,
                      .min_white_black_diff = 40,
                      .bits_corrected = 1,
                      .max_hamming = 1,
                      .min_margin = 40.0};
}

vs_tag_def vs_tag_def_photo(void) {
  vs_tag_def def = vs_tag_def_field();
  def.decimate = 1.0;
  def.min_white_black_diff = 5;
  def.min_margin = 0.0;
  return def;
}

vs_detector_def vs_detector_def_default(void) {
  return (vs_detector_def){.tag = vs_tag_def_field(),
                           .own = VS_MARK_APRIL,
                           .their = VS_MARK_PATCH,
                           .adversary = VS_YELLOW,
                           .ball = {2, 40, 0.5, 0.3},
                           .team = {[VS_BLUE] = {195, 260, 0.22, 0.3}, [VS_YELLOW] = {46, 88, 0.35, 0.35}},
                           .square = {[VS_PLATE_RED] = {350, 0.9},
                                      [VS_PLATE_GREEN] = {130, 0.6},
                                      [VS_PLATE_PINK] = {330, 0.55},
                                      [VS_PLATE_CYAN] = {184, 0.7}}, // vs_plate_default
                           .tag_paper_m = VS_TAG_PAPER_M,
                           .patch_m = VS_PATCH_M};
}

struct vs_detector {
  vs_detector_def def;
  vs_tag_detector *april, *aruco; // NULL: nobody wears them
  vs_blob_finder *blobs;
  double side_px[VS_MARKS];     // expected of the square whose corners are seen; 0: any
  double paper_ratio[VS_MARKS]; // of what is printed to it
  vs_blob_gate ball, adversary, bar;
  int step; // of the colour grid
  uint8_t table[VS_COLOUR_TABLE];
};

// Without a scale: from 12 pixels to a fiftieth of the frame, whatever size that turns out to be.
static vs_blob_gate gate_of(uint8_t bit, double area_px, int most) {
  if (area_px > 0) return (vs_blob_gate){bit, area_px, 0.3 * area_px, 1.6 * area_px, most, 2.2};
  return (vs_blob_gate){bit, 0.0, 12.0, 1e4, 1, 2.2};
}

static void set_sizes(vs_detector *d) {
  double scale = d->def.px_per_m;
  double radius_px = scale * VS_BALL_RADIUS_M, patch_px = scale * d->def.patch_m;
  d->ball = gate_of(BALL, M_PI * radius_px * radius_px, 1);
  d->ball.max_px *= 1.4; // a fast ball is smeared over more
  d->adversary = gate_of(TEAM << d->def.adversary, patch_px * patch_px, VS_TEAM_SIZE);
  if (scale > 0) d->adversary.min_px = fmin(d->adversary.min_px, 0.5 * pow(scale * SMALLEST_PATCH_M, 2));
  d->bar = gate_of(0, scale * scale * VS_PLATE_SIDE_M * VS_PLATE_SQUARE_M, 1);
  d->bar.elongation = 4.0;
  d->side_px[VS_MARK_COLOUR] = scale * VS_PLATE_SIDE_M;
  d->paper_ratio[VS_MARK_COLOUR] = VS_ROBOT_SIZE_M / VS_PLATE_SIDE_M;
  double smallest_px = scale > 0 ? fmin(2 * radius_px, patch_px) : 8.0;
  d->step = (int)fmin(fmax(smallest_px / 4.0, 1.0), 4.0);
}

static bool worn(const vs_detector *d, vs_mark mark) { return d->def.own == mark || d->def.their == mark; }

static vs_status open_marks(vs_detector *d, vs_error *err) {
  vs_tag_def tag = d->def.tag;
  vs_tag_pattern pattern;
  vs_status s = VS_OK;
  if (worn(d, VS_MARK_APRIL)) {
    s = vs_tag_pattern_of(tag.family, 0, &pattern, err);
    if (s == VS_OK) s = vs_tag_detector_new(&tag, &d->april, err);
    if (s != VS_OK) return s;
    d->paper_ratio[VS_MARK_APRIL] = (double)pattern.cells / pattern.border_cells;
    d->side_px[VS_MARK_APRIL] = d->def.px_per_m * d->def.tag_paper_m / d->paper_ratio[VS_MARK_APRIL];
  }
  if (worn(d, VS_MARK_ARUCO)) {
    tag.family = VS_TAG_ARUCO;
    tag.side_px = d->side_px[VS_MARK_ARUCO] = d->def.px_per_m * VS_ARUCO_SIDE_M;
    d->paper_ratio[VS_MARK_ARUCO] = (VS_ARUCO_SIDE_M + 2 * VS_ARUCO_MARGIN_M) / VS_ARUCO_SIDE_M;
    s = vs_tag_detector_new(&tag, &d->aruco, err);
  }
  return s;
}

vs_status vs_detector_new(const vs_detector_def *def, vs_detector **out, vs_error *err) {
  *out = NULL;
  if (!(def->px_per_m >= 0 && def->px_per_m < 1e5) || !(def->patch_m > 0) || !(def->tag_paper_m > 0))
    return vs_fail(err, VS_USAGE, "detector: px_per_m %g, patch_m %g, tag_paper_m %g must be positive", def->px_per_m,
                   def->patch_m, def->tag_paper_m);
  vs_detector *d = calloc(1, sizeof *d);
  if (!d || !(d->blobs = vs_blob_finder_new())) {
    free(d);
    return vs_fail(err, VS_FAIL, "out of memory");
  }
  d->def = *def;
  vs_status s = open_marks(d, err);
  if (s != VS_OK) {
    vs_detector_free(d);
    return s;
  }
  vs_colour_table_add(d->table, &def->ball, BALL);
  for (int team = 0; team < VS_TEAMS; team++) vs_colour_table_add(d->table, &def->team[team], (uint8_t)(TEAM << team));
  set_sizes(d);
  *out = d;
  return VS_OK;
}

void vs_detector_free(vs_detector *detector) {
  if (!detector) return;
  vs_tag_detector_free(detector->april);
  vs_tag_detector_free(detector->aruco);
  vs_blob_finder_free(detector->blobs);
  free(detector);
}

static double side_px(const vs_tag *tag) {
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    const double *a = tag->corner_px[i], *b = tag->corner_px[(i + 1) % 4];
    sum += hypot(a[0] - b[0], a[1] - b[1]);
  }
  return sum / 4;
}

// Tags of another size than ours are reflections, prints on the wall or phantoms.
static int keep_sizes(const vs_detector *d, vs_tag *tag, int count) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    double side = side_px(&tag[i]), expected = d->side_px[tag[i].kind];
    if (expected > 0 && fabs(side - expected) > 0.25 * expected) continue;
    tag[kept++] = tag[i];
  }
  return kept;
}

static bool on_tag(const vs_detector *d, const vs_detections *seen, const vs_blob *blob) {
  for (int i = 0; i < seen->tags; i++) {
    const vs_tag *t = &seen->tag[i];
    double reach = 0.5 * side_px(t) * d->paper_ratio[t->kind];
    if (hypot(blob->x_px - t->centre_px[0], blob->y_px - t->centre_px[1]) < reach) return true;
  }
  return false;
}

// A colour seen on an own cap is paper or glare, no ball and no adversary.
static int keep_off_tags(const vs_detector *d, const vs_detections *seen, vs_blob *blob, int count) {
  int kept = 0;
  for (int i = 0; i < count; i++)
    if (!on_tag(d, seen, &blob[i])) blob[kept++] = blob[i];
  return kept;
}

// An orange identification patch beside a team's colour looks like a ball. One that lies there counts only where no other
// is seen: a real ball at a robot's side is as near.
static int prefer_free_balls(const vs_detector *d, vs_detections *seen) {
  int free_balls = 0;
  vs_blob kept[VS_MAX_BLOBS];
  for (int i = 0; i < seen->balls; i++) {
    bool near = false;
    for (int k = 0; k < seen->adversaries && !near; k++)
      near = hypot(seen->ball[i].x_px - seen->adversary[k].x_px, seen->ball[i].y_px - seen->adversary[k].y_px) <
             PATCHES_APART_M * d->def.px_per_m;
    if (!near) kept[free_balls++] = seen->ball[i];
  }
  if (free_balls == 0) return seen->balls;
  memcpy(seen->ball, kept, (size_t)free_balls * sizeof *kept);
  return free_balls;
}

static vs_status find_marks(const vs_detector *d, const vs_frame *frame, vs_detections *out, vs_error *err) {
  vs_tag_detector *const finder[] = {d->april, d->aruco};
  vs_status s = VS_OK;
  for (size_t i = 0; i < sizeof finder / sizeof *finder && s == VS_OK; i++) {
    if (!finder[i]) continue;
    int found = 0;
    vs_tag *rest = out->tag + out->tags;
    s = vs_tag_detect(finder[i], frame, rest, VS_MAX_TAGS - out->tags, &found, err);
    out->tags += keep_sizes(d, rest, found);
  }
  return s;
}

// The plates of both teams, as far as they wear some.
static vs_status find_plates(const vs_detector *d, const vs_frame *frame, vs_detections *out, vs_error *err) {
  const vs_team team[2] = {(vs_team)(1 - d->def.adversary), d->def.adversary};
  const vs_mark worn_by[2] = {d->def.own, d->def.their};
  vs_status s = VS_OK;
  for (int i = 0; i < 2 && s == VS_OK; i++) {
    if (worn_by[i] != VS_MARK_COLOUR) continue;
    vs_blob bar[MOST_BARS];
    int bars = 0;
    vs_blob_gate gate = d->bar;
    gate.bit = (uint8_t)(TEAM << team[i]);
    s = vs_blobs_find(d->blobs, frame, d->table, &gate, d->step, bar, MOST_BARS, &bars, err);
    out->tags += vs_plates_read(frame, team[i], bar, bars, d->def.px_per_m, d->def.square, out->tag + out->tags,
                                VS_MAX_TAGS - out->tags);
  }
  return s;
}

vs_status vs_detect(vs_detector *d, const vs_frame *frame, vs_detections *out, vs_error *err) {
  out->capture_us = frame->capture_us;
  out->seq = frame->seq;
  out->tags = out->balls = out->adversaries = 0;
  vs_status s = find_marks(d, frame, out, err);
  if (s == VS_OK) s = find_plates(d, frame, out, err);
  if (s != VS_OK) return s;
  s = vs_blobs_find(d->blobs, frame, d->table, &d->ball, d->step, out->ball, VS_MAX_BLOBS, &out->balls, err);
  if (s == VS_OK && d->def.their == VS_MARK_PATCH)
    s = vs_blobs_find(d->blobs, frame, d->table, &d->adversary, d->step, out->adversary, VS_MAX_BLOBS,
                      &out->adversaries, err);
  if (s != VS_OK) return s;
  out->balls = keep_off_tags(d, out, out->ball, out->balls);
  out->adversaries = keep_off_tags(d, out, out->adversary, out->adversaries);
  out->balls = prefer_free_balls(d, out);
  return VS_OK;
}
