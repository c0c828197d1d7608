// Where the pieces stand at a restart, in the view of the team that kicks (it attacks +x): turned for yellow at the end.
#include <math.h>
#include <stddef.h>

#include "referee_internal.h"
#include "vsss/field.h"
#include "vsss/geom.h"

// The restarts as the pieces see them.
typedef struct restart {
  vs_event_kind kind; // KICK_OFF, PENALTY, FREE_BALL, FREE_KICK or GOAL_KICK; NONE: open play
  vs_team kicker;
  double ball_x_m, ball_y_m;
  bool in_the_middle; // a free ball again: robots stand in their own half, outside the circle
} restart;

// False where the event places nothing.
static bool restart_of(const vs_event *event, restart *r) {
  int quadrant = event->quadrant;
  double x_side = quadrant == 1 || quadrant == 4 ? 1 : -1, y_side = quadrant == 1 || quadrant == 2 ? 1 : -1;
  *r = (restart){.kind = event->kind, .kicker = event->team};
  switch (event->kind) {
  case VS_EVENT_GOAL: *r = (restart){.kind = VS_EVENT_KICK_OFF, .kicker = vs_other_team(event->team)}; return true;
  case VS_EVENT_HALF_TIME:
  case VS_EVENT_EXTRA_TIME: r->kind = VS_EVENT_KICK_OFF; return true;
  case VS_EVENT_SHOOT_OUT:
    *r = (restart){.kind = VS_EVENT_PENALTY, .kicker = event->team, .ball_x_m = VS_PENALTY_MARK_X_M};
    return true;
  case VS_EVENT_KICK_OFF: return true;
  case VS_EVENT_PENALTY:
  case VS_EVENT_FREE_KICK: r->ball_x_m = VS_PENALTY_MARK_X_M; return true;
  case VS_EVENT_FREE_BALL:
    r->kicker = VS_BLUE; // nobody's: the absolute frame
    r->in_the_middle = quadrant == 0;
    if (r->in_the_middle) return true;
    r->ball_x_m = x_side * VS_FREE_BALL_MARK_X_M;
    r->ball_y_m = y_side * VS_FREE_BALL_MARK_Y_M;
    return true;
  case VS_EVENT_GOAL_KICK:
    r->ball_x_m = -VS_LEAGUE_GOAL_KICK_X_M;
    r->ball_y_m = (event->team == VS_YELLOW ? -y_side : y_side) * VS_LEAGUE_GOAL_KICK_Y_M;
    return true;
  default: return false;
  }
}

// The league's default placements (rules.md's source S7, 3 against 3), kicker first, keeper, attacker, support: x away
// from the own goal, y shared by both teams. The kicker's keeper at a goal kick points at the ball.
static const vs_pose kick_off_pose[VS_TEAMS][VS_TEAM_SIZE] = {
    {{-0.675, 0, 0}, {-0.2, 0, 0}, {-0.4, 0, 0}},
    {{0.675, 0, VS_PI}, {0.2, 0, VS_PI}, {0.4, 0, VS_PI}},
};
// The defending keeper touches its line and is pointed straight at the ball, as in the paper (section VIII).
#define KEEPER_ON_LINE_M (VS_FIELD_HALF_LENGTH_M - VS_ROBOT_SIZE_M / 2)
static const vs_pose penalty_pose[VS_TEAMS][VS_TEAM_SIZE] = {
    {{-0.65, 0, 0}, {0.3, 0, 0}, {-0.1, 0.4, 0}},
    {{KEEPER_ON_LINE_M, 0, VS_PI}, {-0.1, 0.25, VS_PI}, {-0.1, -0.4, VS_PI}},
};
// Of the receivers one in each quadrant touches its area's line from before.
#define AREA_LINE_M (VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M)
#define AT_LINE_M   (AREA_LINE_M - VS_ROBOT_SIZE_M / 2)
static const vs_pose free_kick_pose[VS_TEAMS][VS_TEAM_SIZE] = {
    {{-0.675, 0, 0}, {0.3, 0, 0}, {-0.1, 0.4, 0}},
    {{KEEPER_ON_LINE_M, 0, VS_PI}, {AT_LINE_M, 0.2, VS_PI}, {AT_LINE_M, -0.2, VS_PI}},
};
static const vs_pose goal_kick_pose[VS_TEAMS][VS_TEAM_SIZE] = {
    {{-0.675, 0.27, VS_PI / 4}, {-0.45, 0.32, 0}, {-0.3, -0.47, 0}},
    {{0.675, 0, VS_PI}, {-0.225, 0.1, VS_PI}, {-0.15, -0.32, VS_PI}},
};

// Both teams as far from the ball as each other.
static void middle_poses(vs_pose pose[VS_TEAMS][VS_TEAM_SIZE]) {
  for (int t = 0; t < VS_TEAMS; t++) {
    double own = t == 0 ? -1 : 1, theta_rad = t == 0 ? 0 : VS_PI;
    pose[t][0] = (vs_pose){own * 0.675, 0, theta_rad};
    pose[t][1] = (vs_pose){own * 0.28, 0, theta_rad};
    pose[t][2] = (vs_pose){own * 0.4, own * 0.2, theta_rad};
  }
}

static void free_ball_poses(const restart *r, vs_pose pose[VS_TEAMS][VS_TEAM_SIZE]) {
  if (r->in_the_middle) {
    middle_poses(pose);
    return;
  }
  double x_side = r->ball_x_m > 0 ? 1 : -1, y_side = r->ball_y_m > 0 ? 1 : -1;
  for (int t = 0; t < VS_TEAMS; t++) {
    double own = t == 0 ? -1 : 1, theta_rad = t == 0 ? 0 : VS_PI; // which side is its own
    bool attacks = own != x_side;
    pose[t][0] = (vs_pose){own * 0.675, 0, theta_rad};
    pose[t][1] = (vs_pose){r->ball_x_m + own * VS_FREE_BALL_ROBOT_M, r->ball_y_m, theta_rad};
    pose[t][2] = (vs_pose){attacks ? -own * 0.1 : own * 0.3, y_side * (attacks ? -0.2 : -0.1), theta_rad};
  }
}

static void fixed_poses(const restart *r, vs_pose pose[VS_TEAMS][VS_TEAM_SIZE]) {
  const vs_pose(*table)[VS_TEAM_SIZE] = r->kind == VS_EVENT_PENALTY     ? penalty_pose
                                        : r->kind == VS_EVENT_FREE_KICK ? free_kick_pose
                                        : r->kind == VS_EVENT_GOAL_KICK ? goal_kick_pose
                                                                        : kick_off_pose;
  if (r->kind == VS_EVENT_FREE_BALL) {
    free_ball_poses(r, pose);
    return;
  }
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) pose[t][i] = table[t][i];
  if (r->kind == VS_EVENT_GOAL_KICK && r->ball_y_m < 0) {
    pose[0][0].y_m = -pose[0][0].y_m;
    pose[0][0].theta_rad = -pose[0][0].theta_rad;
  }
}

// Half a robot's diagonal plus a little: a robot of any heading fits into this circle.
#define ROOT_2        1.4142135623730951
#define ROBOT_CLEAR_M (VS_ROBOT_SIZE_M / 2 * ROOT_2 + 0.005)

// Where robots that have no task at this restart may stand, clear_m from every line that bounds it. t: 0 kicker, 1
// receiver.
static bool rules_allow(const restart *r, int t, double x_m, double y_m, double clear_m) {
  double x_side = r->ball_x_m > 0 ? 1 : -1, y_side = r->ball_y_m > 0 ? 1 : -1;
  double area_x_m = -(VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M);
  switch (r->kind) {
  case VS_EVENT_NONE: return true;
  case VS_EVENT_PENALTY: // behind the half line, as seen from the ball
    return x_m <= -clear_m;
  case VS_EVENT_FREE_BALL: // out of the ball's quadrant; again: as at a kick-off, but for both teams outside the circle
    if (r->in_the_middle) return (t == 0 ? -1 : 1) * x_m >= clear_m && hypot(x_m, y_m) >= VS_CIRCLE_RADIUS_M + clear_m;
    return x_side * x_m <= -clear_m || y_side * y_m <= -clear_m;
  case VS_EVENT_FREE_KICK: // not past the ball; receivers in touch with their area's line
    if (t == 0) return x_m <= r->ball_x_m - clear_m;
    return fabs(x_m - AREA_LINE_M) <= VS_ROBOT_SIZE_M / 2 + fmax(-clear_m, 0) && fabs(y_m) <= VS_AREA_HALF_WIDTH_M;
  case VS_EVENT_GOAL_KICK: // out of the kicker's area
    return x_m >= area_x_m + clear_m || fabs(y_m) >= VS_AREA_HALF_WIDTH_M + clear_m;
  default: // kick-off: own half, receivers outside the circle
    if (t == 0) return x_m <= -clear_m;
    return x_m >= clear_m && hypot(x_m, y_m) >= VS_CIRCLE_RADIUS_M + clear_m;
  }
}

// The robot that has a task: it kicks, keeps the goal or stands beside a free ball. False: team t has none.
static bool draw_task(const restart *r, int t, vs_rng *rng, vs_pose *pose) {
  if (r->in_the_middle) {
    return false;
  } else if (r->kind == VS_EVENT_FREE_BALL) {
    *pose = (vs_pose){r->ball_x_m + (t == 0 ? -1 : 1) * VS_FREE_BALL_ROBOT_M, r->ball_y_m, 0};
  } else if ((r->kind == VS_EVENT_PENALTY || r->kind == VS_EVENT_FREE_KICK) &&
             t == 0) { // behind the ball, 10 to 30 cm away
    double angle = vs_rng_range(rng, -VS_PI / 3, VS_PI / 3), distance = vs_rng_range(rng, 0.1, 0.3);
    *pose = (vs_pose){r->ball_x_m - distance * cos(angle), distance * sin(angle), 0};
  } else if (r->kind == VS_EVENT_PENALTY ||
             r->kind == VS_EVENT_FREE_KICK) { // touches its line, within the goal's mouth
    double room_m = VS_GOAL_HALF_WIDTH_M - ROBOT_CLEAR_M;
    *pose = (vs_pose){KEEPER_ON_LINE_M, vs_rng_range(rng, -room_m, room_m), 0};
  } else if (r->kind == VS_EVENT_GOAL_KICK && t == 0) { // in its area
    double x_m = vs_rng_range(rng, -VS_FIELD_HALF_LENGTH_M + ROBOT_CLEAR_M, -VS_FIELD_HALF_LENGTH_M + VS_AREA_DEPTH_M);
    *pose = (vs_pose){x_m, vs_rng_range(rng, -VS_AREA_HALF_WIDTH_M, VS_AREA_HALF_WIDTH_M), 0};
  } else {
    return false;
  }
  return true;
}

static vs_pose draw_anywhere(const restart *r, int t, vs_rng *rng) {
  const double x_free_m = VS_FIELD_HALF_LENGTH_M - ROBOT_CLEAR_M, y_free_m = VS_FIELD_HALF_WIDTH_M - ROBOT_CLEAR_M;
  const double corner_m = VS_FIELD_HALF_LENGTH_M + VS_FIELD_HALF_WIDTH_M - VS_CORNER_M - ROOT_2 * ROBOT_CLEAR_M;
  for (;;) { // at least a third of the field is allowed in every case but at a free kick, where it is a twentieth
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

static void random_poses(const restart *r, vs_rng *rng, vs_pose pose[VS_TEAMS][VS_TEAM_SIZE]) {
  const vs_pose *placed[VS_TEAMS * VS_TEAM_SIZE];
  int n = 0, robot[VS_TEAMS][VS_TEAM_SIZE];
  for (int t = 0; t < VS_TEAMS; t++) {
    for (int i = 0; i < VS_TEAM_SIZE; i++) robot[t][i] = i;
    vs_rng_shuffle(rng, robot[t], VS_TEAM_SIZE);
  }
  // Robots with a task first (i = 0), since their room is small.
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    for (int t = 0; t < VS_TEAMS; t++) {
      vs_pose *p = &pose[t][robot[t][i]];
      do {
        if (i > 0 || !draw_task(r, t, rng, p)) *p = draw_anywhere(r, t, rng);
        if (r->kind == VS_EVENT_FREE_KICK && t == 1 && i > 0) p->y_m = i == 1 ? fabs(p->y_m) : -fabs(p->y_m);
      } while (!is_clear(r, placed, n, p));
      p->theta_rad = vs_wrap_rad(vs_rng_range(rng, -VS_PI, VS_PI));
      placed[n++] = p;
    }
  }
}

// In the corner of positive x and y: along the end wall beside the goal, along the side wall, or in the corner itself.
static void draw_at_wall(vs_rng *rng, double *x_m, double *y_m) {
  const double at_end_m = VS_FIELD_HALF_LENGTH_M - VS_BALL_RADIUS_M,
               at_side_m = VS_FIELD_HALF_WIDTH_M - VS_BALL_RADIUS_M;
  const double corner_m = VS_CORNER_M + VS_BALL_RADIUS_M; // clear of the triangle
  switch (vs_rng_below(rng, 3)) {
  case 0:
    *x_m = at_end_m;
    *y_m = vs_rng_range(rng, VS_AREA_HALF_WIDTH_M, VS_FIELD_HALF_WIDTH_M - corner_m);
    break;
  case 1:
    *x_m = vs_rng_range(rng, 0, VS_FIELD_HALF_LENGTH_M - corner_m);
    *y_m = at_side_m;
    break;
  default: // at the middle of the triangle's side
    *x_m = VS_FIELD_HALF_LENGTH_M - VS_CORNER_M / 2 - VS_BALL_RADIUS_M / ROOT_2;
    *y_m = VS_FIELD_HALF_WIDTH_M - VS_CORNER_M / 2 - VS_BALL_RADIUS_M / ROOT_2;
  }
}

static vs_ball draw_ball(vs_rng *rng) {
  vs_ball ball = {.z_m = VS_BALL_RADIUS_M, .valid = true};
  if (vs_rng_below(rng, 3) == 0) {
    draw_at_wall(rng, &ball.x_m, &ball.y_m);
    if (vs_rng_below(rng, 2)) ball.x_m = -ball.x_m;
    if (vs_rng_below(rng, 2)) ball.y_m = -ball.y_m;
    return ball;
  }
  const double end_m = VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M, side_m = VS_FIELD_HALF_WIDTH_M - 2 * VS_BALL_RADIUS_M;
  double speed_mps = vs_rng_range(rng, 0, VS_OPEN_PLAY_MPS), to = vs_rng_range(rng, -VS_PI, VS_PI);
  ball.x_m = vs_rng_range(rng, -end_m, end_m);
  ball.y_m = vs_rng_range(rng, -side_m, side_m);
  ball.vx_mps = speed_mps * cos(to);
  ball.vy_mps = speed_mps * sin(to);
  return ball;
}

void vs_place_open_play(const vs_world *before, vs_rng *rng, vs_world *out) {
  *out = *before;
  out->ball = draw_ball(rng);
  const restart r = {.kind = VS_EVENT_NONE, .ball_x_m = out->ball.x_m, .ball_y_m = out->ball.y_m};
  vs_pose pose[VS_TEAMS][VS_TEAM_SIZE];
  random_poses(&r, rng, pose);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) out->robot[t][i] = (vs_robot){.pose = pose[t][i], .valid = true};
}

void vs_place(vs_placement_mode mode, const vs_event *event, const vs_world *before, vs_rng *rng, vs_world *out) {
  restart r;
  vs_world view = *before;
  *out = *before;
  if (!restart_of(event, &r)) return;

  vs_pose pose[VS_TEAMS][VS_TEAM_SIZE];
  if (mode == VS_PLACEMENT_RANDOM)
    random_poses(&r, rng, pose);
  else
    fixed_poses(&r, pose);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) view.robot[t][i] = (vs_robot){.pose = pose[t][i], .valid = true};
  view.ball = (vs_ball){.x_m = r.ball_x_m, .y_m = r.ball_y_m, .z_m = VS_BALL_RADIUS_M, .valid = true};
  vs_world_for_team(&view, r.kicker, out);
}

void vs_place_team(const vs_event *event, vs_team team, vs_pose out[VS_TEAM_SIZE]) {
  const vs_world nothing = {0};
  vs_world placed;
  vs_place(VS_PLACEMENT_PAPER, event, &nothing, NULL, &placed);
  for (int i = 0; i < VS_TEAM_SIZE; i++) out[i] = placed.robot[team][i].pose;
}

void vs_place_without(const vs_referee *referee, vs_world *placed) {
  for (int t = 0; t < VS_TEAMS; t++) {
    vs_robot *robot = placed->robot[t];
    bool moved[VS_TEAM_SIZE] = {false};
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      if (!vs_referee_off(referee, (vs_team)t, i)) continue;
      for (int k = VS_TEAM_SIZE - 1; k > i; k--) {
        if (vs_referee_off(referee, (vs_team)t, k) || moved[k]) continue;
        robot[k] = robot[i];
        moved[k] = true;
        break;
      }
      robot[i] = (vs_robot){.pose = vs_world_beside((vs_team)t, i), .valid = true};
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
    return vs_distance_m(p->x_m, p->y_m, r->ball_x_m + (t == 0 ? -1 : 1) * VS_FREE_BALL_ROBOT_M, r->ball_y_m) <= NEAR_M;
  case VS_EVENT_PENALTY:
  case VS_EVENT_FREE_KICK:
    if (t == 0) return p->x_m < r->ball_x_m && vs_distance_m(p->x_m, p->y_m, r->ball_x_m, r->ball_y_m) <= 0.3 + NEAR_M;
    return p->x_m >= KEEPER_ON_LINE_M - NEAR_M && fabs(p->y_m) <= VS_GOAL_HALF_WIDTH_M;
  case VS_EVENT_GOAL_KICK:
    return t == 0 && p->x_m <= -(VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M) && fabs(p->y_m) <= VS_AREA_HALF_WIDTH_M;
  default: return t == 0 && p->x_m <= 0 && hypot(p->x_m, p->y_m) <= VS_CIRCLE_RADIUS_M + NEAR_M;
  }
}

static bool task_is_due(const restart *r, int t) {
  if (r->in_the_middle) return false;
  return r->kind == VS_EVENT_FREE_BALL || r->kind == VS_EVENT_PENALTY || t == 0; // a free kick's keeper is free
}

// A keeper in its own area may stay where it is.
static bool keeps(const restart *r, int t, const vs_pose *p) {
  double own = t == 0 ? -1 : 1;
  bool in_area = own * p->x_m >= VS_FIELD_HALF_LENGTH_M - VS_AREA_DEPTH_M && fabs(p->y_m) <= VS_AREA_HALF_WIDTH_M;
  return (r->kind == VS_EVENT_FREE_BALL || (r->kind == VS_EVENT_FREE_KICK && t == 1)) && in_area;
}

static vs_status check_spot(const vs_pose *p, int i, const restart *r, vs_error *err) {
  const double x_free_m = VS_FIELD_HALF_LENGTH_M - VS_ROBOT_SIZE_M / 2 + 0.001,
               y_free_m = VS_FIELD_HALF_WIDTH_M - VS_ROBOT_SIZE_M / 2 + 0.001;
  if (!(fabs(p->x_m) <= x_free_m && fabs(p->y_m) <= y_free_m && isfinite(p->theta_rad)))
    return vs_fail(err, VS_FAIL, "robot %d at %.3f, %.3f m is not inside the field", i, p->x_m, p->y_m);
  if (vs_distance_m(p->x_m, p->y_m, r->ball_x_m, r->ball_y_m) < VS_ROBOT_SIZE_M / 2 + VS_BALL_RADIUS_M)
    return vs_fail(err, VS_FAIL, "robot %d stands on the ball's place", i);
  return VS_OK;
}

vs_status vs_placement_check(const vs_event *event, vs_team team, const vs_pose pose[VS_TEAM_SIZE], vs_error *err) {
  restart r;
  if (!restart_of(event, &r)) return vs_fail(err, VS_FAIL, "a %s places nothing", vs_event_name(event->kind));
  int t = team == r.kicker ? 0 : 1, tasks = 0, keepers = 0, at_line[2] = {0, 0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
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
    else if (r.kind == VS_EVENT_FREE_KICK && t == 1 && at_line[p.y_m > 0]++ > 0)
      return vs_fail(err, VS_FAIL, "robot %d is the second of its quadrant at a free kick", i);
  }
  if (task_is_due(&r, t) && tasks == 0)
    return vs_fail(err, VS_FAIL, "no robot stands where the %s wants one", vs_event_name(event->kind));
  return VS_OK;
}
