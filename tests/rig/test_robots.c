// src/rig/robots.c
#include <string.h>

#include "assert_near.h"
#include "rig/robots.h"
#include "vsss/clock.h"
#include "vsss/radio_link.h"

static const uint8_t id[VS_TEAM_SIZE] = {0, 1, 2};
static const vs_wheels forward[VS_TEAM_SIZE] = {{10, 10}, {-5, 5}, {0, 1}};

static void say(vs_serial *to, vs_radio_link *link, const vs_wheels wheels[VS_TEAM_SIZE]) {
  uint8_t bytes[VS_WIRE_BYTES_MAX];
  int64_t now_us = vs_clock_monotonic_us();
  vs_radio_link_command(link, wheels, false, now_us);
  link->next_us = 0;
  size_t size = vs_radio_link_due(link, now_us, bytes);
  assert_true(size > 0);
  vs_serial_write(to, bytes, size, now_us);
}

typedef struct air {
  vs_robots robots;
  vs_serial *radio;
  vs_radio_link link;
} air;

static air open_air(void) {
  air a = {0};
  vs_radio_key none = {0};
  assert_ok(vs_robots_open(&a.robots, id, &none, vs_clock_monotonic_us(), err));
  assert_ok(vs_serial_open(vs_pty_path(a.robots.pty), VS_SERIAL_BAUD, &a.radio, err));
  assert_ok(vs_radio_link_init(&a.link, id, err));
  return a;
}

static void close_air(air *a) {
  vs_serial_close(a->radio);
  vs_robots_close(&a->robots);
}

// Until the robots have taken some frame after their `taken`-th, but no longer than 5 s.
static void serve(air *a, int64_t taken) {
  const vs_wheels still[VS_TEAM_SIZE] = {{0}};
  for (int i = 0; i < 5000 && a->robots.taken <= taken; i++)
    vs_robots_serve(&a->robots, still, vs_clock_monotonic_us() + 1000);
  assert_true(a->robots.taken > taken);
}

// The machine was late: the picture's moment is 20 ms before the command came. Braked robots would be the rig's doing.
static void a_command_younger_than_the_picture_brakes_nobody(void **state) {
  (void)state;
  air a = open_air();
  say(a.radio, &a.link, forward);
  serve(&a, 0);
  vs_wheels told[VS_TEAM_SIZE];
  vs_robots_wheels(&a.robots, a.robots.heard_us - 20000, told);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(told[i].left_radps, forward[i].left_radps, 1e-9);
    assert_near(told[i].right_radps, forward[i].right_radps, 1e-9);
  }
  close_air(&a);
}

static void silence_brakes_after_the_watchdog(void **state) {
  (void)state;
  air a = open_air();
  say(a.radio, &a.link, forward);
  serve(&a, 0);
  vs_wheels told[VS_TEAM_SIZE];
  vs_robots_wheels(&a.robots, a.robots.heard_us + 1000 * (VS_FIRMWARE_WATCHDOG_MS - 10), told);
  assert_near(told[0].left_radps, 10, 1e-9);
  vs_robots_wheels(&a.robots, a.robots.heard_us + 1000 * (VS_FIRMWARE_WATCHDOG_MS + 10), told);
  assert_near(told[0].left_radps, 0, 0);
  close_air(&a);
}

static void a_delayed_command_acts_so_many_pictures_later(void **state) {
  (void)state;
  air a = open_air();
  a.robots.delay_frames = 2;
  say(a.radio, &a.link, forward);
  serve(&a, 0);
  vs_wheels told[VS_TEAM_SIZE];
  int64_t came_us = a.robots.came_us[0]; // all robots' bytes came in one frame
  for (int picture = 0; picture < 3; picture++) {
    vs_robots_wheels(&a.robots, came_us + 33333 * picture, told);
    assert_near(told[0].left_radps, picture < 2 ? 0 : 10, 1e-9);
  }
  assert_int_equal(a.robots.acted, VS_TEAM_SIZE);
  assert_int_equal(a.robots.acted_us, VS_TEAM_SIZE * 66666);
  close_air(&a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_command_younger_than_the_picture_brakes_nobody),
      cmocka_unit_test(silence_brakes_after_the_watchdog),
      cmocka_unit_test(a_delayed_command_acts_so_many_pictures_later),
  };
  return cmocka_run_group_tests_name("rig/robots", tests, NULL, NULL);
}
