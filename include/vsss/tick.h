// One turn of the field's loop as data: what it was given and what came of it. Written by `vsss field --record` beside the
// messages of bus.h (channel VS_TICK_CHANNEL, lcm_types/tick_t.lcm), read by `vsss replay --check`.
#ifndef VSSS_TICK_H
#define VSSS_TICK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

// The channels of a record that the bus does not have. The three others hold texts: what the run was started with, the
// field.ini and the calibration.
#define VS_TICK_CHANNEL   "VSSS_TICK"
#define VS_SETUP_CHANNEL  "VSSS_SETUP"
#define VS_CONFIG_CHANNEL "VSSS_CONFIG"
#define VS_CALIB_CHANNEL  "VSSS_CALIB"

enum { VS_TICK_CLOCKS = 16, VS_TICK_ROWS = 16, VS_TICK_BYTES = 8192 };

typedef struct vs_tick_tag {
  int kind, id, hamming;
  double margin, centre_px[2], corner_px[4][2];
} vs_tick_tag;
typedef struct vs_tick_blob {
  double x_px, y_px, area_px, elongation, confidence, angle_rad;
} vs_tick_blob;

// As lcm_types/tick_t.lcm has it.
typedef struct vs_tick {
  int32_t seq;
  bool frame;
  uint32_t frame_seq;
  int64_t capture_us;
  double fps;
  bool camera, player_failed, armed, rearm;
  int task; // vs_field_task
  int n_clock;
  int64_t clock_us[VS_TICK_CLOCKS];
  bool heard;
  int64_t heard_us;
  vs_msg_referee referee;
  int n_tags, n_balls, n_adversaries;
  vs_tick_tag tag[VS_TICK_ROWS];
  vs_tick_blob ball[VS_TICK_ROWS], adversary[VS_TICK_ROWS];
  bool decided, stop;
  int safety;
  uint64_t world_hash;
  vs_wheels wheels[VS_TEAM_SIZE];
} vs_tick;

// Size written; 0: it does not fit, or the program was built without LCM.
size_t vs_tick_encode(const vs_tick *tick, int64_t utime_us, int64_t utime_capture_us, uint8_t *out, size_t size);
// VS_FAIL: not such a message, or counts that cannot be.
vs_status vs_tick_decode(const uint8_t *data, size_t size, vs_tick *out, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
