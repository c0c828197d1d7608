// Where the pieces stand at a restart, in the view of the team that kicks (it attacks +x): turned for yellow at the end.
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "referee_internal.h"
#include "vsss/field.h"
#include "vsss/geom.h"

// The restarts as the pieces see them.
typedef struct restart {
  const vs_pitch *field;
  vs_division division;
  vs_event_kind kind; // KICK_OFF, PENALTY, FREE_BALL, FREE_KICK or GOAL_KICK; NONE: open play
  vs_team kicker;
  double ball_x_m, ball_y_m;
  bool in_the_middle; // a free ball again: robots stand in their own half, outside the circle
} restart;

// False where the event places nothing.
static bool restart_of(vs_division division, const vs_event *event, restart *r) {
  const vs_pitch *field = vs_pitch_of(division);
  int quadrant = event->quadrant;
  double x_side = quadrant == 1 || quadrant == 4 ? 1 : -1, y_side = quadrant == 1 || quadrant == 2 ? 1 : -1;
  *r = (restart){.field = field, .division = division, .kind = event->kind, .kicker = event->team};
  switch (event->kind) {
  case VS_EVENT_GOAL:
    r->kind = VS_EVENT_KICK_OFF;
    r->kicker = vs_other_team(event->team);
    return true;
  case VS_EVENT_HALF_TIME:
  case VS_EVENT_EXTRA_TIME: r->kind = VS_EVENT_KICK_OFF; return true;
  case VS_EVENT_SHOOT_OUT:
    r->kind = VS_EVENT_PENALTY;
    r->ball_x_m = field->penalty_mark_x_m;
    return true;
  case VS_EVENT_KICK_OFF: return true;
  case VS_EVENT_PENALTY:
  case VS_EVENT_FREE_KICK: r->ball_x_m = field->penalty_mark_x_m; return true;
  case VS_EVENT_FREE_BALL:
    r->kicker = VS_BLUE; // nobody's: the absolute frame
    r->in_the_middle = quadrant == 0;
    if (r->in_the_middle) return true;
    r->ball_x_m = x_side * field->free_ball_mark_x_m;
    r->ball_y_m = y_side * field->free_ball_mark_y_m;
    return true;
  case VS_EVENT_GOAL_KICK:
    r->ball_x_m = -field->goal_kick_x_m;
    r->ball_y_m = (event->team == VS_YELLOW ? -y_side : y_side) * field->goal_kick_y_m;
    return true;
  default: return false;
  }
}

// The league's default placements (rules.md's source S7), kicker first, keeper, attacker, support and in 5 against 5
// midfielder and defender: x away from the own goal, y shared by both teams. The kicker's keeper at a goal kick points at
// the ball. Where the league's keeper would stand in its goal and its kicker outside the circle (5 against 5, kick-off) ours
// stand on the line and in the circle, as its rules want it.
typedef vs_pose poses[VS_DIVISIONS][VS_TEAMS][VS_TEAM_MOST];
#define HALF_ROBOT_M (VS_ROBOT_SIZE_M / 2)
#define LINE_3V3_M   (0.75 - HALF_ROBOT_M)
#define LINE_5V5_M   (1.1 - HALF_ROBOT_M)
static const poses kick_off_pose = {
    [VS_3V3] = {{{-0.675, 0, 0}, {-0.2, 0, 0}, {-0.4, 0, 0}}, {{0.675, 0, VS_PI}, {0.2, 0, VS_PI}, {0.4, 0, VS_PI}}},
    [VS_5V5] = {{{-1.03, 0, 0}, {-0.25, 0, 0}, {-0.45, 0.2, 0}, {-0.45, -0.2, 0}, {-0.7, 0, 0}},
                {{1.03, 0, VS_PI}, {0.3, 0, VS_PI}, {0.45, 0.2, VS_PI}, {0.45, -0.2, VS_PI}, {0.7, 0, VS_PI}}},
};
// The defending keeper touches its line and is pointed straight at the ball, as in the paper (section VIII).
static const poses penalty_pose = {
    [VS_3V3] = {{{-0.65, 0, 0}, {0.3, 0, 0}, {-0.1, 0.4, 0}},
                {{LINE_3V3_M, 0, VS_PI}, {-0.1, 0.25, VS_PI}, {-0.1, -0.4, VS_PI}}},
    [VS_5V5] =
        {{{-1.03, 0, 0}, {0.6, 0, 0}, {-0.3, -0.45, 0}, {-0.3, 0.05, 0}, {-0.3, 0.55, 0}},
         {{LINE_5V5_M, 0, VS_PI}, {-0.3, -0.7, VS_PI}, {-0.3, -0.2, VS_PI}, {-0.3, 0.3, VS_PI}, {-0.3, 0.8, VS_PI}}},
};
// Of the receivers one in each quadrant touches its area's line from before; those of five that are left over wait beyond
// the half-way line, as at a penalty.
static const poses free_kick_pose = {
    [VS_3V3] = {{{-0.675, 0, 0}, {0.3, 0, 0}, {-0.1, 0.4, 0}},
                {{LINE_3V3_M, 0, VS_PI}, {LINE_3V3_M - 0.15, 0.2, VS_PI}, {LINE_3V3_M - 0.15, -0.2, VS_PI}}},
    [VS_5V5] = {{{-1.03, 0, 0}, {0.6, 0, 0}, {-0.3, -0.45, 0}, {-0.3, 0.05, 0}, {-0.3, 0.55, 0}},
                {{LINE_5V5_M, 0, VS_PI},
                 {LINE_5V5_M - 0.15, 0.2, VS_PI},
                 {LINE_5V5_M - 0.15, -0.2, VS_PI},
                 {-0.3, 0.3, VS_PI},
                 {-0.3, -0.2, VS_PI}}},
};
static const poses goal_kick_pose = {
    [VS_3V3] = {{{-0.675, 0.27, VS_PI / 4}, {-0.45, 0.32, 0}, {-0.3, -0.47, 0}},
                {{0.675, 0, VS_PI}, {-0.225, 0.1, VS_PI}, {-0.15, -0.32, VS_PI}}},
    [VS_5V5] = {{{-1.03, 0.2, 0.5586}, {0.45, 0.45, 0}, {0.4, 0.2, 0}, {0.2, -0.4, 0}, {-0.4, -0.5, 0}},
                {{1.03, 0, VS_PI}, {0.15, 0, VS_PI}, {0.2, 0.4, VS_PI}, {0.5, -0.3, VS_PI}, {0.6, -0.6, VS_PI}}},
};
// A free ball in the middle: both teams as far from the ball as each other. y: to the team's left.
static const vs_pose middle_pose[VS_DIVISIONS][VS_TEAM_MOST] = {
    [VS_3V3] = {{0.675, 0, 0}, {0.28, 0, 0}, {0.4, 0.2, 0}},
    [VS_5V5] = {{1.03, 0, 0}, {0.33, 0, 0}, {0.45, 0.2, 0}, {0.45, -0.2, 0}, {0.7, 0, 0}},
};
// A free ball at a mark: who attacks the ball's half, who defends it. y: towards the mark's side. The second robot of each
// stands beside the ball.
static const poses free_ball_pose = {
    [VS_3V3] = {{{0.675, 0, 0}, {0}, {-0.1, -0.2, 0}}, {{0.675, 0, 0}, {0}, {0.3, -0.1, 0}}},
    [VS_5V5] = {{{1.03, 0, 0}, {0}, {-0.7, -0.1, 0}, {0.4, -0.6, 0}, {0.4, 0.6, 0}},
                {{1.03, 0, 0}, {0}, {0.4, -0.1, 0}, {-0.4, 0, 0}, {0.3, -0.5, 0}}},
};

static void middle_poses(const restart *r, vs_pose pose[VS_TEAMS][VS_TEAM_MOST]) {
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < r->field->team_size; i++) {
      double own = t == 0 ? -1 : 1; // which side is its own
      const vs_pose *p = &middle_pose[r->division][i];
      pose[t][i] = (vs_pose){own * p->x_m, own * p->y_m + 0.0, t == 0 ? 0 : VS_PI}; // + 0.0: no -0
    }
}

static void free_ball_poses(const restart *r, vs_pose pose[VS_TEAMS][VS_TEAM_MOST]) {
  double x_side = r->ball_x_m > 0 ? 1 : -1, y_side = r->ball_y_m > 0 ? 1 : -1;
  for (int t = 0; t < VS_TEAMS; t++) {
    double own = t == 0 ? -1 : 1, theta_rad = t == 0 ? 0 : VS_PI;
    const vs_pose *row = free_ball_pose[r->division][own == x_side];
    for (int i = 0; i < r->field->team_size; i++)
      pose[t][i] = (vs_pose){own * row[i].x_m, y_side * row[i].y_m + 0.0, theta_rad};
    pose[t][1] = (vs_pose){r->ball_x_m + own * r->field->free_ball_robot_m, r->ball_y_m, theta_rad};
  }
}

static void fixed_poses(const restart *r, vs_pose pose[VS_TEAMS][VS_TEAM_MOST]) {
  const poses *table = r->kind == VS_EVENT_PENALTY     ? &penalty_pose
                       : r->kind == VS_EVENT_FREE_KICK ? &free_kick_pose
                       : r->kind == VS_EVENT_GOAL_KICK ? &goal_kick_pose
                                                       : &kick_off_pose;
  if (r->kind == VS_EVENT_FREE_BALL) {
    if (r->in_the_middle)
      middle_poses(r, pose);
    else
      free_ball_poses(r, pose);
    return;
  }
  memcpy(pose, (*table)[r->division], sizeof(*table)[r->division]);
  if (r->kind == VS_EVENT_GOAL_KICK && r->ball_y_m < 0) {
    pose[0][0].y_m = -pose[0][0].y_m;
    pose[0][0].theta_rad = -pose[0][0].theta_rad;
  }
}

// Half a robot's diagonal plus a little: a robot of any heading fits into this circle.
#define ROOT_2        1.4142135623730951
#define ROBOT_CLEAR_M (VS_ROBOT_SIZE_M / 2 * ROOT_2 + 0.005)

static double area_line_m(const restart *r) { return r->field->half_length_m - r->field->area_depth_m; }
static double goal_line_m(const restart *r) { return r->field->half_length_m - HALF_ROBOT_M; } // of who touches it

// At a free kick: in touch with the receivers' area's line.
static bool at_area_line(const restart *r, double x_m, double y_m, double clear_m) {
  return fabs(x_m - area_line_m(r)) <= HALF_ROBOT_M + fmax(-clear_m, 0) && fabs(y_m) <= r->field->area_half_width_m;
}

// Where robots that have no task at this restart may stand, clear_m from every line that bounds it. t: 0 kicker, 1
// receiver.
static bool rules_allow(const restart *r, int t, double x_m, double y_m, double clear_m) {
  double x_side = r->ball_x_m > 0 ? 1 : -1, y_side = r->ball_y_m > 0 ? 1 : -1;
  double circle_m = r->field->circle_radius_m;
  switch (r->kind) {
  case VS_EVENT_NONE: return true;
  case VS_EVENT_PENALTY: // behind the half line, as seen from the ball
    return x_m <= -clear_m;
  case VS_EVENT_FREE_BALL: // out of the ball's quadrant; again: as at a kick-off, but for both teams outside the circle
    if (r->in_the_middle) return (t == 0 ? -1 : 1) * x_m >= clear_m && hypot(x_m, y_m) >= circle_m + clear_m;
    return x_side * x_m <= -clear_m || y_side * y_m <= -clear_m;
  case VS_EVENT_FREE_KICK: // not past the ball; receivers in touch with their area's line, of five some beyond the half line
    if (t == 0) return x_m <= r->ball_x_m - clear_m;
    return at_area_line(r, x_m, y_m, clear_m) || (r->field->team_size > VS_TEAM_SIZE && x_m <= -clear_m);
  case VS_EVENT_GOAL_KICK: // out of the kicker's area
    return x_m >= -area_line_m(r) + clear_m || fabs(y_m) >= r->field->area_half_width_m + clear_m;
  default: // kick-off: own half, receivers outside the circle
    if (t == 0) return x_m <= -clear_m;
    return x_m >= clear_m && hypot(x_m, y_m) >= circle_m + clear_m;
  }
}

// The robot that has a task: it kicks, keeps the goal or stands beside a free ball. False: team t has none.
static bool draw_task(const restart *r, int t, vs_rng *rng, vs_pose *pose) {
  if (r->in_the_middle) {
    return false;
  } else if (r->kind == VS_EVENT_FREE_BALL) {
    *pose = (vs_pose){r->ball_x_m + (t == 0 ? -1 : 1) * r->field->free_ball_robot_m, r->ball_y_m, 0};
  } else if ((r->kind == VS_EVENT_PENALTY || r->kind == VS_EVENT_FREE_KICK) &&
             t == 0) { // behind the ball, 10 to 30 cm away
    double angle = vs_rng_range(rng, -VS_PI / 3, VS_PI / 3), distance = vs_rng_range(rng, 0.1, 0.3);
    *pose = (vs_pose){r->ball_x_m - distance * cos(angle), distance * sin(angle), 0};
  } else if (r->kind == VS_EVENT_PENALTY ||
             r->kind == VS_EVENT_FREE_KICK) { // touches its line, within the goal's mouth
    double room_m = r->field->goal_half_width_m - ROBOT_CLEAR_M;
    *pose = (vs_pose){goal_line_m(r), vs_rng_range(rng, -room_m, room_m), 0};
  } else if (r->kind == VS_EVENT_GOAL_KICK && t == 0) { // in its area
    double goal_x_m = -r->field->half_length_m, half_m = r->field->area_half_width_m;
    double x_m = vs_rng_range(rng, goal_x_m + ROBOT_CLEAR_M, goal_x_m + r->field->area_depth_m);
    *pose = (vs_pose){x_m, vs_rng_range(rng, -half_m, half_m), 0};
  } else {
    return false;
  }
  return true;
}

static vs_pose draw_anywhere(const restart *r, int t, vs_rng *rng) {
  const vs_pitch *f = r->field;
  const double x_free_m = f->half_length_m - ROBOT_CLEAR_M, y_free_m = f->half_width_m - ROBOT_CLEAR_M;
  const double corner_m = f->half_length_m + f->half_width_m - f->corner_m - ROOT_2 * ROBOT_CLEAR_M;
  for (;;) { // at least a third of the field is allowed in every case but at a free kick, where it may be a hundredth
    double x_m = vs_rng_range(rng, -x_free_m, x_free_m), y_m = vs_rng_range(rng, -y_free_m, y_free_m);
    if (fabs(x_m) + fabs(y_m) <= corner_m && rules_allow(r, t, x_m, y_m, ROBOT_CLEAR_M)) return (vs_pose){x_m, y_m, 0};
  }
}

static bool is_clear(const restart *r, const vs_pose *placed[], int n, const vs_pose *pose) {
  if (vs_distance_m(pose->x_m, pose->y_m, r->ball_x_m, r->ball_y_m) < ROBOT_CLEAR_M + VS_BALL_RADIUS_M) return false;
  for (int k = 0; k < n; k++)
    if (vs_distance_m(pose->x_m, pose->y_m, placed[k]->x_m, placed[k]->y_m) < 2 * ROBOT_CLEAR_M) return false;
  return true;
}

// At a free kick the first two receivers stand at their area's line, one in each quadrant, the others elsewhere.
static bool quadrants_allow(const restart *r, int t, int i, vs_pose *p) {
  if (r->kind != VS_EVENT_FREE_KICK || t == 0 || i == 0) return true;
  if (i <= 2) p->y_m = i == 1 ? fabs(p->y_m) : -fabs(p->y_m);
  return (i <= 2) == at_area_line(r, p->x_m, p->y_m, 0);
}

static void random_poses(const restart *r, vs_rng *rng, vs_pose pose[VS_TEAMS][VS_TEAM_MOST]) {
  const vs_pose *placed[VS_TEAMS * VS_TEAM_MOST];
  const int team_size = r->field->team_size;
  int n = 0, robot[VS_TEAMS][VS_TEAM_MOST];
  for (int t = 0; t < VS_TEAMS; t++) {
    for (int i = 0; i < team_size; i++) robot[t][i] = i;
    vs_rng_shuffle(rng, robot[t], team_size);
  }
  // Robots with a task first (i = 0), since their room is small.
  for (int i = 0; i < team_size; i++) {
    for (int t = 0; t < VS_TEAMS; t++) {
      vs_pose *p = &pose[t][robot[t][i]];
      do {
        if (i > 0 || !draw_task(r, t, rng, p)) *p = draw_anywhere(r, t, rng);
      } while (!quadrants_allow(r, t, i, p) || !is_clear(r, placed, n, p));
      p->theta_rad = vs_wrap_rad(vs_rng_range(rng, -VS_PI, VS_PI));
      placed[n++] = p;
    }
  }
}

// In the corner of positive x and y: along the end wall beside the goal, along the side wall, or in the corner itself.
static void draw_at_wall(const vs_pitch *f, vs_rng *rng, double *x_m, double *y_m) {
  const double at_end_m = f->half_length_m - VS_BALL_RADIUS_M, at_side_m = f->half_width_m - VS_BALL_RADIUS_M;
  const double corner_m = f->corner_m + VS_BALL_RADIUS_M; // clear of the triangle
  switch (vs_rng_below(rng, 3)) {
  case 0:
    *x_m = at_end_m;
    *y_m = vs_rng_range(rng, f->area_half_width_m, f->half_width_m - corner_m);
    break;
  case 1:
    *x_m = vs_rng_range(rng, 0, f->half_length_m - corner_m);
    *y_m = at_side_m;
    break;
  default: // at the middle of the triangle's side
    *x_m = f->half_length_m - f->corner_m / 2 - VS_BALL_RADIUS_M / ROOT_2;
    *y_m = f->half_width_m - f->corner_m / 2 - VS_BALL_RADIUS_M / ROOT_2;
  }
}

static vs_ball draw_ball(const vs_pitch *f, vs_rng *rng) {
  vs_ball ball = {.z_m = VS_BALL_RADIUS_M, .valid = true};
  if (vs_rng_below(rng, 3) == 0) {
    draw_at_wall(f, rng, &ball.x_m, &ball.y_m);
    if (vs_rng_below(rng, 2)) ball.x_m = -ball.x_m;
    if (vs_rng_below(rng, 2)) ball.y_m = -ball.y_m;
    return ball;
  }
  const double end_m = f->half_length_m - f->area_depth_m, side_m = f->half_width_m - 2 * VS_BALL_RADIUS_M;
  double speed_mps = vs_rng_range(rng, 0, VS_OPEN_PLAY_MPS), to = vs_rng_range(rng, -VS_PI, VS_PI);
  ball.x_m = vs_rng_range(rng, -end_m, end_m);
  ball.y_m = vs_rng_range(rng, -side_m, side_m);
  ball.vx_mps = speed_mps * cos(to);
  ball.vy_mps = speed_mps * sin(to);
  return ball;
}

void vs_place_open_play(const vs_world *before, vs_rng *rng, vs_world *out) {
  *out = *before;
  const vs_pitch *field = vs_pitch_of(before->division);
  out->ball = draw_ball(field, rng);
  const restart r = {.field = field,
                     .division = before->division,
                     .kind = VS_EVENT_NONE,
                     .ball_x_m = out->ball.x_m,
                     .ball_y_m = out->ball.y_m};
  vs_pose pose[VS_TEAMS][VS_TEAM_MOST];
  random_poses(&r, rng, pose);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < field->team_size; i++) out->robot[t][i] = (vs_robot){.pose = pose[t][i], .valid = true};
}

void vs_place(vs_placement_mode mode, const vs_event *event, const vs_world *before, vs_rng *rng, vs_world *out) {
  restart r;
  vs_world view = *before;
  *out = *before;
  if (!restart_of(before->division, event, &r)) return;

  vs_pose pose[VS_TEAMS][VS_TEAM_MOST];
  bool random = mode == VS_PLACEMENT_RANDOM || (mode == VS_PLACEMENT_MIXED && vs_rng_below(rng, 2) == 0);
  if (random)
    random_poses(&r, rng, pose);
  else
    fixed_poses(&r, pose);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < r.field->team_size; i++) view.robot[t][i] = (vs_robot){.pose = pose[t][i], .valid = true};
  view.ball = (vs_ball){.x_m = r.ball_x_m, .y_m = r.ball_y_m, .z_m = VS_BALL_RADIUS_M, .valid = true};
  vs_world_for_team(&view, r.kicker, out);
}

void vs_place_team(vs_division division, const vs_event *event, vs_team team, vs_pose *out) {
  const vs_world nothing = {.division = division};
  vs_world placed;
  vs_place(VS_PLACEMENT_PAPER, event, &nothing, NULL, &placed);
  for (int i = 0; i < vs_team_size(&nothing); i++) out[i] = placed.robot[team][i].pose;
}

void vs_place_without(const vs_referee *referee, vs_world *placed) {
  const int team_size = vs_team_size(placed);
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_robot *robot = placed->robot[t];
    bool moved[VS_TEAM_MOST] = {false};
    for (int i = 0; i < team_size; i++) {
      if (!vs_referee_off(referee, (vs_team)t, i)) continue;
      for (int k = team_size - 1; k > i; k--) {
        if (vs_referee_off(referee, (vs_team)t, k) || moved[k]) continue;
        robot[k] = robot[i];
        moved[k] = true;
        break;
      }
      robot[i] = (vs_robot){.pose = vs_world_beside(placed->division, (vs_team)t, i), .valid = true};
    }
  }
}

// --- what teams place themselves ---------------------------------------------------------------------------------------

#define NEAR_M 0.03 // of a point that the rules name

// The robot that the restart is about stands where it must. False where none of team t has to.
static bool has_task(const restart *r, int t, const vs_pose *p) {
  if (r->in_the_middle) return false;
  switch (r->kind) {
  case VS_EVENT_FREE_BALL:
    return vs_distance_m(p->x_m, p->y_m, r->ball_x_m + (t == 0 ? -1 : 1) * r->field->free_ball_robot_m, r->ball_y_m) <=
           NEAR_M;
  case VS_EVENT_PENALTY:
  case VS_EVENT_FREE_KICK:
    if (t == 0) return p->x_m < r->ball_x_m && vs_distance_m(p->x_m, p->y_m, r->ball_x_m, r->ball_y_m) <= 0.3 + NEAR_M;
    return p->x_m >= goal_line_m(r) - NEAR_M && fabs(p->y_m) <= r->field->goal_half_width_m;
  case VS_EVENT_GOAL_KICK: return t == 0 && p->x_m <= -area_line_m(r) && fabs(p->y_m) <= r->field->area_half_width_m;
  default: return t == 0 && p->x_m <= 0 && hypot(p->x_m, p->y_m) <= r->field->circle_radius_m + NEAR_M;
  }
}

static bool task_is_due(const restart *r, int t) {
  if (r->in_the_middle) return false;
  return r->kind == VS_EVENT_FREE_BALL || r->kind == VS_EVENT_PENALTY || t == 0; // a free kick's keeper is free
}

// A keeper in its own area may stay where it is.
static bool keeps(const restart *r, int t, const vs_pose *p) {
  double own = t == 0 ? -1 : 1;
  bool in_area = own * p->x_m >= area_line_m(r) && fabs(p->y_m) <= r->field->area_half_width_m;
  return (r->kind == VS_EVENT_FREE_BALL || (r->kind == VS_EVENT_FREE_KICK && t == 1)) && in_area;
}

static vs_status check_spot(const vs_pose *p, int i, const restart *r, vs_error *err) {
  const double x_free_m = r->field->half_length_m - VS_ROBOT_SIZE_M / 2 + 0.001,
               y_free_m = r->field->half_width_m - VS_ROBOT_SIZE_M / 2 + 0.001;
  if (!(fabs(p->x_m) <= x_free_m && fabs(p->y_m) <= y_free_m && isfinite(p->theta_rad)))
    return vs_fail(err, VS_FAIL, "robot %d at %.3f, %.3f m is not inside the field", i, p->x_m, p->y_m);
  if (vs_distance_m(p->x_m, p->y_m, r->ball_x_m, r->ball_y_m) < VS_ROBOT_SIZE_M / 2 + VS_BALL_RADIUS_M)
    return vs_fail(err, VS_FAIL, "robot %d stands on the ball's place", i);
  return VS_OK;
}

vs_status vs_placement_check(vs_division division, const vs_event *event, vs_team team, const vs_pose *pose,
                             vs_error *err) {
  restart r;
  if (!restart_of(division, event, &r)) return vs_fail(err, VS_FAIL, "a %s places nothing", vs_event_name(event->kind));
  int t = team == r.kicker ? 0 : 1, tasks = 0, keepers = 0, at_line[2] = {0, 0};
  for (int i = 0; i < r.field->team_size; i++) {
    vs_pose p = r.kicker == VS_YELLOW ? vs_pose_rotate_pi(pose[i]) : pose[i];
    vs_status s = check_spot(&p, i, &r, err);
    if (s != VS_OK) return s;
    for (int k = 0; k < i; k++)
      if (vs_distance_m(pose[i].x_m, pose[i].y_m, pose[k].x_m, pose[k].y_m) < VS_ROBOT_SIZE_M)
        return vs_fail(err, VS_FAIL, "robots %d and %d overlap", k, i);
    if (has_task(&r, t, &p) && tasks == 0)
      tasks++;
    else if (keeps(&r, t, &p) && keepers == 0)
      keepers++;
    else if (!rules_allow(&r, t, p.x_m, p.y_m, -0.001))
      return vs_fail(err, VS_FAIL, "robot %d at %.3f, %.3f m is where a %s allows none", i, pose[i].x_m, pose[i].y_m,
                     vs_event_name(event->kind));
    else if (r.kind == VS_EVENT_FREE_KICK && t == 1 && at_area_line(&r, p.x_m, p.y_m, -0.001) &&
             at_line[p.y_m > 0]++ > 0)
      return vs_fail(err, VS_FAIL, "robot %d is the second of its quadrant at a free kick", i);
  }
  if (task_is_due(&r, t) && tasks == 0)
    return vs_fail(err, VS_FAIL, "no robot stands where the %s wants one", vs_event_name(event->kind));
  return VS_OK;
}
