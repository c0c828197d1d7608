#include "field_internal.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/isolate.h"

#define WAIT_MS 100 // for a frame; so that a dead camera does not make us deaf to Ctrl-C

// A camera that loses many of its frames all the time leaves long gaps by chance: of a half, seven in a row every 9 s. Then
// the last command lives on for this long, where a camera that was whole until it fell silent is taken to be frozen.
#define LOSSY          0.2
#define LOSSY_GRACE_US 150000
#define ABSENT_US      600000

void vs_field_send(vs_field *f, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t moment_us, bool now) {
  if (f->sender) vs_sender_command(f->sender, wheels, stop, moment_us, now);
}

// moment_us: of the world that the wheels answer to.
static void command(vs_field *f, int64_t moment_us, const vs_field_tick_result *r) {
  static const vs_wheels still[VS_TEAM_SIZE] = {{0}};
  vs_field_send(f, r->wheels, r->stop, moment_us, r->decided || r->stop);
  if (f->meter) vs_latency_meter_sent(f->meter, moment_us, r->stop ? still : r->wheels);
}

static void say(vs_field *f, vs_field_tick_result *r, const char *format, const char *what) {
  snprintf(f->said, sizeof f->said, format, what);
  r->said = f->said;
}

static vs_event_kind referee_of(const vs_field *f) {
  if (f->task == VS_FIELD_BY_EVENTS) return f->game.last_event.kind;
  return f->task == VS_FIELD_STAND ? VS_EVENT_HALT : VS_EVENT_NONE;
}

// The last word before the radio. moment_us: of the world that the wheels answer to.
static void judge(vs_field *f, int64_t moment_us, vs_field_tick_result *r) {
  const vs_object *ball = &f->tracker.ball;
  int64_t hold_us = llround(1e6 * f->def.ball_hold_s);
  int64_t now_us = vs_field_clock_us(f);
  bool places = f->task == VS_FIELD_PLACE;
  vs_safety_input in = {.now_us = now_us,
                        .armed = vs_field_is_armed(f, now_us),
                        .no_camera = f->dark,
                        .no_ball =
                            !places && hold_us > 0 && (!ball->ever || r->world.time_us - ball->seen_us > hold_us),
                        .no_player = f->mindless && !places,
                        .referee = referee_of(f),
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
  if (f->task == VS_FIELD_PLACE) {
    vs_go_to_step(&f->go_to, &r->world, f->def.team, f->place, r->wheels);
    if (r->world.time_us > f->step_us) f->step_us = r->world.time_us;
    return;
  }
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

// What the robots made of their commands tells how late these act.
static void measure_latency(vs_field *f, const vs_world *world) {
  double latency_s;
  if (!f->meter || !vs_latency_meter_see(f->meter, world, &latency_s)) return;
  f->stats.latency_s = latency_s;
  f->stats.latency_told = true;
  for (int i = 0; i < 2 && f->control[i]; i++) vs_control_set_latency(f->control[i], latency_s, NULL);
}

static int64_t period_us(const vs_field *f) {
  double fps = f->eyes.info.fps;
  return llround(1e6 / (fps >= 10.0 && fps <= 240.0 ? fps : VS_CAMERA_HZ));
}

// Before the tracker takes the frame in. A camera that was away for longer than ABSENT_US has not lost its frames.
static void count_lost(vs_field *f, const vs_frame *frame) {
  int64_t gap_us = frame->capture_us - f->tracker.time_us;
  if (!f->tracker.time_us || gap_us <= 0 || gap_us > ABSENT_US) return;
  double per_frame = (double)period_us(f) * 1e-6; // remembered for a second
  for (int64_t i = (gap_us + period_us(f) / 2) / period_us(f); i > 0; i--) f->loss += per_frame * ((i > 1) - f->loss);
}

// Takes a frame in; false: it cannot be read, its camera was given up.
bool vs_field_see(vs_field *f, const vs_frame *frame, vs_field_tick_result *r) {
  vs_field_count_frame(f, frame);
  vs_field_mark(f, VS_STAGE_CAMERA);
  vs_error why = {0};
  if (f->def.rerun) {
    vs_record_see_again(&f->tick, &f->seen);
  } else if (vs_detect(f->detector, frame, &f->seen, &why) != VS_OK) {
    vs_eyes_lose(&f->eyes, why.text);
    return false;
  }
  vs_field_mark(f, VS_STAGE_DETECT);
  vs_field_hear(f, frame->capture_us);
  count_lost(f, frame);
  vs_track_update(&f->tracker, &f->calib, &f->seen);
  vs_track_world(&f->tracker, 0, &r->world);
  measure_latency(f, &r->world);
  vs_field_mark(f, VS_STAGE_TRACK);
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
  int64_t age_us = vs_field_clock_us(f) - frame->capture_us;
  if (age_us > VS_FIELD_MAX_AGE_US) { // the last command ages too: the sender stops the robots if this goes on
    f->stats.too_old++;
    return;
  }
  decide(f, r);
  memcpy(f->kept, r->wheels, sizeof f->kept);
  vs_field_mark(f, VS_STAGE_CONTROL);
  judge(f, frame->capture_us, r);
  command(f, frame->capture_us, r);
  vs_field_mark(f, VS_STAGE_WRITE);
  r->age_us = f->mark_us - frame->capture_us;
  if (r->decided) {
    vs_field_count_decision(f, frame->capture_us);
    vs_field_count(f, VS_STAGE_AGE, age_us, f->mark_us);
    vs_field_count(f, VS_STAGE_TOTAL, r->age_us, f->mark_us);
  }
  publish(f, frame, r);
  publish_slowly(f);
  vs_field_mark(f, VS_STAGE_PUBLISH);
  const char *moved = vs_moved_look(&f->moved, frame); // after all that a wheel waits for
  if (moved) r->said = moved;
}

// Only what runs lives on: nothing starts again without a new decision.
static bool lives_on_blind(const vs_field *f) {
  return f->loss > LOSSY && f->step_us && !f->dark && !f->mindless && f->safety.state == VS_SAFETY_RUNNING;
}

// No frame when one was due: the prediction stands in for it as long as the tracker holds what it saw. What is decided on
// it ages as if it had been seen then, so that robots which nobody sees stop VS_TRACK_HOLD_US + VS_SAFETY_STALE_US after
// the last frame at the latest, LOSSY_GRACE_US later where frames are lost all the time; at once where the camera is known
// to be gone.
static void play_blind(vs_field *f, vs_field_tick_result *r) {
  int64_t next_us = f->step_us + period_us(f), now_us = vs_field_clock_us(f);
  vs_field_hear(f, now_us);
  r->bridged = !f->dark && f->step_us && now_us >= f->awake_us && next_us <= now_us &&
               next_us - f->tracker.time_us <= VS_TRACK_HOLD_US;
  f->awake_us = now_us + period_us(f);
  vs_track_world(&f->tracker, r->bridged ? next_us : f->step_us, &r->world);
  int64_t moment_us = r->bridged ? next_us : f->step_us;
  bool lives_on = !r->bridged && lives_on_blind(f);
  if (r->bridged) {
    f->stats.bridged++;
    decide(f, r);
    memcpy(f->kept, r->wheels, sizeof f->kept);
    if (r->decided) vs_field_count_decision(f, next_us);
  } else if (lives_on) {
    memcpy(r->wheels, f->kept, sizeof f->kept);
    if (moment_us + LOSSY_GRACE_US < now_us)
      moment_us += LOSSY_GRACE_US;
    else if (moment_us < now_us)
      moment_us = now_us;
  }
  judge(f, moment_us, r);
  bool tells = r->bridged || r->stop || lives_on;
  if (tells) command(f, moment_us, r);
  if (tells) publish(f, NULL, r);
  publish_slowly(f);
}

// Until the next frame, or until a missing one is bridged.
static int wait_ms(const vs_field *f) {
  bool bridges = f->eyes.camera && f->step_us && f->step_us + period_us(f) - f->tracker.time_us <= VS_TRACK_HOLD_US;
  if (!bridges && !lives_on_blind(f)) return WAIT_MS;
  int64_t left_us = f->awake_us - vs_clock_monotonic_us();
  return left_us <= 0 ? 0 : left_us < 1000 * WAIT_MS ? (int)((left_us + 999) / 1000) : WAIT_MS;
}

// The turn itself, with or without a frame.
void vs_field_turn(vs_field *f, const vs_frame *frame, vs_field_tick_result *r) {
  if (frame) {
    f->came_us = vs_field_clock_us(f);
    f->awake_us = f->came_us + period_us(f) * 3 / 2;
    play(f, frame, r);
  } else {
    play_blind(f, r);
  }
}

vs_status vs_field_tick(vs_field *f, vs_field_tick_result *r, vs_error *err) {
  memset(r, 0, sizeof *r);
  memset(&f->tick, 0, sizeof f->tick);
  vs_frame *frame = &f->frame;
  f->has_frame = false;
  int64_t lost = f->eyes.lost, reopened = f->eyes.reopened;
  vs_status s = vs_eyes_read(&f->eyes, wait_ms(f), frame, &r->got, err);
  if (s != VS_OK || r->got == VS_CAMERA_END) return s;
  f->tick.armed = f->armed;
  f->tick.rearm = f->rearm;
  f->tick.task = f->task;
  if (r->got == VS_CAMERA_FRAME && !vs_field_see(f, frame, r)) r->got = VS_CAMERA_TIMEOUT;
  f->dark = !f->eyes.camera;
  if (f->dark && (f->eyes.lost != lost || strcmp(f->eyes.why, f->why_dark)))
    say(f, r, "camera gone: %s; the robots are stopped, looking for it", f->eyes.why);
  snprintf(f->why_dark, sizeof f->why_dark, "%s", f->eyes.why);
  if (f->eyes.reopened != reopened) say(f, r, "camera back: %s", f->eyes.info.name);
  f->has_frame = r->got == VS_CAMERA_FRAME;
  const vs_frame *got = vs_field_frame(f);
  vs_field_turn(f, got, r);
  if (f->record.bus) vs_field_keep(f, got, r);
  r->now_us = vs_clock_monotonic_us();
  r->silent_us = r->now_us - f->came_us;
  return VS_OK;
}

const vs_tracker *vs_field_tracker(const vs_field *f) { return &f->tracker; }
const vs_camera_info *vs_field_camera(const vs_field *f) { return &f->eyes.info; }
const vs_game *vs_field_game(const vs_field *f) { return &f->game; }
const vs_frame *vs_field_frame(const vs_field *f) { return f->has_frame ? &f->frame : NULL; }
const vs_detections *vs_field_seen(const vs_field *f) { return &f->seen; }
const vs_calib *vs_field_calib(const vs_field *f) { return &f->calib; }
double vs_field_latency_s(const vs_field *f) { return f->stats.latency_s; }
void vs_field_ahead(const vs_field *f, const vs_world *now, vs_world *out) {
  vs_control_ahead(f->control[f->plays], f->def.team, now, out);
}
