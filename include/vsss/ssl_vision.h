// What a shared vision of the hall says: SSL-Vision's wrapper, as RobôCIn's vss-vision sends it too. Bytes -> struct -> world.
// Fields and numbers: src/league_net/ssl.proto. Positions only: velocities come of a filter here.
#ifndef VSSS_SSL_VISION_H
#define VSSS_SSL_VISION_H

#include <stddef.h>
#include <stdint.h>

#include "vsss/kalman.h"
#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_SSL_GROUP   "224.5.23.2"
#define VS_SSL_PORT    10015
#define VS_SSL_HOLD_US 100000 // not seen for longer: not valid

// One picture of one camera. Metres; origin in the centre, as world.h's absolute frame.
typedef struct vs_ssl_frame {
  bool detection;   // false: a message without one, such as geometry alone
  double capture_s; // of the sender's clock; 0: not told
  bool seen[VS_TEAMS][VS_TEAM_SIZE], ball_seen;
  vs_pose robot[VS_TEAMS][VS_TEAM_SIZE];
  double ball_x_m, ball_y_m; // the one of most confidence
} vs_ssl_frame;
// Numbers that are none, places off the field and robots that do not exist are left out. VS_FAIL: no such message.
vs_status vs_ssl_decode(const uint8_t *data, size_t size, vs_ssl_frame *out, vs_error *err);

// Plain data; all zero at the start.
typedef struct vs_ssl_object {
  int64_t seen_us; // 0: never
  vs_kalman x, y, theta;
} vs_ssl_object;
typedef struct vs_ssl_world {
  double capture_s;
  int64_t time_us; // monotonic
  vs_ssl_object robot[VS_TEAMS][VS_TEAM_SIZE], ball;
} vs_ssl_world;

// Takes a frame in that arrived now and gives the world. Time goes on by the sender's clock where it tells one.
void vs_ssl_world_see(vs_ssl_world *ssl, const vs_ssl_frame *frame, int64_t now_us, vs_world *world);

#ifdef __cplusplus
}
#endif
#endif
