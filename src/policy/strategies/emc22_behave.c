// EMC-2022: defender and goalkeeper.
#include "emc22.h"

#define BACK_X_M   0.32 // the defender's line
#define KEEPER_X_M 0.17
#define GOAL_HIGH  0.825
#define GOAL_LOW   0.475
#define REACH_M    0.083

static bool upper(vs_point p) { return p.y >= EMC22_CENTRE_Y_M; }

static void wait_at(const emc22_state *s, emc22_robot *r, double x, double y) {
  if (vs_point_distance(r->at, (vs_point){x, y}) > EMC22_ARRIVAL_M)
    emc22_go_stop(r, x, y);
  else
    emc_face(&r->command, r->at, s->ball, EMC22_SPEED_MPS);
}

void emc22_defend(emc22_state *s) {
  emc22_robot *d = &s->robot[s->role[EMC22_DEFENDER]];
  vs_point attacker = s->robot[s->role[EMC22_ATTACKER]].at, ball = s->ball;
  if (ball.x < 0.28 || (ball.x < 0.53 && vs_point_distance(attacker, ball) < 0.1))
    wait_at(s, d, BACK_X_M, upper(ball) ? GOAL_LOW : GOAL_HIGH);
  else if (emc22_ball_at(s, 0.35).x > 0.92 && !emc22_any_goal(d->at))
    wait_at(s, d, attacker.x - 0.40, vs_clamp(emc22_ball_at(s, 1.0).y, 0.325, 0.975));
  else if (emc22_any_goal(d->at))
    emc22_go_stop(d, EMC22_CENTRE_X_M, EMC22_CENTRE_Y_M);
  else if (vs_point_distance(d->at, ball) < EMC22_SIZE_M)
    emc22_spin_kick(s, d);
  else if (ball.x >= d->at.x)
    emc22_go_stop(d, BACK_X_M, ball.y);
  else
    emc22_go_stop(d, BACK_X_M, upper(ball) ? GOAL_HIGH : GOAL_LOW);
}

// As go_stop, but on its place the keeper turns along its goal.
static void keeper_go(emc22_robot *g, vs_point place) {
  if (vs_point_distance(g->at, place) >= EMC22_ARRIVAL_M) {
    emc22_go_stop(g, place.x, place.y);
    return;
  }
  g->command.kind = EMC_ORIENTATION;
  g->command.angle_rad = VS_PI / 2;
  g->command.speed_mps = EMC22_SPEED_MPS;
}

// Where a line through the ball meets the keeper's line. With the ball behind that line it is the mirror point: the
// original measures the distance without its sign.
static vs_point meets_keeper_line(vs_point ball, double direction_rad) {
  double way = fabs(ball.x - KEEPER_X_M) / cos(VS_PI - direction_rad);
  return (vs_point){ball.x + way * cos(direction_rad), ball.y + way * sin(direction_rad)};
}

static void keep_penalty(emc22_state *s, emc22_robot *g) {
  double y = s->ball.y;
  int shooter = -1;
  for (int i = 0; i < s->adversaries; i++)
    if (shooter < 0 || vs_point_distance(s->adversary[i], s->ball) < vs_point_distance(s->adversary[shooter], s->ball))
      shooter = i;
  if (shooter >= 0) y = meets_keeper_line(s->ball, vs_point_angle(s->adversary[shooter], s->ball)).y;
  vs_point place = {0.145, vs_clamp(y, EMC22_CENTRE_Y_M - 0.15, EMC22_CENTRE_Y_M + 0.15)};
  if (vs_point_distance(g->at, place) < 0.04)
    emc22_spin_kick(s, g);
  else
    keeper_go(g, place);
}

static vs_point keeper_place(const emc22_state *s) {
  vs_point ball = s->ball, v = s->velocity_mps, place = {KEEPER_X_M, ball.y};
  if (ball.x >= 0.08 && ball.x <= 0.253 && (ball.y >= GOAL_HIGH || ball.y <= GOAL_LOW))
    return (vs_point){KEEPER_X_M, ball.y > EMC22_CENTRE_Y_M ? 0.935 : 0.365};
  double direction = atan2(v.y, v.x);
  if (fabs(direction) > VS_PI / 2 && hypot(v.x, v.y) > 0.005) place = meets_keeper_line(ball, direction);
  if (place.y > GOAL_HIGH) return (vs_point){KEEPER_X_M, GOAL_HIGH};
  if (place.y < GOAL_LOW) return (vs_point){KEEPER_X_M, GOAL_LOW};
  return place;
}

// The ball passes within reach of a keeper that stands on its place, and within a second.
static bool ball_comes(const emc22_state *s, const emc22_robot *g, vs_point place) {
  vs_point v = s->velocity_mps, to = {g->at.x - s->ball.x, g->at.y - s->ball.y};
  double speed = hypot(v.x, v.y);
  if (!(speed > hypot(to.x, to.y))) return false;
  double along = (to.x * v.x + to.y * v.y) / speed, off = fabs(to.x * v.y - to.y * v.x) / speed;
  return off < REACH_M && along > 0.0 && vs_point_distance(g->at, place) < 0.03;
}

static void keep(emc22_state *s, emc22_robot *g) {
  if (emc22_penalty_against(s)) {
    keep_penalty(s, g);
    return;
  }
  if (emc22_any_goal(g->at)) {
    emc22_go_stop(g, 0.155, EMC22_CENTRE_Y_M);
    return;
  }
  vs_point place = keeper_place(s);
  if (vs_point_distance(g->at, s->ball) < REACH_M || ball_comes(s, g, place))
    emc22_spin_kick(s, g);
  else
    keeper_go(g, place);
}

void emc22_keep(emc22_state *s) {
  emc22_robot *g = &s->robot[s->role[EMC22_KEEPER]];
  keep(s, g);
  bool attacker_there = emc22_our_area(s->robot[s->role[EMC22_ATTACKER]].at) && !emc22_our_area(g->at);
  bool drives = g->command.kind == EMC_POSITION || g->command.kind == EMC_VECTOR;
  if (attacker_there && drives && emc22_our_area(g->command.target)) emc_stop(&g->command);
}
