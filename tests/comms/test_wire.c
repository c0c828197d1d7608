// src/comms/wire.c: every encoder byte for byte, and through the link of the radio.
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/radio_link.h"
#include "vsss/wire.h"

// Wheels of 3 cm, 7 cm apart: 10 rad/s is 0.3 m/s; (10, 10): 0.3 m/s ahead; (-5, 5): (0.15 + 0.15) / 0.07 = 4.285714 rad/s,
// 245.5541 degrees/s; (46.66, 0): 1.3998 left, 0.6999 m/s ahead, -19.997143 rad/s, -1145.752 degrees/s.
static const vs_wheels wheels[VS_TEAM_SIZE] = {{10, 10}, {-5, 5}, {46.66, 0}};
static const uint8_t ids[VS_TEAM_SIZE] = {0, 1, 2}, mixed[VS_TEAM_SIZE] = {2, 0, 1};

static void assert_bytes(const char *name, const uint8_t id[VS_TEAM_SIZE], const void *want, size_t size) {
  const vs_wire *wire;
  uint8_t out[VS_WIRE_BYTES_MAX];
  assert_ok(vs_wire_find(name, &wire, err));
  assert_int_equal(wire->encode(id, wheels, out), size);
  assert_memory_equal(out, want, size);
  // The same once more as the radio's thread gets it.
  vs_radio_link link;
  assert_ok(vs_radio_link_init(&link, id, err));
  assert_ok(vs_radio_link_set_wire(&link, wire, err));
  vs_radio_link_command(&link, wheels, false, 1000000);
  assert_int_equal(vs_radio_link_due(&link, 1000000, out), size);
  assert_memory_equal(out, want, size);
}

static void assert_text(const char *name, const uint8_t id[VS_TEAM_SIZE], const char *want) {
  assert_bytes(name, id, want, strlen(want));
}

static void sysmic_is_a_line_of_five_pairs(void **state) {
  (void)state;
  assert_text("sysmic", ids, "300,300,-150,150,1400,0,0,0,0,0\n");
  assert_text("sysmic", mixed, "-150,150,1400,0,300,300,0,0,0,0\n");
  assert_text("sysmic-vw", ids, "300,0,0,246,700,-1146,0,0,0,0\n");
}

static void neon_is_in_angle_brackets_by_number(void **state) {
  (void)state;
  assert_text("neon", ids, "<0,0.3000,0.0000,1,0.0000,4.2857,2,0.6999,-19.9971>");
  assert_text("neon", mixed, "<0,0.0000,4.2857,1,0.6999,-19.9971,2,0.3000,0.0000>");
}

// Length, then type 1, frame id 0, address, option 1, text; the sum of these and the last byte is FF.
// "0.30;0.30": 30 2E 33 30 3B 30 2E 33 30 add up to 1BD, with 01 00 00 00 01: 1BF, so 40. "0.15;-0.15": 30 2E 31 35 3B 2D 30 2E
// 31 35: 1F0, with 01 00 00 01 01: 1F3, so 0C. "0.00;1.40": 30 2E 30 30 3B 31 2E 34 30: 1BC, with 01 00 00 02 01: 1C0, so 3F.
static void pequi_is_an_xbee_frame_for_each_robot_right_wheel_first(void **state) {
  (void)state;
  static const uint8_t want[] = {0x7E, 0, 14, 1, 0, 0, 0, 1, '0', '.', '3', '0', ';', '0', '.', '3', '0', 0x40, //
                                 0x7E, 0, 15, 1, 0, 0, 1, 1, '0', '.', '1', '5', ';', '-', '0', '.', '1', '5',  0x0C,
                                 0x7E, 0, 14, 1, 0, 0, 2, 1, '0', '.', '0', '0', ';', '1', '.', '4', '0', 0x3F};
  assert_bytes("pequi-xbee", ids, want, sizeof want);
}

// 0.3 / 2 * 32767 = 4915.05: 0x1333; 0.6999 / 2 * 32767 = 11466.81: 11466 = 0x2CCA; 4.285714 / 64 * 32767 = 2194.22: 2194 =
// 0x0892; -19.997143 / 64 * 32767 = -10238.23: -10238 = 0xD802. Sum 4915 + 11466 + 2194 - 10238 = 8337 = 0x2091.
static void unball_is_three_letters_six_numbers_and_their_sum(void **state) {
  (void)state;
  static const uint8_t want[] = {'B', 'B', 'B', 0x33, 0x13, 0, 0, 0xCA, 0x2C, 0, 0, 0x92, 0x08, 0x02, 0xD8, 0x91, 0x20};
  assert_bytes("unball", ids, want, sizeof want);
}

static void a_stop_is_zeros_and_so_is_an_old_command(void **state) {
  (void)state;
  vs_radio_link link;
  const vs_wire *wire;
  uint8_t out[VS_WIRE_BYTES_MAX];
  assert_ok(vs_wire_find("sysmic", &wire, err));
  assert_ok(vs_radio_link_init(&link, ids, err));
  assert_ok(vs_radio_link_set_wire(&link, wire, err));
  static const char still[] = "0,0,0,0,0,0,0,0,0,0\n";
  vs_radio_link_command(&link, wheels, false, 1000000);
  assert_int_equal(vs_radio_link_due(&link, 1151000, out), strlen(still)); // 151 ms old
  assert_memory_equal(out, still, strlen(still));
  assert_int_equal(vs_radio_link_stop(&link, 1160000, out), strlen(still));
  assert_memory_equal(out, still, strlen(still));
  assert_int_equal(vs_radio_link_last_stop(&link, 16, out), strlen(still));
  // What such a base says is no telemetry, whatever it looks like.
  vs_radio_frame frame = {.type = VS_RADIO_TELEMETRY};
  size_t size = vs_radio_encode(&frame, out);
  vs_radio_link_receive(&link, out, size, 1170000);
  assert_false(link.robot[0].heard);
}

static void the_largest_speeds_fit_every_wire(void **state) {
  (void)state;
  const vs_wheels fast[VS_TEAM_SIZE] = {{-46.66, -46.66}, {-46.66, 46.66}, {46.66, -46.66}};
  for (int i = 1; vs_wire_at(i); i++) {
    const vs_wire *wire = vs_wire_at(i);
    const uint8_t high[VS_TEAM_SIZE] = {(uint8_t)wire->max_id, (uint8_t)(wire->max_id - 1),
                                        (uint8_t)(wire->max_id - 2)};
    uint8_t out[VS_WIRE_BYTES_MAX];
    size_t size = wire->encode(high, fast, out);
    assert_in_range(size, 10, VS_WIRE_BYTES_MAX - 1);
    assert_non_null(wire->lacks);
    if (i > 1 && out[size - 1] != '\n' && out[size - 1] != '>' && strcmp(wire->name, "unball"))
      fail_msg("%s is cut", wire->name);
  }
}

static void numbers_that_a_wire_does_not_have_and_unknown_wires_are_named(void **state) {
  (void)state;
  vs_radio_link link;
  const vs_wire *wire;
  vs_error err = {0};
  const uint8_t high[VS_TEAM_SIZE] = {0, 1, 5};
  assert_int_equal(vs_wire_find("morse", &wire, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "expected one of vsss, pequi-xbee, sysmic, sysmic-vw, neon, unball"));
  assert_ok(vs_wire_find("sysmic", &wire, err));
  assert_ok(vs_radio_link_init(&link, high, err));
  assert_int_equal(vs_radio_link_set_wire(&link, wire, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "robot 2 has radio id 5, sysmic has 0 to 4"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sysmic_is_a_line_of_five_pairs),
      cmocka_unit_test(neon_is_in_angle_brackets_by_number),
      cmocka_unit_test(pequi_is_an_xbee_frame_for_each_robot_right_wheel_first),
      cmocka_unit_test(unball_is_three_letters_six_numbers_and_their_sum),
      cmocka_unit_test(a_stop_is_zeros_and_so_is_an_old_command),
      cmocka_unit_test(the_largest_speeds_fit_every_wire),
      cmocka_unit_test(numbers_that_a_wire_does_not_have_and_unknown_wires_are_named),
  };
  return cmocka_run_group_tests_name("comms/wire", tests, NULL, NULL);
}
