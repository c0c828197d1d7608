#ifndef VSSS_RIG_RIG_INTERNAL_H
#define VSSS_RIG_RIG_INTERNAL_H

#include "optics.h"
#include "robots.h"
#include "venue.h"
#include "vsss/bus.h"
#include "vsss/env.h"
#include "vsss/render.h"
#include "vsss/rig.h"

#define VS_RIG_TOUCH_APART_S 0.2 // without contact, then it is another touch

struct vs_rig {
  vs_rig_def def;
  vs_env *env;
  vs_render *render;
  uint8_t *rgb;
  uint8_t *moment; // of an exposure, and their sum; NULL: pictures take no time
  uint16_t *exposed;
  vs_optics optics;
  vs_frame_server *camera;
  vs_robots robots;
  vs_bus *bus;
  char camera_path[256], radio_path[256], calib_path[256];
  vs_venue venue; // the folder of these three
  vs_venue_file radio_file, calib_file;
  bool begun;                     // the first match
  double next_us;                 // moment of the next frame; 0: before the first
  uint32_t seq;                   // of pictures, drawn or skipped
  uint64_t matches;               // played to their end
  vs_wheels wheels[VS_TEAM_SIZE]; // what the motors were told at the present frame
  vs_world truth;
  double apart_s; // since an own robot last touched the ball
  vs_rig_stats stats;
  vs_message message; // scratch
};

#endif
