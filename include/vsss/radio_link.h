// The PC's side of the radio: repeats the newest command at 50 Hz, stops the robots when it is too old, reads what they
// report. Pure: told the time, hands out bytes; radio_serial.h carries them.
#ifndef VSSS_RADIO_LINK_H
#define VSSS_RADIO_LINK_H

#include "vsss/bus.h"
#include "vsss/radio_codec.h"
#include "vsss/radio_serial.h"
#include "vsss/status.h"
#include "vsss/wire.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_RADIO_PERIOD_US   20000  // 50 Hz
#define VS_RADIO_STALE_US    150000 // an older command is a STOP
#define VS_RADIO_STOP_FRAMES 10     // sent on the way out

typedef struct vs_radio_robot_state {
  bool heard;
  vs_radio_telemetry last;
  int64_t heard_us, round_trip_us; // round trip: -1 unknown
} vs_radio_robot_state;

// One team's link. Plain data; times are of the monotonic clock.
typedef struct vs_radio_link {
  uint8_t id[VS_TEAM_SIZE]; // number on the air of robot i
  const vs_wire *wire;      // NULL: our own protocol
  uint64_t counter;         // of the next frame; its low byte is the seq
  bool have_command, stop;
  vs_wheels wheels[VS_TEAM_SIZE];
  int64_t command_us;     // when the command was decided
  int64_t next_us;        // when the next frame is due; 0: at once
  bool stopping;          // the last frame was a STOP
  int64_t command_age_us; // at the last frame; -1: none yet
  int64_t sent_us[256];   // by seq, for the round trip
  vs_radio_decoder decoder;
  vs_radio_robot_state robot[VS_TEAM_SIZE];
  int64_t foreign; // telemetry of robots that are not ours
} vs_radio_link;

// VS_USAGE: two robots with one id.
vs_status vs_radio_link_init(vs_radio_link *link, const uint8_t id[VS_TEAM_SIZE], vs_error *err);

// From here on all frames are the key's. wall_us: since the epoch; the counter starts at it, 65536 a second, which no
// sender reaches, so that one that starts anew counts on above the last one's frames.
void vs_radio_link_set_key(vs_radio_link *link, const vs_radio_key *key, int64_t wall_us);

// A new command; decided_us: the moment of the frame it was decided on. stop: brake. A wheel that is not finite is a stop.
void vs_radio_link_command(vs_radio_link *link, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t decided_us);

// Another team's protocol, or ours. VS_USAGE: a robot's number is none of it.
vs_status vs_radio_link_set_wire(vs_radio_link *link, const vs_wire *wire, vs_error *err);

// All that write want VS_WIRE_BYTES_MAX bytes; with our own protocol VS_RADIO_FRAME_MAX do.
// Writes the frame that is due at now and returns its size; 0: none is due before next_us. Never catches up in bursts.
size_t vs_radio_link_due(vs_radio_link *link, int64_t now_us, uint8_t *out);
// One STOP frame, due or not.
size_t vs_radio_link_stop(vs_radio_link *link, int64_t now_us, uint8_t *out);

// The same without touching the link, for a program that dies: its number is `ahead` of the next frame's.
size_t vs_radio_link_last_stop(const vs_radio_link *link, uint8_t ahead, uint8_t *out);

void vs_radio_link_receive(vs_radio_link *link, const uint8_t *bytes, size_t size, int64_t now_us);

// What VSSS_RADIO says of link and device.
void vs_radio_link_report(const vs_radio_link *link, const char *device, const vs_serial_stats *serial, int64_t now_us,
                          vs_msg_radio *out);

#ifdef __cplusplus
}
#endif
#endif
