// The firmware contract of a robot, as code: deploy/firmware/firmware.c, compiled for the robot and into the program,
// where the rig's robots run it. No allocation, no clock of its own (millisecond counter in, may wrap), C99.
//
// A robot starts stopped. It takes a command frame only with a valid CRC, the right version and a seq newer (mod 256)
// than the last it took; after 150 ms without one it brakes, and then takes any seq. A frame without its own id and
// without STOP is not for it. STOP brakes and stays until a later frame without STOP. Wheel targets are limited to
// +-46.66 rad/s. Telemetry is the caller's to send, when no command waits to be read.
//
// With a key it takes, of commands and of STOP, only those that carry its team's number and check, and each only once:
// the counter must be higher than the last one's for as long as the robot is on, silence or not. (The PC counts from its
// clock, so a PC that starts anew goes on higher; one whose clock is behind is heard when the robot is switched off and
// on. Then, until the first frame of the match, a recorded one would be taken too: use another key each day.)
#ifndef VSSS_FIRMWARE_H
#define VSSS_FIRMWARE_H

#include "vsss/radio_codec.h"

#ifdef __cplusplus
extern "C" {
#endif

// Seven frames of the sender in a row are lost before it bites; with a 30 Hz view of the motors they stand within 200 ms.
#define VS_FIRMWARE_WATCHDOG_MS 150
#define VS_FIRMWARE_LIMIT       4666 // 0.01 rad/s

typedef struct vs_firmware {
  uint8_t id;
  vs_radio_decoder decoder;
  bool running;        // a command was taken and is younger than the watchdog
  bool stopped;        // STOP holds
  uint8_t last_seq;    // of the last frame taken
  uint64_t counter;    // of it, where a key is set
  uint32_t last_ms;    // when
  int16_t left, right; // targets, 0.01 rad/s
  uint16_t rx_ok, rx_bad;
  uint32_t start_ms;
} vs_firmware;

typedef struct vs_firmware_drive {
  bool brake;          // actively: short the motors
  int16_t left, right; // 0.01 rad/s; 0 while braking
} vs_firmware_drive;

void vs_firmware_init(vs_firmware *firmware, uint8_t id, uint32_t now_ms);
void vs_firmware_set_key(vs_firmware *firmware, const vs_radio_key *key); // after init
void vs_firmware_receive(vs_firmware *firmware, const uint8_t *bytes, size_t size, uint32_t now_ms);
// What the speed controller shall do now; call it at every tick of the controller (5 ms or less).
vs_firmware_drive vs_firmware_tick(vs_firmware *firmware, uint32_t now_ms);
// Writes a telemetry frame and returns its size.
size_t vs_firmware_telemetry(const vs_firmware *firmware, uint32_t now_ms, int16_t measured_left,
                             int16_t measured_right, uint16_t battery_mv, int8_t rssi_dbm,
                             uint8_t out[VS_RADIO_FRAME_MAX]);

#ifdef __cplusplus
}
#endif
#endif
