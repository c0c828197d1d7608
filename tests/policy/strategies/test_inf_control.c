// src/policy/strategies/inf_control.c: turning and looking by hand; driving by its quirks and by where it arrives.
#include "policy/strategies/inf.h"
#include "rows.h"
#include "vsss/rng.h"

typedef struct row {
  const char *name;
  double o_rad;
  inf_command command;
  double left, right;
} row;

static void run(void **state) {
  const row *r = *state;
  inf_state s;
  inf_init(&s);
  s.robot[0].at = (vs_point){300, 200};
  s.robot[0].o_rad = r->o_rad;
  s.robot[0].command = r->command;
  double out[2];
  inf_control(&s, 0, out);
  assert_near(out[0], r->left, 1e-9);
  assert_near(out[1], r->right, 1e-9);
}

// LOOK: the angle to a point at (dx, dy) is atan2(dy, -dx), since the orientation is mirrored; v = 0.8 and an error e
// give +-0.64 e. The end of the robot whose error is within 90 degrees faces the point.
#define LOOK_AT(x_px, y_px)                                                                                            \
  { .kind = INF_LOOK, .toward = {x_px, y_px}, .speed = 0.8 }
#define LOOK_ALONG(rad)                                                                                                \
  { .kind = INF_LOOK, .toward_angle = true, .angle_rad = rad, .speed = 0.8 }

static const row rows[] = {
    {"clockwise", 0, {.kind = INF_TURN, .clockwise = true, .speed = 1}, 1, -1},
    {"counter-clockwise", 0, {.kind = INF_TURN, .speed = 1}, -1, 1},
    {"look at a point within 2 degrees: stands", -0.03, LOOK_AT(200, 200), 0, 0},
    {"look at a point 0.5 rad off: turns", -0.5, LOOK_AT(200, 200), 0.32, -0.32},
    {"look at a point 0.5 rad off, the other way: turns back", 0.5, LOOK_AT(200, 200), -0.32, 0.32},
    {"look at a point behind: the rear faces it", VS_PI - 0.5, LOOK_AT(200, 200), 0.32, -0.32},
    {"look along an angle", 0.2, LOOK_ALONG(0.7), 0.32, -0.32},
    {"look 1.5 rad off: the command is held at 1 before the speed", -1.5, LOOK_ALONG(0), 0.8, -0.8},
};

static inf_state driver(vs_point at, double theta_rad, vs_point target) {
  inf_state s;
  inf_init(&s);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    s.robot[i].at = at;
    s.robot[i].o_rad = -theta_rad;
    s.robot[i].command = (inf_command){.kind = INF_GOTO, .target = target, .toward = {696, 240}, .speed = 0.8};
    s.robot[i].has_moved = true;
  }
  return s;
}

// GOTO at 0.8, worked out by a restatement of the rules in another language. The course is the law's, not the straight
// line; on the left the branch of the field: y within, below or above the radius.
typedef struct drive_row {
  const char *name;
  vs_point at;
  double theta_rad;
  vs_point target, toward;
  int front;
  double left, right;
} drive_row;

static const drive_row drives[] = {
    {"far target, wide radius, within", {100, 250}, 0.3, {400, 260}, {696, 240}, 1, 0.7998349691, 0.5598821888},
    {"near target, below", {300, 150}, -1.0, {330, 380}, {696, 240}, -1, -0.3130531591, -0.7890178868},
    {"at the side, narrow radius, above", {300, 400}, 2.0, {200, 218}, {696, 240}, -1, -0.1397407577, -0.7916411244},
    {"at the lower side, below", {300, 60}, 2.5, {250, 100}, {300, 61}, 1, 0.0137669089, 0.7965110582},
    {"towards a wall", {500, 300}, 0.7, {480, 240}, {68, 480}, -1, -0.7893701295, -0.2803423424},
    {"close to the target: slows", {30, 30}, 0.4, {20, 20}, {31, 29}, -1, -0.2823292634, -0.1702363058},
    {"at the side, within", {40, 400}, -2.2, {3, 2}, {41, 399}, 1, 0.7896661332, 0.2673258015},
};

static void run_drive(void **state) {
  const drive_row *r = *state;
  inf_state s = driver(r->at, r->theta_rad, r->target);
  s.robot[0].command.toward = r->toward;
  double out[2];
  inf_control(&s, 0, out);
  assert_int_equal(s.robot[0].front, r->front);
  assert_near(out[0], r->left, 1e-8);
  assert_near(out[1], r->right, 1e-8);
}

static void first_drive_ever_is_at_three_quarters(void **state) {
  (void)state;
  inf_state s = driver((vs_point){100, 100}, 0.3, (vs_point){400, 260});
  double first[2], second[2];
  s.robot[0].has_moved = false;
  inf_control(&s, 0, first);
  s.hold = false;
  inf_control(&s, 0, second);
  assert_near(first[0], 0.75 * second[0], 1e-12);
  assert_near(first[1], 0.75 * second[1], 1e-12);
}

static void robot_on_its_target_stands(void **state) {
  (void)state;
  inf_state s = driver((vs_point){400, 260}, 0.3, (vs_point){400, 260});
  double out[2];
  inf_control(&s, 0, out);
  assert_near(out[0], 0, 0);
  assert_near(out[1], 0, 0);
}

// Facing the target all three would change to the front end: the first does, the second is held, the third does.
static void change_of_end_holds_the_next_robot_once(void **state) {
  (void)state;
  inf_state s = driver((vs_point){100, 255}, 0, (vs_point){400, 260});
  double out[2];
  inf_control(&s, 0, out);
  assert_int_equal(s.robot[0].front, 1);
  assert_true(s.hold && out[0] > 0 && out[1] > 0);
  inf_control(&s, 1, out);
  assert_int_equal(s.robot[1].front, -1);
  assert_true(!s.hold && out[0] < 0 && out[1] < 0);
  inf_control(&s, 2, out);
  assert_int_equal(s.robot[2].front, 1);
}

// The target is straight up, 0.3 rad to the left of one end of the robot. Rear first it turns left, towards the course;
// front first the mirrored error turns it right, away.
static void front_first_turns_the_wrong_way(void **state) {
  (void)state;
  inf_state s = driver((vs_point){300, 120}, VS_PI / 2 - 0.3, (vs_point){300, 380});
  double out[2];
  s.robot[0].front = 1;
  inf_control(&s, 0, out);
  assert_int_equal(s.robot[0].front, 1);
  assert_true(out[0] > out[1]);
  s.robot[1].o_rad = -(VS_PI / 2 - 0.3 + VS_PI);
  inf_control(&s, 1, out);
  assert_int_equal(s.robot[1].front, -1);
  assert_true(out[0] < out[1]);
}

static void axis_along_a_coordinate_or_a_diagonal_gives_finite_wheels(void **state) {
  (void)state;
  const vs_point toward[] = {{500, 260}, {400, 300}, {400, 260}, {500, 360}, {300, 360}};
  for (size_t i = 0; i < sizeof toward / sizeof *toward; i++) {
    inf_state s = driver((vs_point){100, 100}, 0.3, (vs_point){400, 260});
    s.robot[0].command.toward = toward[i];
    double out[2];
    inf_control(&s, 0, out);
    assert_true(isfinite(out[0]) && isfinite(out[1]));
  }
}

// Ideal wheels of 0.9 m/s at most, 4 cm from the middle, 400 px/m: as the original's law, every random target is
// reached, within seconds.
static void random_targets_are_reached(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(5, 0);
  for (int k = 0; k < 100; k++) {
    vs_point at = {vs_rng_range(&rng, 60, 580), vs_rng_range(&rng, 60, 420)};
    vs_point target = {vs_rng_range(&rng, 60, 580), vs_rng_range(&rng, 60, 420)};
    double theta = vs_rng_range(&rng, -VS_PI, VS_PI), nearest = 1e9;
    inf_state s = driver(at, theta, target);
    inf_robot *r = &s.robot[0];
    for (int tick = 0; tick < 300 && nearest > 20; tick++) {
      double out[2];
      inf_control(&s, 0, out);
      double forward = 0.45 * (out[0] + out[1]), turn = 0.9 * (out[1] - out[0]) / 0.08;
      theta += turn / 30;
      r->o_rad = -theta;
      r->at.x += forward * cos(theta) * 400 / 30;
      r->at.y += forward * sin(theta) * 400 / 30;
      nearest = fmin(nearest, vs_point_distance(r->at, target));
    }
    if (nearest > 20) fail_msg("target %d missed by %g px", k, nearest);
  }
}

int main(void) {
  const struct CMUnitTest others[] = {
      cmocka_unit_test(first_drive_ever_is_at_three_quarters),
      cmocka_unit_test(robot_on_its_target_stands),
      cmocka_unit_test(change_of_end_holds_the_next_robot_once),
      cmocka_unit_test(front_first_turns_the_wrong_way),
      cmocka_unit_test(axis_along_a_coordinate_or_a_diagonal_gives_finite_wheels),
      cmocka_unit_test(random_targets_are_reached),
  };
  int failed = RUN_ROWS("turns", rows, run) + RUN_ROWS("drives", drives, run_drive);
  return failed + cmocka_run_group_tests(others, NULL, NULL);
}
