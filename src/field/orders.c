#include "field_internal.h"

#include <math.h>
#include <string.h>

#include "vsss/clock.h"
#include "vsss/referee.h"

#define FAULT_REST_US 1000000

void vs_field_arm(vs_field *f, bool go) {
  f->rearm = go;
  if (f->armed == go) return;
  f->armed = go;
  if (go) return;
  const vs_wheels still[VS_TEAM_SIZE] = {{0}};
  vs_field_send(f, still, true, vs_clock_monotonic_us(), true); // not only with the next frame
}

static void obey_referee(vs_field *f, vs_event_kind kind) {
  bool restart =
      kind == VS_EVENT_KICK_OFF || kind == VS_EVENT_PENALTY || kind == VS_EVENT_FREE_BALL || kind == VS_EVENT_GOAL_KICK;
  if (restart) vs_field_arm(f, true);
  if (kind == VS_EVENT_HALF_TIME) vs_field_arm(f, false);
}

void vs_field_set_task(vs_field *f, vs_field_task task) {
  if (task != f->task) f->last_decision_us = 0; // none was missed while nobody decided
  f->task = task;
}

void vs_field_tell(vs_field *f, const vs_event *event) {
  f->told = *event;
  f->is_told = true;
}

// Where the robots belong at the last restart.
static void choose_places(vs_field *f) {
  vs_place_team(VS_3V3, &f->game.last_event, f->def.team, f->place);
  f->go_to = (vs_go_to){.delay_s = f->stats.latency_s};
}

// A network referee tells neither score nor duration.
static void hear_told(vs_field *f) {
  f->is_told = false;
  vs_event event = f->told;
  if (event.kind == VS_EVENT_NONE) {
    event = f->game.last_event;
    event.time_s = f->told.time_s;
  }
  f->tap.heard = (vs_msg_referee){.event = event, .duration_s = f->game.duration_s};
  memcpy(f->tap.heard.score, f->game.score, sizeof f->game.score);
  f->tap.heard_us = vs_clock_monotonic_us();
}

// A FAULT is left by being released again; where nobody is there to do so, after a second.
bool vs_field_is_armed(vs_field *f, int64_t now_us) {
  bool fault = f->safety.state == VS_SAFETY_FAULT;
  bool again = fault && (f->rearm || (f->def.go && now_us - f->safety.since_us > FAULT_REST_US));
  f->rearm = false;
  return f->armed && !again;
}

// What a referee said: where play restarts the past counts no more.
void vs_field_hear(vs_field *f, int64_t now_us) {
  vs_tick *t = &f->tick;
  if (f->def.rerun) {
    f->tap.heard = t->referee;
    f->tap.heard_us = t->heard ? t->heard_us : f->tap.heard_us;
  } else {
    t->heard = vs_tap_listen(&f->tap) || f->is_told;
    if (f->is_told) hear_told(f);
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
    choose_places(f);
    vs_track_restart(&f->tracker);
    for (int i = 0; i < 2 && f->control[i]; i++) vs_control_restart(f->control[i]);
  }
  if (!f->start_us) return;
  double from_s = f->tap.heard_us ? f->game.last_event.time_s : 0.0;
  int64_t since_us = now_us - (f->tap.heard_us ? f->tap.heard_us : f->start_us);
  f->game.time_s = fmin(from_s + 1e-6 * (double)since_us, f->game.duration_s);
}
