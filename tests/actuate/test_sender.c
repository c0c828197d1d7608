// src/actuate/sender.c
#include <string.h>

#include "assert_near.h"
#include "vsss/sender.h"
#include "vsss/clock.h"

static const uint8_t id[VS_TEAM_SIZE] = {4, 7, 9};
static vs_status open_sender(const char *device, vs_sender **out, vs_error *err) {
  vs_sender_def def = {.device = device, .baud = VS_SERIAL_BAUD};
  memcpy(def.id, id, sizeof def.id);
  return vs_sender_new(&def, out, err);
}
// A radio's two ends, ours and what hears it.
typedef struct radio {
  vs_pty *pty;
  vs_sender *sender;
  vs_radio_decoder decoder;
} radio;

static radio open_radio(void) {
  radio r = {0};
  assert_ok(vs_pty_new(&r.pty, err));
  assert_ok(open_sender(vs_pty_path(r.pty), &r.sender, err));
  return r;
}

static void close_radio(radio *r) {
  vs_sender_free(r->sender);
  vs_pty_free(r->pty);
}

static const vs_wheels forward[VS_TEAM_SIZE] = {{10, 10}, {-5, 5}, {0, 1}};

typedef struct heard {
  int frames, stops, last_is_stop;
  int trailing_stops; // at the end
  vs_radio_command last;
} heard;

// Reads the other end for some time.
static void listen(radio *r, int64_t for_us, heard *h) {
  int64_t until_us = vs_clock_monotonic_us() + for_us;
  do {
    uint8_t bytes[512];
    size_t n = vs_pty_read(r->pty, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++) {
      vs_radio_frame frame;
      if (!vs_radio_decode(&r->decoder, bytes[i], &frame) || frame.type != VS_RADIO_COMMAND) continue;
      h->last = frame.as.command;
      h->frames++;
      h->last_is_stop = (frame.as.command.flags & VS_RADIO_FLAG_STOP) != 0;
      h->stops += h->last_is_stop;
      h->trailing_stops = h->last_is_stop ? h->trailing_stops + 1 : 0;
    }
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 1000);
  } while (vs_clock_monotonic_us() < until_us);
}

static void before_any_command_the_robots_are_told_to_stop(void **state) {
  (void)state;
  radio r = open_radio();
  heard h = {0};
  listen(&r, 200000, &h);
  assert_true(h.frames >= 2);
  assert_int_equal(h.stops, h.frames);
  close_radio(&r);
}

static void a_command_is_repeated_until_it_is_too_old_then_stops(void **state) {
  (void)state;
  radio r = open_radio();
  heard early = {0}, late = {0};
  listen(&r, 20000, &early);
  memset(&early, 0, sizeof early);
  vs_sender_command(r.sender, forward, false, vs_clock_monotonic_us(), true);
  listen(&r, 5000, &early);
  assert_true(early.frames >= 1);
  assert_int_equal(early.last.n, 3);
  assert_int_equal(early.last.robot[1].id, 7);
  assert_int_equal(early.last.robot[1].left, -500); // 0.01 rad/s
  assert_int_equal(early.last.robot[1].right, 500);
  listen(&r, VS_RADIO_STALE_US + 100000, &late);
  assert_true(late.frames >= 3); // 50 Hz for 250 ms, on however busy a machine
  assert_true(late.last_is_stop);
  close_radio(&r);
}

static void an_old_frame_never_drives(void **state) {
  (void)state;
  radio r = open_radio();
  heard h = {0};
  vs_sender_command(r.sender, forward, false, vs_clock_monotonic_us() - VS_RADIO_STALE_US - 1, true);
  listen(&r, 100000, &h);
  assert_true(h.frames >= 1);
  assert_int_equal(h.stops, h.frames);
  close_radio(&r);
}

static void the_last_frames_are_stops(void **state) {
  (void)state;
  radio r = open_radio();
  heard h = {0};
  vs_sender_command(r.sender, forward, false, vs_clock_monotonic_us(), true);
  vs_sender_free(r.sender);
  listen(&r, 50000, &h);
  assert_true(h.trailing_stops >= VS_RADIO_STOP_FRAMES);
  assert_int_equal(h.last.robot[0].left, 0);
  vs_pty_free(r.pty);
}

static void a_dry_run_makes_frames_for_nobody(void **state) {
  (void)state;
  vs_sender *sender;
  assert_ok(open_sender(NULL, &sender, err));
  vs_sender_command(sender, forward, false, vs_clock_monotonic_us(), true);
  vs_radio_link link;
  vs_serial_stats serial;
  vs_sender_state(sender, &link, &serial);
  assert_true(link.counter >= 1);
  assert_int_equal(serial.sent, 0);
  vs_sender_free(sender);
}

static void a_device_that_is_not_there_is_named(void **state) {
  (void)state;
  vs_sender *sender;
  vs_error err = {0};
  assert_int_equal(open_sender("/dev/no-such-radio", &sender, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/no-such-radio"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(before_any_command_the_robots_are_told_to_stop),
      cmocka_unit_test(a_command_is_repeated_until_it_is_too_old_then_stops),
      cmocka_unit_test(an_old_frame_never_drives),
      cmocka_unit_test(the_last_frames_are_stops),
      cmocka_unit_test(a_dry_run_makes_frames_for_nobody),
      cmocka_unit_test(a_device_that_is_not_there_is_named),
  };
  return cmocka_run_group_tests_name("actuate/sender", tests, NULL, NULL);
}
