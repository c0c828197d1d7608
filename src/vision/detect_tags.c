// libapriltag: patterns of tags and finding them. Built where the library is; detect_tags_stub.c otherwise.
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h10.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>

#include "vision/aruco.h"
#include "vsss/detect.h"
#include "vsss/tag.h"

// Below this a picture holds no tag, and libapriltag 3.3 reads and writes beyond its buffers.
#define LEAST_PX 64
// Marks smaller than this are looked for in the picture at twice its size, too, if not all are seen: see VS_TAG_ARUCO.
#define SMALL_MARK_PX 32

typedef struct family {
  const char *name;
  apriltag_family_t *(*create)(void);
  void (*destroy)(apriltag_family_t *);
} family;

// Marks of ArUco Original as a family of libapriltag's: 5 x 5 bits inside a dark border are the cells of tag25h9, whose
// order of bits is taken over. The codes are filled in when it is known which ids are looked for.
static apriltag_family_t *aruco_create(void) {
  apriltag_family_t *tags = tag25h9_create();
  tags->ncodes = 0;
  tags->h = 3;
  return tags;
}

static const family families[] = {
    {VS_TAG_ARUCO, aruco_create, tag25h9_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy},
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag36h10", tag36h10_create, tag36h10_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tagCircle21h7", tagCircle21h7_create, tagCircle21h7_destroy},
    {"tagCircle49h12", tagCircle49h12_create, tagCircle49h12_destroy},
    {"tagCustom48h12", tagCustom48h12_create, tagCustom48h12_destroy},
    {"tagStandard52h13", tagStandard52h13_create, tagStandard52h13_destroy},
};

const char *vs_tag_families(void) {
  return VS_TAG_ARUCO " tagStandard41h12 tag36h11 tag25h9 tag36h10 tag16h5 tagCircle21h7 tagCircle49h12 tagCustom48h12 "
                      "tagStandard52h13";
}

static vs_status find_family(const char *name, const family **out, vs_error *err) {
  for (size_t i = 0; i < sizeof families / sizeof *families; i++)
    if (!strcmp(families[i].name, name)) return *out = &families[i], VS_OK;
  return vs_fail(err, VS_USAGE, "unknown tag family '%s'; known are %s", name, vs_tag_families());
}

vs_status vs_tag_pattern_of(const char *name, int id, vs_tag_pattern *out, vs_error *err) {
  const family *f = NULL;
  if (!strcmp(name, VS_TAG_ARUCO)) return vs_aruco_pattern(id, out, err);
  vs_status s = find_family(name, &f, err);
  if (s != VS_OK) return s;
  apriltag_family_t *tags = f->create();
  if (id < 0 || id >= (int)tags->ncodes) {
    s = vs_fail(err, VS_USAGE, "tag id %d: %s has 0 to %d", id, name, (int)tags->ncodes - 1);
  } else {
    image_u8_t *image = apriltag_to_image(tags, id);
    *out = (vs_tag_pattern){.cells = tags->total_width, .border_cells = tags->width_at_border};
    for (int row = 0; row < out->cells; row++)
      memcpy(out->cell[row], image->buf + (size_t)row * image->stride, out->cells);
    image_u8_destroy(image);
  }
  f->destroy(tags);
  return s;
}

struct vs_tag_detector {
  vs_tag_def def;
  const family *family;
  apriltag_family_t *tags;
  apriltag_detector_t *detector;
  bool aruco;
  int ids, id[VS_TAG_MOST_IDS]; // of an ArUco family's codes
  uint8_t *large;               // the picture at twice its size, where small marks are looked for
  size_t large_bytes;
};

// The six of the league, or those that were asked for.
static vs_status choose_codes(vs_tag_detector *d, vs_error *err) {
  d->ids = d->def.ids;
  if (d->ids < 0 || d->ids > VS_TAG_MOST_IDS)
    return vs_fail(err, VS_USAGE, "%d ids of marks: allowed are 0 to %d", d->ids, VS_TAG_MOST_IDS);
  memcpy(d->id, d->def.id, sizeof d->id);
  if (d->ids == 0) {
    d->ids = VS_TEAMS * VS_TEAM_SIZE;
    memcpy(d->id, vs_aruco_league_id, sizeof vs_aruco_league_id);
  }
  for (int i = 0; i < d->ids; i++) {
    vs_tag_pattern pattern;
    vs_status s = vs_aruco_pattern(d->id[i], &pattern, err);
    if (s != VS_OK) return s;
    uint64_t code = 0;
    for (uint32_t bit = 0; bit < d->tags->nbits; bit++)
      code = code << 1 | (pattern.cell[d->tags->bit_y[bit]][d->tags->bit_x[bit]] != 0);
    d->tags->codes[i] = code;
  }
  d->tags->ncodes = (uint32_t)d->ids;
  return VS_OK;
}

vs_status vs_tag_detector_new(const vs_tag_def *def, vs_tag_detector **out, vs_error *err) {
  *out = NULL;
  const family *f = NULL;
  vs_status s = find_family(def->family, &f, err);
  if (s != VS_OK) return s;
  if (!(def->decimate >= 1.0 && def->decimate <= 8.0))
    return vs_fail(err, VS_USAGE, "decimate %g: allowed are 1 to 8", def->decimate);
  if (def->bits_corrected < 0 || def->bits_corrected > 2)
    return vs_fail(err, VS_USAGE, "%d corrected bits: allowed are 0 to 2", def->bits_corrected);
  vs_tag_detector *d = calloc(1, sizeof *d);
  if (!d) return vs_fail(err, VS_FAIL, "out of memory");
  d->def = *def;
  d->family = f;
  d->aruco = f->create == aruco_create;
  d->tags = f->create();
  d->detector = apriltag_detector_create();
  if (d->aruco && (s = choose_codes(d, err)) != VS_OK) {
    vs_tag_detector_free(d);
    return s;
  }
  d->detector->nthreads = 1; // two are slower, and race (field.md, Tags)
  // The light margin of an ArUco mark is half a cell: a coarser search does not see it.
  d->detector->quad_decimate = d->aruco ? 1.0f : (float)def->decimate;
  d->detector->quad_sigma = (float)def->blur_px;
  d->detector->decode_sharpening = def->sharpening;
  d->detector->refine_edges = true;
  d->detector->qtp.min_white_black_diff = def->min_white_black_diff;
  errno = 0;
  apriltag_detector_add_family_bits(d->detector, d->tags, def->bits_corrected);
  if (errno == ENOMEM) { // the library's only sign that its table of codes could not be made
    vs_tag_detector_free(d);
    return vs_fail(err, VS_FAIL, "out of memory for %s with %d corrected bits", def->family, def->bits_corrected);
  }
  d->def.family = f->name;
  *out = d;
  return VS_OK;
}

void vs_tag_detector_free(vs_tag_detector *detector) {
  if (!detector) return;
  apriltag_detector_destroy(detector->detector);
  detector->family->destroy(detector->tags);
  free(detector->large);
  free(detector);
}

static int by_id_then_x(const void *a, const void *b) {
  const vs_tag *p = a, *q = b;
  if (p->id != q->id) return p->id < q->id ? -1 : 1;
  return (p->centre_px[0] > q->centre_px[0]) - (p->centre_px[0] < q->centre_px[0]);
}

// Twice the size, between the middles of pixels: (x, y) of the picture becomes (2 x, 2 y).
static void enlarge(const vs_frame *f, uint8_t *out) {
  size_t stride = 2 * (size_t)f->width;
  for (int y = 0; y < f->height; y++) {
    const uint8_t *row = f->grey + (size_t)y * f->grey_stride;
    const uint8_t *above = y > 0 ? row - f->grey_stride : row, *below = y + 1 < f->height ? row + f->grey_stride : row;
    uint8_t *high = out + 2 * (size_t)y * stride, *low = high + stride;
    for (int x = 0; x < f->width; x++) {
      int l = x > 0 ? x - 1 : x, r = x + 1 < f->width ? x + 1 : x;
      int up[3] = {3 * row[l] + above[l], 3 * row[x] + above[x], 3 * row[r] + above[r]};
      int down[3] = {3 * row[l] + below[l], 3 * row[x] + below[x], 3 * row[r] + below[r]};
      high[2 * x] = (uint8_t)((up[0] + 3 * up[1] + 8) >> 4);
      high[2 * x + 1] = (uint8_t)((3 * up[1] + up[2] + 8) >> 4);
      low[2 * x] = (uint8_t)((down[0] + 3 * down[1] + 8) >> 4);
      low[2 * x + 1] = (uint8_t)((3 * down[1] + down[2] + 8) >> 4);
    }
  }
}

static vs_status make_large(vs_tag_detector *d, const vs_frame *frame, vs_error *err) {
  size_t bytes = 4 * (size_t)frame->width * frame->height;
  if (bytes > d->large_bytes) {
    free(d->large);
    d->large = malloc(bytes);
    d->large_bytes = d->large ? bytes : 0;
  }
  if (!d->large) return vs_fail(err, VS_FAIL, "out of memory for a picture");
  enlarge(frame, d->large);
  return VS_OK;
}

static void take(const vs_tag_detector *d, const apriltag_detection_t *hit, double scale, vs_tag *tag) {
  *tag = (vs_tag){.kind = d->aruco ? VS_MARK_ARUCO : VS_MARK_APRIL,
                  .id = d->aruco ? d->id[hit->id] : hit->id,
                  .hamming = hit->hamming,
                  .margin = hit->decision_margin};
  for (int k = 0; k < 2; k++) {
    tag->centre_px[k] = hit->c[k] / scale;
    for (int i = 0; i < 4; i++) tag->corner_px[i][k] = hit->p[i][k] / scale;
  }
}

// Looks at the picture at scale (1 or 2) times its size.
static vs_status search(vs_tag_detector *d, const vs_frame *frame, int scale, vs_tag *out, int capacity, int *count,
                        vs_error *err) {
  *count = 0;
  image_u8_t image = {.width = scale * frame->width,
                      .height = scale * frame->height,
                      .stride = scale == 2 ? 2 * frame->width : frame->grey_stride,
                      .buf = scale == 2 ? d->large : (uint8_t *)frame->grey};
  errno = 0;
  zarray_t *found = apriltag_detector_detect(d->detector, &image);
  if (!found) return vs_fail(err, VS_FAIL, "libapriltag: %s", errno ? strerror(errno) : "no result");
  for (int i = 0; i < zarray_size(found) && *count < capacity; i++) {
    apriltag_detection_t *hit;
    zarray_get(found, i, &hit);
    if (hit->hamming > d->def.max_hamming || hit->decision_margin < d->def.min_margin) continue;
    take(d, hit, scale, &out[(*count)++]);
  }
  apriltag_detections_destroy(found);
  qsort(out, *count, sizeof *out, by_id_then_x);
  return VS_OK;
}

static bool all_found(const vs_tag_detector *d, const vs_tag *tag, int count) {
  int different = 0;
  for (int i = 0; i < count; i++) different += i == 0 || tag[i].id != tag[i - 1].id;
  return different == d->ids;
}

vs_status vs_tag_detect(vs_tag_detector *d, const vs_frame *frame, vs_tag *out, int capacity, int *count,
                        vs_error *err) {
  *count = 0;
  if (frame->width < LEAST_PX || frame->height < LEAST_PX)
    return vs_fail(err, VS_USAGE, "a picture of %d x %d pixels: tags are looked for in at least %d x %d", frame->width,
                   frame->height, LEAST_PX, LEAST_PX);
  vs_status s = search(d, frame, 1, out, capacity, count, err);
  bool small = d->aruco && d->def.side_px > 0 && d->def.side_px < SMALL_MARK_PX;
  if (s != VS_OK || !small || all_found(d, out, *count)) return s;
  // Some hide or are blurred: the larger picture costs three times as much and shows them.
  s = make_large(d, frame, err);
  return s == VS_OK ? search(d, frame, 2, out, capacity, count, err) : s;
}
