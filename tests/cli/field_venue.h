// A venue that a test holds in its hands: a camera under which three robots stand still, a radio behind which one of them
// obeys, and `vsss field` between them. Faults are made here; how long the robot takes to brake and to drive is read off
// its firmware. Or the pictures are those of a rig behind, and its robots hear what is heard here.
#ifndef VSSS_TESTS_CLI_FIELD_VENUE_H
#define VSSS_TESTS_CLI_FIELD_VENUE_H

#include "assert_near.h"
#include "cli/field_match.h"
#include "field/tagged_picture.h"
#include "vsss/clock.h"
#include "vsss/firmware.h"
#include "vsss/frame_stream.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"
#include "vsss/rng.h"

typedef struct venue {
  char folder[64], camera_path[96], radio_path[96], log_path[96];
  pid_t field;
  vs_camera *rig_camera; // whose pictures are passed on; NULL: the one below
  vs_serial *rig_radio;
  vs_frame_server *camera; // NULL: unplugged
  vs_pty *radio;           // NULL: unplugged
  uint8_t picture[3 * PICTURE_W * PICTURE_H];
  uint32_t seq;
  int64_t next_us; // picture
  double drop;     // share of the pictures that are lost, or -1: every second one
  vs_rng rng;
  vs_firmware robot;
  vs_radio_decoder tap;
  bool garbage;             // noise before each frame
  int frames, stops;        // heard
  int trailing_stops;       // since the last other frame
  vs_firmware_drive drives; // the robot, now
} venue;

static inline uint32_t venue_ms(void) { return (uint32_t)(vs_clock_monotonic_us() / 1000); }

static inline void plug_camera_of(venue *v, int width, int height) {
  assert_ok(vs_frame_server_new(v->camera_path, width, height, 30, &v->camera, err));
}

static inline void plug_camera(venue *v) { plug_camera_of(v, PICTURE_W, PICTURE_H); }

static inline void unplug_camera(venue *v) {
  vs_frame_server_free(v->camera);
  v->camera = NULL;
}

static inline void plug_radio(venue *v) {
  assert_ok(vs_pty_new(&v->radio, err));
  unlink(v->radio_path);
  assert_int_equal(symlink(vs_pty_path(v->radio), v->radio_path), 0);
}

static inline void unplug_radio(venue *v) {
  unlink(v->radio_path);
  vs_pty_free(v->radio);
  v->radio = NULL;
}

static inline bool is_lost(venue *v, uint32_t seq) { return v->drop < 0 ? seq % 2 : vs_rng_uniform(&v->rng) < v->drop; }

static inline void pass_picture_on(venue *v) {
  vs_frame frame;
  vs_camera_got got;
  if (vs_camera_read(v->rig_camera, 0, &frame, &got, NULL) != VS_OK || got != VS_CAMERA_FRAME) return;
  for (int i = 0; i < PICTURE_W * PICTURE_H; i++) { // blue, green, red to red, green, blue
    v->picture[3 * i] = frame.bgr[3 * i + 2];
    v->picture[3 * i + 1] = frame.bgr[3 * i + 1];
    v->picture[3 * i + 2] = frame.bgr[3 * i];
  }
  if (v->camera && !is_lost(v, frame.seq)) vs_frame_server_put(v->camera, v->picture, frame.capture_us, frame.seq);
}

static inline void show_picture(venue *v, int64_t now_us) {
  if (v->rig_camera) {
    pass_picture_on(v);
    return;
  }
  if (now_us < v->next_us) return;
  v->next_us += 33333;
  if (v->next_us < now_us) v->next_us = now_us + 33333;
  uint32_t seq = v->seq++;
  if (v->camera && !is_lost(v, seq)) vs_frame_server_put(v->camera, v->picture, now_us, seq);
}

static inline void listen_to_radio(venue *v) {
  uint8_t bytes[1024];
  size_t n = v->radio ? vs_pty_read(v->radio, bytes, sizeof bytes) : 0;
  static const uint8_t noise[] = {0x55, 0xAA, 0x13, 0x7F, 0x01};
  if (v->rig_radio) {
    uint8_t back[256];
    int64_t now_us = vs_clock_monotonic_us();
    if (n) vs_serial_write(v->rig_radio, bytes, n < 96 ? n : 96, now_us);
    size_t said = vs_serial_read(v->rig_radio, back, sizeof back, now_us);
    if (said && v->radio) vs_pty_write(v->radio, back, said);
  }
  if (n && v->garbage) vs_firmware_receive(&v->robot, noise, sizeof noise, venue_ms());
  vs_firmware_receive(&v->robot, bytes, n, venue_ms());
  for (size_t i = 0; i < n; i++) {
    vs_radio_frame frame;
    if (!vs_radio_decode(&v->tap, bytes[i], &frame) || frame.type != VS_RADIO_COMMAND) continue;
    bool stop = frame.as.command.flags & VS_RADIO_FLAG_STOP;
    v->frames++;
    v->stops += stop;
    v->trailing_stops = stop ? v->trailing_stops + 1 : 0;
  }
  v->drives = vs_firmware_tick(&v->robot, venue_ms());
}

// About a millisecond.
static inline void live(venue *v) {
  int64_t now_us = vs_clock_monotonic_us();
  show_picture(v, now_us);
  listen_to_radio(v);
  vs_clock_sleep_until_us(now_us + 1000);
}

static inline void live_for(venue *v, double seconds) {
  for (int64_t end_us = vs_clock_monotonic_us() + (int64_t)(1e6 * seconds); vs_clock_monotonic_us() < end_us;) live(v);
}

// Milliseconds until the robot drives, or brakes.
static inline double wait_until(venue *v, bool drives) {
  int64_t start_us = vs_clock_monotonic_us();
  while (v->drives.brake == drives) {
    live(v);
    if (vs_clock_monotonic_us() - start_us > 60000000) {
      fail_msg("the robot does not %s: %s", drives ? "drive" : "brake", read_text(v->log_path));
      return 60000;
    }
  }
  return 1e-3 * (double)(vs_clock_monotonic_us() - start_us);
}

// The figure of the fault table. A busy machine may take four times as long; VSSS_STRICT=1 holds it to the figure.
static inline void assert_within(const char *what, double ms, double limit_ms) {
  const char *strict = getenv("VSSS_STRICT");
  double factor = strict && *strict == '1' ? 1 : 4;
  print_message("%-44s %4.0f ms (<= %.0f)\n", what, ms, limit_ms);
  if (ms > factor * limit_ms) fail_msg("%s: %.0f ms", what, ms);
}

static inline void start_field(venue *v, const char *flags) {
  char arguments[1024];
  // Where a referee says go and stop the robots wait for it.
  const char *go = strstr(flags, "--referee") ? "" : "--go ";
  const char *lcm = strstr(flags, "--lcm ") ? "" : "--no-lcm ";
  snprintf(arguments, sizeof arguments, "field %s%s--camera rig:%s --radio %s %s", go, lcm, v->camera_path,
           v->radio_path, flags);
  v->field = vsss_start(v->log_path, arguments);
}

// Without a field in it yet.
static inline venue *make_venue_in(const char *folder) {
  static venue venue_;
  venue *v = &venue_;
  memset(v, 0, sizeof *v);
  snprintf(v->folder, sizeof v->folder, "%s", folder);
  snprintf(v->camera_path, sizeof v->camera_path, "%s/camera", folder);
  snprintf(v->radio_path, sizeof v->radio_path, "%s/radio", folder);
  snprintf(v->log_path, sizeof v->log_path, "%s/field.log", folder);
  v->rng = vs_rng_make(1, 0);
  paint_tagged_picture(v->picture);
  vs_firmware_init(&v->robot, 1, venue_ms());
  v->drives.brake = true;
  plug_camera(v);
  plug_radio(v);
  return v;
}

static inline venue *open_venue(const char *folder, const char *flags) {
  venue *v = make_venue_in(folder);
  start_field(v, flags);
  return v;
}

static inline void close_venue(venue *v, int expected_status) {
  kill(v->field, SIGINT);
  int status = -1;
  for (int i = 0; i < 20000 && waitpid(v->field, &status, WNOHANG) != v->field; i++) live(v);
  int ended = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (ended != expected_status) fail_msg("field ended with %d: %s", ended, read_text(v->log_path));
  if (v->camera) unplug_camera(v);
  if (v->radio) unplug_radio(v);
}

#endif
