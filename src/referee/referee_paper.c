// The paper's rules (section V), one function a row.
#include "referee_internal.h"
#include "vsss/geom.h"

void vs_paper_clocks(vs_referee *r, const vs_world *world, const vs_facts *f) {
  const vs_ball *ball = &world->ball;
  if (vs_distance_m(ball->x_m, ball->y_m, r->still_x_m, r->still_y_m) < r->def.still_distance_m) {
    r->still_s += f->dt_s;
    return;
  }
  r->still_x_m = ball->x_m;
  r->still_y_m = ball->y_m;
  r->still_s = 0;
}

static bool goal(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  if (f->scorer < 0) return false;
  event->kind = VS_EVENT_GOAL;
  event->team = (vs_team)f->scorer;
  return true;
}

static bool two_defenders(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  if (f->area < 0 || f->defenders < 2) return false;
  event->kind = VS_EVENT_PENALTY;
  event->team = vs_other_team(f->area);
  return true;
}

static bool ball_still(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (!vs_reached(r->still_s, r->def.still_s, f->dt_s)) return false;
  event->kind = VS_EVENT_FREE_BALL;
  event->quadrant = f->quadrant;
  return true;
}

const vs_rule vs_paper_rules[] = {
    {"goal: the whole ball is over the line", goal},
    {"time is up: half time or end", vs_rule_time},
    {"the ball has left the field: free ball", vs_rule_ball_out},
    {"two defenders and the ball in their area: penalty", two_defenders},
    {"the ball has not moved 2 cm for 10 s: free ball", ball_still},
    {0},
};
