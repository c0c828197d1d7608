// EMC-2019: what each role does. Regions and points are the strategy's own numbers, in its frame.
#include "emc.h"

#define ARRIVAL_M  0.03
#define AREA_X_M   0.155 // the line in front of our goal
#define BOX_LOW_M  0.45
#define BOX_HIGH_M 0.81
#define OWN_END_M  0.23 // front of our area
#define BACK_X_M   0.36 // the defender's line

static const vs_point their_goal = {1.62, 0.63}, centre = {EMC_CENTRE_X_M, EMC_CENTRE_Y_M};

static bool upper(vs_point p) { return p.y >= EMC_CENTRE_Y_M; }
static bool our_field(vs_point p) { return p.x < EMC_CENTRE_X_M; }
static bool our_box(vs_point p) { return p.x >= 0.08 && p.x <= OWN_END_M && p.y >= BOX_LOW_M && p.y <= BOX_HIGH_M; }
static bool our_upper_corner(vs_point p) { return p.x < OWN_END_M && p.y > 0.95; }
static bool our_lower_corner(vs_point p) { return p.x < OWN_END_M && p.y < 0.30; }
static bool any_side(vs_point p) { return p.y <= 0.1 || p.y >= 1.16; }
static bool any_goal(vs_point p) { return p.x <= 0.11 || p.x >= 1.51; }

bool emc_their_corner(vs_point p) { return p.x >= 1.39 && (p.y >= 0.95 || p.y <= 0.30); }

static bool their_area_side(vs_point p) {
  return p.x > 1.39 && ((p.y >= 0.30 && p.y <= 0.455) || (p.y >= 0.805 && p.y <= 0.95));
}

static void go_stop(emc_role *r, double x, double y) {
  emc_go_stop(&r->command, r->at, (vs_point){x, y}, EMC_SPEED_MPS, ARRIVAL_M);
}

static void go_to(emc_role *r, vs_point target) { emc_go_to(&r->command, r->at, target, EMC_SPEED_MPS); }

static void spin(emc_role *r, bool counter_clockwise) {
  emc_spin(&r->command, counter_clockwise ? EMC_SPIN_RADPS : -EMC_SPIN_RADPS);
}

// Which way to spin so that the ball leaves towards their goal.
static void decide_spin(emc_role *r, vs_point ball) {
  double a = vs_point_angle(r->at, ball);
  if (upper(r->at))
    spin(r, a < -VS_PI / 2);
  else
    spin(r, !(a > VS_PI / 2));
}

static void keeper_shot(emc_role *g, vs_point ball) {
  if (ball.x > g->at.x + 0.04)
    spin(g, upper(g->at));
  else if (ball.x > g->at.x - 0.02)
    spin(g, !(ball.y > g->at.y));
  else
    emc_stop(&g->command); // the ball is behind
}

static void keeper(emc_state *s) {
  emc_role *g = &s->role[EMC_KEEPER];
  vs_point ball = s->ball, ahead = s->ahead;
  if (vs_point_distance(g->at, ball) < EMC_CONTACT_M && !any_goal(g->at)) {
    keeper_shot(g, ball);
  } else if (any_goal(g->at)) {
    go_stop(g, AREA_X_M, 0.63);
  } else if (our_upper_corner(ball)) {
    go_stop(g, AREA_X_M, 0.95);
  } else if (our_lower_corner(ball)) {
    go_stop(g, AREA_X_M, 0.30);
  } else {
    bool coming = ahead.x < ball.x && vs_point_distance(ball, ahead) > 0.03;
    go_stop(g, AREA_X_M, vs_clamp(coming ? ahead.y : ball.y, BOX_LOW_M, BOX_HIGH_M));
  }
}

static void defender_waits(emc_state *s, emc_role *d) {
  vs_point place = {1.0044, upper(s->ball) ? 0.305 : 0.955};
  if (vs_point_distance(d->at, place) > ARRIVAL_M)
    go_stop(d, place.x, place.y);
  else
    emc_face(&d->command, d->at, s->ball, EMC_SPEED_MPS);
}

static void defender(emc_state *s) {
  emc_role *d = &s->role[EMC_DEFENDER];
  vs_point ball = s->ball;
  if (s->role[EMC_ATTACKER].at.x < 0.486)
    emc_stop(&d->command);
  else if (s->ahead.x > 1.31 && !any_goal(d->at))
    defender_waits(s, d);
  else if (any_goal(d->at))
    emc_heading(&d->command, 0.8, EMC_SPEED_MPS); // the original passes a size where it means an angle
  else if (vs_point_distance(d->at, ball) < EMC_CONTACT_M)
    decide_spin(d, ball);
  else if (ball.x >= d->at.x)
    go_stop(d, BACK_X_M, ball.y);
  else
    go_stop(d, BACK_X_M, upper(ball) ? 0.955 : 0.305);
}

// UVF to the goal: get behind the ball (SEEK), run at it (CLOSE), push it (HAS). One step at most per tick.
static void advance_uvf(emc_state *s, vs_point p, vs_point target, double error_rad) {
  double d = vs_point_distance(p, s->ball);
  switch (s->uvf) {
  case EMC_SEEK:
    if (error_rad < vs_rad(25) && p.x < target.x && d < 0.15) s->uvf = EMC_CLOSE;
    break;
  case EMC_CLOSE:
    if (error_rad > vs_rad(70))
      s->uvf = EMC_SEEK;
    else if (d < 0.7)
      s->uvf = EMC_HAS;
    break;
  case EMC_HAS:
    if (error_rad > vs_rad(70) || d > 0.15) s->uvf = EMC_SEEK;
    break;
  }
}

static void attack_goal(emc_state *s, emc_role *a) {
  vs_point ball = s->ball;
  vs_point target = {ball.x + 0.2 * (s->ahead.x - ball.x), ball.y + 0.2 * (s->ahead.y - ball.y)};
  double to_goal = vs_point_angle(ball, their_goal);
  advance_uvf(s, a->at, target, fabs(vs_wrap_rad(vs_point_angle(a->at, ball) - to_goal)));
  switch (s->uvf) {
  case EMC_SEEK: emc_go_pose(&a->command, target, to_goal, EMC_SPEED_MPS); break;
  case EMC_CLOSE: go_to(a, ball); break;
  case EMC_HAS: go_to(a, their_goal); break;
  }
}

static void attack_side(emc_role *a, vs_point ball) {
  double d = vs_point_distance(a->at, ball);
  bool high = ball.y > EMC_CENTRE_Y_M;
  if (a->at.x < ball.x - 0.01 && d > 0.065)
    go_to(a, ball);
  else if (d <= 0.065 && a->at.x < ball.x)
    spin(a, !high);
  else
    emc_go_pose(&a->command, ball, high ? VS_PI / 4 : -VS_PI / 4, EMC_SPEED_MPS);
}

static void leave_goal(emc_role *a, vs_point ball) {
  if (!our_field(a->at) && ball.x > a->at.x)
    emc_heading(&a->command, 0.0, EMC_SPEED_MPS);
  else
    go_to(a, centre);
}

static void attacker(emc_state *s) {
  emc_role *a = &s->role[EMC_ATTACKER];
  vs_point ball = s->ball, p = a->at, defends = s->role[EMC_DEFENDER].at;
  double d = vs_point_distance(p, ball);
  if (ball.x < 0.486 && p.x > 0.486) {
    go_stop(a, 0.5022, upper(defends) ? fmin(0.1, defends.y - 0.5) : fmin(0.76, defends.y + 0.15));
  } else if (emc_their_corner(p)) {
    if (d >= EMC_CONTACT_M)
      go_to(a, ball);
    else
      decide_spin(a, ball);
  } else if (d < EMC_CONTACT_M && their_area_side(p)) {
    decide_spin(a, ball);
  } else if (our_box(p)) {
    emc_heading(&a->command, vs_point_angle(p, ball), 1.2);
  } else if (ball.x < OWN_END_M && !any_goal(p)) {
    if (d < EMC_CONTACT_M)
      spin(a, !upper(ball));
    else
      go_stop(a, AREA_X_M, upper(ball) ? 1.03 : 0.22);
  } else if (any_side(ball)) {
    attack_side(a, ball);
  } else if (any_goal(p)) {
    leave_goal(a, ball);
  } else {
    attack_goal(s, a);
  }
}

// Keeps attacker and defender out of our box. The stored targets may be of an older command: that is the original's.
static void overrides(emc_state *s) {
  emc_role *a = &s->role[EMC_ATTACKER], *d = &s->role[EMC_DEFENDER];
  if (s->role[EMC_KEEPER].at.x >= EMC_CENTRE_X_M) {
    go_to(a, s->ball);
    return;
  }
  if (our_box(a->at))
    emc_heading(&a->command, 0.8, EMC_SPEED_MPS);
  else if (our_box(a->command.target) || (a->command.target.x < 0.45 && a->at.x > 0.45))
    emc_stop(&a->command);
  if (our_box(d->at)) emc_heading(&d->command, 0.8, EMC_SPEED_MPS);
  if (our_box(d->command.target)) emc_stop(&d->command);
}

void emc_behave(emc_state *s) {
  keeper(s);
  defender(s);
  attacker(s);
  overrides(s);
}
