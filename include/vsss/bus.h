// What vsss says to the outside over LCM: one plain struct per channel, one way to publish it, one to hear it. The
// generated LCM types stay behind this header. Layout of the wire: lcm_types/*.lcm.
//
// A failed publish is a lost message, never a reason to stop driving: callers on the field count it and go on.
#ifndef VSSS_BUS_H
#define VSSS_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vsss/contract.h"
#include "vsss/status.h"
#include "vsss/world.h"

#ifdef __cplusplus
extern "C" {
#endif

#define VS_BUS_DEFAULT_URL "udpm://239.255.76.67:7667?ttl=0"

typedef enum vs_channel {
  VS_CH_TRUTH,      // as.world
  VS_CH_STATE,      // as.world
  VS_CH_DETECTIONS, // as.detections
  VS_CH_POLICY,     // as.policy
  VS_CH_CMD,        // as.cmd
  VS_CH_REFEREE,    // as.referee
  VS_CH_RADIO,      // as.radio
  VS_CH_STATS,      // as.stats
  VS_CH_IMAGE,      // as.image
  VS_CHANNELS
} vs_channel;

const char *vs_channel_name(vs_channel channel);          // "VSSS_TRUTH", ...
bool vs_channel_parse(const char *name, vs_channel *out); // with or without "VSSS_", any case

#define VS_BUS_TEXT 128 // longer texts are cut

typedef struct vs_msg_world {
  vs_world world; // of either division: world_t or world_5v5_t on the wire
  vs_game game;
  int asks_team; // VS_CH_STATE: the team whose command is awaited (players in another process); -1: nobody's
} vs_msg_world;

typedef struct vs_msg_cmd {
  vs_team team;
  vs_wheels wheels[VS_TEAM_MOST];
  bool stop;                // brake and hold until a command without it
  int64_t state_seq;        // world.seq this answers; -1: none
  char source[VS_BUS_TEXT]; // player URI, or who else commands
  vs_division division;     // how many wheels count, and the type on the wire: cmd_t or cmd_5v5_t
} vs_msg_cmd;

typedef struct vs_msg_referee {
  vs_event event;
  double duration_s;
  int score[VS_TEAMS];
} vs_msg_referee;

typedef struct vs_msg_policy {
  vs_team team;
  uint64_t contract_hash;
  float observation[VS_TEAM_SIZE][VS_OBS_SIZE];
  float action[VS_TEAM_SIZE][VS_ACTION_SIZE];
  char player[VS_BUS_TEXT];
} vs_msg_policy;

#define VS_BUS_TAGS  8
#define VS_BUS_BLOBS 16
typedef struct vs_msg_tag {
  int id, hamming;
  double margin; // grey levels
  double centre_px[2], corner_px[4][2];
  vs_pose pose; // at tag height, absolute frame
} vs_msg_tag;
typedef enum vs_blob_kind { VS_BLOB_BALL, VS_BLOB_OPPONENT } vs_blob_kind;
typedef struct vs_msg_blob {
  vs_blob_kind kind;
  double centre_px[2], area_px, confidence; // 0..1
  double x_m, y_m;
} vs_msg_blob;
typedef struct vs_msg_detections {
  int width_px, height_px;
  int n_tags, n_blobs; // clipped to the sizes of the arrays when published
  vs_msg_tag tag[VS_BUS_TAGS];
  vs_msg_blob blob[VS_BUS_BLOBS];
} vs_msg_detections;

// Ages and times in us; -1: none yet.
typedef struct vs_msg_radio_robot {
  int id; // on the air
  int64_t age_us, round_trip_us;
  vs_wheels measured;
  double battery_v, uptime_s;
  int rssi_dbm, rx_ok, rx_bad;
} vs_msg_radio_robot;
typedef struct vs_msg_radio {
  char device[VS_BUS_TEXT];
  bool up, stopping;
  int64_t sent_frames, dropped_frames, reopened, received_frames, bad_frames, command_age_us;
  vs_msg_radio_robot robot[VS_TEAM_SIZE];
} vs_msg_radio;

#define VS_STATS_STAGES  12
#define VS_STATS_BUCKETS 21 // bucket k: [2^k, 2^(k+1)) us; the last also longer
#define VS_STATS_NAME    24
typedef struct vs_msg_stage {
  char name[VS_STATS_NAME];
  int64_t count;
  double p50_us, p99_us, max_us;
  int32_t bucket[VS_STATS_BUCKETS];
} vs_msg_stage;
typedef struct vs_msg_stats {
  int64_t frames, dropped_frames, decisions, missed_ticks;
  int n_stages;
  vs_msg_stage stage[VS_STATS_STAGES];
} vs_msg_stats;

#define VS_BUS_IMAGE_MAX 60000 // one datagram
typedef struct vs_msg_image {
  int width_px, height_px;
  char format[16];     // "jpeg"
  int size;            // <= VS_BUS_IMAGE_MAX
  const uint8_t *data; // the caller's; in a handler: valid until it returns
} vs_msg_image;

typedef struct vs_message {
  vs_channel channel;
  int64_t utime_us;         // since the epoch; filled in by vs_bus_publish where 0
  int64_t utime_capture_us; // since the epoch: mid-exposure of the frame this comes from; 0: unknown
  int32_t seq;              // of a world: that of the world, whatever stands here
  union {
    vs_msg_world world;
    vs_msg_cmd cmd;
    vs_msg_referee referee;
    vs_msg_policy policy;
    vs_msg_detections detections;
    vs_msg_radio radio;
    vs_msg_stats stats;
    vs_msg_image image;
  } as;
} vs_message;

typedef struct vs_bus vs_bus;

// VS_FAIL where the program was built without LCM: says what to install.
vs_status vs_bus_supported(vs_error *err);

// The URL that vs_bus_open(NULL) takes: LCM_DEFAULT_URL of the environment, else VS_BUS_DEFAULT_URL.
const char *vs_bus_default_url(void);

// Opens udpm://, memq:// (this process only) or file://PATH?mode=w. VS_USAGE: not such a URL. VS_FAIL: no multicast
// route, with the two commands that mend it in the text; or the program was built without LCM.
vs_status vs_bus_open(const char *url /* NULL: default */, vs_bus **out, vs_error *err);
void vs_bus_close(vs_bus *bus); // NULL is allowed
const char *vs_bus_url(const vs_bus *bus);

// Sends message on its channel. Any thread; no allocation. VS_FAIL: not sent (too large, network gone).
vs_status vs_bus_publish(vs_bus *bus, vs_message *message, vs_error *err);

// Calls handler from vs_bus_handle for every message of channel (VS_CHANNELS: of all of ours). Messages of another
// version of the types are not delivered, see vs_bus_refused. newest_only: keep one message waiting instead of 30.
typedef void (*vs_bus_handler)(const vs_message *message, void *user);
vs_status vs_bus_subscribe(vs_bus *bus, vs_channel channel, bool newest_only, vs_bus_handler handler, void *user,
                           vs_error *err);
// The same, but only for messages that this machine sent: for what moves robots. LCM listens to the whole network, and
// with a time to live of 1 or more anybody on it is heard.
vs_status vs_bus_subscribe_near(vs_bus *bus, vs_channel channel, vs_bus_handler handler, void *user, vs_error *err);
int64_t vs_bus_far(const vs_bus *bus); // messages on our channels from other machines, refused for that

// Waits up to timeout_ms (0: not at all) for one message and hands it on, then all that already wait. One thread only.
// handled (may be NULL): how many.
vs_status vs_bus_handle(vs_bus *bus, int timeout_ms, int *handled, vs_error *err);
int64_t vs_bus_refused(const vs_bus *bus); // messages on our channels that could not be decoded

// The same for bytes as they are, on channels of any name (logs, the text spy). channel NULL: all of them.
typedef void (*vs_bus_raw_handler)(const char *channel, const uint8_t *data, size_t size, int64_t utime_us, void *user);
vs_status vs_bus_subscribe_raw(vs_bus *bus, const char *channel, vs_bus_raw_handler handler, void *user, vs_error *err);
vs_status vs_bus_publish_raw(vs_bus *bus, const char *channel, const uint8_t *data, size_t size, vs_error *err);

// Bytes of the wire. encode: size written, 0 where they do not fit. decode: VS_FAIL says what is wrong with them.
#define VS_MESSAGE_MAX_BYTES 65000
size_t vs_message_encode(const vs_message *message, uint8_t *out, size_t out_size);
// image_buffer: VS_BUS_IMAGE_MAX bytes that an image's data is copied to and points at; NULL: images have no data.
vs_status vs_message_decode(vs_channel channel, const uint8_t *data, size_t size, vs_message *out,
                            uint8_t *image_buffer, vs_error *err);

#ifdef __cplusplus
}
#endif
#endif
