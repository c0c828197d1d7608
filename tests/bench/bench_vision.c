// Times the eyes, frame in, detections out (tags, ball, adversaries), on drawn frames of a full field with sensor noise;
// and one tracker update, which is pixels to metres and seven Kalman filters.
#include <stdio.h>
#include <stdlib.h>

#include "vision/jpeg.h"
#include "vision/scene.h"
#include "vsss/calib.h"
#include "vsss/clock.h"
#include "vsss/track.h"

enum { FRAMES = 5, ROUNDS = 15 };

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void scatter(scene *s, int k) {
  vs_rng rng = vs_rng_make(11, (uint64_t)k);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    s->world.robot[i / 3][i % 3] =
        (vs_robot){.pose = {-0.5 + 0.5 * (i % 3) + vs_rng_range(&rng, -0.15, 0.15),
                            (i < 3 ? 0.33 : -0.33) + vs_rng_range(&rng, -0.2, 0.2), vs_rng_range(&rng, -3.1, 3.1)},
                   .valid = true};
  s->world.ball = (vs_ball){.x_m = vs_rng_range(&rng, -0.7, 0.7), .valid = true};
}

static int measure(int width, int height, double decimate, const char *name) {
  static scene s;
  scene_init(&s, width, height);
  vs_calib calib = vs_calib_overhead(width, height, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&calib, VS_ROBOT_HEIGHT_M);
  def.tag.decimate = decimate;
  vs_track_def track = vs_track_def_default();
  vs_tracker tracker;
  vs_track_init(&tracker, &track);
  vs_detector *detector;
  vs_error err;
  if (vs_detector_new(&def, &detector, &err) != VS_OK) return fprintf(stderr, "bench_vision: %s\n", err.text), 1;
  static double ms[FRAMES * ROUNDS], us[FRAMES * ROUNDS];
  int n = 0, found = 0;
  for (int k = 0; k < FRAMES; k++) {
    scatter(&s, k);
    vs_frame frame = scene_draw(&s, 0, 0);
    for (int round = 0; round < ROUNDS; round++, n++) {
      vs_detections seen;
      frame.capture_us = 33333 * (n + 1);
      int64_t start = vs_clock_monotonic_us();
      if (vs_detect(detector, &frame, &seen, &err) != VS_OK) return 1;
      int64_t middle = vs_clock_monotonic_us();
      for (int i = 0; i < 100; i++, seen.capture_us++) vs_track_update(&tracker, &calib, &seen);
      ms[n] = 1e-3 * (double)(middle - start);
      us[n] = (double)(vs_clock_monotonic_us() - middle) / 100;
      found += seen.tags + seen.balls + seen.adversaries;
    }
  }
  qsort(ms, (size_t)n, sizeof *ms, by_value);
  qsort(us, (size_t)n, sizeof *us, by_value);
  printf("bench vision_%s %.2f ms\n", name, ms[n / 2]);
  printf("bench vision_%s_p95 %.2f ms\n", name, ms[n * 95 / 100]);
  printf("bench vision_%s_found %.2f of_7\n", name, (double)found / n);
  if (decimate == 1.0) printf("bench track_update_%s %.2f us\n", name, us[n / 2]);
  vs_detector_free(detector);
  scene_free(&s);
  return 0;
}

// An MJPG camera's 720p: decoding, and decoding with detection, which is what of frame to bytes is ours to make fast.
static int measure_mjpg(void) {
  enum { W = 1280, H = 720, TIMES = 200 };
  static scene s;
  static uint8_t jpeg[1 << 21], bgr[3 * W * H], grey[W * H];
  static double decode_ms[TIMES], total_ms[TIMES];
  scene_init(&s, W, H);
  scatter(&s, 0);
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_calib calib = vs_calib_overhead(W, H, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&calib, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  vs_jpeg *decoder;
  vs_detections seen;
  vs_error err;
  size_t size;
  if (vs_detector_new(&def, &detector, &err) != VS_OK || vs_jpeg_new(&decoder, &err) != VS_OK ||
      vs_image_jpeg(&(vs_image){s.bgr, W, H, 3 * W}, &(vs_jpeg_def){85, 1}, jpeg, sizeof jpeg, &size, &err) != VS_OK)
    return fprintf(stderr, "bench_vision: %s\n", err.text), 1;
  frame.bgr = bgr, frame.grey = grey;
  for (int k = 0; k < TIMES; k++) {
    int64_t start = vs_clock_monotonic_us();
    if (vs_jpeg_decode(decoder, jpeg, size, W, H, bgr, grey, &err) != VS_OK) return 1;
    decode_ms[k] = 1e-3 * (double)(vs_clock_monotonic_us() - start);
    if (vs_detect(detector, &frame, &seen, &err) != VS_OK) return 1;
    total_ms[k] = 1e-3 * (double)(vs_clock_monotonic_us() - start);
  }
  qsort(decode_ms, TIMES, sizeof *decode_ms, by_value);
  qsort(total_ms, TIMES, sizeof *total_ms, by_value);
  printf("bench mjpg_720p_bytes %zu bytes\n", size);
  printf("bench mjpg_720p_decode %.2f ms\n", decode_ms[TIMES / 2]);
  printf("bench mjpg_720p_decode_p99 %.2f ms\n", decode_ms[TIMES * 99 / 100]);
  printf("bench mjpg_720p_decode_and_detect %.2f ms\n", total_ms[TIMES / 2]);
  printf("bench mjpg_720p_decode_and_detect_p99 %.2f ms\n", total_ms[TIMES * 99 / 100]);
  vs_jpeg_free(decoder);
  vs_detector_free(detector);
  scene_free(&s);
  return 0;
}

int main(void) {
  if (measure_mjpg()) return 1;
  return measure(640, 480, 1.0, "640x480") || measure(640, 480, 2.0, "640x480_decimate2") ||
         measure(1280, 720, 1.0, "1280x720") || measure(1280, 720, 2.0, "1280x720_decimate2");
}
