// Stands in for detect_tags.c where libapriltag is missing.
#include <string.h>

#include "vision/aruco.h"
#include "vsss/detect.h"
#include "vsss/tag.h"

static vs_status missing(vs_error *err) {
  return vs_fail(err, VS_FAIL, "this build finds no tags: install libapriltag-dev and run make again");
}

const char *vs_tag_families(void) { return "(none: install libapriltag-dev and run make again)"; }

vs_status vs_tag_pattern_of(const char *family, int id, vs_tag_pattern *out, vs_error *err) {
  return strcmp(family, VS_TAG_ARUCO) ? missing(err) : vs_aruco_pattern(id, out, err);
}

vs_status vs_tag_detector_new(const vs_tag_def *def, vs_tag_detector **out, vs_error *err) {
  (void)def;
  *out = NULL;
  return missing(err);
}

void vs_tag_detector_free(vs_tag_detector *detector) { (void)detector; }

vs_status vs_tag_detect(vs_tag_detector *detector, const vs_frame *frame, vs_tag *out, int capacity, int *count,
                        vs_error *err) {
  (void)detector, (void)frame, (void)out, (void)capacity;
  *count = 0;
  return missing(err);
}
