// Times the field's whole line of data with an MJPG camera of 720p, 30 pictures a second, paced as a camera paces them: from the
// moment a compressed frame is ready to the last byte of its command in the radio's terminal, of frames that were decided on.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vision/jpeg.h"
#include "vision/scene.h"
#include "vsss/camera.h"
#include "vsss/clock.h"
#include "vsss/field_loop.h"
#include "vsss/radio_serial.h"

enum { W = 1280, H = 720, PICTURES = 4, FRAMES = 900, FRAME_US = 33333 };

static struct {
  uint8_t jpeg[PICTURES][1 << 20];
  size_t size[PICTURES];
  vs_jpeg *decoder;
  uint8_t bgr[3 * W * H], grey[W * H];
  int64_t next_us;
  uint32_t seq;
} camera;

static int failed(const vs_error *err) { return fprintf(stderr, "bench_field: %s\n", err->text), 1; }

static vs_status open_camera(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                             vs_error *err) {
  (void)rest, (void)def;
  *handle = &camera;
  *info = (vs_camera_info){.width = W, .height = H, .fps = 30};
  camera.next_us = vs_clock_monotonic_us();
  return vs_jpeg_new(&camera.decoder, err);
}

static vs_status read_camera(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  (void)handle, (void)timeout_ms;
  int64_t now_us = vs_clock_monotonic_us();
  while (camera.next_us < now_us) camera.next_us += FRAME_US; // a frame that nobody fetched is lost
  vs_clock_sleep_until_us(camera.next_us);
  int k = (int)(camera.seq % PICTURES);
  *got = VS_CAMERA_FRAME;
  *out = (vs_frame){.grey = camera.grey,
                    .bgr = camera.bgr,
                    .width = W,
                    .height = H,
                    .grey_stride = W,
                    .bgr_stride = 3 * W,
                    .capture_us = camera.next_us,
                    .seq = camera.seq++};
  return vs_jpeg_decode(camera.decoder, camera.jpeg[k], camera.size[k], W, H, camera.bgr, camera.grey, err);
}

static void close_camera(void *handle) {
  (void)handle;
  vs_jpeg_free(camera.decoder);
}

// Robots at places of the season, with sensor noise, at the quality cameras compress with.
static vs_status take_pictures(vs_error *err) {
  static scene s;
  scene_init(&s, W, H);
  vs_status status = VS_OK;
  for (int k = 0; k < PICTURES && status == VS_OK; k++) {
    for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
      s.world.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE] =
          (vs_robot){.pose = {-0.5 + 0.5 * (i % 3) + 0.01 * k, i < 3 ? 0.33 : -0.33, 0.4 * i + 0.1 * k}, .valid = true};
    s.world.ball = (vs_ball){.x_m = 0.1 * k, .valid = true};
    scene_draw(&s, 0, 0);
    status = vs_image_jpeg(&(vs_image){s.bgr, W, H, 3 * W}, &(vs_jpeg_def){85, 1}, camera.jpeg[k],
                           sizeof camera.jpeg[k], &camera.size[k], err);
  }
  scene_free(&s);
  return status;
}

static void drain(vs_pty *pty) {
  uint8_t bytes[512];
  while (vs_pty_read(pty, bytes, sizeof bytes) > 0) continue;
}

int main(void) {
  static const vs_camera_api api = {"mjpg", "mjpg: of this benchmark", open_camera, read_camera, close_camera};
  vs_error err = {0};
  vs_pty *pty = NULL;
  vs_field *field = NULL;
  vs_camera_register(&api);
  if (take_pictures(&err) != VS_OK || vs_pty_new(&pty, &err) != VS_OK) return failed(&err);
  vs_field_def def = vs_field_def_default();
  def.camera = "mjpg:";
  def.policy = "onnx:models/policy/field.onnx";
  def.radio = vs_pty_path(pty);
  def.go = true;
  def.lcm = false;
  char note[400] = "";
  if (vs_field_new(&def, &field, note, sizeof note, &err) != VS_OK) return failed(&err);
  for (int i = 0; i < FRAMES; i++) {
    vs_field_tick_result r;
    if (vs_field_tick(field, &r, &err) != VS_OK) return failed(&err);
    drain(pty);
  }
  static vs_field_stats stats;
  vs_field_get_stats(field, &stats);
  const vs_histogram *all = &stats.stage[VS_STAGE_TOTAL], *decode = &stats.stage[VS_STAGE_CAMERA];
  printf("bench mjpg_720p_ready_to_decoded %.2f ms\n", 1e-3 * vs_histogram_quantile_us(decode, 0.5));
  printf("bench mjpg_720p_ready_to_decoded_p99 %.2f ms\n", 1e-3 * vs_histogram_quantile_us(decode, 0.99));
  printf("bench mjpg_720p_detect %.2f ms\n", 1e-3 * vs_histogram_quantile_us(&stats.stage[VS_STAGE_DETECT], 0.5));
  printf("bench mjpg_720p_ready_to_bytes %.2f ms\n", 1e-3 * vs_histogram_quantile_us(all, 0.5));
  printf("bench mjpg_720p_ready_to_bytes_p99 %.2f ms\n", 1e-3 * vs_histogram_quantile_us(all, 0.99));
  printf("bench mjpg_720p_frames_decided %lld of_%d\n", (long long)all->count, (int)stats.frames);
  vs_field_free(field);
  vs_pty_free(pty);
  return 0;
}
