// Square marks as patterns: what is printed on a robot's cap and textured on the rig's. AprilTags need libapriltag; ArUco
// Original is its own definition.
#ifndef VSSS_TAG_H
#define VSSS_TAG_H

#include <stdint.h>

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

// Side of the printed paper on the 80 mm cap, all cells (field.md, Tags). The top edge of the pattern shows to the front.
#define VS_TAG_PAPER_M   0.078
#define VS_TAG_FAMILY    "tagStandard41h12"
#define VS_TAG_MAX_CELLS 12 // a side of the largest family, white margin included

// ArUco Original, 5 x 5 bits: what LARC 2026 asks for (mark.h), found by libapriltag through a family of the ids looked
// for; marks smaller than 32 px once more in the picture at twice its size, where not all were seen. On drawn frames of
// 640x480 with 0 to 8 mm of motion blur that finds 100 of 100, 0.2 to 0.4 mm and 0.2 to 0.3 degrees off, in 2 ms or, both
// times, 8.4 ms; at 1280x720 in 4.4 ms. OpenCV's detector takes 1.4 ms, but finds 94 to 99 with the one window that suits
// this size of mark (5 or 11 px: 43 to 96), 0.5 mm and 0.8 degrees off. Without the larger picture libapriltag finds all
// up to 6 mm of blur and 57 at 8 mm.
#define VS_TAG_ARUCO "aruco"

// The pattern of one tag: cells x cells, row 0 is the top edge, 0 black, 255 white.
typedef struct vs_tag_pattern {
  int cells; // on a side: 9 for tagStandard41h12 (no margin: its outer ring is data), 10 for tag36h11, 7 for aruco
  int border_cells; // side of the square whose corners the detector reports: 5, 8 and 7
  uint8_t cell[VS_TAG_MAX_CELLS][VS_TAG_MAX_CELLS];
} vs_tag_pattern;

// VS_USAGE: unknown family (lists the known ones) or an id the family does not have; VS_FAIL: built without libapriltag.
vs_status vs_tag_pattern_of(const char *family, int id, vs_tag_pattern *out, vs_error *err);
const char *vs_tag_families(void); // "aruco tagStandard41h12 tag25h9 ..."

// Writes tags on one A4 sheet in true size, with outline, name and a 100 mm bar to check the print by; the ending of
// path chooses .pdf or .png (300 dots per inch, patterns only; needs OpenCV). VS_USAGE: more than fit a sheet.
vs_status vs_tag_sheet(const char *path, const char *family, const int *ids, int count, double paper_m, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
