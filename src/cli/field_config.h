// deploy/config/field.ini: what a team's field needs, apart from the camera's calibration.
#ifndef VSSS_CLI_FIELD_CONFIG_H
#define VSSS_CLI_FIELD_CONFIG_H

#include "vsss/field_loop.h"
#include "vsss/vision_config.h"

typedef struct vs_field_config {
  vs_field_def def; // its texts point into this struct
  char policy[256], fallback[256], radio[256], team[16], attack[8];
  vs_vision_words vision;
  int radio_id[VS_TEAM_SIZE], team_id;
  char key[64], wire[24];
  char path[512]; // of the file
} vs_field_config;

// path NULL: deploy/config/field.ini of this program. attack stays "" where the file does not say.
vs_status vs_field_config_load(const char *path, vs_field_config *out, vs_error *err);
// The same from the text of such a file.
vs_status vs_field_config_parse(const char *name, const char *text, vs_field_config *out, vs_error *err);

// A rig lays the calibration of its camera beside the camera. False: the camera is none of a rig, or there is none.
bool vs_field_rig_calib(const char *camera, char *path, size_t size);

#endif
