#include "vsss/field_loop.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "eyes.h"
#include "moved.h"
#include "record.h"
#include "tap.h"
#include "vsss/clock.h"
#include "vsss/control.h"
#include "vsss/isolate.h"
#include "vsss/sender.h"

#define FAULT_REST_US 1000000
#define WAIT_MS       100 // for a frame; so that a dead camera does not make us deaf to Ctrl-C

struct vs_field {
  vs_field_def def;
  vs_eyes eyes;
  vs_calib calib;
  vs_detector *detector;
  vs_moved moved; // whether the camera did
  vs_tracker tracker;
  vs_control *control[2]; // the policy's and the fallback's (NULL: none)
  int plays;              // which of them
  bool armed, rearm;      // the operator lets the robots move; and just said so again
  bool mindless;          // it failed and has not decided since
  vs_sender *sender;      // NULL: a run computed again
  vs_tap tap;
  vs_record record;
  vs_tick tick;   // what this turn was given so far; computed again: what it is given
  int clock_used; // of its readings, computed again
  bool dark;      // the camera is gone
  vs_game game;   // absolute frame
  vs_safety safety;
  int64_t start_us, last_decision_us;
  int64_t step_us;           // moment of the world that control was stepped with last; 0: none yet
  int64_t came_us, awake_us; // when the last frame came; when a missing one is bridged
  uint32_t last_seq;
  vs_detections seen;
  char said[400], why_dark[sizeof((vs_eyes *)0)->why]; // the last lines of each kind
  int64_t mark_us;                                     // end of the last stage
  vs_field_stats stats;
  vs_histogram second[VS_STAGES]; // of the present second
};

const char *vs_stage_name(vs_stage stage) {
  static const char *const names[VS_STAGES] = {"camera", "detect",  "track",        "control",
                                               "write",  "publish", "decision age", "camera to radio"};
  return names[stage];
}

vs_field_def vs_field_def_default(void) {
  return (vs_field_def){.policy = "onnx:models/policy/field.onnx", // holds its own where commands take time
                        .team = VS_BLUE,
                        .seed = 1,
                        .duration_s = 120,
                        .baud = VS_SERIAL_BAUD,
                        .radio_id = {0, 1, 2},
                        .camera_height_m = 2.2,
                        .ball_hold_s = 3,
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
  const vs_camera_info *info = &f->eyes.info;
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
  const vs_field_rerun *again = f->def.rerun;
  vs_status s = again ? VS_OK : vs_eyes_open(&f->eyes, f->def.camera, &f->def.camera_def, err);
  if (s != VS_OK) return s;
  if (again) f->eyes.info = (vs_camera_info){.width = again->width_px, .height = again->height_px};
  const vs_camera_info *info = &f->eyes.info;
  if (*info->note) add_note(note, note_size, info->note);
  s = get_calib(f, note, note_size, err);
  if (s != VS_OK) return s;
  if (f->def.calib && !again && (s = vs_moved_open(&f->moved, &f->calib, err)) != VS_OK) return s;
  f->def.detector.adversary = f->def.team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  f->def.detector.px_per_m = vs_calib_px_per_m(&f->calib, f->def.tracker.tag_height_m);
  f->def.tracker.team = f->def.team;
  vs_track_init(&f->tracker, &f->def.tracker);
  return again ? VS_OK : vs_detector_new(&f->def.detector, &f->detector, err);
}

static vs_status open_brain(vs_field *f, const char *uri, vs_control **control, vs_error *err) {
  vs_player *player;
  vs_status s = f->def.rerun ? vs_player_open_rerun(uri, &player, err)
                             : vs_player_open_isolated(uri, VS_FIELD_PATIENCE_MS, &player, err);
  if (s != VS_OK) return s;
  s = vs_control_new(player, control, err);
  if (s != VS_OK) {
    vs_player_close(player);
    return s;
  }
  s = vs_control_set_latency(*control, f->def.latency_s, err);
  return s == VS_OK ? vs_control_reset(*control, f->def.seed, false, err) : s;
}

vs_status vs_field_new(const vs_field_def *def, vs_field **out, char *note, size_t note_size, vs_error *err) {
  *out = NULL;
  if (note && note_size) *note = '\0';
  vs_field *f = calloc(1, sizeof *f);
  if (!f) return vs_fail(err, VS_FAIL, "out of memory");
  f->def = *def;
  f->game.duration_s = def->duration_s;
  f->came_us = def->rerun ? def->rerun->start_us : vs_clock_monotonic_us();
  f->armed = def->go;
  vs_safety_init(&f->safety, f->came_us);
  // Before anything starts a thread: the players' processes are forked from here.
  vs_status s = open_brain(f, def->policy, &f->control[0], err);
  if (s == VS_OK && def->fallback) s = open_brain(f, def->fallback, &f->control[1], err);
  vs_sender_def radio = {.device = def->radio, .baud = def->baud, .key = def->key, .wire = def->wire};
  memcpy(radio.id, def->radio_id, sizeof radio.id);
  if (s == VS_OK && !def->rerun) s = vs_sender_new(&radio, &f->sender, err);
  if (s == VS_OK) s = open_eyes(f, note, note_size, err);
  if (s == VS_OK) s = vs_tap_open(&f->tap, &f->def, &f->calib, note, note_size, err);
  const vs_field_rerun start = {f->eyes.info.width, f->eyes.info.height, f->safety.since_us};
  if (s == VS_OK && def->record) s = vs_record_open(&f->record, &f->def, &start, err);
  f->tap.record = f->record.bus;
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
  vs_record_close(&f->record);
  vs_detector_free(f->detector);
  for (int i = 0; i < 2; i++) vs_control_free(f->control[i]);
  vs_moved_close(&f->moved);
  vs_eyes_close(&f->eyes);
  free(f);
}

// What is decided by time is decided by this: each reading is in the record, and a run computed again is given them.
static int64_t clock_us(vs_field *f) {
  vs_tick *t = &f->tick;
  if (f->def.rerun) {
    int i = f->clock_used++;
    return i < t->n_clock ? t->clock_us[i] : 0; // 0: vs_field_again tells
  }
  int64_t now_us = vs_clock_monotonic_us();
  if (t->n_clock < VS_TICK_CLOCKS) t->clock_us[t->n_clock++] = now_us;
  return now_us;
}

static void send(vs_field *f, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t moment_us, bool now) {
  if (f->sender) vs_sender_command(f->sender, wheels, stop, moment_us, now);
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

void vs_field_arm(vs_field *f, bool go) {
  f->rearm = go;
  if (f->armed == go) return;
  f->armed = go;
  if (go) return;
  const vs_wheels still[VS_TEAM_SIZE] = {{0}};
  send(f, still, true, vs_clock_monotonic_us(), true); // not only with the next frame
}

static void obey_referee(vs_field *f, vs_event_kind kind) {
  bool restart =
      kind == VS_EVENT_KICK_OFF || kind == VS_EVENT_PENALTY || kind == VS_EVENT_FREE_BALL || kind == VS_EVENT_GOAL_KICK;
  if (restart) vs_field_arm(f, true);
  if (kind == VS_EVENT_HALF_TIME) vs_field_arm(f, false);
}

// A FAULT is left by being released again; where nobody is there to do so, after a second.
static bool is_armed(vs_field *f, int64_t now_us) {
  bool fault = f->safety.state == VS_SAFETY_FAULT;
  bool again = fault && (f->rearm || (f->def.go && now_us - f->safety.since_us > FAULT_REST_US));
  f->rearm = false;
  return f->armed && !again;
}

// What a referee said: where play restarts the past counts no more.
static void hear_referee(vs_field *f, int64_t now_us) {
  vs_tick *t = &f->tick;
  if (f->def.rerun) {
    f->tap.heard = t->referee;
    f->tap.heard_us = t->heard ? t->heard_us : f->tap.heard_us;
  } else {
    t->heard = vs_tap_listen(&f->tap);
    t->heard_us = f->tap.heard_us;
    t->referee = f->tap.heard;
  }
  if (t->heard) {
    const vs_msg_referee *said = &f->tap.heard;
    f->stats.events++;
    f->game.last_event = said->event;
    f->game.duration_s = said->duration_s;
    memcpy(f->game.score, said->score, sizeof f->game.score);
    if (f->def.referee_goes) obey_referee(f, said->event.kind);
    vs_track_restart(&f->tracker);
    for (int i = 0; i < 2 && f->control[i]; i++) vs_control_restart(f->control[i]);
  }
  if (!f->start_us) return;
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
  double period_us = 1e6 / vs_player_rate_hz(vs_control_player(f->control[f->plays]));
  double periods = f->last_decision_us ? (double)(capture_us - f->last_decision_us) / period_us : 1.0;
  if (periods > 1.5) f->stats.missed_ticks += llround(periods) - 1;
  f->last_decision_us = capture_us;
  f->stats.decisions++;
}

static void say(vs_field *f, vs_field_tick_result *r, const char *format, const char *what) {
  snprintf(f->said, sizeof f->said, format, what);
  r->said = f->said;
}

// The last word before the radio. moment_us: of the world that the wheels answer to.
static void judge(vs_field *f, int64_t moment_us, vs_field_tick_result *r) {
  const vs_object *ball = &f->tracker.ball;
  int64_t hold_us = llround(1e6 * f->def.ball_hold_s);
  int64_t now_us = clock_us(f);
  vs_safety_input in = {.now_us = now_us,
                        .armed = is_armed(f, now_us),
                        .no_camera = f->dark,
                        .no_ball = hold_us > 0 && (!ball->ever || r->world.time_us - ball->seen_us > hold_us),
                        .no_player = f->mindless,
                        .referee = f->game.last_event.kind,
                        .team = f->def.team,
                        .world = &r->world,
                        .command_us = moment_us};
  memcpy(in.wheels, r->wheels, sizeof in.wheels);
  r->safety = vs_safety_step(&f->safety, &in, r->wheels);
  r->stop = r->safety != VS_SAFETY_RUNNING;
}

// Lets the player decide on r->world, when its rate says so. One that fails leaves the robots stopped until it, or the
// other one, decides again.
static void decide(vs_field *f, vs_field_tick_result *r) {
  double dt_s = f->step_us ? fmax(0.0, 1e-6 * (double)(r->world.time_us - f->step_us)) : 0.0;
  vs_error why = {0};
  if (f->def.rerun && f->tick.player_failed) vs_player_fail_next(vs_control_player(f->control[f->plays]));
  vs_status s =
      vs_control_step(f->control[f->plays], f->def.team, &r->world, &f->game, dt_s, r->wheels, &r->decided, &why);
  if (r->world.time_us > f->step_us) f->step_us = r->world.time_us;
  if (s == VS_OK) {
    if (r->decided && f->mindless) say(f, r, "%s plays", vs_player_uri(vs_control_player(f->control[f->plays])));
    if (r->decided) f->mindless = false;
    return;
  }
  f->tick.player_failed = true;
  r->decided = false;
  if (!f->mindless) say(f, r, "%s; the robots are stopped", why.text);
  f->mindless = true;
  if (!f->control[1]) return;
  f->plays = 1 - f->plays;
  vs_control_restart(f->control[f->plays]);
}

// Takes a frame in; false: it cannot be read, its camera was given up.
static bool see(vs_field *f, const vs_frame *frame, vs_field_tick_result *r) {
  count_frame(f, frame);
  mark(f, VS_STAGE_CAMERA);
  vs_error why = {0};
  if (f->def.rerun) {
    vs_record_see_again(&f->tick, &f->seen);
  } else if (vs_detect(f->detector, frame, &f->seen, &why) != VS_OK) {
    vs_eyes_lose(&f->eyes, why.text);
    return false;
  }
  mark(f, VS_STAGE_DETECT);
  hear_referee(f, frame->capture_us);
  vs_track_update(&f->tracker, &f->calib, &f->seen);
  vs_track_world(&f->tracker, 0, &r->world);
  mark(f, VS_STAGE_TRACK);
  return true;
}

static void publish(vs_field *f, const vs_frame *frame, const vs_field_tick_result *r) {
  if (frame) vs_tap_frame(&f->tap, &r->world, &f->game, &f->seen, frame->width, frame->height);
  vs_tap_command(&f->tap, &r->world, r->wheels, r->stop);
  if (r->decided) vs_tap_decision(&f->tap, f->control[f->plays], &r->world);
  if (frame) vs_tap_picture(&f->tap, frame);
}

static void publish_slowly(vs_field *f) {
  vs_radio_link link;
  if (f->def.rerun) return;
  vs_sender_state(f->sender, &link, &f->stats.serial);
  vs_tap_slow(&f->tap, &f->stats, &link, f->second);
}

static void play(vs_field *f, const vs_frame *frame, vs_field_tick_result *r) {
  int64_t age_us = clock_us(f) - frame->capture_us;
  if (age_us > VS_FIELD_MAX_AGE_US) { // the last command ages too: the sender stops the robots if this goes on
    f->stats.too_old++;
    return;
  }
  decide(f, r);
  mark(f, VS_STAGE_CONTROL);
  judge(f, frame->capture_us, r);
  send(f, r->wheels, r->stop, frame->capture_us, r->decided || r->stop);
  mark(f, VS_STAGE_WRITE);
  r->age_us = f->mark_us - frame->capture_us;
  if (r->decided) {
    count_decision(f, frame->capture_us);
    count(f, VS_STAGE_AGE, age_us, f->mark_us);
    count(f, VS_STAGE_TOTAL, r->age_us, f->mark_us);
  }
  publish(f, frame, r);
  publish_slowly(f);
  mark(f, VS_STAGE_PUBLISH);
  const char *moved = vs_moved_look(&f->moved, frame); // after all that a wheel waits for
  if (moved) r->said = moved;
}

static int64_t period_us(const vs_field *f) {
  double fps = f->eyes.info.fps;
  return llround(1e6 / (fps >= 10.0 && fps <= 240.0 ? fps : VS_CAMERA_HZ));
}

// No frame when one was due: the prediction stands in for it as long as the tracker holds what it saw. What is decided on
// it ages as if it had been seen then, so that robots which nobody sees stop VS_TRACK_HOLD_US + VS_SAFETY_STALE_US after
// the last frame at the latest; at once where the camera is known to be gone.
static void play_blind(vs_field *f, vs_field_tick_result *r) {
  int64_t next_us = f->step_us + period_us(f), now_us = clock_us(f);
  hear_referee(f, now_us);
  r->bridged = !f->dark && f->step_us && now_us >= f->awake_us && next_us <= now_us &&
               next_us - f->tracker.time_us <= VS_TRACK_HOLD_US;
  f->awake_us = now_us + period_us(f);
  vs_track_world(&f->tracker, r->bridged ? next_us : f->step_us, &r->world);
  if (r->bridged) {
    f->stats.bridged++;
    decide(f, r);
    if (r->decided) count_decision(f, next_us);
  }
  judge(f, f->step_us, r);
  if (r->bridged || r->stop) send(f, r->wheels, r->stop, f->step_us, r->decided || r->stop);
  if (r->bridged || r->stop) publish(f, NULL, r);
  publish_slowly(f);
}

// Until the next frame, or until a missing one is bridged.
static int wait_ms(const vs_field *f) {
  if (!f->eyes.camera || !f->step_us || f->step_us + period_us(f) - f->tracker.time_us > VS_TRACK_HOLD_US)
    return WAIT_MS;
  int64_t left_us = f->awake_us - vs_clock_monotonic_us();
  return left_us <= 0 ? 0 : left_us < 1000 * WAIT_MS ? (int)((left_us + 999) / 1000) : WAIT_MS;
}

// The turn itself, with or without a frame.
static void turn(vs_field *f, const vs_frame *frame, vs_field_tick_result *r) {
  if (frame) {
    f->came_us = clock_us(f);
    f->awake_us = f->came_us + period_us(f) * 3 / 2;
    play(f, frame, r);
  } else {
    play_blind(f, r);
  }
}

static void keep(vs_field *f, const vs_frame *frame, const vs_field_tick_result *r) {
  vs_tick *t = &f->tick;
  t->frame = frame != NULL;
  t->fps = f->eyes.info.fps;
  t->camera = !f->dark;
  if (frame) {
    t->capture_us = frame->capture_us;
    t->frame_seq = frame->seq;
    vs_record_seen(&f->seen, t);
  }
  t->decided = r->decided;
  t->stop = r->stop;
  t->safety = r->safety;
  t->world_hash = vs_world_hash(VS_HASH_START, &r->world);
  memcpy(t->wheels, r->wheels, sizeof t->wheels);
  vs_record_tick(&f->record, t);
}

vs_status vs_field_tick(vs_field *f, vs_field_tick_result *r, vs_error *err) {
  memset(r, 0, sizeof *r);
  memset(&f->tick, 0, sizeof f->tick);
  vs_frame frame;
  int64_t lost = f->eyes.lost, reopened = f->eyes.reopened;
  vs_status s = vs_eyes_read(&f->eyes, wait_ms(f), &frame, &r->got, err);
  if (s != VS_OK || r->got == VS_CAMERA_END) return s;
  f->tick.armed = f->armed;
  f->tick.rearm = f->rearm;
  if (r->got == VS_CAMERA_FRAME && !see(f, &frame, r)) r->got = VS_CAMERA_TIMEOUT;
  f->dark = !f->eyes.camera;
  if (f->dark && (f->eyes.lost != lost || strcmp(f->eyes.why, f->why_dark)))
    say(f, r, "camera gone: %s; the robots are stopped, looking for it", f->eyes.why);
  snprintf(f->why_dark, sizeof f->why_dark, "%s", f->eyes.why);
  if (f->eyes.reopened != reopened) say(f, r, "camera back: %s", f->eyes.info.name);
  const vs_frame *got = r->got == VS_CAMERA_FRAME ? &frame : NULL;
  turn(f, got, r);
  if (f->record.bus) keep(f, got, r);
  r->silent_us = vs_clock_monotonic_us() - f->came_us;
  return VS_OK;
}

vs_status vs_field_again(vs_field *f, const vs_tick *tick, vs_tick *again, vs_error *err) {
  vs_field_tick_result r = {.got = tick->frame ? VS_CAMERA_FRAME : VS_CAMERA_TIMEOUT};
  vs_frame frame = {.capture_us = tick->capture_us,
                    .seq = tick->frame_seq,
                    .width = f->eyes.info.width,
                    .height = f->eyes.info.height};
  f->tick = *tick;
  f->clock_used = 0;
  f->armed = tick->armed;
  f->rearm = tick->rearm;
  f->dark = !tick->camera;
  f->eyes.info.fps = tick->fps;
  if (tick->frame) see(f, &frame, &r);
  turn(f, tick->frame ? &frame : NULL, &r);
  keep(f, tick->frame ? &frame : NULL, &r);
  *again = f->tick;
  if (f->clock_used == tick->n_clock) return VS_OK;
  return vs_fail(err, VS_FAIL, "turn %d looked at the clock %d times, the recorded one %d times", tick->seq,
                 f->clock_used, tick->n_clock);
}

void vs_field_get_stats(vs_field *f, vs_field_stats *out) {
  vs_radio_link link;
  vs_sender_state(f->sender, &link, &f->stats.serial);
  memcpy(f->stats.robot, link.robot, sizeof f->stats.robot);
  f->stats.track = f->tracker.stats;
  f->stats.lost_messages = vs_tap_lost(&f->tap);
  f->stats.lost_record = f->record.lost;
  f->stats.camera_lost = f->eyes.lost;
  f->stats.camera_reopened = f->eyes.reopened;
  f->stats.player_failures = 0;
  for (int i = 0; i < 2 && f->control[i]; i++)
    f->stats.player_failures += vs_player_failures(vs_control_player(f->control[i]));
  memcpy(f->stats.entered, f->safety.entered, sizeof f->stats.entered);
  *out = f->stats;
}

const vs_tracker *vs_field_tracker(const vs_field *f) { return &f->tracker; }
const vs_camera_info *vs_field_camera(const vs_field *f) { return &f->eyes.info; }
