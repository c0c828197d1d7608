// PY-VSSS-INF: from a tactic to a command. Each tactic sets only what it needs; the rest of the command stays.
#include "inf.h"

#define KEEPER_X_PX 68.0

static const vs_point their_goal = {640.0, INF_MIDDLE_Y_PX}, past_goal = {INF_PAST_GOAL_X_PX, INF_MIDDLE_Y_PX};

static void go(inf_command *c, vs_point target, double speed) {
  c->kind = INF_GOTO;
  c->target = target;
  c->speed = speed;
}

static void toward(inf_command *c, vs_point point) {
  c->toward_angle = false;
  c->toward = point;
}

// A ball behind the robot is approached around its own side.
static vs_point behind(const inf_state *s, const inf_robot *r) {
  vs_point b = s->ball;
  if (!(b.x < r->at.x - INF_ROBOT_PX)) return b;
  return (vs_point){b.x - 60.0, b.y > INF_MIDDLE_Y_PX ? b.y - 18.0 : b.y + 18.0};
}

// On its place it stands and looks (locked), else it goes there.
static bool arrived(inf_robot *r, vs_point place) {
  if (vs_point_distance(r->at, place) > INF_ROBOT_PX) return false;
  r->locked = true;
  r->command.kind = INF_LOOK;
  return true;
}

static vs_point side_wall(const inf_robot *r) {
  return (vs_point){KEEPER_X_PX, r->at.y > INF_MIDDLE_Y_PX ? INF_HEIGHT_PX : 0.0};
}

// Where the line through the oldest and the newest sample of the ball meets the keeper's line.
static double extrapolated_y(const inf_state *s) {
  vs_point p0 = s->sample[0], p1 = s->sample[s->samples - 1];
  if (p1.x == p0.x) return p1.y;
  return p1.y - (p1.y - p0.y) / (p1.x - p0.x) * (p1.x - KEEPER_X_PX);
}

static void block(const inf_state *s, inf_robot *r) {
  double y = s->ball.y <= 0.0 ? extrapolated_y(s) : s->ball.y; // only a ball at the lower wall is extrapolated
  vs_point place = {KEEPER_X_PX, vs_clamp(y, INF_GOAL_LOW_PX, INF_GOAL_HIGH_PX)};
  r->command.speed = INF_SPEED;
  if (arrived(r, place)) {
    toward(&r->command, (vs_point){KEEPER_X_PX, 0.0});
  } else {
    go(&r->command, place, INF_SPEED);
    toward(&r->command, side_wall(r));
  }
}

static void opening(const inf_state *s, inf_robot *r) {
  double y = vs_clamp(s->ball.y, INF_ROBOT_PX, INF_HEIGHT_PX - INF_ROBOT_PX);
  if (s->ball.x < INF_AREA_X_PX) y = vs_clamp(y, INF_AREA_LOW_PX, INF_AREA_HIGH_PX);
  vs_point place = {INF_AREA_X_PX, y};
  r->command.speed = INF_SPEED;
  if (arrived(r, place)) {
    toward(&r->command, s->ball);
  } else {
    go(&r->command, place, INF_SPEED);
    toward(&r->command, side_wall(r));
  }
}

static void wait_behind(const inf_state *s, inf_robot *r) {
  vs_point b = s->ball, place = {fmax(b.x - 160.0, 56.0), INF_MIDDLE_Y_PX};
  if (arrived(r, place)) {
    toward(&r->command, b);
    return;
  }
  bool same = place.x == b.x && place.y == b.y;
  go(&r->command, place, INF_SPEED);
  toward(&r->command, same ? (vs_point){b.x + 10.0, b.y + 10.0} : b);
}

static void spin(const inf_state *s, inf_robot *r) {
  vs_point p = r->at, b = s->ball;
  r->locked = true;
  r->command.kind = INF_TURN;
  r->command.speed = 1.0;
  if (p.y - INF_ROBOT_PX > b.y)
    r->command.clockwise = false;
  else if (p.y + INF_ROBOT_PX < b.y)
    r->command.clockwise = true;
  else
    r->command.clockwise = p.y > INF_MIDDLE_Y_PX;
  if (b.x > INF_MIDDLE_X_PX && b.y > INF_GOAL_LOW_PX && b.y < INF_GOAL_HIGH_PX) r->command.clockwise = p.y < b.y;
}

static void unlock(const inf_state *s, inf_robot *r) {
  double reach = s->unlock_sign * 100.0;
  // Along the orientation, which is the mirrored heading: the original drives to a mirrored point.
  vs_point target = {r->at.x + reach * cos(r->o_rad), r->at.y + reach * sin(r->o_rad)};
  go(&r->command, target, INF_SPEED);
}

void inf_act(inf_state *s, int robot) {
  inf_robot *r = &s->robot[robot];
  inf_command *c = &r->command;
  r->locked = false;
  switch (r->tactic) {
  case INF_KICK:
    go(c, their_goal, 1.0);
    toward(c, past_goal);
    break;
  case INF_PUSHB:
    go(c, inf_ball_distance(s, robot) < INF_ROBOT_PX ? their_goal : s->ball, INF_SPEED);
    toward(c, past_goal);
    break;
  case INF_CATCH:
    go(c, behind(s, r), INF_SPEED);
    toward(c, past_goal);
    break;
  case INF_SIDE:
    go(c, behind(s, r), INF_SPEED);
    c->toward_angle = true;
    c->angle_rad = s->ball.y > INF_MIDDLE_Y_PX ? VS_PI / 2 : -VS_PI / 2;
    break;
  case INF_BLOCK: block(s, r); break;
  case INF_OPENING: opening(s, r); break;
  case INF_WAIT: wait_behind(s, r); break;
  case INF_SPIN: spin(s, r); break;
  case INF_UNLOCK: unlock(s, r); break;
  case INF_TACTICS: break;
  }
}
