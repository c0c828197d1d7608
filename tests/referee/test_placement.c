// Tests src/referee/placement.c: the fixed positions, and that every placement is legal.
#include "referee/referee_world.h"

#include <string.h>

#include "vsss/geom.h"

static const vs_world nothing_before = {.time_us = 77, .seq = 5};

static vs_world placed(vs_placement_mode mode, vs_event_kind kind, vs_team team, int quadrant, vs_rng *rng) {
  vs_event event = {.kind = kind, .team = team, .quadrant = quadrant};
  vs_world w;
  vs_place(mode, &event, &nothing_before, rng, &w);
  return w;
}

static void assert_pose(const vs_world *w, int team, int robot, double x_m, double y_m, double degrees) {
  const vs_pose *p = &w->robot[team][robot].pose;
  assert_near(p->x_m, x_m, 1e-12);
  assert_near(p->y_m, y_m, 1e-12);
  assert_near(vs_wrap_rad(p->theta_rad - degrees * VS_PI / 180), 0, 1e-12);
}

static void assert_ball(const vs_world *w, double x_m, double y_m) {
  assert_near(w->ball.x_m, x_m, 1e-12);
  assert_near(w->ball.y_m, y_m, 1e-12);
  assert_near(w->ball.z_m, VS_BALL_RADIUS_M, 0);
}

static void kick_off_stands_on_the_middle_line_of_the_field(void **state) {
  (void)state;
  for (int team = 0; team < VS_TEAMS; team++) {
    vs_world w = placed(VS_PLACEMENT_PAPER, VS_EVENT_KICK_OFF, (vs_team)team, 0, NULL);
    assert_ball(&w, 0, 0);
    static const double x_m[] = {0.675, 0.2, 0.4}; // the same for kicker and receiver
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      assert_pose(&w, VS_BLUE, i, -x_m[i], 0, 0);
      assert_pose(&w, VS_YELLOW, i, x_m[i], 0, 180);
    }
  }
}

static void goal_and_half_time_are_followed_by_a_kick_off(void **state) {
  (void)state;
  vs_world kick_off = placed(VS_PLACEMENT_PAPER, VS_EVENT_KICK_OFF, VS_YELLOW, 0, NULL);
  vs_world goal = placed(VS_PLACEMENT_PAPER, VS_EVENT_GOAL, VS_BLUE, 0, NULL); // yellow conceded and kicks
  vs_world half = placed(VS_PLACEMENT_PAPER, VS_EVENT_HALF_TIME, VS_YELLOW, 0, NULL);
  assert_memory_equal(&goal, &kick_off, sizeof goal);
  assert_memory_equal(&half, &kick_off, sizeof half);
  // Random ones show who kicks: only the kicker's robots may be in the circle.
  int in_circle[VS_TEAMS] = {0};
  for (int n = 0; n < 300; n++) {
    vs_rng rng = vs_rng_make(3, (uint64_t)n);
    vs_world w = placed(VS_PLACEMENT_RANDOM, VS_EVENT_GOAL, VS_BLUE, 0, &rng);
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++)
        in_circle[t] += hypot(w.robot[t][i].pose.x_m, w.robot[t][i].pose.y_m) < VS_CIRCLE_RADIUS_M ? 1 : 0;
  }
  assert_int_equal(in_circle[VS_BLUE], 0);
  assert_true(in_circle[VS_YELLOW] > 20);
}

static void penalty_keeper_touches_its_line_and_points_at_the_ball(void **state) {
  (void)state;
  vs_world w = placed(VS_PLACEMENT_PAPER, VS_EVENT_PENALTY, VS_BLUE, 0, NULL);
  assert_ball(&w, 0.375, 0);
  assert_pose(&w, VS_BLUE, 0, -0.65, 0, 0);
  assert_pose(&w, VS_BLUE, 1, 0.3, 0, 0);
  assert_pose(&w, VS_BLUE, 2, -0.1, 0.4, 0);
  assert_pose(&w, VS_YELLOW, 0, 0.71, 0, 180); // its back at 0.75, straight at the ball
  assert_pose(&w, VS_YELLOW, 1, -0.1, 0.25, 180);
  assert_pose(&w, VS_YELLOW, 2, -0.1, -0.4, 180);
  w = placed(VS_PLACEMENT_PAPER, VS_EVENT_PENALTY, VS_YELLOW, 0, NULL); // all turned by 180 degrees
  assert_ball(&w, -0.375, 0);
  assert_pose(&w, VS_YELLOW, 1, -0.3, 0, 180);
  assert_pose(&w, VS_BLUE, 0, -0.71, 0, 0);
  assert_pose(&w, VS_BLUE, 1, 0.1, -0.25, 0);
}

static void free_ball_robots_stand_20_cm_beside_the_mark_of_the_quadrant(void **state) {
  (void)state;
  static const struct {
    double ball_x_m, ball_y_m, blue_x_m, blue_y_m, yellow_x_m, yellow_y_m; // ball, and the supports of both
  } row[] = {{0.375, 0.4, 0.1, -0.2, 0.3, -0.1},
             {-0.375, 0.4, -0.3, -0.1, -0.1, -0.2},
             {-0.375, -0.4, -0.3, 0.1, -0.1, 0.2},
             {0.375, -0.4, 0.1, 0.2, 0.3, 0.1}};
  for (int q = 1; q <= 4; q++) {
    vs_world w = placed(VS_PLACEMENT_PAPER, VS_EVENT_FREE_BALL, VS_BLUE, q, NULL);
    assert_ball(&w, row[q - 1].ball_x_m, row[q - 1].ball_y_m);
    assert_pose(&w, VS_BLUE, 0, -0.675, 0, 0);
    assert_pose(&w, VS_BLUE, 1, row[q - 1].ball_x_m - 0.2, row[q - 1].ball_y_m, 0);
    assert_pose(&w, VS_BLUE, 2, row[q - 1].blue_x_m, row[q - 1].blue_y_m, 0);
    assert_pose(&w, VS_YELLOW, 0, 0.675, 0, 180);
    assert_pose(&w, VS_YELLOW, 1, row[q - 1].ball_x_m + 0.2, row[q - 1].ball_y_m, 180);
    assert_pose(&w, VS_YELLOW, 2, row[q - 1].yellow_x_m, row[q - 1].yellow_y_m, 180);
  }
}

static void goal_kick_keeper_points_at_the_ball_on_the_side_of_the_foul(void **state) {
  (void)state;
  vs_world w = placed(VS_PLACEMENT_PAPER, VS_EVENT_GOAL_KICK, VS_BLUE, 2, NULL);
  assert_ball(&w, -0.6, 0.35);
  assert_pose(&w, VS_BLUE, 0, -0.675, 0.27, 45);
  assert_pose(&w, VS_BLUE, 1, -0.45, 0.32, 0);
  assert_pose(&w, VS_BLUE, 2, -0.3, -0.47, 0);
  assert_pose(&w, VS_YELLOW, 0, 0.675, 0, 180);
  assert_pose(&w, VS_YELLOW, 1, -0.225, 0.1, 180);
  assert_pose(&w, VS_YELLOW, 2, -0.15, -0.32, 180);
  w = placed(VS_PLACEMENT_PAPER, VS_EVENT_GOAL_KICK, VS_BLUE, 3, NULL);
  assert_ball(&w, -0.6, -0.35);
  assert_pose(&w, VS_BLUE, 0, -0.675, -0.27, -45);
  w = placed(VS_PLACEMENT_PAPER, VS_EVENT_GOAL_KICK, VS_YELLOW, 4, NULL);
  assert_ball(&w, 0.6, -0.35);
  assert_pose(&w, VS_YELLOW, 0, 0.675, -0.27, -135);
}

static void event_without_a_placement_changes_nothing(void **state) {
  (void)state;
  vs_world before = quiet_world(0.1, 0.2), after;
  static const vs_event_kind kind[] = {VS_EVENT_NONE, VS_EVENT_END, VS_EVENT_HALT};
  for (int k = 0; k < 3; k++) {
    vs_event event = {.kind = kind[k]};
    vs_place(VS_PLACEMENT_PAPER, &event, &before, NULL, &after);
    assert_memory_equal(&after, &before, sizeof after);
  }
}

static void everything_is_placed_at_rest_and_the_clock_goes_on(void **state) {
  (void)state;
  vs_world before = quiet_world(0.1, 0.2), after;
  before.time_us = 1234567;
  before.seq = 37;
  before.ball.vx_mps = 1;
  before.robot[VS_BLUE][1].omega_radps = 3;
  before.robot[VS_BLUE][1].left_radps = 30;
  vs_event event = {.kind = VS_EVENT_PENALTY, .team = VS_YELLOW};
  vs_place(VS_PLACEMENT_PAPER, &event, &before, NULL, &after);
  assert_int_equal(after.time_us, 1234567);
  assert_int_equal(after.seq, 37);
  assert_near(fabs(after.ball.vx_mps) + fabs(after.ball.vy_mps) + fabs(after.ball.vz_mps), 0, 0);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_robot *r = &after.robot[t][i];
      assert_true(r->valid);
      assert_near(fabs(r->vx_mps) + fabs(r->vy_mps) + fabs(r->omega_radps), 0, 0);
      assert_near(fabs(r->left_radps) + fabs(r->right_radps), 0, 0);
    }
}

// Legality, judged by the real squares and not by the circles the drawing uses.

#define HALF_M (VS_ROBOT_SIZE_M / 2)

static void corners_of(const vs_pose *p, double out[4][2]) {
  static const double sign[4][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}};
  double c = cos(p->theta_rad), s = sin(p->theta_rad);
  for (int k = 0; k < 4; k++) {
    out[k][0] = p->x_m + HALF_M * (sign[k][0] * c - sign[k][1] * s);
    out[k][1] = p->y_m + HALF_M * (sign[k][0] * s + sign[k][1] * c);
  }
}

// Two squares are apart if some side's direction of either separates them.
static bool apart_along(const vs_pose *a, const vs_pose *b) {
  double corner[4][2];
  corners_of(b, corner);
  for (int axis = 0; axis < 2; axis++) {
    double ux = axis ? -sin(a->theta_rad) : cos(a->theta_rad), uy = axis ? cos(a->theta_rad) : sin(a->theta_rad);
    double low = 1e9, high = -1e9;
    for (int k = 0; k < 4; k++) {
      double d = (corner[k][0] - a->x_m) * ux + (corner[k][1] - a->y_m) * uy;
      low = fmin(low, d);
      high = fmax(high, d);
    }
    if (low > HALF_M || high < -HALF_M) return true;
  }
  return false;
}

static bool ball_apart(const vs_pose *p, const vs_ball *ball) {
  double dx = ball->x_m - p->x_m, dy = ball->y_m - p->y_m, c = cos(p->theta_rad), s = sin(p->theta_rad);
  double outside_x = fmax(fabs(dx * c + dy * s) - HALF_M, 0), outside_y = fmax(fabs(-dx * s + dy * c) - HALF_M, 0);
  return hypot(outside_x, outside_y) > VS_BALL_RADIUS_M;
}

static bool on_field(double x_m, double y_m) {
  bool mouth = fabs(y_m) < VS_GOAL_HALF_WIDTH_M;
  double length_m = VS_FIELD_HALF_LENGTH_M + (mouth ? VS_GOAL_DEPTH_M : 1e-9);
  bool corner = fabs(x_m) + fabs(y_m) > VS_FIELD_HALF_LENGTH_M + VS_FIELD_HALF_WIDTH_M - VS_CORNER_M;
  return fabs(x_m) <= length_m && fabs(y_m) <= VS_FIELD_HALF_WIDTH_M && !(corner && !mouth);
}

static void assert_apart_and_on_the_field(const vs_world *w) {
  const vs_pose *pose[6];
  for (int n = 0; n < 6; n++) pose[n] = &w->robot[n / 3][n % 3].pose;
  for (int a = 0; a < 6; a++) {
    double corner[4][2];
    corners_of(pose[a], corner);
    for (int k = 0; k < 4; k++) assert_true(on_field(corner[k][0], corner[k][1]));
    assert_true(ball_apart(pose[a], &w->ball));
    for (int b = 0; b < a; b++) assert_true(apart_along(pose[a], pose[b]) || apart_along(pose[b], pose[a]));
  }
}

// Counts the robots of a team for which a condition holds, in the kicker's view.
#define COUNT(team, condition)                                                                                         \
  ({                                                                                                                   \
    int n_ = 0;                                                                                                        \
    for (int i_ = 0; i_ < VS_TEAM_SIZE; i_++) {                                                                        \
      double x = v.robot[team][i_].pose.x_m, y = v.robot[team][i_].pose.y_m;                                           \
      (void)y;                                                                                                         \
      n_ += (condition) ? 1 : 0;                                                                                       \
    }                                                                                                                  \
    n_;                                                                                                                \
  })

static void assert_legal(const vs_world *w, vs_event_kind kind, vs_team kicker, int quadrant) {
  assert_apart_and_on_the_field(w);
  vs_world v;
  vs_world_for_team(w, kicker, &v);
  switch (kind) {
  case VS_EVENT_KICK_OFF: // kicker in its own half; receiver in its own, its centres outside the circle
    assert_ball(&v, 0, 0);
    assert_int_equal(COUNT(0, x < 0), 3);
    assert_int_equal(COUNT(1, x > 0 && hypot(x, y) >= VS_CIRCLE_RADIUS_M - 1e-12), 3);
    break;
  case VS_EVENT_PENALTY: // keeper on its line, kicker behind the ball, all others behind the half line
    assert_ball(&v, 0.375, 0);
    assert_int_equal(COUNT(1, x > 0.75 - VS_ROBOT_SIZE_M * 0.7072 && fabs(y) < VS_GOAL_HALF_WIDTH_M), 1);
    assert_int_equal(COUNT(1, x < 0), 2);
    assert_int_equal(COUNT(0, x > 0 && x < 0.375), 1);
    assert_int_equal(COUNT(0, x < 0), 2);
    break;
  case VS_EVENT_FREE_BALL: { // one each 20 cm from the ball along x, the others' centres not in its quadrant
    double sx = quadrant == 1 || quadrant == 4 ? 1 : -1, sy = quadrant < 3 ? 1 : -1;
    v = *w;
    assert_ball(&v, sx * 0.375, sy * 0.4);
    assert_int_equal(COUNT(0, fabs(x - (sx * 0.375 - 0.2)) < 1e-9 && fabs(y - sy * 0.4) < 1e-9), 1);
    assert_int_equal(COUNT(1, fabs(x - (sx * 0.375 + 0.2)) < 1e-9 && fabs(y - sy * 0.4) < 1e-9), 1);
    assert_int_equal(COUNT(0, x * sx > 0 && y * sy > 0) + COUNT(1, x * sx > 0 && y * sy > 0), 2);
    break;
  }
  case VS_EVENT_FREE_KICK: { // kicker behind the ball, nobody past it; the line of the area held, one a quadrant
    assert_ball(&v, 0.375, 0);
    assert_true(COUNT(0, x < 0.375 && hypot(x - 0.375, y) <= 0.3 + 1e-9) >= 1);
    assert_int_equal(COUNT(0, x <= 0.375 - 0.0375), VS_TEAM_SIZE);
    assert_int_equal(COUNT(1, x > 0.70 && fabs(y) < 0.2), 1);
    assert_int_equal(COUNT(1, fabs(x - 0.6) < 0.04 + 1e-9 && y > 0), 1);
    assert_int_equal(COUNT(1, fabs(x - 0.6) < 0.04 + 1e-9 && y < 0), 1);
    break;
  }
  default: { // goal kick: the keeper alone in its area
    double sy = (quadrant < 3 ? 1 : -1) * (kicker == VS_BLUE ? 1 : -1);
    assert_ball(&v, -0.6, sy * 0.35);
    assert_int_equal(COUNT(0, x < -0.6 && fabs(y) < 0.35), 1);
    assert_int_equal(COUNT(1, x < -0.6 && fabs(y) < 0.35), 0);
  }
  }
}

static const struct {
  vs_event_kind kind;
  vs_team kicker;
  int quadrant;
} restarts[] = {
    {VS_EVENT_KICK_OFF, VS_BLUE, 0},  {VS_EVENT_KICK_OFF, VS_YELLOW, 0},  {VS_EVENT_PENALTY, VS_BLUE, 0},
    {VS_EVENT_PENALTY, VS_YELLOW, 0}, {VS_EVENT_FREE_BALL, VS_BLUE, 1},   {VS_EVENT_FREE_BALL, VS_BLUE, 2},
    {VS_EVENT_FREE_BALL, VS_BLUE, 3}, {VS_EVENT_FREE_BALL, VS_BLUE, 4},   {VS_EVENT_GOAL_KICK, VS_BLUE, 2},
    {VS_EVENT_GOAL_KICK, VS_BLUE, 3}, {VS_EVENT_GOAL_KICK, VS_YELLOW, 1}, {VS_EVENT_GOAL_KICK, VS_YELLOW, 4},
    {VS_EVENT_FREE_KICK, VS_BLUE, 0}, {VS_EVENT_FREE_KICK, VS_YELLOW, 0},
};
#define RESTARTS (int)(sizeof restarts / sizeof *restarts)

static void every_fixed_placement_is_legal(void **state) {
  (void)state;
  for (int k = 0; k < RESTARTS; k++) {
    vs_world w = placed(VS_PLACEMENT_PAPER, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant, NULL);
    assert_legal(&w, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant);
  }
}

static void ten_thousand_random_placements_are_legal(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(11, 0);
  for (int n = 0; n < 10000; n++) {
    int k = n % RESTARTS;
    vs_world w = placed(VS_PLACEMENT_RANDOM, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant, &rng);
    assert_legal(&w, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant);
  }
}

static void no_random_placement_is_at_once_whistled_again(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(12, 0);
  for (int n = 0; n < 2000; n++) {
    int k = n % RESTARTS;
    vs_world w = placed(VS_PLACEMENT_RANDOM, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant, &rng);
    for (int rules = VS_RULES_PAPER; rules <= VS_RULES_LARC_2026; rules++) {
      vs_referee r = referee_of((vs_rules)rules, &w);
      assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
    }
  }
}

static void mixed_placements_are_the_papers_half_of_the_time_and_otherwise_random(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(13, 0);
  for (int k = 0; k < RESTARTS; k++) {
    vs_world paper = placed(VS_PLACEMENT_PAPER, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant, NULL);
    int fixed = 0, last = 0, changes = 0;
    for (int n = 0; n < 200; n++) {
      vs_world w = placed(VS_PLACEMENT_MIXED, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant, &rng);
      assert_legal(&w, restarts[k].kind, restarts[k].kicker, restarts[k].quadrant);
      int same = memcmp(&w, &paper, sizeof w) == 0;
      fixed += same, changes += same != last, last = same;
    }
    assert_in_range(fixed, 70, 130);   // 100 expected
    assert_in_range(changes, 70, 130); // drawn for each restart
  }
}

// 10 to 30 cm from the ball, and both ends are reached.
static void a_random_kicker_stands_10_to_30_cm_behind_the_ball(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(21, 0);
  double nearest = 1.0, farthest = 0.0;
  for (int n = 0; n < 3000; n++) {
    vs_world w = placed(VS_PLACEMENT_RANDOM, VS_EVENT_PENALTY, VS_BLUE, 0, &rng);
    double of_this = 2.0;
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_pose *p = &w.robot[VS_BLUE][i].pose;
      if (p->x_m > 0)
        of_this = hypot(p->x_m - w.ball.x_m, p->y_m - w.ball.y_m); // the kicker alone is beyond the middle
    }
    nearest = fmin(nearest, of_this);
    farthest = fmax(farthest, of_this);
  }
  assert_true(nearest >= 0.1 - 1e-9 && nearest < 0.105);
  assert_true(farthest <= 0.3 + 1e-9 && farthest > 0.295);
}

static void random_roles_and_headings_are_all_drawn_and_depend_on_the_seed_alone(void **state) {
  (void)state;
  int kicker[VS_TEAM_SIZE] = {0}, eighth[8] = {0};
  for (uint64_t n = 0; n < 1200; n++) {
    vs_rng rng = vs_rng_make(5, n), same = rng;
    vs_world w = placed(VS_PLACEMENT_RANDOM, VS_EVENT_PENALTY, VS_BLUE, 0, &rng);
    vs_world again = placed(VS_PLACEMENT_RANDOM, VS_EVENT_PENALTY, VS_BLUE, 0, &same);
    assert_memory_equal(&w, &again, sizeof w);
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      kicker[i] += w.robot[VS_BLUE][i].pose.x_m > 0 ? 1 : 0;
      eighth[(int)floor((w.robot[VS_YELLOW][i].pose.theta_rad + VS_PI) / (2 * VS_PI) * 8) % 8]++;
    }
  }
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_in_range(kicker[i], 320, 480); // 400 expected
  for (int k = 0; k < 8; k++) assert_in_range(eighth[k], 370, 530);            // 450 expected
}

// Open play: everything on the field and apart, no penalty at once, a third of the balls at a wall and at rest, the
// others rolling no faster than they should.
static void open_play_is_legal_and_a_third_of_it_at_the_walls(void **state) {
  (void)state;
  enum { N = 6000 };
  int at_wall = 0, in_corner = 0;
  double fastest_mps = 0;
  for (int n = 0; n < N; n++) {
    vs_rng rng = vs_rng_make(5, (uint64_t)n);
    vs_world w;
    vs_place_open_play(&nothing_before, &rng, &w);
    assert_apart_and_on_the_field(&w);
    double x_m = fabs(w.ball.x_m), y_m = fabs(w.ball.y_m), mps = hypot(w.ball.vx_mps, w.ball.vy_mps);
    bool corner = x_m + y_m > 1.25, wall = corner || x_m > 0.7 || y_m > 0.62;
    assert_false(x_m > 0.6 && y_m < 0.35); // in an area
    if (wall) assert_near(mps, 0, 0);
    at_wall += wall;
    in_corner += corner;
    fastest_mps = fmax(fastest_mps, mps);
    assert_int_equal(w.seq, nothing_before.seq);
  }
  assert_in_range(at_wall, N / 3 - 120, N / 3 + 120); // 3 deviations: 110
  assert_true(in_corner > N / 12);
  assert_true(fastest_mps > 0.95 && fastest_mps <= VS_OPEN_PLAY_MPS);
}

// Teams may also place themselves: what the referee itself places passes, and a robot out of bounds does not.
static void own_placements_are_checked_against_each_restart(void **state) {
  (void)state;
  const struct {
    vs_event_kind kind;
    int quadrants;
    double x_m, y_m; // where no robot of the kicker (attacking +x) but its taker may stand
  } row[] = {{VS_EVENT_KICK_OFF, 0, 0.5, 0.5},
             {VS_EVENT_PENALTY, 0, 0.2, 0.4},
             {VS_EVENT_FREE_BALL, 4, 0, 0},
             {VS_EVENT_GOAL_KICK, 4, -0.65, -0.1}};
  for (int k = 0; k < 4; k++)
    for (int team = 0; team < VS_TEAMS; team++)
      for (int q = row[k].quadrants ? 1 : 0; q <= row[k].quadrants; q++) {
        vs_event event = {.kind = row[k].kind, .team = (vs_team)team, .quadrant = q};
        vs_world w = placed(VS_PLACEMENT_PAPER, row[k].kind, (vs_team)team, q, NULL);
        vs_pose pose[VS_TEAM_SIZE];
        for (int t = 0; t < VS_TEAMS; t++) {
          for (int i = 0; i < VS_TEAM_SIZE; i++) pose[i] = w.robot[t][i].pose;
          assert_ok(vs_placement_check(VS_3V3, &event, (vs_team)t, pose, err));
        }
        for (int i = 0; i < VS_TEAM_SIZE; i++) pose[i] = w.robot[team][i].pose;
        pose[2] = (vs_pose){row[k].x_m, row[k].y_m, 0};
        if (team == VS_YELLOW) pose[2] = vs_pose_rotate_pi(pose[2]);
        if (row[k].kind == VS_EVENT_FREE_BALL) // in the ball's quadrant, not beside the mark
          pose[2] = (vs_pose){w.ball.x_m > 0 ? 0.2 : -0.2, w.ball.y_m > 0 ? 0.1 : -0.1, 0};
        vs_error err = {0};
        assert_int_equal(vs_placement_check(VS_3V3, &event, (vs_team)team, pose, &err), VS_FAIL);
        if (!strstr(err.text, "robot 2 at")) fail_msg("%s", err.text);
      }
  vs_event end = {.kind = VS_EVENT_END};
  vs_pose any[VS_TEAM_SIZE] = {{0}};
  assert_int_equal(vs_placement_check(VS_3V3, &end, VS_BLUE, any, NULL), VS_FAIL);
}

// Blue's keeper is off: its last robot takes the goal. Blue's taker is off: the last one kicks. Yellow stays.
static void who_is_off_stands_beside_the_field_and_the_last_one_moves_up(void **state) {
  (void)state;
  for (int off = 0; off < VS_TEAM_SIZE; off++) {
    vs_world all = placed(VS_PLACEMENT_PAPER, VS_EVENT_PENALTY, VS_BLUE, 0, NULL), w = all;
    vs_referee r = referee_of(VS_RULES_LARC_2026, &w);
    r.idle.robot[VS_BLUE][off].off = true;
    vs_place_without(&r, &w);
    assert_pose(&w, VS_BLUE, off, -0.2 * (off + 1), 0.95, 0);
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_pose *was = &all.robot[VS_BLUE][i == 2 ? off : i].pose, *is = &w.robot[VS_BLUE][i].pose;
      if (i != off) assert_memory_equal(is, was, sizeof *is);
    }
    assert_memory_equal(w.robot[VS_YELLOW], all.robot[VS_YELLOW], sizeof all.robot[VS_YELLOW]);
  }
}

// Two defenders at the line in one quadrant, or one that is nowhere near it.
static void a_free_kicks_line_is_checked(void **state) {
  (void)state;
  vs_error why = {0};
  const vs_event event = {.kind = VS_EVENT_FREE_KICK, .team = VS_BLUE};
  vs_pose pose[VS_TEAM_SIZE] = {{0.71, 0, 0}, {0.56, 0.2, 0}, {0.56, -0.2, 0}};
  assert_ok(vs_placement_check(VS_3V3, &event, VS_YELLOW, pose, err));
  pose[2].y_m = 0.05;
  assert_int_equal(vs_placement_check(VS_3V3, &event, VS_YELLOW, pose, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "second of its quadrant"));
  pose[2] = (vs_pose){0.3, -0.3, 0};
  assert_int_equal(vs_placement_check(VS_3V3, &event, VS_YELLOW, pose, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "free kick allows none"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(kick_off_stands_on_the_middle_line_of_the_field),
      cmocka_unit_test(goal_and_half_time_are_followed_by_a_kick_off),
      cmocka_unit_test(penalty_keeper_touches_its_line_and_points_at_the_ball),
      cmocka_unit_test(free_ball_robots_stand_20_cm_beside_the_mark_of_the_quadrant),
      cmocka_unit_test(goal_kick_keeper_points_at_the_ball_on_the_side_of_the_foul),
      cmocka_unit_test(event_without_a_placement_changes_nothing),
      cmocka_unit_test(everything_is_placed_at_rest_and_the_clock_goes_on),
      cmocka_unit_test(who_is_off_stands_beside_the_field_and_the_last_one_moves_up),
      cmocka_unit_test(a_free_kicks_line_is_checked),
      cmocka_unit_test(every_fixed_placement_is_legal),
      cmocka_unit_test(own_placements_are_checked_against_each_restart),
      cmocka_unit_test(ten_thousand_random_placements_are_legal),
      cmocka_unit_test(open_play_is_legal_and_a_third_of_it_at_the_walls),
      cmocka_unit_test(no_random_placement_is_at_once_whistled_again),
      cmocka_unit_test(mixed_placements_are_the_papers_half_of_the_time_and_otherwise_random),
      cmocka_unit_test(a_random_kicker_stands_10_to_30_cm_behind_the_ball),
      cmocka_unit_test(random_roles_and_headings_are_all_drawn_and_depend_on_the_seed_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
