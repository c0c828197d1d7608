// The shared vision's datagrams by protobuf-c. The generated types stay in this file.
#include <math.h>
#include <string.h>

#include "league/ssl.pb-c.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/ssl_vision.h"

static bool on_field(double x_m, double y_m) {
  return fabs(x_m) <= VS_FIELD_HALF_LENGTH_M + VS_GOAL_DEPTH_M && fabs(y_m) <= VS_FIELD_HALF_WIDTH_M; // false for NaN
}

static void read_robots(Ssl__Robot *const *from, size_t n, vs_team team, vs_ssl_frame *out) {
  double best[VS_TEAM_SIZE] = {-1, -1, -1};
  for (size_t k = 0; k < n; k++) {
    const Ssl__Robot *r = from[k];
    double x_m = 1e-3 * r->x, y_m = 1e-3 * r->y;
    if (!r->has_robot_id || r->robot_id >= VS_TEAM_SIZE || !r->has_orientation || !isfinite(r->orientation)) continue;
    if (!on_field(x_m, y_m) || !(r->confidence > best[r->robot_id])) continue;
    best[r->robot_id] = r->confidence;
    out->seen[team][r->robot_id] = true;
    out->robot[team][r->robot_id] = (vs_pose){x_m, y_m, vs_wrap_rad(r->orientation)};
  }
}

static void read_ball(Ssl__Ball *const *from, size_t n, vs_ssl_frame *out) {
  double best = -1;
  for (size_t k = 0; k < n; k++) {
    double x_m = 1e-3 * from[k]->x, y_m = 1e-3 * from[k]->y;
    if (!on_field(x_m, y_m) || !(from[k]->confidence > best)) continue;
    best = from[k]->confidence;
    out->ball_seen = true;
    out->ball_x_m = x_m;
    out->ball_y_m = y_m;
  }
}

vs_status vs_ssl_decode(const uint8_t *data, size_t size, vs_ssl_frame *out, vs_error *err) {
  Ssl__Wrapper *m = ssl__wrapper__unpack(NULL, size, data);
  memset(out, 0, sizeof *out);
  if (!m) return vs_fail(err, VS_FAIL, "%zu bytes that are no SSL_WrapperPacket", size);
  const Ssl__Detection *d = m->detection;
  if (d) {
    out->detection = true;
    out->capture_s = isfinite(d->t_capture) ? d->t_capture : 0;
    read_robots(d->robots_blue, d->n_robots_blue, VS_BLUE, out);
    read_robots(d->robots_yellow, d->n_robots_yellow, VS_YELLOW, out);
    read_ball(d->balls, d->n_balls, out);
  }
  ssl__wrapper__free_unpacked(m, NULL);
  return VS_OK;
}
