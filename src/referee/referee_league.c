// The rules of the league's automatic referee, one function a row. A play in an area begins when the ball comes in and
// ends when it leaves or goes into the goal; fouls in it are judged after 3 s or at its end.
#include "referee_internal.h"

static void foul_clock(bool now, double time_s, double dt_s, double *lasted_s, double *seen_s) {
  *lasted_s = now ? *lasted_s + dt_s : 0;
  if (now) *seen_s = time_s;
}

void vs_league_clocks(vs_referee *r, vs_facts *f) {
  // A ball that rolls into or out of an area slowly starts the stillness clock anew.
  bool slow = f->ball_mps <= VS_LEAGUE_STUCK_MPS && f->area == r->play_area;
  r->still_s = slow ? r->still_s + f->dt_s : 0;
  if (f->area != r->play_area) {
    f->ended_play = r->play_area;
    r->play_area = f->area;
    r->defence_s = r->attack_s = 0;
  }
  if (f->area < 0) return;
  foul_clock(f->defenders >= 2, r->game.time_s, f->dt_s, &r->defence_s, &r->defence_seen_s);
  foul_clock(f->attackers >= 2, r->game.time_s, f->dt_s, &r->attack_s, &r->attack_seen_s);
}

static bool call(vs_event *event, vs_event_kind kind, int team, int quadrant) {
  event->kind = kind;
  event->team = (vs_team)team;
  event->quadrant = kind == VS_EVENT_GOAL_KICK || kind == VS_EVENT_FREE_BALL ? quadrant : 0;
  return true;
}

// A goal counts, even if the defenders fouled, unless the attackers did; where both did, the later foul is called.
static bool goal(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->scorer < 0) return false;
  if (r->attack_seen_s < 0) return call(event, VS_EVENT_GOAL, f->scorer, 0);
  if (r->attack_seen_s >= r->defence_seen_s)
    return call(event, VS_EVENT_GOAL_KICK, vs_other_team(f->scorer), f->quadrant);
  return call(event, VS_EVENT_PENALTY, f->scorer, 0);
}

static bool play_ended(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->ended_play < 0 || (r->attack_seen_s < 0 && r->defence_seen_s < 0)) return false;
  if (r->attack_seen_s >= r->defence_seen_s) return call(event, VS_EVENT_GOAL_KICK, f->ended_play, f->quadrant);
  return call(event, VS_EVENT_PENALTY, vs_other_team(f->ended_play), 0);
}

static bool defenders_stay(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->area < 0 || !vs_reached(r->defence_s, VS_LEAGUE_FOUL_S, f->dt_s)) return false;
  return call(event, VS_EVENT_PENALTY, vs_other_team(f->area), 0);
}

static bool attackers_stay(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->area < 0 || !vs_reached(r->attack_s, VS_LEAGUE_FOUL_S, f->dt_s)) return false;
  return call(event, VS_EVENT_GOAL_KICK, f->area, f->quadrant);
}

// Both teams are at the ball: the defenders may kick it off. Nobody, or one side alone: they should have cleared it.
static bool stuck_in_area(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->area < 0 || !vs_reached(r->still_s, VS_LEAGUE_STUCK_S, f->dt_s)) return false;
  if (f->near_ball[VS_BLUE] && f->near_ball[VS_YELLOW]) return call(event, VS_EVENT_GOAL_KICK, f->area, f->quadrant);
  return call(event, VS_EVENT_PENALTY, vs_other_team(f->area), 0);
}

static bool stuck_outside(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->area >= 0 || !vs_reached(r->still_s, VS_LEAGUE_STUCK_S, f->dt_s)) return false;
  return call(event, VS_EVENT_FREE_BALL, VS_BLUE, f->quadrant);
}

const vs_rule vs_league_rules[] = {
    {"goal, or the foul of the play that led to it", goal},
    {"time is up: half time or end", vs_rule_time},
    {"the play in an area is over: its later foul, goal kick or penalty", play_ended},
    {"the ball has left the field: free ball", vs_rule_ball_out},
    {"two defenders in their area with the ball for 3 s: penalty", defenders_stay},
    {"two attackers in that area with the ball for 3 s: goal kick", attackers_stay},
    {"the ball is stuck in an area for 5 s: goal kick or penalty", stuck_in_area},
    {"the ball is stuck elsewhere for 5 s: free ball", stuck_outside},
    {0},
};
