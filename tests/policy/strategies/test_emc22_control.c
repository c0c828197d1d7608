// src/policy/strategies/emc22_control.c: command -> wheels, worked out by hand. Curve: R, L = v * sat(m +- (sin e +
// m kgz tan(m e / 2))), kgz 0.22 in the field and 0.7 for the keeper.
#include "emc22_scene.h"

// The keeper avoids nothing: its wheels are the plain law.
typedef struct keeper_row {
  const char *name;
  double theta_rad;
  emc_command command;
  bool penalty;
  double left_mps, right_mps;
} keeper_row;

static void run_keeper(void **state) {
  const keeper_row *r = *state;
  emc22_state s = scene_state(&(scene){.ball = {0.9, 0.3}, .foul = EMC22_PENALTY, .fresh = r->penalty});
  s.robot[1].theta_rad = r->theta_rad;
  s.robot[1].command = r->command;
  emc22_control(&s);
  assert_near(s.robot[1].wheel_mps[0], r->left_mps, 1e-6);
  assert_near(s.robot[1].wheel_mps[1], r->right_mps, 1e-6);
}

// The keeper stands at (0.5, 0.65).
#define TO(x_m, y_m) .target = {x_m, y_m}
#define VECTOR_AT(rad)                                                                                                 \
  { .kind = EMC_VECTOR, .angle_rad = rad, .speed_mps = 1 }
#define POSITION(x_m, y_m)                                                                                             \
  { .kind = EMC_POSITION, TO(x_m, y_m), .speed_mps = 1 }

static const keeper_row keeper[] = {
    {"no command: stands", 0, {.kind = EMC_NONE, .speed_mps = 1}, false, 0, 0},
    {"spin left: 1.4 m/s a wheel", 0, {.kind = EMC_SPIN, .spin_radps = 35}, false, -1.4, 1.4},
    {"vector ahead", 0.5, VECTOR_AT(0.5), false, 1, 1},
    // sin 0.2 = 0.198669, 0.7 tan 0.1 = 0.070234: left 1 - 0.268903, right held at 1.
    {"vector to the left: the left wheel slower", 0, VECTOR_AT(0.2), false, 0.731097, 1},
    {"vector to the right: the right wheel slower", 0, VECTOR_AT(-0.2), false, 1, 0.731097},
    // Rear 0.2 rad to the left: m = -1, e = 0.2, bend = -0.7 tan(-0.1): right -1 + 0.268903, left held at -1.
    {"vector behind: backwards, turning the same way", 0, VECTOR_AT(0.2 - VS_PI), false, -1, -0.731097},
    // 0.2 m: u = tanh 1 = 0.761594, V = 0.8 u.
    {"position ahead: 0.8 of the braked speed", 0, POSITION(0.7, 0.65), false, 0.609275, 0.609275},
    {"position behind: backwards", 0, POSITION(0.3, 0.65), false, -0.609275, -0.609275},
    // e = 0.2: V = 0.609275 cos 0.2 = 0.597130, W = 4.
    {"position to the left: turns at 20 rad/s a radian", -0.2, POSITION(0.7, 0.65), false, 0.437130, 0.757130},
    {"position in a penalty against us: the field players' curve", 0, POSITION(0.7, 0.65), true, 0.761594, 0.761594},
    {"position within 5 mm: stands", 0, POSITION(0.504, 0.65), false, 0, 0},
    // Arrival up at (0.9, 0.65): reference (0.9, 0.75), f = atan 0.25 = 0.244979, course -1.7 f.
    {"uvf: swings out",
     -0.416464,
     {.kind = EMC_UVF, TO(0.9, 0.65), .angle_rad = VS_PI / 2, .speed_mps = 1},
     false,
     1,
     1},
    {"orientation: turns at 7 rad/s a radian",
     0,
     {.kind = EMC_ORIENTATION, .angle_rad = 0.5, .speed_mps = 1},
     false,
     -0.14,
     0.14},
    {"orientation: the nearer end",
     0,
     {.kind = EMC_ORIENTATION, .angle_rad = VS_PI - 0.5, .speed_mps = 1},
     false,
     0.14,
     -0.14},
};

// A field player at the centre of the field that should drive along +x. The walls' feet turn it by 0.04 (1/0.85 +
// 1/0.85) = 0.094118 (those ahead and behind; those at the sides cancel); every other obstacle adds to that. With its
// heading on the bent course both wheels run at full speed.
typedef struct obstacle_row {
  const char *name;
  int robot; // 0 attacker, 2 defender
  scene scene;
  double course_rad;
} obstacle_row;

static void run_obstacle(void **state) {
  const obstacle_row *r = *state;
  emc22_state s = scene_state(&r->scene);
  emc22_robot *robot = &s.robot[r->robot];
  emc_heading(&robot->command, 0, 1);
  robot->theta_rad = r->course_rad;
  emc22_control(&s);
  assert_near(robot->wheel_mps[0], 1, 1e-5);
  assert_near(robot->wheel_mps[1], 1, 1e-5);
}

#define WALLS (0.08 / 0.85)
#define CENTRE                                                                                                         \
  { 0.85, 0.65 }
// The keeper 0.7 m to the left of the centre turns a robot there by 0.07 / 0.7 = 0.1.
#define KEEPER_BEHIND .keeper = {0.15, 0.65}
#define NEAR_BALL     .ball = {0.85, 0.45}
#define FAR_BALL      .ball = {0.85, 0.25}

static const obstacle_row obstacles[] = {
    {"attacker near the ball: walls and keeper",
     0,
     {NEAR_BALL, .attacker = CENTRE, KEEPER_BEHIND, .defender = {0.85, 0.9}},
     WALLS + 0.1},
    // Defender 0.25 m above: it lies to the left, so the robot turns right by 0.05 / 0.25.
    {"attacker far from the ball: the defender as well",
     0,
     {FAR_BALL, .attacker = CENTRE, KEEPER_BEHIND, .defender = {0.85, 0.9}},
     WALLS + 0.1 - 0.2},
    {"attacker near the ball: no adversaries",
     0,
     {NEAR_BALL, .attacker = CENTRE, KEEPER_BEHIND, .adversaries = 1, .adversary = {{0.85, 1.15}}},
     WALLS + 0.1},
    // The defender of the scene, (0.6, 0.4), lies 0.353553 m to the right and behind: +0.05 / 0.353553.
    {"attacker far from the ball: adversaries far from it",
     0,
     {FAR_BALL, .attacker = CENTRE, KEEPER_BEHIND, .adversaries = 1, .adversary = {{0.85, 1.15}}},
     WALLS + 0.1 + 0.141421 - 0.14},
    {"attacker far from the ball: no adversary near the ball",
     0,
     {FAR_BALL, .attacker = CENTRE, KEEPER_BEHIND, .adversaries = 1, .adversary = {{0.85, 0.5}}},
     WALLS + 0.1 + 0.141421},
    // Attacker 0.35 m above the defender: -0.07 / 0.35.
    {"defender: walls, keeper and attacker",
     2,
     {NEAR_BALL, .defender = CENTRE, KEEPER_BEHIND, .attacker = {0.85, 1.0}},
     WALLS + 0.1 - 0.2},
    {"defender near the ball: adversaries far from the ball",
     2,
     {NEAR_BALL, .defender = CENTRE, KEEPER_BEHIND, .attacker = {0.85, 1.0}, .adversaries = 2,
      .adversary = {{0.85, 1.15}, {0.85, 0.5}}},
     WALLS + 0.1 - 0.2 - 0.14},
};

static void field_player_does_not_turn_to_an_orientation(void **state) {
  (void)state;
  emc22_state s = scene_state(&(scene){.ball = {0.9, 0.3}});
  emc_face(&s.robot[2].command, s.robot[2].at, s.ball, 1);
  emc22_control(&s);
  assert_near(s.robot[2].wheel_mps[0], 0, 0);
  assert_near(s.robot[2].wheel_mps[1], 0, 0);
}

// Attacker at the centre, course bent by WALLS + 0.1 and heading 0.1 less: e = 0.1; 0.2 m to go.
static void field_player_brakes_towards_a_position(void **state) {
  (void)state;
  emc22_state s = scene_state(&(scene){NEAR_BALL, .attacker = CENTRE, KEEPER_BEHIND});
  s.robot[0].theta_rad = WALLS;
  s.robot[0].command = (emc_command)POSITION(1.05, 0.65);
  emc22_control(&s);
  double speed = 0.761594 * 0.995004;
  assert_near(s.robot[0].wheel_mps[1], speed, 1e-5);
  assert_near(s.robot[0].wheel_mps[0], speed * (1 - 0.0998334 - 0.22 * 0.0500417), 1e-5);
}

static emc22_robot settled(double omega_radps, double last_mps, bool penalty, emc_kind kind) {
  emc22_state s = scene_state(&(scene){.ball = {0.9, 0.3}, .foul = EMC22_PENALTY, .fresh = penalty});
  s.robot[1].spun = true;
  s.robot[1].theta_rad = VS_PI / 2 - 0.1;
  s.robot[1].omega_radps = omega_radps;
  s.robot[1].wheel_mps[0] = s.robot[1].wheel_mps[1] = last_mps;
  s.robot[1].command = (emc_command){.kind = kind, TO(0.7, 0.65), .speed_mps = 1, .spin_radps = 35};
  emc22_control(&s);
  return s.robot[1];
}

// W = 15 * 0.1 = 1.5: wheels -+0.06.
static void keeper_that_still_turns_after_a_spin_settles_along_its_goal(void **state) {
  (void)state;
  emc22_robot g = settled(1.1, 0.09, false, EMC_POSITION);
  assert_near(g.wheel_mps[0], -0.06, 1e-12);
  assert_near(g.wheel_mps[1], 0.06, 1e-12);
  assert_true(g.spun);
}

static void keeper_in_a_penalty_settles_standing(void **state) {
  (void)state;
  emc22_robot g = settled(1.1, 0.09, true, EMC_POSITION);
  assert_near(g.wheel_mps[0], 0, 0);
  assert_near(g.wheel_mps[1], 0, 0);
}

static void keeper_at_rest_after_a_spin_follows_its_command_again(void **state) {
  (void)state;
  emc22_robot g = settled(-0.9, 0.09, false, EMC_POSITION);
  assert_false(g.spun);
  assert_true(g.wheel_mps[1] - g.wheel_mps[0] < -0.5); // turns right, towards (0.7, 0.65)
}

static void keeper_that_drives_does_not_settle(void **state) {
  (void)state;
  emc22_robot g = settled(1.1, 0.11, false, EMC_POSITION);
  assert_true(g.spun);
  assert_true(g.wheel_mps[1] - g.wheel_mps[0] < -0.5);
}

static void keeper_that_spins_goes_on(void **state) {
  (void)state;
  emc22_robot g = settled(1.1, 0.09, false, EMC_SPIN);
  assert_near(g.wheel_mps[1], 1.4, 1e-12);
}

static void any_robots_spin_is_remembered(void **state) {
  (void)state;
  emc22_state s = scene_state(&(scene){.ball = {0.9, 0.3}});
  emc_stop(&s.robot[0].command);
  emc22_control(&s);
  assert_true(s.robot[0].spun);
  assert_false(s.robot[1].spun);
}

int main(void) {
  const struct CMUnitTest others[] = {
      cmocka_unit_test(field_player_does_not_turn_to_an_orientation),
      cmocka_unit_test(field_player_brakes_towards_a_position),
      cmocka_unit_test(keeper_that_still_turns_after_a_spin_settles_along_its_goal),
      cmocka_unit_test(keeper_in_a_penalty_settles_standing),
      cmocka_unit_test(keeper_at_rest_after_a_spin_follows_its_command_again),
      cmocka_unit_test(keeper_that_drives_does_not_settle),
      cmocka_unit_test(keeper_that_spins_goes_on),
      cmocka_unit_test(any_robots_spin_is_remembered),
  };
  int failed = RUN_ROWS("keeper", keeper, run_keeper) + RUN_ROWS("obstacles", obstacles, run_obstacle);
  return failed + cmocka_run_group_tests(others, NULL, NULL);
}
