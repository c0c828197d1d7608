// PY-VSSS-INF: which tactic each robot follows: the table of states, the ends of the field, contact with the ball, and
// robots that do not get away.
#include "inf.h"

static inf_tactic of_attacker(const inf_state *s) {
  int a = s->role[INF_ATTACKER];
  switch (s->phase) {
  case INF_ADVANCE:
    if (inf_ball_distance(s, a) < INF_SPIN_PX) return inf_can_kick(s, a) ? INF_KICK : INF_SPIN;
    return INF_CATCH;
  case INF_PUSH:
  case INF_RECOVER: return INF_CATCH;
  case INF_PASS: return INF_OPENING;
  default: return INF_SIDE; // RETURN, DANGER
  }
}

static inf_tactic of_midfielder(const inf_state *s) {
  switch (s->phase) {
  case INF_ADVANCE: return INF_WAIT;
  case INF_RECOVER: return s->ball.x > INF_MIDDLE_X_PX ? INF_PUSHB : INF_BLOCK;
  case INF_PASS: return INF_CATCH;
  default: return INF_OPENING; // PUSH, RETURN, DANGER
  }
}

static void ball_at_our_end(const inf_state *s, inf_tactic tactic[INF_ROLES]) {
  double y = s->ball.y;
  tactic[INF_MIDFIELDER] = INF_OPENING;
  tactic[INF_ATTACKER] = INF_SIDE;
  if (y > INF_AREA_HIGH_PX || y < INF_AREA_LOW_PX) {
    tactic[INF_KEEPER] = INF_BLOCK;
  } else if (y > INF_GOAL_LOW_PX && y < INF_GOAL_HIGH_PX) {
    tactic[INF_KEEPER] = INF_PUSHB;
  } else if (inf_ball_distance(s, s->role[INF_KEEPER]) < INF_ROBOT_PX) {
    tactic[INF_KEEPER] = INF_SPIN;
    tactic[INF_ATTACKER] = INF_OPENING;
  } else {
    tactic[INF_KEEPER] = INF_CATCH;
  }
}

static void ball_at_their_end(const inf_state *s, inf_tactic tactic[INF_ROLES]) {
  tactic[INF_KEEPER] = INF_BLOCK;
  tactic[INF_MIDFIELDER] = INF_WAIT;
  tactic[INF_ATTACKER] = inf_ball_distance(s, s->role[INF_ATTACKER]) < INF_SPIN_PX ? INF_SPIN : INF_CATCH;
}

static void spin_at_contact(const inf_state *s, inf_tactic tactic[INF_ROLES]) {
  for (int r = 0; r < INF_ROLES; r++) {
    bool drives_through = r != INF_KEEPER && (tactic[r] == INF_PUSHB || tactic[r] == INF_KICK);
    if (!drives_through && inf_ball_distance(s, s->role[r]) < INF_SPIN_PX) tactic[r] = INF_SPIN;
  }
}

// A robot that should move and has not for a while spins at the ball or drives away, for some time.
static void free_stuck(inf_state *s, int robot, double dt_s) {
  inf_robot *r = &s->robot[robot];
  bool slow = vs_point_distance(r->at, r->before) < 10.0 * dt_s;
  if (r->locked) {
    r->locked_s = 0.0;
  } else if (r->timer_s <= 0.0 && slow) {
    if (!(r->locked_s > 0.2)) {
      r->locked_s += dt_s;
    } else if (inf_ball_distance(s, robot) < INF_ROBOT_PX) {
      r->tactic = INF_SPIN;
      r->timer_s = 0.5;
    } else {
      r->tactic = INF_UNLOCK;
      r->locked_s = 0.0;
      r->timer_s = 0.8;
      s->unlock_sign = -s->unlock_sign;
    }
  } else if (r->timer_s > 0.0) {
    r->timer_s -= dt_s; // and once more below: the original's clock of a robot that moves runs twice as fast
  } else {
    r->locked_s = 0.0;
  }
}

void inf_choose_tactics(inf_state *s, double dt_s) {
  inf_tactic tactic[INF_ROLES] = {of_attacker(s), of_midfielder(s), INF_BLOCK};
  if (s->ball.x < INF_AREA_X_PX) ball_at_our_end(s, tactic);
  if (s->ball.x > 546.0) ball_at_their_end(s, tactic);
  spin_at_contact(s, tactic);
  for (int i = 0; i < VS_TEAM_SIZE; i++) free_stuck(s, i, dt_s);
  for (int r = 0; r < INF_ROLES; r++) {
    inf_robot *robot = &s->robot[s->role[r]];
    if (robot->timer_s > 0.0)
      robot->timer_s -= dt_s;
    else
      robot->tactic = tactic[r];
  }
}
