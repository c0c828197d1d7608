// EMC-2022: the attacker, and the guard that keeps it out of our area while the keeper is there.
#include "emc22.h"

static const vs_point their_goal_back = {EMC22_LENGTH_M, EMC22_CENTRE_Y_M}, upper_post = {1.62, 0.825},
                      lower_post = {1.62, 0.475};

static bool their_corner(vs_point p) { return p.x >= 1.47 && (p.y >= 0.95 || p.y <= 0.30); }

static bool their_area_side(vs_point p) {
  return p.x > 1.47 && ((p.y >= 0.30 && p.y <= 0.475) || (p.y >= 0.825 && p.y <= 0.95));
}

static bool any_side(vs_point p) { return p.y <= 0.1 || p.y >= 1.2; }

static void go_to(emc22_robot *r, vs_point target, double speed_mps) {
  emc_go_to(&r->command, r->at, target, speed_mps);
}

// The line from the robot through the ball meets their goal, give or take 5 degrees.
static bool can_run(const emc22_state *s, vs_point p) {
  double line = vs_point_angle(p, s->ball);
  return vs_wrap_rad(vs_point_angle(s->ball, upper_post) - line) > -vs_rad(5) &&
         vs_wrap_rad(vs_point_angle(s->ball, lower_post) - line) < vs_rad(5);
}

static void advance_uvf(emc22_state *s, vs_point p) {
  double d = vs_point_distance(p, s->ball);
  double error = fabs(vs_wrap_rad(vs_point_angle(p, s->ball) - vs_point_angle(s->ball, their_goal_back)));
  switch (s->uvf) {
  case EMC22_SEEK:
    if (can_run(s, p)) s->uvf = EMC22_CLOSE;
    break;
  case EMC22_CLOSE:
    if (error > vs_rad(90))
      s->uvf = EMC22_SEEK;
    else if (d < 0.1)
      s->uvf = EMC22_HAS;
    break;
  case EMC22_HAS:
    if (error > vs_rad(90) || d > 0.25) s->uvf = EMC22_SEEK;
    break;
  }
}

// From which direction to arrive at the ball: with it where it rolls forward, against it where it comes.
static double arrival(const emc22_state *s) {
  double speed = hypot(s->velocity_mps.x, s->velocity_mps.y);
  if (!(speed > 0.02)) return vs_point_angle(s->ball, their_goal_back);
  double direction = atan2(s->velocity_mps.y, s->velocity_mps.x);
  bool with_it = fabs(direction) < VS_PI / 2 && speed > 0.05;
  return with_it ? direction : vs_wrap_rad(direction + VS_PI);
}

static void attack_goal(emc22_state *s, emc22_robot *a) {
  advance_uvf(s, a->at);
  switch (s->uvf) {
  case EMC22_SEEK: emc_go_pose(&a->command, s->ball, arrival(s), EMC22_SPEED_MPS); break;
  case EMC22_CLOSE: go_to(a, s->ball, EMC22_SPEED_MPS); break;
  case EMC22_HAS: go_to(a, their_goal_back, 1.5); break;
  }
}

static void attack_side(emc22_state *s, emc22_robot *a) {
  double d = vs_point_distance(a->at, s->ball);
  if (a->at.x < s->ball.x - 0.01 && d > 0.07)
    go_to(a, s->ball, EMC22_SPEED_MPS);
  else if (d <= 0.07 && a->at.x < s->ball.x)
    emc22_spin_kick(s, a);
  else
    emc_go_pose(&a->command, s->ball, s->ball.y > EMC22_CENTRE_Y_M ? VS_PI / 4 : -VS_PI / 4, EMC22_SPEED_MPS);
}

static void behave(emc22_state *s, emc22_robot *a) {
  vs_point p = a->at, ball = s->ball;
  double d = vs_point_distance(p, ball);
  bool kick = s->foul == EMC22_KICKOFF || (s->foul == EMC22_PENALTY && s->foul_ours);
  if (kick && emc22_fresh(s)) {
    go_to(a, ball, 2.0);
  } else if (their_corner(p)) {
    if (d >= EMC22_SIZE_M)
      go_to(a, ball, EMC22_SPEED_MPS);
    else
      emc22_spin_kick(s, a);
  } else if (d < EMC22_CONTACT_M && their_area_side(p)) {
    emc22_spin_kick(s, a);
  } else if (any_side(ball)) {
    attack_side(s, a);
  } else if (ball.x < 0.23 && !emc22_any_goal(p)) {
    if (d < EMC22_CONTACT_M)
      emc22_spin_kick(s, a);
    else
      emc22_go_stop(a, 0.155, ball.y >= EMC22_CENTRE_Y_M ? 1.03 : 0.22);
  } else {
    attack_goal(s, a);
  }
}

// The ball is in our area, was a tenth of a second ago or will be within a second.
static bool ball_visits_area(const emc22_state *s) {
  if (emc22_our_area(s->ball)) return true;
  for (int k = -20; k < 200; k++)
    if (emc22_our_area(emc22_ball_at(s, 0.005 * k))) return true;
  return false;
}

// Driving on straight towards its stored target for a tenth of a second.
static bool runs_into_area(const emc22_robot *a) {
  double direction = vs_point_angle(a->at, a->command.target);
  for (int k = 0; k < 20; k++) {
    double way = a->command.speed_mps * 0.005 * k;
    if (emc22_our_area((vs_point){a->at.x + way * cos(direction), a->at.y + way * sin(direction)})) return true;
  }
  return false;
}

// The last 0.1 m before a UVF target pass through our area. (The original also asks for the corner of ours opposite to
// the target's, which is 0.65 m away.)
static bool approach_crosses_area(const emc_command *c) {
  for (int k = 50; k > 0; k--) {
    double way = 0.002 * k;
    vs_point p = {c->target.x - way * cos(c->angle_rad), c->target.y - way * sin(c->angle_rad)};
    if (emc22_our_area(p)) return true;
  }
  return false;
}

static bool target_in_area(const emc_command *c) {
  switch (c->kind) {
  case EMC_POSITION:
  case EMC_VECTOR: return emc22_our_area(c->target);
  case EMC_UVF: return emc22_our_area(c->target) || approach_crosses_area(c);
  default: return false;
  }
}

static void guard_area(const emc22_state *s, emc22_robot *a) {
  if (!emc22_our_area(s->robot[s->role[EMC22_KEEPER]].at) || emc22_our_area(a->at)) return;
  if (ball_visits_area(s) || runs_into_area(a))
    emc_stop(&a->command);
  else if (!emc22_fresh(s) && target_in_area(&a->command))
    emc_stop(&a->command);
}

void emc22_attack(emc22_state *s) {
  emc22_robot *a = &s->robot[s->role[EMC22_ATTACKER]];
  behave(s, a);
  guard_area(s, a);
}
