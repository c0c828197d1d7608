// The worlds the referee's tests judge: everybody in midfield on their own side, the ball where the test puts it.
#ifndef VSSS_TESTS_REFEREE_WORLD_H
#define VSSS_TESTS_REFEREE_WORLD_H

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/referee.h"

#define FRAME_S (1.0 / 30)

static inline vs_world quiet_world(double ball_x_m, double ball_y_m) {
  vs_world w = {0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    w.robot[VS_BLUE][i].pose = (vs_pose){-0.4, 0.2 * (i - 1), 0};
    w.robot[VS_YELLOW][i].pose = (vs_pose){0.4, 0.2 * (i - 1), 0};
  }
  w.ball.x_m = ball_x_m;
  w.ball.y_m = ball_y_m;
  w.ball.z_m = VS_BALL_RADIUS_M;
  return w;
}

static inline void put(vs_world *w, vs_team team, int robot, double x_m, double y_m) {
  w->robot[team][robot].pose.x_m = x_m;
  w->robot[team][robot].pose.y_m = y_m;
}

static inline vs_referee referee_of(vs_rules rules, const vs_world *start) {
  vs_referee_def def = vs_referee_def_default(rules);
  vs_referee r;
  assert_ok(vs_referee_init(&r, &def, err));
  vs_referee_restarted(&r, start);
  return r;
}

// Steps the same world until something happens, at most limit_s; returns that event and for how long it took.
static inline vs_event wait_for_event(vs_referee *r, const vs_world *w, double limit_s, double *took_s) {
  vs_event event = {.kind = VS_EVENT_NONE};
  int frames = 0;
  while (event.kind == VS_EVENT_NONE && frames * FRAME_S < limit_s) {
    event = vs_referee_step(r, w, FRAME_S);
    frames++;
  }
  *took_s = frames * FRAME_S;
  return event;
}

static inline void assert_event(vs_event event, vs_event_kind kind, vs_team team, int quadrant) {
  if (event.kind != kind) fail_msg("event is '%s', expected '%s'", vs_event_name(event.kind), vs_event_name(kind));
  if (event.team != team) fail_msg("event is for %s, expected %s", vs_team_name(event.team), vs_team_name(team));
  assert_int_equal(event.quadrant, quadrant);
}

#endif
