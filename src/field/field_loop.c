#include "vsss/field_loop.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/sender.h"
#include "tap.h"
#include "vsss/clock.h"
#include "vsss/control.h"

#define WAIT_MS 100 // for a frame; so that a dead camera does not make us deaf to Ctrl-C

struct vs_field {
  vs_field_def def;
  vs_camera *camera;
  vs_calib calib;
  vs_detector *detector;
  vs_tracker tracker;
  vs_control *control;
  vs_sender *sender;
  vs_tap tap;
  vs_game game; // absolute frame
  vs_safety safety;
  int64_t start_us, last_capture_us, last_decision_us;
  uint32_t last_seq;
  vs_detections seen;
  int64_t mark_us; // end of the last stage
  vs_field_stats stats;
  vs_histogram second[VS_STAGES]; // of the present second
};

const char *vs_stage_name(vs_stage stage) {
  static const char *const names[VS_STAGES] = {"camera", "detect",  "track",        "control",
                                               "write",  "publish", "decision age", "camera to radio"};
  return names[stage];
}

vs_field_def vs_field_def_default(void) {
  return (vs_field_def){.policy = "emc:",
                        .team = VS_BLUE,
                        .seed = 1,
                        .duration_s = 120,
                        .baud = VS_SERIAL_BAUD,
                        .radio_id = {0, 1, 2},
                        .camera_height_m = 2.2,
                        .camera_def = vs_camera_def_default(),
                        .detector = vs_detector_def_default(),
                        .tracker = vs_track_def_default(),
                        .lcm = true,
                        .image_hz = 1};
}

static void add_note(char *note, size_t size, const char *text) {
  size_t used = note && size ? strlen(note) : 0;
  if (note && used + 1 < size) snprintf(note + used, size - used, "%s\n", text);
}

// Without a file: a lens straight above the middle that just sees the goals and the side walls (0.90 m and 0.68 m out).
static vs_status get_calib(vs_field *f, char *note, size_t note_size, vs_error *err) {
  const vs_camera_info *info = vs_camera_about(f->camera);
  if (f->def.calib) {
    vs_status s = vs_calib_load(f->def.calib, &f->calib, err);
    return s == VS_OK ? vs_calib_check_size(&f->calib, f->def.calib, info->width, info->height, err) : s;
  }
  double half_m = fmax(0.68, 0.90 * info->height / info->width);
  f->calib =
      vs_calib_overhead(info->width, info->height, f->def.camera_height_m, 2.0 * atan(half_m / f->def.camera_height_m));
  char text[200];
  snprintf(text, sizeof text, "no --calib: assuming a camera %.2f m above the middle that shows just the field",
           f->def.camera_height_m);
  add_note(note, note_size, text);
  return VS_OK;
}

static vs_status open_eyes(vs_field *f, char *note, size_t note_size, vs_error *err) {
  vs_status s = vs_camera_open(f->def.camera, &f->def.camera_def, &f->camera, err);
  if (s != VS_OK) return s;
  const vs_camera_info *info = vs_camera_about(f->camera);
  if (*info->note) add_note(note, note_size, info->note);
  s = get_calib(f, note, note_size, err);
  if (s != VS_OK) return s;
  f->def.detector.adversary = f->def.team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  f->def.detector.px_per_m = vs_calib_px_per_m(&f->calib, f->def.tracker.tag_height_m);
  f->def.tracker.team = f->def.team;
  vs_track_init(&f->tracker, &f->def.tracker);
  return vs_detector_new(&f->def.detector, &f->detector, err);
}

static vs_status open_brain(vs_field *f, vs_error *err) {
  vs_player *player;
  vs_status s = vs_player_open(f->def.policy, &player, err);
  if (s != VS_OK) return s;
  s = vs_control_new(player, &f->control, err);
  if (s != VS_OK) {
    vs_player_close(player);
    return s;
  }
  return vs_control_reset(f->control, f->def.seed, false, err);
}

vs_status vs_field_new(const vs_field_def *def, vs_field **out, char *note, size_t note_size, vs_error *err) {
  *out = NULL;
  if (note && note_size) *note = '\0';
  vs_field *f = calloc(1, sizeof *f);
  if (!f) return vs_fail(err, VS_FAIL, "out of memory");
  f->def = *def;
  f->game.duration_s = def->duration_s;
  vs_safety_init(&f->safety, vs_clock_monotonic_us());
  vs_status s = open_brain(f, err);
  if (s == VS_OK) s = vs_sender_new(def->radio, def->baud, def->radio_id, &f->sender, err);
  if (s == VS_OK) s = open_eyes(f, note, note_size, err);
  if (s == VS_OK) s = vs_tap_open(&f->tap, &f->def, &f->calib, note, note_size, err);
  if (s != VS_OK) {
    vs_field_free(f);
    return s;
  }
  *out = f;
  return VS_OK;
}

void vs_field_free(vs_field *f) {
  if (!f) return;
  vs_sender_free(f->sender); // the robots stop first
  vs_tap_close(&f->tap);
  vs_detector_free(f->detector);
  vs_control_free(f->control);
  vs_camera_close(f->camera);
  free(f);
}

static void count(vs_field *f, vs_stage stage, int64_t duration_us, int64_t now_us) {
  vs_histogram_add(&f->stats.stage[stage], duration_us, now_us);
  vs_histogram_add(&f->second[stage], duration_us, now_us);
}

// Ends a stage.
static void mark(vs_field *f, vs_stage stage) {
  int64_t now_us = vs_clock_monotonic_us();
  count(f, stage, now_us - f->mark_us, now_us);
  f->mark_us = now_us;
}

// What a referee said: where play restarts the past counts no more.
static void hear_referee(vs_field *f, int64_t now_us) {
  if (vs_tap_listen(&f->tap)) {
    const vs_msg_referee *said = &f->tap.heard;
    f->stats.events++;
    f->game.last_event = said->event;
    f->game.duration_s = said->duration_s;
    memcpy(f->game.score, said->score, sizeof f->game.score);
    vs_track_restart(&f->tracker);
    vs_control_restart(f->control);
  }
  double from_s = f->tap.heard_us ? f->game.last_event.time_s : 0.0;
  int64_t since_us = now_us - (f->tap.heard_us ? f->tap.heard_us : f->start_us);
  f->game.time_s = fmin(from_s + 1e-6 * (double)since_us, f->game.duration_s);
}

static void count_frame(vs_field *f, const vs_frame *frame) {
  if (f->stats.frames++ > 0) f->stats.dropped += (int64_t)(uint32_t)(frame->seq - f->last_seq) - 1;
  if (!f->start_us) f->start_us = frame->capture_us;
  f->last_seq = frame->seq;
  f->mark_us = frame->capture_us;
}

// A decision that came more than half a period late is one or more missed.
static void count_decision(vs_field *f, int64_t capture_us) {
  double period_us = 1e6 / vs_player_rate_hz(vs_control_player(f->control));
  double periods = f->last_decision_us ? (double)(capture_us - f->last_decision_us) / period_us : 1.0;
  if (periods > 1.5) f->stats.missed_ticks += llround(periods) - 1;
  f->last_decision_us = capture_us;
  f->stats.decisions++;
}

// The last word before the radio.
static void judge(vs_field *f, int64_t capture_us, vs_field_tick_result *r) {
  vs_safety_input in = {.now_us = vs_clock_monotonic_us(),
                        .armed = true, // by having started the program
                        .referee = f->game.last_event.kind,
                        .team = f->def.team,
                        .world = &r->world,
                        .command_us = capture_us};
  memcpy(in.wheels, r->wheels, sizeof in.wheels);
  r->safety = vs_safety_step(&f->safety, &in, r->wheels);
  r->stop = r->safety != VS_SAFETY_RUNNING;
}

vs_status vs_field_tick(vs_field *f, vs_field_tick_result *r, vs_error *err) {
  memset(r, 0, sizeof *r);
  vs_frame frame;
  vs_status s = vs_camera_read(f->camera, WAIT_MS, &frame, &r->got, err);
  if (s != VS_OK || r->got != VS_CAMERA_FRAME) return s;
  count_frame(f, &frame);
  mark(f, VS_STAGE_CAMERA);

  s = vs_detect(f->detector, &frame, &f->seen, err);
  if (s != VS_OK) return s;
  mark(f, VS_STAGE_DETECT);

  hear_referee(f, frame.capture_us);
  vs_track_update(&f->tracker, &f->calib, &f->seen);
  vs_track_world(&f->tracker, 0, &r->world);
  mark(f, VS_STAGE_TRACK);

  int64_t age_us = vs_clock_monotonic_us() - frame.capture_us;
  if (age_us > VS_FIELD_MAX_AGE_US) { // the last command ages too: the sender stops the robots if this goes on
    f->stats.too_old++;
    return VS_OK;
  }
  double dt_s = f->last_capture_us ? 1e-6 * (double)(frame.capture_us - f->last_capture_us) : 0.0;
  f->last_capture_us = frame.capture_us;
  s = vs_control_step(f->control, f->def.team, &r->world, &f->game, dt_s, r->wheels, &r->decided, err);
  if (s != VS_OK) return s;
  mark(f, VS_STAGE_CONTROL);

  judge(f, frame.capture_us, r);
  vs_sender_command(f->sender, r->wheels, r->stop, frame.capture_us, r->decided);
  mark(f, VS_STAGE_WRITE);
  r->age_us = f->mark_us - frame.capture_us;
  if (r->decided) {
    count_decision(f, frame.capture_us);
    count(f, VS_STAGE_AGE, age_us, f->mark_us);
    count(f, VS_STAGE_TOTAL, r->age_us, f->mark_us);
  }

  vs_tap_frame(&f->tap, &r->world, &f->game, &f->seen, frame.width, frame.height);
  vs_tap_command(&f->tap, &r->world, r->wheels, r->stop);
  if (r->decided) vs_tap_decision(&f->tap, f->control, &r->world);
  vs_tap_picture(&f->tap, &frame);
  vs_radio_link link;
  vs_sender_state(f->sender, &link, &f->stats.serial);
  vs_tap_slow(&f->tap, &f->stats, &link, f->second);
  mark(f, VS_STAGE_PUBLISH);
  return VS_OK;
}

void vs_field_get_stats(vs_field *f, vs_field_stats *out) {
  vs_radio_link link;
  vs_sender_state(f->sender, &link, &f->stats.serial);
  memcpy(f->stats.robot, link.robot, sizeof f->stats.robot);
  f->stats.track = f->tracker.stats;
  f->stats.lost_messages = vs_tap_lost(&f->tap);
  *out = f->stats;
}

const vs_tracker *vs_field_tracker(const vs_field *f) { return &f->tracker; }
const vs_camera_info *vs_field_camera(const vs_field *f) { return vs_camera_about(f->camera); }
