// ArUco Original: 1024 marks of 7 x 7 cells, the outer ring dark.
#ifndef VSSS_VISION_ARUCO_H
#define VSSS_VISION_ARUCO_H

#include "vsss/mark.h"
#include "vsss/tag.h"

enum { VS_ARUCO_IDS = 1024 };
bool vs_aruco_light(int id, int row, int column); // row, column: 0..6 from the top left
vs_status vs_aruco_pattern(int id, vs_tag_pattern *out, vs_error *err);

#endif
