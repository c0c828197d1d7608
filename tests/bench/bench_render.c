// Milliseconds of a picture: the rig's overhead camera and the broadcast of a video.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/render.h"

enum { RUNS = 31 };

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int bench(vs_view view, const char *name) {
  vs_render_def def = vs_render_def_default(view);
  vs_render *r;
  vs_error err = {0};
  if (vs_render_new(&def, &r, &err) != VS_OK) {
    fprintf(stderr, "note: %s not measured: %s\n", name, err.text);
    return 0;
  }
  vs_world w;
  memset(&w, 0, sizeof w);
  for (int i = 0; i < 6; i++)
    w.robot[i / 3][i % 3] = (vs_robot){.pose = {-0.6 + 0.24 * i, i % 2 ? 0.3 : -0.3, i}, .valid = true};
  w.ball = (vs_ball){.z_m = 0.02, .valid = true};
  vs_game game = {.duration_s = 120};
  uint8_t *rgb = malloc((size_t)def.width_px * def.height_px * 3);
  double ms[RUNS];
  vs_status s = vs_render_world(r, &w, &game, rgb, &err);
  for (int i = 0; i < RUNS && s == VS_OK; i++) {
    int64_t start_us = vs_clock_monotonic_us();
    w.ball.x_m += 0.01;
    s = vs_render_world(r, &w, &game, rgb, &err);
    ms[i] = 1e-3 * (double)(vs_clock_monotonic_us() - start_us);
  }
  qsort(ms, RUNS, sizeof *ms, ascending);
  if (s == VS_OK) printf("bench %s %.2f ms\n", name, ms[RUNS / 2]);
  vs_render_free(r);
  free(rgb);
  return s != VS_OK;
}

int main(void) {
  return bench(VS_VIEW_CAMERA, "render_camera_640x480") + bench(VS_VIEW_BROADCAST, "render_broadcast_720p");
}
