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

// The [vision] section of deploy/config/field.ini: writes up to capacity rows for vs_config_load that set detector and
// tracker, and returns how many (no closing row). family[32] receives the tag family's name, which detector->tag.family
// points to.
int vs_vision_schema(vs_detector_def *detector, vs_track_def *tracker, vs_camera_def *camera, char family[32],
                     vs_config_key *rows, int capacity);

#ifdef __cplusplus
}
#endif
#endif
