// src/policy/strategies/emc_control.c and src/policy/strategies/command.c: command -> wheels, worked out by hand. Wheels =
// V -+ 0.04 W; V = v cos e, W = 15 e forwards, V = -v cos b, W = 10 b backwards.
#include "commands.h"
#include "policy/strategies/emc.h"

typedef struct row {
  const char *name;
  vs_point at;
  double theta_rad;
  emc_command command;
  double left_mps, right_mps;
} row;

static void run(void **state) {
  const row *r = *state;
  emc_role role = {.at = r->at, .theta_rad = r->theta_rad, .command = r->command};
  double wheel[2];
  emc_control(&role, wheel);
  assert_near(wheel[0], r->left_mps, 1e-9);
  assert_near(wheel[1], r->right_mps, 1e-9);
}

static const row rows[] = {
    {"no command: stands", {0, 0}, 0, {.kind = EMC_NONE, .speed_mps = 1}, 0, 0},
    {"spin left: 35 rad/s is 1.4 m/s a wheel", {0, 0}, 1, {.kind = EMC_SPIN, .spin_radps = 35}, -1.4, 1.4},
    {"vector ahead: full speed", {0, 0}, 0.5, {.kind = EMC_VECTOR, .angle_rad = 0.5, .speed_mps = 1.4}, 1.4, 1.4},
    // e = 0.1: V = cos 0.1, W = 1.5.
    {"vector to the left: turns left",
     {0, 0},
     0,
     {.kind = EMC_VECTOR, .angle_rad = 0.1, .speed_mps = 1},
     0.995004165278 - 0.06,
     0.995004165278 + 0.06},
    {"vector behind: drives backwards", {0, 0}, 0, {.kind = EMC_VECTOR, .angle_rad = VS_PI, .speed_mps = 1}, -1, -1},
    // e = pi - 0.1, b = -0.1: V = -cos 0.1, W = -1.
    {"vector behind to the left: backwards, turns right",
     {0, 0},
     0,
     {.kind = EMC_VECTOR, .angle_rad = VS_PI - 0.1, .speed_mps = 1},
     -0.995004165278 + 0.04,
     -0.995004165278 - 0.04},
    {"vector across the wrap: takes the short way",
     {0, 0},
     3.1,
     {.kind = EMC_VECTOR, .angle_rad = 3.1 + 0.1 - 2 * VS_PI, .speed_mps = 1},
     0.995004165278 - 0.06,
     0.995004165278 + 0.06},
    {"position: slows with the root of the distance",
     {0, 0},
     0,
     {.kind = EMC_POSITION, .target = {0.25, 0}, .speed_mps = 1.4},
     0.7,
     0.7},
    {"position within 2 cm: stands", {0, 0}, 0, {.kind = EMC_POSITION, .target = {0.019, 0}, .speed_mps = 1.4}, 0, 0},
    {"orientation: turns on the spot",
     {0, 0},
     0,
     {.kind = EMC_ORIENTATION, .angle_rad = 0.1, .speed_mps = 1.4},
     -0.06,
     0.06},
    {"orientation behind: turns its rear",
     {0, 0},
     0,
     {.kind = EMC_ORIENTATION, .angle_rad = VS_PI - 0.1, .speed_mps = 1.4},
     0.04,
     -0.04},
    {"uvf with arrival along the way: straight",
     {0, 0},
     0,
     {.kind = EMC_UVF, .target = {1, 0}, .angle_rad = 0, .speed_mps = 1},
     1,
     1},
    // Target (0.4, 0), reference (0.4, 0.1): f = atan 0.25 = 0.2449787, course -1.8 f = -0.4409616.
    {"uvf with arrival to the left: swings out to the right",
     {0, 0},
     -0.4409615941,
     {.kind = EMC_UVF, .target = {0.4, 0}, .angle_rad = VS_PI / 2, .speed_mps = 1},
     1,
     1},
};

static void assert_pid(emc_pid before, double target, double measured, double out, emc_pid after) {
  emc_pid pid = before;
  assert_near(emc_pid_step(&pid, target, measured, 0.1), out, 1e-12);
  assert_near(pid.integral, after.integral, 1e-12);
  assert_near(pid.last_error, after.last_error, 1e-12);
}

// e = 0.2, I = 0.02, D = 2: 0.5 + 0.05 + 0.002.
static void pid_adds_error_integral_and_derivative(void **state) {
  (void)state;
  assert_pid((emc_pid){0, 0}, 0.5, 0.3, 0.552, (emc_pid){0.02, 0.2});
}

static void pid_with_target_zero_forgets_and_gives_nothing(void **state) {
  (void)state;
  assert_pid((emc_pid){0.4, 1}, 0, 0.7, 0, (emc_pid){0, 0});
}

// e = -1, I = -0.48 - 0.1 held at -0.5, D = -10: -2.5 - 1.25 - 0.01, held at -2.
static void pid_holds_integral_and_output_at_their_limits(void **state) {
  (void)state;
  assert_pid((emc_pid){-0.48, 0}, 0.2, 1.2, -2, (emc_pid){-0.5, -1});
}

static void short_way_to_a_stop_command_keeps_the_old_target(void **state) {
  (void)state;
  emc_command c = {.kind = EMC_VECTOR, .target = {0.7, 0.7}, .angle_rad = 1, .speed_mps = 1.4};
  emc_go_stop(&c, (vs_point){0.2, 0.2}, (vs_point){0.2, 0.229}, 1.4, 0.03);
  assert_command(&c, &(wanted)STOPS, (vs_point){0.2, 0.2}, (vs_point){0.7, 0.7});
  emc_go_stop(&c, (vs_point){0.2, 0.2}, (vs_point){0.2, 0.231}, 1.4, 0.03);
  assert_command(&c, &(wanted)GOES(0.2, 0.231, 1.4), (vs_point){0.2, 0.2}, (vs_point){0.7, 0.7});
}

int main(void) {
  const struct CMUnitTest others[] = {
      cmocka_unit_test(pid_adds_error_integral_and_derivative),
      cmocka_unit_test(pid_with_target_zero_forgets_and_gives_nothing),
      cmocka_unit_test(pid_holds_integral_and_output_at_their_limits),
      cmocka_unit_test(short_way_to_a_stop_command_keeps_the_old_target),
  };
  return RUN_ROWS("wheels", rows, run) + cmocka_run_group_tests(others, NULL, NULL);
}
