// The rules of matches between real robots, 2023 (Serie A) and 2026 (LARC), as far as a world shows them: one function
// a row. A false start is judged where play begins (vs_referee_start). What a world does not show is left to persons: something
// that grips the ball without covering it, what people do by hand, damage, radio.
#include <math.h>
#include <stddef.h>

#include "referee_internal.h"
#include "vsss/field.h"
#include "vsss/geom.h"

// Face to face 8 cm; a robot that turns while it touches is up to 11 cm away.
#define TOUCH_ROBOT_M 0.09
#define TOUCH_GAP_M   0.004

static bool touches_ball(const vs_robot *robot, const vs_ball *ball) {
  double c = cos(robot->pose.theta_rad), s = sin(robot->pose.theta_rad);
  double dx = ball->x_m - robot->pose.x_m, dy = ball->y_m - robot->pose.y_m, half_m = VS_ROBOT_SIZE_M / 2;
  double ahead = fmax(fabs(c * dx + s * dy) - half_m, 0), aside = fmax(fabs(-s * dx + c * dy) - half_m, 0);
  return hypot(ahead, aside) <= VS_BALL_RADIUS_M + TOUCH_GAP_M;
}

// The share of the ball's diameter that lies under the robot's square.
static double covered(const vs_robot *robot, const vs_ball *ball) {
  double c = cos(robot->pose.theta_rad), s = sin(robot->pose.theta_rad);
  double dx = ball->x_m - robot->pose.x_m, dy = ball->y_m - robot->pose.y_m, half_m = VS_ROBOT_SIZE_M / 2;
  double ahead = fabs(c * dx + s * dy), aside = fabs(-s * dx + c * dy);
  if (fmin(ahead, aside) > half_m || ball->z_m > VS_ROBOT_SIZE_M) return 0; // at a corner; it flies over the robot
  return (half_m + VS_BALL_RADIUS_M - fmax(ahead, aside)) / (2 * VS_BALL_RADIUS_M);
}

static bool in_area_of(const vs_world *w, int team, const vs_robot *robot) {
  return vs_in_area(vs_pitch_of(w->division), team == VS_BLUE ? -1 : 1, robot->pose.x_m, robot->pose.y_m);
}

// The keeper is the defender nearest to its goal's middle; a second one in the area that touches the ball interferes.
static bool second_defender_interferes(const vs_world *w, int team) {
  const int team_size = vs_team_size(w);
  double half_m = vs_pitch_of(w->division)->half_length_m, goal_x_m = team == VS_BLUE ? -half_m : half_m;
  double nearest_m = INFINITY;
  int keeper = -1;
  for (int i = 0; i < team_size; i++) {
    const vs_pose *p = &w->robot[team][i].pose;
    double d = vs_distance_m(p->x_m, p->y_m, goal_x_m, 0);
    if (in_area_of(w, team, &w->robot[team][i]) && d < nearest_m) nearest_m = d, keeper = i;
  }
  for (int i = 0; i < team_size; i++)
    if (i != keeper && in_area_of(w, team, &w->robot[team][i]) && touches_ball(&w->robot[team][i], &w->ball))
      return true;
  return false;
}

static bool touches_any(const vs_world *w, int team, const vs_robot *robot) {
  for (int i = 0, n = vs_team_size(w); i < n; i++) {
    const vs_pose *p = &w->robot[team][i].pose;
    if (vs_distance_m(p->x_m, p->y_m, robot->pose.x_m, robot->pose.y_m) <= TOUCH_ROBOT_M) return true;
  }
  return false;
}

// The attacker nearest to the ball may be in the area; another one there that touches the ball or a defender interferes.
static bool second_attacker_interferes(const vs_world *w, int defender) {
  const int team_size = vs_team_size(w);
  int team = vs_other_team(defender), first = -1;
  double nearest_m = INFINITY;
  for (int i = 0; i < team_size; i++) {
    const vs_pose *p = &w->robot[team][i].pose;
    double d = vs_distance_m(p->x_m, p->y_m, w->ball.x_m, w->ball.y_m);
    if (in_area_of(w, defender, &w->robot[team][i]) && d < nearest_m) nearest_m = d, first = i;
  }
  for (int i = 0; i < team_size; i++) {
    const vs_robot *r = &w->robot[team][i];
    if (i == first || !in_area_of(w, defender, r)) continue;
    if (touches_ball(r, &w->ball) || touches_any(w, defender, r)) return true;
  }
  return false;
}

// Whom of the other team a robot of this team pushes without the ball in this frame; NULL: nobody.
static const vs_robot *pushed_by(const vs_world *w, int team) {
  const int n = vs_team_size(w);
  for (int k = 0; k < n * n; k++) {
    const vs_robot *a = &w->robot[team][k / n], *b = &w->robot[vs_other_team(team)][k % n];
    double dx = b->pose.x_m - a->pose.x_m, dy = b->pose.y_m - a->pose.y_m, d = hypot(dx, dy);
    if (d > TOUCH_ROBOT_M || d <= 0) continue;
    bool with_ball = vs_distance_m(a->pose.x_m, a->pose.y_m, w->ball.x_m, w->ball.y_m) <= VS_PUSH_BALL_M ||
                     vs_distance_m(b->pose.x_m, b->pose.y_m, w->ball.x_m, w->ball.y_m) <= VS_PUSH_BALL_M;
    double a_mps = (a->vx_mps * dx + a->vy_mps * dy) / d, b_mps = (b->vx_mps * dx + b->vy_mps * dy) / d;
    if (!with_ball && a_mps > VS_PUSH_MPS && b_mps > VS_PUSH_MPS) return b;
  }
  return NULL;
}

static void push_clocks(vs_referee *r, const vs_world *world, vs_facts *f) {
  for (int t = 0; t < VS_TEAMS; t++) {
    const vs_robot *pushed = pushed_by(world, t);
    r->push_s[t] = pushed ? r->push_s[t] + f->dt_s : 0;
    if (!pushed || f->pusher >= 0 || !vs_reached(r->push_s[t], VS_PUSH_S, f->dt_s)) continue;
    int other = vs_other_team(t);
    f->pusher = t;
    f->push_area = in_area_of(world, t, pushed) ? t : in_area_of(world, other, pushed) ? other : -1;
    f->push_quadrant = pushed->pose.y_m >= 0 ? (pushed->pose.x_m >= 0 ? 1 : 2) : (pushed->pose.x_m >= 0 ? 4 : 3);
  }
}

static int holder(const vs_world *w) {
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0, n = vs_team_size(w); i < n; i++)
      if (covered(&w->robot[t][i], &w->ball) > VS_HOLD_SHARE) return t;
  return -1;
}

void vs_serie_a_clocks(vs_referee *r, const vs_world *world, vs_facts *f) {
  vs_paper_clocks(r, world, f); // the stalemate outside
  f->holder = holder(world);
  push_clocks(r, world, f);
  if (f->area != r->play_area) {
    f->ended_play = r->play_area;
    r->play_area = f->area;
    r->defence_s = r->attack_s = 0;
  }
  if (f->area < 0) return;
  // defence_s: the ball is the keeper's alone; attack_s: it is contested.
  bool contested = f->near_ball[vs_other_team(f->area)];
  r->attack_s = contested ? r->attack_s + f->dt_s : 0;
  r->defence_s = contested ? 0 : r->defence_s + f->dt_s;
  if (second_defender_interferes(world, f->area)) r->defence_seen_s = r->game.time_s;
  if (second_attacker_interferes(world, f->area)) r->attack_seen_s = r->game.time_s;
}

static bool call(vs_event *event, vs_event_kind kind, int team, int quadrant) {
  event->kind = kind;
  event->team = (vs_team)team;
  event->quadrant = quadrant;
  return true;
}

// The referee waits for what becomes of a foul of the defenders: a goal counts.
static bool goal(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  return f->scorer >= 0 && call(event, VS_EVENT_GOAL, f->scorer, 0);
}

static bool second_attacker(const vs_referee *r, const vs_facts *f, vs_event *event) {
  int area = f->area >= 0 ? f->area : f->ended_play;
  return area >= 0 && r->attack_seen_s >= 0 && call(event, VS_EVENT_GOAL_KICK, area, f->quadrant);
}

static bool second_defender(const vs_referee *r, const vs_facts *f, vs_event *event) {
  return f->ended_play >= 0 && r->defence_seen_s >= 0 && call(event, VS_EVENT_PENALTY, vs_other_team(f->ended_play), 0);
}

static bool keeper_holds(const vs_referee *r, const vs_facts *f, vs_event *event) {
  return f->area >= 0 && vs_reached(r->defence_s, VS_SERIE_A_PATIENCE_S, f->dt_s) &&
         call(event, VS_EVENT_PENALTY, vs_other_team(f->area), 0);
}

static bool contested(const vs_referee *r, const vs_facts *f, vs_event *event) {
  if (f->area < 0 || !vs_reached(r->attack_s, VS_SERIE_A_PATIENCE_S, f->dt_s)) return false;
  if (r->defence_seen_s >= 0) return call(event, VS_EVENT_PENALTY, vs_other_team(f->area), 0);
  return call(event, VS_EVENT_GOAL_KICK, f->area, f->quadrant);
}

// In the pusher's own area a penalty; a keeper pushed in its area kicks off; elsewhere a free kick.
static bool pushing(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  if (f->pusher < 0) return false;
  int pushed = vs_other_team(f->pusher);
  if (f->push_area == f->pusher) return call(event, VS_EVENT_PENALTY, pushed, 0);
  if (f->push_area == pushed) return call(event, VS_EVENT_GOAL_KICK, pushed, f->push_quadrant);
  return call(event, VS_EVENT_FREE_KICK, pushed, 0);
}

// As pushing: by where the ball is held.
static bool holding(const vs_referee *r, const vs_facts *f, vs_event *event) {
  (void)r;
  if (f->holder < 0) return false;
  int other = vs_other_team(f->holder);
  if (f->area == f->holder) return call(event, VS_EVENT_PENALTY, other, 0);
  if (f->area == other) return call(event, VS_EVENT_GOAL_KICK, other, f->quadrant);
  return call(event, VS_EVENT_FREE_KICK, other, 0);
}

static bool stalemate(const vs_referee *r, const vs_facts *f, vs_event *event) {
  return f->area < 0 && vs_reached(r->still_s, VS_SERIE_A_PATIENCE_S, f->dt_s) &&
         call(event, VS_EVENT_FREE_BALL, VS_BLUE, f->quadrant);
}

// The second and third in a row are played in the middle of the field.
static bool stalemate_again(const vs_referee *r, const vs_facts *f, vs_event *event) {
  return r->free_balls >= 1 && stalemate(r, f, event) && call(event, VS_EVENT_FREE_BALL, VS_BLUE, 0);
}

const vs_rule vs_serie_a_2023_rules[] = {
    {"an attacker's goal with a second attacker interfering in the area: goal kick", second_attacker},
    {"goal: the whole ball is over the line, also after the defenders' foul", goal},
    {"time is up: half time or end", vs_rule_time},
    {"a second defender has interfered in its area, and the ball has left it: penalty", second_defender},
    {"the ball has left the field: free ball", vs_rule_ball_out},
    {"a robot pushes another without the ball for 1 s: free kick, in its area penalty, a keeper's goal kick", pushing},
    {"a robot covers more than 30 % of the ball: free kick, in its area penalty, in the other's goal kick", holding},
    {"the keeper has not cleared an uncontested ball for 10 s: penalty", keeper_holds},
    {"a contested ball in an area for 10 s: goal kick, after the defenders' foul penalty", contested},
    {"the ball has not moved 2 cm for 10 s elsewhere: free ball", stalemate},
    {0},
};

const vs_rule vs_larc_2026_rules[] = {
    {"a second attacker interferes in the area: goal kick", second_attacker},
    {"goal: the whole ball is over the line, also after the defenders' foul", goal},
    {"time is up: half time or end", vs_rule_time},
    {"a second defender has interfered in its area, and the ball has left it: penalty", second_defender},
    {"the ball has left the field: free ball", vs_rule_ball_out},
    {"a robot pushes another without the ball for 1 s: free kick, in its area penalty, a keeper's goal kick", pushing},
    {"a robot covers more than 30 % of the ball: free kick, in its area penalty, in the other's goal kick", holding},
    {"the keeper has not cleared an uncontested ball for 10 s: penalty", keeper_holds},
    {"a contested ball in an area for 10 s: goal kick, after the defenders' foul penalty", contested},
    {"a stalemate of 10 s again: free ball in the middle", stalemate_again},
    {"the ball has not moved 2 cm for 10 s elsewhere: free ball", stalemate},
    {0},
};
