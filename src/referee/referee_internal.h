// What the referee's files share: the facts of one frame and the rows of a set of rules.
#ifndef VSSS_REFEREE_INTERNAL_H
#define VSSS_REFEREE_INTERNAL_H

#include <math.h>

#include "vsss/referee.h"

// What one frame shows, worked out once for all rules.
typedef struct vs_facts {
  double dt_s;
  int scorer;               // the whole ball is over the other team's goal line; -1: no goal
  bool ball_out;            // it has left the field some other way (over a wall): an accident
  int quadrant;             // of the ball
  int area;                 // the team in whose area the ball is; -1: none
  int defenders, attackers; // of and against that team, in that area
  double ball_mps;
  bool near_ball[VS_TEAMS];
  // Serie A, LARC: the team that pushes without the ball (-1: none), in whose area (-1: in none) and quadrant the pushed is.
  int pusher, push_area, push_quadrant;
  int holder;     // Serie A, LARC: the team a robot of which covers the ball; -1: none
  int ended_play; // not paper: the team whose area the ball has just left (into the goal or out of it); -1: none
} vs_facts;

// One rule. Fills kind, team and quadrant of event where it applies. The first row that applies decides; the table ends
// with a row without a name.
typedef struct vs_rule {
  const char *name;
  bool (*applies)(const vs_referee *referee, const vs_facts *facts, vs_event *event);
} vs_rule;

extern const vs_rule vs_paper_rules[], vs_league_rules[], vs_serie_a_2023_rules[], vs_larc_2026_rules[];

// The clocks of one set of rules, kept before its rules are asked.
void vs_paper_clocks(vs_referee *referee, const vs_world *world, const vs_facts *facts);
void vs_league_clocks(vs_referee *referee, vs_facts *facts);
void vs_serie_a_clocks(vs_referee *referee, const vs_world *world, vs_facts *facts);

// knockout.c: whether this goal ended the match; what extra time and shoot-out begin with; a frame of a shoot-out.
bool vs_ended_by_goal(const vs_referee *referee, double dt_s);
void vs_extend(vs_referee *referee, const vs_event *event);
void vs_shoot_out_step(vs_referee *referee, const vs_world *world, const vs_facts *facts, vs_event *event);

// Rows both tables have.
bool vs_rule_time(const vs_referee *referee, const vs_facts *facts, vs_event *event);
bool vs_rule_ball_out(const vs_referee *referee, const vs_facts *facts, vs_event *event);

// In the area of the team that defends -x (side -1) or +x (side 1), the goal behind it included.
static inline bool vs_in_area(const vs_pitch *field, int side, double x_m, double y_m) {
  return side * x_m > field->half_length_m - field->area_depth_m && fabs(y_m) < field->area_half_width_m;
}

static inline vs_team vs_other_team(int team) { return team == VS_BLUE ? VS_YELLOW : VS_BLUE; }

// A clock that counts frames has reached limit_s: half a frame of tolerance against rounding.
static inline bool vs_reached(double clock_s, double limit_s, double dt_s) { return clock_s + 0.5 * dt_s >= limit_s; }

#endif
