// One run of the field: what its files share. field_open.c opens and closes it, field_loop.c takes each frame to the wheels,
// orders.c says whether the robots may move, field_stats.c counts, rerun.c keeps a run and computes it again.
#ifndef VSSS_FIELD_INTERNAL_H
#define VSSS_FIELD_INTERNAL_H

#include "eyes.h"
#include "moved.h"
#include "record.h"
#include "tap.h"
#include "vsss/control.h"
#include "vsss/field_loop.h"
#include "vsss/go_to.h"
#include "vsss/latency_meter.h"
#include "vsss/sender.h"

struct vs_field {
  vs_field_def def;
  vs_eyes eyes;
  vs_calib calib;
  vs_detector *detector;
  vs_moved moved; // whether the camera did
  vs_tracker tracker;
  vs_latency_meter *meter; // NULL: the latency is told
  vs_control *control[2];  // the policy's and the fallback's (NULL: none)
  int plays;               // which of them
  bool armed, rearm;       // the operator lets the robots move; and just said so again
  vs_field_task task;      // by a network referee
  vs_event told;           // its call,
  bool is_told;            // to be heard with the next turn
  vs_pose place[VS_TEAM_SIZE];
  vs_go_to go_to;    // to those
  bool mindless;     // it failed and has not decided since
  vs_sender *sender; // NULL: a run computed again
  vs_tap tap;
  vs_record record;
  vs_tick tick;   // what this turn was given so far; computed again: what it is given
  int clock_used; // of its readings, computed again
  bool dark;      // the camera is gone
  vs_game game;   // absolute frame
  vs_safety safety;
  int64_t start_us, last_decision_us;
  int64_t step_us;              // moment of the world that control was stepped with last; 0: none yet
  int64_t came_us, awake_us;    // when the last frame came; when a missing one is bridged
  double loss;                  // share of the last second's frames that were lost, before the gap that is open now
  vs_wheels kept[VS_TEAM_SIZE]; // what the robots were told last, while they ran
  uint32_t last_seq;
  vs_frame frame; // of this tick
  bool has_frame;
  vs_detections seen;
  char said[400], why_dark[sizeof((vs_eyes *)0)->why]; // the last lines of each kind
  int64_t mark_us;                                     // end of the last stage
  vs_field_stats stats;
  vs_histogram second[VS_STAGES]; // of the present second
};

// orders.c: whether the robots may move now, and what a referee says, which restarts the past and the match's clock.
bool vs_field_is_armed(vs_field *f, int64_t now_us);
void vs_field_hear(vs_field *f, int64_t now_us);

// field_loop.c: a frame's way into r->world; false: it cannot be read, its camera was given up. Then the rest of the turn,
// with the frame, or without one (NULL).
bool vs_field_see(vs_field *f, const vs_frame *frame, vs_field_tick_result *r);
void vs_field_turn(vs_field *f, const vs_frame *frame, vs_field_tick_result *r);
void vs_field_send(vs_field *f, const vs_wheels wheels[VS_TEAM_SIZE], bool stop, int64_t moment_us, bool now);

// field_stats.c: the end of a stage; a duration of one; a frame taken in; a decision made on a frame.
void vs_field_mark(vs_field *f, vs_stage stage);
void vs_field_count(vs_field *f, vs_stage stage, int64_t duration_us, int64_t now_us);
void vs_field_count_frame(vs_field *f, const vs_frame *frame);
void vs_field_count_decision(vs_field *f, int64_t capture_us);

// rerun.c: the monotonic clock of all that is decided by time, kept and given again; the turn that was, into the record.
int64_t vs_field_clock_us(vs_field *f);
void vs_field_keep(vs_field *f, const vs_frame *frame, const vs_field_tick_result *r);

#endif
