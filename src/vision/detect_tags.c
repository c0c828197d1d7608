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

#include "vsss/detect.h"
#include "vsss/tag.h"

typedef struct family {
  const char *name;
  apriltag_family_t *(*create)(void);
  void (*destroy)(apriltag_family_t *);
} family;

static const family families[] = {
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
  return "tagStandard41h12 tag36h11 tag25h9 tag36h10 tag16h5 tagCircle21h7 tagCircle49h12 tagCustom48h12 "
         "tagStandard52h13";
}

static vs_status find_family(const char *name, const family **out, vs_error *err) {
  for (size_t i = 0; i < sizeof families / sizeof *families; i++)
    if (!strcmp(families[i].name, name)) return *out = &families[i], VS_OK;
  return vs_fail(err, VS_USAGE, "unknown tag family '%s'; known are %s", name, vs_tag_families());
}

vs_status vs_tag_pattern_of(const char *name, int id, vs_tag_pattern *out, vs_error *err) {
  const family *f = NULL;
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
};

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
  d->tags = f->create();
  d->detector = apriltag_detector_create();
  d->detector->nthreads = 1; // two are slower, and race (field.md 1.2)
  d->detector->quad_decimate = (float)def->decimate;
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
  free(detector);
}

static int by_id_then_x(const void *a, const void *b) {
  const vs_tag *p = a, *q = b;
  if (p->id != q->id) return p->id < q->id ? -1 : 1;
  return (p->centre_px[0] > q->centre_px[0]) - (p->centre_px[0] < q->centre_px[0]);
}

vs_status vs_tag_detect(vs_tag_detector *detector, const vs_frame *frame, vs_tag *out, int capacity, int *count,
                        vs_error *err) {
  *count = 0;
  image_u8_t image = {
      .width = frame->width, .height = frame->height, .stride = frame->grey_stride, .buf = (uint8_t *)frame->grey};
  errno = 0;
  zarray_t *found = apriltag_detector_detect(detector->detector, &image);
  if (!found) return vs_fail(err, VS_FAIL, "libapriltag: %s", errno ? strerror(errno) : "no result");
  for (int i = 0; i < zarray_size(found) && *count < capacity; i++) {
    apriltag_detection_t *hit;
    zarray_get(found, i, &hit);
    if (hit->hamming > detector->def.max_hamming || hit->decision_margin < detector->def.min_margin) continue;
    vs_tag *tag = &out[(*count)++];
    tag->id = hit->id;
    tag->hamming = hit->hamming;
    tag->margin = hit->decision_margin;
    memcpy(tag->centre_px, hit->c, sizeof tag->centre_px);
    memcpy(tag->corner_px, hit->p, sizeof tag->corner_px);
  }
  apriltag_detections_destroy(found);
  qsort(out, *count, sizeof *out, by_id_then_x);
  return VS_OK;
}
