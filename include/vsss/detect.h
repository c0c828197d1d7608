// One frame -> what can be seen in it, in pixels: marks of robots, orange balls, adversaries' colour patches. Knows nothing of
// metres (calib.h) nor of the frames before (track.h). No allocation per frame beyond libapriltag's own.
#ifndef VSSS_DETECT_H
#define VSSS_DETECT_H

#include "vsss/camera.h"
#include "vsss/mark.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

// Side of the team-colour square in the middle of an adversary's otherwise dark cap, as the rig draws it. Real teams
// have 30 mm to 80 mm; patch_m says how large one is where several run together.
#define VS_PATCH_M 0.06

// A mark with a name and a front, whatever its kind.
typedef struct vs_tag {
  vs_mark kind;
  int id;
  int hamming;            // bits corrected
  double margin;          // contrast of the decoded bits, 0..255; real tags > 100, phantoms < 5 (field.md, Tags)
  double centre_px[2];    // x, y
  double corner_px[4][2]; // of the tag's border: bottom left, bottom right, top right, top left of the printed pattern
} vs_tag;

enum { VS_TAG_MOST_IDS = 16 };
typedef struct vs_tag_def {
  const char *family;       // VS_TAG_FAMILY, tag25h9, tag36h11, ...
  double decimate;          // tags are searched in a picture smaller by this; 1 finds the smallest
  double blur_px;           // Gaussian before the search; 0
  double sharpening;        // of the decoded bits; 0.25
  int min_white_black_diff; // 40 on the field: 5 to 14 times faster than libapriltag's 5 (field.md, Tags)
  int bits_corrected;       // 1: 2 costs 175 MB and 99 ms (field.md, Tags)
  int max_hamming;          // accepted: 1
  double min_margin;        // accepted: 40
  // Of family VS_TAG_ARUCO only:
  double side_px; // expected of its border; 0: not known
  int ids;        // looked for; 0: the league's six
  int id[VS_TAG_MOST_IDS];
} vs_tag_def;
vs_tag_def vs_tag_def_field(void); // the field's camera, as above, decimate 2 (a third of the time, 0.1 mm worse)
vs_tag_def vs_tag_def_photo(void); // any photograph: libapriltag's own thresholds, decimate 1

typedef struct vs_tag_detector vs_tag_detector; // one thread at a time
vs_status vs_tag_detector_new(const vs_tag_def *def, vs_tag_detector **out, vs_error *err);
void vs_tag_detector_free(vs_tag_detector *detector); // NULL is allowed
// Writes up to capacity tags, ordered by id, then x; count is how many were written. Uses frame->grey only.
vs_status vs_tag_detect(vs_tag_detector *detector, const vs_frame *frame, vs_tag *out, int capacity, int *count,
                        vs_error *err);

// A colour as a range. Hue in degrees: red 0, yellow 60, blue 240; min > max wraps through 0.
typedef struct vs_colour {
  double hue_min_deg, hue_max_deg;
  double saturation_min, value_min; // 0..1
} vs_colour;

typedef struct vs_blob {
  double x_px, y_px; // centre of area
  double area_px;
  double elongation; // long over short axis of its second moments; 1 for disc and square
  double confidence; // 0..1 from area and shape
  double angle_rad;  // of the long axis, from right towards down the picture
} vs_blob;

enum { VS_MAX_TAGS = 16, VS_MAX_BLOBS = 16 };
typedef struct vs_detections {
  int64_t capture_us; // of the frame
  uint32_t seq;
  int tags, balls, adversaries;
  vs_tag tag[VS_MAX_TAGS];
  vs_blob ball[VS_MAX_BLOBS];      // best first
  vs_blob adversary[VS_MAX_BLOBS]; // best first
} vs_detections;

typedef struct vs_detector_def {
  vs_tag_def tag;          // AprilTags; its thresholds count for ArUco marks too
  vs_mark own, their;      // VS_MARK_APRIL, VS_MARK_PATCH
  vs_team adversary;       // whose colour is looked for
  vs_colour ball, team[2]; // team[VS_BLUE], team[VS_YELLOW]
  vs_hue square[VS_PLATE_COLOURS];
  double tag_paper_m; // VS_TAG_PAPER_M
  double patch_m;     // VS_PATCH_M
  double px_per_m;    // of the camera on the field (vs_calib_px_per_m): gates sizes. 0: sizes are not gated
} vs_detector_def;
vs_detector_def vs_detector_def_default(void);

typedef struct vs_detector vs_detector; // one thread at a time
vs_status vs_detector_new(const vs_detector_def *def, vs_detector **out, vs_error *err);
void vs_detector_free(vs_detector *detector); // NULL is allowed
vs_status vs_detect(vs_detector *detector, const vs_frame *frame, vs_detections *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
