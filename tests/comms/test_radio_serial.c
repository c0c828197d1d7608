// Tests src/comms/radio_serial.c and radio_pty.c on a pseudo terminal.
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/clock.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"

static vs_pty *pty;
static vs_serial *serial;

static int open_both(void **state) {
  (void)state;
  vs_error err = {0};
  if (vs_pty_new(&pty, &err) != VS_OK || vs_serial_open(vs_pty_path(pty), VS_SERIAL_BAUD, &serial, &err) != VS_OK) {
    fprintf(stderr, "%s\n", err.text);
    return -1;
  }
  return 0;
}

static int close_both(void **state) {
  (void)state;
  vs_serial_close(serial);
  vs_pty_free(pty);
  serial = NULL;
  pty = NULL;
  return 0;
}

// Reads until size bytes came or half a minute went by.
static size_t read_all(uint8_t *bytes, size_t size) {
  size_t got = 0;
  for (int tries = 0; got < size && tries < 3000; tries++) {
    struct pollfd wait = {.fd = vs_pty_fd(pty), .events = POLLIN};
    poll(&wait, 1, 10);
    got += vs_pty_read(pty, bytes + got, size - got);
  }
  return got;
}

static void every_byte_value_passes_both_ways(void **state) {
  (void)state;
  uint8_t all[256], back[256];
  for (int i = 0; i < 256; i++) all[i] = (uint8_t)i;
  for (int at = 0; at < 256; at += 64) assert_true(vs_serial_write(serial, all + at, 64, 1));
  assert_int_equal(read_all(back, sizeof back), sizeof back);
  assert_memory_equal(all, back, sizeof all);
  assert_int_equal(vs_pty_write(pty, all, sizeof all), sizeof all);
  size_t got = 0;
  for (int tries = 0; got < sizeof back && tries < 3000; tries++) {
    struct pollfd wait = {.fd = vs_serial_fd(serial), .events = POLLIN};
    poll(&wait, 1, 10);
    got += vs_serial_read(serial, back + got, sizeof back - got, 1);
  }
  assert_memory_equal(all, back, sizeof all);
  assert_int_equal(vs_serial_get_stats(serial).sent, 4);
}

static void an_idle_line_reads_nothing_and_stays_up(void **state) {
  (void)state;
  uint8_t bytes[16];
  assert_int_equal(vs_serial_read(serial, bytes, sizeof bytes, 1), 0);
  assert_true(vs_serial_get_stats(serial).up);
}

static void a_full_buffer_drops_whole_frames_and_counts_them(void **state) {
  (void)state;
  vs_radio_frame f = {.type = VS_RADIO_COMMAND};
  f.as.command.n = 3;
  for (int i = 0; i < 3; i++) f.as.command.robot[i] = (vs_radio_robot){(uint8_t)i, 1000, -1000};
  // Nobody reads: after a few thousand frames the terminal takes no more, and writing must still return.
  int64_t sent = 0, tried = 20000;
  for (int64_t i = 0; i < tried; i++) {
    uint8_t bytes[VS_RADIO_FRAME_MAX];
    f.as.command.seq = (uint8_t)i;
    size_t size = vs_radio_encode(&f, bytes);
    sent += vs_serial_write(serial, bytes, size, 1);
  }
  vs_serial_stats stats = vs_serial_get_stats(serial);
  assert_int_equal(stats.sent, sent);
  assert_int_equal(stats.dropped, tried - sent);
  assert_true(sent > 100 && stats.dropped > 100);
  // What was sent arrives whole: the cut frame is completed by the first write after there is room again.
  vs_radio_decoder decoder = {0};
  vs_radio_frame out;
  int64_t frames = 0;
  uint8_t bytes[4096];
  for (int quiet = 0; quiet < 50;) {
    struct pollfd wait = {.fd = vs_pty_fd(pty), .events = POLLIN};
    poll(&wait, 1, 2);
    size_t n = vs_pty_read(pty, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++) frames += vs_radio_decode(&decoder, bytes[i], &out);
    if (n == 0) quiet++;
    if (n == 0 && quiet == 5) {
      size_t size = vs_radio_encode(&f, bytes);
      sent += vs_serial_write(serial, bytes, size, 1);
    }
  }
  assert_int_equal(frames, sent);
  assert_int_equal(decoder.bad, 0);
}

static void a_device_that_goes_away_is_found_again(void **state) {
  (void)state;
  char link_path[64];
  snprintf(link_path, sizeof link_path, "/tmp/vsss_test_radio_%ld", (long)getpid());
  unlink(link_path);
  assert_int_equal(symlink(vs_pty_path(pty), link_path), 0);
  vs_serial_close(serial);
  assert_ok(vs_serial_open(link_path, VS_SERIAL_BAUD, &serial, err));
  const uint8_t bytes[] = {1, 2, 3, 0};
  assert_true(vs_serial_write(serial, bytes, sizeof bytes, 1));

  vs_pty_free(pty); // unplugged
  pty = NULL;
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1000000));
  assert_false(vs_serial_get_stats(serial).up);
  assert_int_equal(vs_serial_fd(serial), -1);
  // Not before 50 ms, then after pauses that double up to 0.2 s.
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1049999));
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1050000)); // tried, still away: next at 1.15 s
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1150000)); // then at 1.35 s
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1350000)); // and at 1.55 s, not at 1.75

  assert_ok(vs_pty_new(&pty, err)); // plugged in again, under the same name
  unlink(link_path);
  assert_int_equal(symlink(vs_pty_path(pty), link_path), 0);
  assert_false(vs_serial_write(serial, bytes, sizeof bytes, 1549999));
  assert_true(vs_serial_write(serial, bytes, sizeof bytes, 1550000));
  uint8_t back[4];
  assert_int_equal(read_all(back, 4), 4);
  vs_serial_stats stats = vs_serial_get_stats(serial);
  assert_true(stats.up);
  assert_int_equal(stats.reopened, 1);
  assert_int_equal(stats.dropped, 6);
  unlink(link_path);
}

static void reading_notices_a_device_that_went_away(void **state) {
  (void)state;
  vs_pty_free(pty);
  pty = NULL;
  uint8_t bytes[8];
  assert_int_equal(vs_serial_read(serial, bytes, sizeof bytes, 1), 0);
  assert_false(vs_serial_get_stats(serial).up);
}

static void the_robots_end_survives_a_pc_that_closes_and_comes_back(void **state) {
  (void)state;
  const uint8_t bytes[] = {9, 8, 7, 0};
  uint8_t back[4];
  vs_serial_close(serial);
  // Nobody has the PC's end open: the kernel answers EIO, which is no byte and no failure.
  assert_int_equal(read(vs_pty_fd(pty), back, 4), -1);
  assert_int_equal(errno, EIO);
  assert_int_equal(vs_pty_read(pty, back, 4), 0);
  assert_ok(vs_serial_open(vs_pty_path(pty), VS_SERIAL_BAUD, &serial, err));
  assert_true(vs_serial_write(serial, bytes, sizeof bytes, 1));
  assert_int_equal(read_all(back, 4), 4);
  assert_memory_equal(back, bytes, 4);
}

static void a_second_program_is_kept_out(void **state) {
  (void)state;
  vs_serial *other;
  vs_error err = {0};
  assert_int_equal(vs_serial_open(vs_pty_path(pty), VS_SERIAL_BAUD, &other, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "another program"));
}

static void wrong_devices_are_named(void **state) {
  (void)state;
  vs_serial *none;
  vs_error err = {0};
  assert_int_equal(vs_serial_open("/dev/no_such_radio", VS_SERIAL_BAUD, &none, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/no_such_radio: No such file"));
  assert_int_equal(vs_serial_open("/dev/null", VS_SERIAL_BAUD, &none, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/null: not a serial device"));
  assert_int_equal(vs_serial_open(vs_pty_path(pty), 12345, &none, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "12345"));
}

static void drain_returns_when_the_reader_took_all(void **state) {
  (void)state;
  const uint8_t bytes[] = {1, 2, 3, 0};
  uint8_t back[4];
  assert_true(vs_serial_write(serial, bytes, sizeof bytes, 1));
  assert_int_equal(read_all(back, 4), 4);
  vs_serial_drain(serial, 10000);
  vs_pty_free(pty);
  pty = NULL;
  vs_serial_drain(serial, 100); // and does not hang where there is no device
}

int main(void) {
#define WITH_PTY(name) cmocka_unit_test_setup_teardown(name, open_both, close_both)
  const struct CMUnitTest tests[] = {
      WITH_PTY(every_byte_value_passes_both_ways),
      WITH_PTY(an_idle_line_reads_nothing_and_stays_up),
      WITH_PTY(a_full_buffer_drops_whole_frames_and_counts_them),
      WITH_PTY(a_device_that_goes_away_is_found_again),
      WITH_PTY(reading_notices_a_device_that_went_away),
      WITH_PTY(the_robots_end_survives_a_pc_that_closes_and_comes_back),
      WITH_PTY(a_second_program_is_kept_out),
      WITH_PTY(wrong_devices_are_named),
      WITH_PTY(drain_returns_when_the_reader_took_all),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
