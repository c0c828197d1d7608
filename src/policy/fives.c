// How a strategy of three robots (emc:, inf:, emc22:) plays 5 against 5: it goes on to play with robots 0 to 2, as if on the
// field it was made for; robots 3 and 4 are ours, a sweeper and a wing.
//
// The field it is shown: distances to walls and around the ball are the true ones, since its numbers for contact, areas and
// corners are of a robot's size; what lies between shrinks.
#include <math.h>

#include "policy_internal.h"
#include "vsss/field.h"
#include "vsss/geom.h"

#define EDGE_M      0.2 // true this near a wall
#define AT_BALL_M   0.2 // true this near the ball, and shrunken as all else from
#define FROM_BALL_M 0.8 // ... here: between them a robot farther away is shown farther away still

// One coordinate of a field of half_m on one of shown_m.
static double shrink(double value, double half_m, double shown_m) {
  double from_middle = fabs(value), edge = half_m - EDGE_M;
  double shown =
      from_middle > edge ? shown_m - (half_m - from_middle) : from_middle * (shown_m - EDGE_M) / (half_m - EDGE_M);
  return copysign(shown, value);
}

static void show_robot(const vs_pitch *field, const vs_ball *ball, const vs_ball *ball_shown, vs_robot *robot) {
  double dx = robot->pose.x_m - ball->x_m, dy = robot->pose.y_m - ball->y_m;
  double near = vs_clamp((FROM_BALL_M - hypot(dx, dy)) / (FROM_BALL_M - AT_BALL_M), 0, 1);
  double x_m = shrink(robot->pose.x_m, field->half_length_m, VS_FIELD_HALF_LENGTH_M);
  double y_m = shrink(robot->pose.y_m, field->half_width_m, VS_FIELD_HALF_WIDTH_M);
  robot->pose.x_m = near * (ball_shown->x_m + dx) + (1 - near) * x_m;
  robot->pose.y_m = near * (ball_shown->y_m + dy) + (1 - near) * y_m;
}

void vs_fives_show(const vs_world *view, vs_world *three) {
  const vs_pitch *field = vs_pitch_of(view->division);
  *three = (vs_world){.time_us = view->time_us, .seq = view->seq, .ball = view->ball};
  three->ball.x_m = shrink(view->ball.x_m, field->half_length_m, VS_FIELD_HALF_LENGTH_M);
  three->ball.y_m = shrink(view->ball.y_m, field->half_width_m, VS_FIELD_HALF_WIDTH_M);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      three->robot[t][i] = view->robot[t][i];
      show_robot(field, &view->ball, &three->ball, &three->robot[t][i]);
    }
}

// --- robots 3 and 4 ---------------------------------------------------------------------------------------------------

#define SPEED_MPS     1.0
#define AREA_CLEAR_M  0.10 // of both areas: a second robot there is a foul
#define STRIKE_M      0.6  // the ball is worth going for
#define NEARER_M      0.05 // than the others of the team, so that two do not fight for it
#define BEHIND_BALL_M 0.12
#define WING_BACK_M   0.30
#define WING_ASIDE_M  0.40
#define GIVE_WAY_M    0.16 // to own robots ahead

typedef struct point {
  double x_m, y_m;
} point;

static double from_ball_m(const vs_world *w, int robot) {
  const vs_pose *p = &w->robot[VS_OWN][robot].pose;
  return vs_distance_m(p->x_m, p->y_m, w->ball.x_m, w->ball.y_m);
}

static bool is_nearest(const vs_world *w, int robot) {
  double own_m = from_ball_m(w, robot);
  for (int i = 0, n = vs_team_size(w); i < n; i++)
    if (i != robot && from_ball_m(w, i) < own_m + NEARER_M) return false;
  return own_m < STRIKE_M;
}

// From the middle of the own goal outwards, a third of the way to the ball: never in the own area.
static point sweeper_place(const vs_pitch *field, const vs_world *w) {
  double goal_x_m = -field->half_length_m, out_m = field->area_depth_m + AREA_CLEAR_M;
  double away_m = w->ball.x_m - goal_x_m, ahead_m = vs_clamp(away_m / 3, out_m, field->half_length_m - 0.1);
  double share = away_m > ahead_m ? ahead_m / away_m : 1;
  double side_m = field->half_width_m - 2 * VS_ROBOT_SIZE_M;
  return (point){goal_x_m + ahead_m, vs_clamp(share * w->ball.y_m, -side_m, side_m)};
}

// Behind the ball on the emptier side of the field, where rebounds and passes across go: never in their area.
static point wing_place(const vs_pitch *field, const vs_world *w) {
  double last_m = field->half_length_m - field->area_depth_m - AREA_CLEAR_M;
  double x_m = vs_clamp(w->ball.x_m - WING_BACK_M, -0.3, last_m);
  double side = fabs(w->ball.y_m) > 0.1 ? -w->ball.y_m : w->robot[VS_OWN][4].pose.y_m;
  return (point){x_m, copysign(WING_ASIDE_M, side)};
}

// Round to behind the ball as seen from their goal, then through it.
static point strike_place(const vs_pitch *field, const vs_world *w, int robot) {
  const vs_pose *p = &w->robot[VS_OWN][robot].pose;
  double goal_x = field->half_length_m - w->ball.x_m, goal_y = -w->ball.y_m, far = fmax(hypot(goal_x, goal_y), 1e-6);
  double ux = goal_x / far, uy = goal_y / far, dx = w->ball.x_m - p->x_m, dy = w->ball.y_m - p->y_m;
  double behind = ux * dx + uy * dy, aside = -uy * dx + ux * dy;
  if (behind > 0 && fabs(aside) < 0.3 * behind + 0.02) return (point){w->ball.x_m + 0.2 * ux, w->ball.y_m + 0.2 * uy};
  point to = {w->ball.x_m - BEHIND_BALL_M * ux, w->ball.y_m - BEHIND_BALL_M * uy};
  if (behind < 0) { // past it: round the ball on the side it is on already
    double way = aside > 0 ? -1 : 1;
    to.x_m += BEHIND_BALL_M * way * -uy;
    to.y_m += BEHIND_BALL_M * way * ux;
  }
  return to;
}

// Round an own robot that is close and in the way.
static double give_way(const vs_world *w, int robot, double direction_rad) {
  const vs_pose *p = &w->robot[VS_OWN][robot].pose;
  for (int i = 0, n = vs_team_size(w); i < n; i++) {
    const vs_pose *other = &w->robot[VS_OWN][i].pose;
    if (i == robot || vs_distance_m(p->x_m, p->y_m, other->x_m, other->y_m) > GIVE_WAY_M) continue;
    double off = vs_wrap_rad(atan2(other->y_m - p->y_m, other->x_m - p->x_m) - direction_rad);
    if (fabs(off) < VS_PI / 3) return vs_wrap_rad(direction_rad + (off > 0 ? -1 : 1) * VS_PI / 2);
  }
  return direction_rad;
}

// Either end may be the front.
static vs_wheels drive_to(const vs_world *w, int robot, point to) {
  const vs_pose *p = &w->robot[VS_OWN][robot].pose;
  double far_m = vs_distance_m(p->x_m, p->y_m, to.x_m, to.y_m);
  if (far_m < 0.03) return (vs_wheels){0, 0};
  double way_rad = give_way(w, robot, atan2(to.y_m - p->y_m, to.x_m - p->x_m));
  double turn_rad = vs_wrap_rad(way_rad - p->theta_rad), sign = 1;
  if (fabs(turn_rad) > VS_PI / 2) {
    turn_rad = vs_wrap_rad(turn_rad + VS_PI);
    sign = -1;
  }
  double speed = sign * fmin(SPEED_MPS, 4 * far_m) * fmax(cos(turn_rad), 0), rim = VS_HALF_TRACK_M * 8 * turn_rad;
  return (vs_wheels){(speed - rim) / VS_WHEEL_RADIUS_M, (speed + rim) / VS_WHEEL_RADIUS_M};
}

void vs_fives_drive(const vs_world *view, vs_wheels *wheels) {
  const vs_pitch *field = vs_pitch_of(view->division);
  double area_m = field->half_length_m - field->area_depth_m;
  bool in_area =
      fabs(view->ball.x_m) > area_m - AREA_CLEAR_M && fabs(view->ball.y_m) < field->area_half_width_m + AREA_CLEAR_M;
  for (int i = VS_TEAM_SIZE; i < field->team_size; i++) {
    bool strikes = !in_area && is_nearest(view, i);
    point to = strikes ? strike_place(field, view, i) : i == 3 ? sweeper_place(field, view) : wing_place(field, view);
    wheels[i] = drive_to(view, i, to);
  }
}
