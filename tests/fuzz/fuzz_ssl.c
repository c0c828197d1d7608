// Fuzzes src/league_net/ssl_messages.c and ssl_world.c, which field --camera ssl: and vss-vision: hear: datagrams one after the
// other, each with a byte of time and two of length before it.
#include <math.h>

#include "fuzz.h"
#include "league_net/ssl_bytes.h"
#include "vsss/field.h"
#include "vsss/ssl_vision.h"

static void seed(const char *name, const ssl_bytes datagram[], int n) {
  uint8_t bytes[4 * sizeof datagram->data];
  size_t used = 0;
  for (int k = 0; k < n; k++) {
    bytes[used++] = 33; // ms since the one before
    bytes[used++] = (uint8_t)(datagram[k].size & 255);
    bytes[used++] = (uint8_t)(datagram[k].size >> 8);
    memcpy(bytes + used, datagram[k].data, datagram[k].size);
    used += datagram[k].size;
  }
  fuzz_seed(name, bytes, used);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  ssl_bytes datagram[3];
  for (int k = 0; k < 3; k++) {
    ssl_bytes detection = {.size = 0};
    put_head(&detection, (uint32_t)(1000 + k), 5.0 + 0.033 * k);
    put_ball(&detection, 0.9F, 0.01 * k, -0.02);
    if (k == 2) put_ball(&detection, 0.1F, 0.5, 0.5);
    for (uint32_t i = 0; i < 3; i++) {
      put_robot(&detection, 6, i, 0.4, 0.2 * i - 0.2, 3.1 + 0.02 * k);
      put_robot(&detection, 7, i, -0.4 + 0.02 * k, 0.2 * i - 0.2, 0);
    }
    datagram[k] = wrap(&detection, k == 1);
  }
  seed("three", datagram, 3);
  seed("one", datagram, 1);
  datagram[0] = wrap(NULL, 1);
  seed("geometry", datagram, 2);
  return 0;
}

static bool on_field(double x_m, double y_m) {
  return fabs(x_m) <= VS_FIELD_HALF_LENGTH_M + VS_GOAL_DEPTH_M && fabs(y_m) <= VS_FIELD_HALF_WIDTH_M;
}

static void check_frame(const vs_ssl_frame *f) {
  if (!isfinite(f->capture_s)) abort();
  if (f->ball_seen && !on_field(f->ball_x_m, f->ball_y_m)) abort();
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_pose *p = &f->robot[t][i];
      if (f->seen[t][i] && (!on_field(p->x_m, p->y_m) || !(fabs(p->theta_rad) < 3.2))) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_ssl_world follows = {0};
  vs_world world = {0};
  int64_t now_us = 1000000;
  while (size >= 3) {
    vs_ssl_frame f;
    size_t length = (size_t)data[1] | (size_t)data[2] << 8;
    if (length > size - 3) length = size - 3;
    now_us += 1000 * data[0];
    if (vs_ssl_decode(data + 3, length, &f, NULL) == VS_OK && f.detection) {
      check_frame(&f);
      vs_ssl_world_see(&follows, &f, now_us, &world);
      if (!vs_world_ok(&world) || follows.time_us > now_us) abort();
    }
    data += 3 + length;
    size -= 3 + length;
  }
  return 0;
}
