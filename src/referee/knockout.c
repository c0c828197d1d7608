// When a half, a match, its extra time and its shoot-out are over.
#include <stdlib.h>

#include "referee_internal.h"

static bool is_last(const vs_referee *r) {
  return r->half == VS_HALF_EXTRA_2 || (r->half < VS_HALF_EXTRA_1 && r->half + 1 == r->def.halves);
}

static double half_end_s(const vs_referee *r) {
  if (r->half < VS_HALF_EXTRA_1) return r->def.duration_s * (r->half + 1) / r->def.halves;
  return r->def.duration_s + r->def.extra_half_s * (r->half - VS_HALF_EXTRA_1 + 1);
}

static bool undecided(const vs_referee *r) {
  return r->def.knockout && r->game.score[VS_BLUE] == r->game.score[VS_YELLOW];
}

bool vs_rule_time(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (!vs_reached(r->game.time_s, half_end_s(r), f->dt_s)) return false;
  if (!is_last(r)) {
    event->kind = VS_EVENT_HALF_TIME;
    event->team = vs_other_team(r->def.kick_off);
  } else if (undecided(r)) {
    event->kind = r->half < VS_HALF_EXTRA_1 && r->def.extra_half_s > 0 ? VS_EVENT_EXTRA_TIME : VS_EVENT_SHOOT_OUT;
    event->team = r->def.kick_off;
  } else {
    event->kind = VS_EVENT_END;
  }
  return true;
}

bool vs_ended_by_goal(const vs_referee *r, double dt_s) {
  int difference = abs(r->game.score[VS_BLUE] - r->game.score[VS_YELLOW]);
  if (r->def.end_at_first_goal) return true;
  if (r->def.goal_difference_stop > 0 && difference >= r->def.goal_difference_stop) return true;
  return is_last(r) && vs_reached(r->game.time_s, half_end_s(r), dt_s) && !undecided(r);
}

static void begin_kick(vs_referee *r, vs_team team) {
  r->half = VS_HALF_SHOOT_OUT;
  r->kick_off = team;
  r->kick_s = 0;
  r->game.duration_s = r->game.time_s + r->def.kick_s;
}

void vs_extend(vs_referee *r, const vs_event *event) {
  if (event->kind == VS_EVENT_EXTRA_TIME) {
    r->half = VS_HALF_EXTRA_1;
    r->kick_off = event->team;
    r->game.duration_s = r->def.duration_s + 2 * r->def.extra_half_s;
  } else if (event->kind == VS_EVENT_SHOOT_OUT) {
    begin_kick(r, event->team);
  }
}

// Ahead by more than the other can still score: of the first kicks, then of each pair.
static int shoot_out_winner(const vs_referee *r) {
  int left[VS_TEAMS], most = r->kicks[VS_BLUE] > r->kicks[VS_YELLOW] ? r->kicks[VS_BLUE] : r->kicks[VS_YELLOW];
  if (most < VS_SHOOT_OUT_KICKS) most = VS_SHOOT_OUT_KICKS;
  for (int t = 0; t < VS_TEAMS; t++) left[t] = most - r->kicks[t];
  for (int t = 0; t < VS_TEAMS; t++)
    if (r->kicks_scored[t] > r->kicks_scored[!t] + left[!t]) return t;
  return -1;
}

void vs_shoot_out_step(vs_referee *r, const vs_world *world, const vs_facts *f, vs_event *event) {
  int team = r->kick_off;
  r->kick_s += f->dt_s;
  if (f->scorer < 0 && !f->ball_out && !vs_reached(r->kick_s, r->def.kick_s, f->dt_s)) return;
  r->kicks[team]++;
  r->kicks_scored[team] += f->scorer == team;
  bool pairs = r->kicks[VS_BLUE] == r->kicks[VS_YELLOW];
  if (shoot_out_winner(r) < 0 && pairs && r->kicks[team] >= VS_SHOOT_OUT_MOST) // a coin: the world's bits
    r->lot = 1 + (int)(vs_world_hash(VS_HASH_START, world) >> 32 & 1);
  r->over = shoot_out_winner(r) >= 0 || r->lot;
  event->kind = r->over ? VS_EVENT_END : VS_EVENT_SHOOT_OUT;
  if (!r->over) begin_kick(r, event->team = vs_other_team(team));
  r->game.last_event = *event;
}

int vs_referee_winner(const vs_referee *r) {
  const int *score = r->game.score;
  if (!r->over) return -1;
  if (score[VS_BLUE] != score[VS_YELLOW]) return score[VS_BLUE] > score[VS_YELLOW] ? VS_BLUE : VS_YELLOW;
  return r->lot ? r->lot - 1 : shoot_out_winner(r);
}
