// The configuration of detector, tracker and camera as keys of a file.
#ifndef VSSS_VISION_CONFIG_H
#define VSSS_VISION_CONFIG_H

#include "vsss/camera.h"
#include "vsss/config.h"
#include "vsss/detect.h"
#include "vsss/track.h"

#ifdef __cplusplus
extern "C" {
#endif

// Where the [vision] section's words go; the defs point into it, so it must outlive them.
typedef struct vs_vision_words {
  char family[32], own_tags[16], their_tags[16], plate[VS_TEAMS][VS_TEAM_SIZE][32];
} vs_vision_words;
// The [vision] section of deploy/config/field.ini: writes up to capacity rows for vs_config_load that set detector and
// tracker, and returns how many (no closing row).
int vs_vision_schema(vs_detector_def *detector, vs_track_def *tracker, vs_camera_def *camera, vs_vision_words *words,
                     vs_config_key *rows, int capacity);
// After loading: what the words mean, for detector and tracker. VS_USAGE: an unknown kind of mark.
vs_status vs_vision_take(const vs_vision_words *words, vs_detector_def *detector, vs_track_def *tracker, vs_error *err);
// Both defs from the kinds of marks, where flags say otherwise than the file.
void vs_vision_marks(vs_detector_def *detector, vs_track_def *tracker, vs_mark own, vs_mark their);

#ifdef __cplusplus
}
#endif
#endif
