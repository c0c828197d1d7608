// The field's side of LCM: hears a referee, tells what was seen, decided and sent. A tap on the pipe: it is called after
// the wheels have their bytes, and a message that cannot be sent is counted and forgotten.
#ifndef VSSS_FIELD_TAP_H
#define VSSS_FIELD_TAP_H

#include "pictures.h"
#include "vsss/bus.h"
#include "vsss/control.h"
#include "vsss/field_loop.h"

typedef struct vs_tap {
  vs_bus *bus;           // NULL: nobody listens
  vs_bus *record;        // gets the same messages; NULL: there is none
  vs_pictures *pictures; // NULL: none are sent
  vs_team team;
  const char *policy, *radio; // the definition's
  vs_calib calib;
  double tag_height_m, patch_height_m, ball_height_m;
  int32_t seq[VS_CHANNELS];
  int64_t lost;
  int64_t radio_us, stats_us; // when the slow channels went out last
  int64_t heard_us;           // when the referee last spoke, monotonic; 0: never
  vs_msg_referee heard;
  bool news;          // heard is new
  vs_message message; // scratch
} vs_tap;

// Opens the bus that def asks for. Without an explicit URL a bus that does not open is a note, not an error.
vs_status vs_tap_open(vs_tap *tap, const vs_field_def *def, const vs_calib *calib, char *note, size_t note_size,
                      vs_error *err);
void vs_tap_close(vs_tap *tap);

// True: the referee said something new, now in tap->heard.
bool vs_tap_listen(vs_tap *tap);

void vs_tap_frame(vs_tap *tap, const vs_world *world, const vs_game *game, const vs_detections *seen, int width_px,
                  int height_px);
// Every frame, decided or not: a bridge on another computer counts a command's age from its frame, as our sender does.
void vs_tap_command(vs_tap *tap, const vs_world *world, const vs_wheels wheels[VS_TEAM_SIZE], bool stop);
void vs_tap_decision(vs_tap *tap, const vs_control *control, const vs_world *world);
// What the camera saw, when the next picture is due.
void vs_tap_picture(vs_tap *tap, const vs_frame *frame);
// The slow channels, when their time has come: radio 5 times, statistics once a second. second: this second's stages,
// emptied after they went out.
void vs_tap_slow(vs_tap *tap, const vs_field_stats *all, const vs_radio_link *link, vs_histogram second[VS_STAGES]);

int64_t vs_tap_lost(const vs_tap *tap); // messages, pictures among them

#endif
