// The link between the PC and the robots, protocol v1 and its keyed form v2: what goes over the serial line and through the air. Pure, no
// allocation, nothing but C: compiled into the program and into a robot's firmware alike (deploy/firmware).
//
// A frame is payload + CRC-16/CCITT-FALSE (poly 0x1021, start 0xFFFF; low byte first), COBS coded, between two 0x00: the
// first ends whatever noise is on the line, so that it cannot spoil the frame. A receiver takes two in a row for an idle
// line, so one that knows only the delimiter at the end understands it too.
// Numbers are little-endian; wheel speeds are int16 in 0.01 rad/s. The first byte is version << 4 | type.
//   down (type 1): head, seq, flags, n, n x { id, left i16, right i16 }; one frame for all robots, no answer wanted
//   up   (type 2): head, id, seq_echo, left i16, right i16, battery_mv u16, rssi i8, rx_ok u16, rx_bad u16, uptime_ms u32
// Three robots: 19 + 2 bytes of payload and CRC, 24 on the line (2.1 ms at 115200 baud).
//
// Version 2 carries a team's number and ends in a check that only those who have the team's key can make: the low 32 bits
// of SipHash-2-4 over all bytes before it. Its counter only ever grows, so that a frame cannot be used twice.
//   down (type 1): head, team, counter u48, flags, n, n x { id, left i16, right i16 }, check u32; seq: the low byte of counter
//   up   (type 2): head, team, id, seq_echo ... uptime_ms as in version 1, check u32
// Three robots: 34 bytes on the line (3.0 ms); without its two delimiters it fits the 32 bytes of an nRF24.
#ifndef VSSS_RADIO_CODEC_H
#define VSSS_RADIO_CODEC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/siphash.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_RADIO_VERSION     1
#define VS_RADIO_KEYED       2 // the version of frames with a team and a check
#define VS_RADIO_ROBOTS_MAX  6
#define VS_RADIO_FLAG_STOP   0x01 // every robot that hears it brakes, named in the frame or not
#define VS_RADIO_CHECK       4
#define VS_RADIO_PAYLOAD_MAX (10 + 5 * VS_RADIO_ROBOTS_MAX + VS_RADIO_CHECK)
#define VS_RADIO_FRAME_MAX   (VS_RADIO_PAYLOAD_MAX + 2 + 3) // CRC, COBS byte, two delimiters

#define VS_RADIO_UNIT_RADPS 0.01 // one count of a wheel speed

typedef enum vs_radio_type { VS_RADIO_COMMAND = 1, VS_RADIO_TELEMETRY = 2 } vs_radio_type;

typedef struct vs_radio_robot {
  uint8_t id;
  int16_t left, right; // 0.01 rad/s, positive drives forward
} vs_radio_robot;

typedef struct vs_radio_command {
  uint8_t seq, flags, n; // n <= VS_RADIO_ROBOTS_MAX
  vs_radio_robot robot[VS_RADIO_ROBOTS_MAX];
  uint64_t counter; // 48 bits, of keyed frames, whose seq is its low byte
} vs_radio_command;

typedef struct vs_radio_telemetry {
  uint8_t id, seq_echo; // of the last command taken
  int16_t left, right;  // measured, 0.01 rad/s
  uint16_t battery_mv;
  int8_t rssi_dbm;
  uint16_t rx_ok, rx_bad; // frames taken and refused, mod 65536
  uint32_t uptime_ms;
} vs_radio_telemetry;

typedef struct vs_radio_frame {
  vs_radio_type type;
  union {
    vs_radio_command command;
    vs_radio_telemetry telemetry;
  } as;
} vs_radio_frame;

// What a team's frames are known by. All zero: none is set, frames are of version 1.
typedef struct vs_radio_key {
  bool set;
  uint8_t team; // number on the air, of the team's choice
  uint8_t secret[VS_SIPHASH_KEY];
} vs_radio_key;

// "TEAM" and 32 hexadecimal digits as a file has them; false: they are not.
bool vs_radio_key_parse(int team, const char *digits, vs_radio_key *out);

uint16_t vs_radio_crc(const uint8_t *bytes, size_t size); // "123456789" -> 0x29B1

// Rounds to the nearest count; beyond the int16 range or not finite: the limit, or 0.
int16_t vs_radio_counts(double radps);
double vs_radio_radps(int16_t counts);

// Writes one whole frame with its delimiters and returns its size; 0: more robots than fit.
size_t vs_radio_encode(const vs_radio_frame *frame, uint8_t out[VS_RADIO_FRAME_MAX]);
// The same in the form that the key asks for.
size_t vs_radio_encode_keyed(const vs_radio_frame *frame, const vs_radio_key *key, uint8_t out[VS_RADIO_FRAME_MAX]);

// Bytes in, frames out. All zero is a fresh one without a key.
typedef struct vs_radio_decoder {
  vs_radio_key key; // set: only keyed frames of this team are taken; not set: only those of version 1
  uint8_t bytes[VS_RADIO_FRAME_MAX];
  uint8_t used;
  bool overlong;    // more bytes without a delimiter than any frame has: wait for the next one
  uint32_t ok, bad; // frames taken; runs of bytes between delimiters that were none (CRC, version, type, length, check)
  uint32_t foreign; // of those: whole frames of another team, or without the check that the key asks for
} vs_radio_decoder;

// Takes one byte; true: it ended a valid frame, now in out. Loses at most the frame that a damaged byte is in, and the
// next where the damaged byte was the delimiter.
bool vs_radio_decode(vs_radio_decoder *decoder, uint8_t byte, vs_radio_frame *out);

// seq is newer than last, mod 256.
bool vs_radio_seq_newer(uint8_t seq, uint8_t last);

#ifdef __cplusplus
}
#endif
#endif
