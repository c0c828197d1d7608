// src/policy/strategies/emc.c: swaps of roles, a test per rule; the ball estimate; the tick's order. Metres from the
// field's lower left corner. Robots 0, 1, 2 start as attacker, defender, keeper.
#include "commands.h"
#include "policy/strategies/emc.h"

#define NOWHERE NAN // a role whose last command has no direction

typedef struct row {
  const char *name;
  vs_point ball, attacker, defender, keeper;
  double heading_rad[EMC_ROLES]; // of the last commands of attacker, defender, keeper
  int robot[EMC_ROLES];          // that hold the roles afterwards
  bool restarts;                 // the 2 s begin anew
} row;

static emc_state scene(vs_point ball, vs_point attacker, vs_point defender, vs_point keeper, emc_input *in) {
  emc_state s;
  emc_init(&s);
  s.running = true;
  s.clock_s = 100;
  for (int i = 0; i < EMC_SAMPLES; i++) s.sample[i] = ball;
  *in = (emc_input){.ball = ball, .at = {attacker, defender, keeper}, .dt_s = 1.0 / 30};
  return s;
}

static void run(void **state) {
  const row *r = *state;
  emc_input in;
  emc_state s = scene(r->ball, r->attacker, r->defender, r->keeper, &in);
  for (int i = 0; i < EMC_ROLES; i++)
    if (!isnan(r->heading_rad[i])) emc_heading(&s.role[i].command, r->heading_rad[i], 1.4);
  emc_output out;
  emc_tick(&s, &in, &out);
  for (int i = 0; i < EMC_ROLES; i++) assert_int_equal(s.role[i].robot, r->robot[i]);
  assert_near(s.swap_s, r->restarts ? 100 + 1.0 / 30 : 0, 1e-9);
}

#define EAST 0
#define WEST VS_PI

// Keeper left of the defender, both far from the attacker, which has the ball.
#define KEEPER_TOUCHES_DEFENDER                                                                                        \
  {1.05, 0.6}, {1.0, 0.6}, {0.4, 0.6}, { 0.3, 0.6 }
// Defender left of the attacker, the ball as far from one as from the other.
#define DEFENDER_TOUCHES_ATTACKER                                                                                      \
  {0.90625, 0.75}, {0.9375, 0.5}, {0.875, 0.5}, { 0.155, 0.6 }
// Keeper left of the attacker, which has the ball.
#define KEEPER_TOUCHES_ATTACKER                                                                                        \
  {0.42, 0.6}, {0.4, 0.6}, {1.0, 0.3}, { 0.3, 0.6 }

static const row rows[] = {
    {"keeper drives into defender: they swap", KEEPER_TOUCHES_DEFENDER, {NOWHERE, NOWHERE, EAST}, {0, 2, 1}, true},
    {"keeper drives away, defender into it: no swap", KEEPER_TOUCHES_DEFENDER, {NOWHERE, WEST, WEST}, {0, 1, 2}, true},
    {"keeper has no direction, defender drives into it: they swap",
     KEEPER_TOUCHES_DEFENDER,
     {NOWHERE, WEST, NOWHERE},
     {0, 2, 1},
     true},
    {"keeper has no direction, defender drives away: no swap",
     KEEPER_TOUCHES_DEFENDER,
     {NOWHERE, EAST, NOWHERE},
     {0, 1, 2},
     true},
    {"neither keeper nor defender has a direction: no swap",
     KEEPER_TOUCHES_DEFENDER,
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     true},
    {"keeper passes defender at 80 degrees: they swap",
     KEEPER_TOUCHES_DEFENDER,
     {NOWHERE, NOWHERE, 1.4},
     {0, 2, 1},
     true},
    {"keeper passes defender at 100 degrees: no swap",
     KEEPER_TOUCHES_DEFENDER,
     {NOWHERE, NOWHERE, 1.75},
     {0, 1, 2},
     true},
    {"defender drives into attacker: they swap", DEFENDER_TOUCHES_ATTACKER, {NOWHERE, EAST, NOWHERE}, {1, 0, 2}, true},
    {"defender drives away from attacker: no swap", DEFENDER_TOUCHES_ATTACKER, {WEST, WEST, NOWHERE}, {0, 1, 2}, true},
    {"defender has no direction, attacker drives into it: they swap",
     DEFENDER_TOUCHES_ATTACKER,
     {WEST, NOWHERE, NOWHERE},
     {1, 0, 2},
     true},
    {"defender has no direction, attacker drives away: no swap",
     DEFENDER_TOUCHES_ATTACKER,
     {EAST, NOWHERE, NOWHERE},
     {0, 1, 2},
     true},
    {"neither defender nor attacker has a direction: no swap",
     DEFENDER_TOUCHES_ATTACKER,
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     true},
    {"keeper drives into attacker: they swap", KEEPER_TOUCHES_ATTACKER, {NOWHERE, NOWHERE, EAST}, {2, 1, 0}, true},
    {"keeper drives away from attacker: no swap", KEEPER_TOUCHES_ATTACKER, {WEST, NOWHERE, WEST}, {0, 1, 2}, true},
    {"keeper has no direction, attacker drives into it: they swap",
     KEEPER_TOUCHES_ATTACKER,
     {WEST, NOWHERE, NOWHERE},
     {2, 1, 0},
     true},
    {"keeper has no direction, attacker drives away: no swap",
     KEEPER_TOUCHES_ATTACKER,
     {EAST, NOWHERE, NOWHERE},
     {0, 1, 2},
     true},
    {"neither keeper nor attacker has a direction: no swap",
     KEEPER_TOUCHES_ATTACKER,
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     true},
    {"only the first touching pair counts",
     {0.55, 0.6},
     {0.5, 0.6},
     {0.4, 0.6},
     {0.3, 0.6},
     {NOWHERE, EAST, WEST},
     {0, 1, 2},
     true},
    {"12.5 cm apart is no touch",
     {1.05, 0.6},
     {1.0, 0.6},
     {0.425, 0.6},
     {0.3, 0.6},
     {NOWHERE, NOWHERE, EAST},
     {0, 1, 2},
     false},
    // After the swap the new attacker is farther from the ball than the new defender: swapped back at once.
    {"a swap by touch is undone by the distance to the ball",
     {1.05, 0.6},
     {1.0, 0.6},
     {0.9, 0.6},
     {0.155, 0.6},
     {NOWHERE, EAST, NOWHERE},
     {0, 1, 2},
     true},
    {"ball in their box, attacker in the corner and farther: swap",
     {1.45, 0.6},
     {1.4, 1.0},
     {1.3, 0.6},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {1, 0, 2},
     true},
    {"ball in their box, attacker nearer: none",
     {1.45, 0.6},
     {1.35, 0.6},
     {1.0, 0.6},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     false},
    {"attacker more than 0.3 beyond the ball: swap, though the defender is farther",
     {0.8, 0.6},
     {1.2, 0.6},
     {0.3, 0.2},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {1, 0, 2},
     true},
    {"attacker 0.25 beyond the ball: none",
     {0.8, 0.6},
     {1.05, 0.6},
     {0.3, 0.2},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     false},
    {"attacker 0.4 behind the ball: none",
     {0.8, 0.6},
     {0.4, 0.6},
     {0.36, 0.2},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     false},
    {"attacker far beyond the ball in their corner: none",
     {1.0, 0.6},
     {1.45, 1.0},
     {0.3, 0.6},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     false},
    {"defender nearer to the ball: swap",
     {0.8, 0.6},
     {0.5, 0.6},
     {0.7, 0.4},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {1, 0, 2},
     true},
    {"defender nearer, attacker in their corner: none",
     {1.3, 1.1},
     {1.39, 0.95},
     {1.2, 1.1},
     {0.155, 0.6},
     {NOWHERE, NOWHERE, NOWHERE},
     {0, 1, 2},
     false},
};

// Whether the last command has a direction, and which: the keeper touches the defender, which lies to its east.
typedef struct direction {
  const char *name;
  emc_command last;
  bool swaps;
} direction;

static const direction directions[] = {
    {"position: towards its target, swap", {EMC_POSITION, {1.0, 0.6}, WEST, 1.4, 0}, true},
    {"position: towards a target behind, no swap", {EMC_POSITION, {0.1, 0.6}, EAST, 1.4, 0}, false},
    {"vector: along its angle, swap", {EMC_VECTOR, {0.1, 0.6}, EAST, 1.4, 0}, true},
    {"orientation: along its angle, swap", {EMC_ORIENTATION, {0.1, 0.6}, EAST, 1.4, 0}, true},
    {"uvf: along its angle, swap", {EMC_UVF, {0.1, 0.6}, EAST, 1.4, 0}, true},
    {"spin: none, the defender's counts", {EMC_SPIN, {1.0, 0.6}, EAST, 0, 35}, false},
    {"vector without speed: none, the defender's counts", {EMC_VECTOR, {1.0, 0.6}, EAST, 0, 0}, false},
};

static void run_direction(void **state) {
  const direction *d = *state;
  emc_input in;
  emc_state s = scene((vs_point){1.05, 0.6}, (vs_point){1.0, 0.6}, (vs_point){0.4, 0.6}, (vs_point){0.3, 0.6}, &in);
  s.role[EMC_KEEPER].command = d->last;
  emc_heading(&s.role[EMC_DEFENDER].command, EAST, 1.4); // away from the keeper
  emc_output out;
  emc_tick(&s, &in, &out);
  assert_int_equal(s.role[EMC_KEEPER].robot, d->swaps ? 1 : 2);
}

// Defender nearer to the ball from the start. At 30 Hz the 62nd call is the first at more than 2 s.
static void nothing_swaps_in_the_first_two_seconds(void **state) {
  (void)state;
  emc_state s;
  emc_init(&s);
  emc_input in = {.ball = {0.8, 0.6}, .at = {{0.5, 0.6}, {0.7, 0.4}, {0.155, 0.6}}, .dt_s = 1.0 / 30};
  emc_output out;
  for (int call = 1; call <= 61; call++) {
    emc_tick(&s, &in, &out);
    assert_int_equal(s.role[EMC_ATTACKER].robot, 0);
  }
  emc_tick(&s, &in, &out);
  assert_int_equal(s.role[EMC_ATTACKER].robot, 1);
}

static void swapped_robots_carry_each_others_commands_for_one_tick(void **state) {
  (void)state;
  emc_input in;
  emc_state s = scene((vs_point){0.8, 0.6}, (vs_point){0.5, 0.6}, (vs_point){0.7, 0.4}, (vs_point){0.155, 0.6}, &in);
  for (int tick = 0; tick < 2; tick++) {
    emc_output out;
    emc_tick(&s, &in, &out);
    assert_int_equal(s.role[EMC_ATTACKER].robot, 1);
    double attacker[2], defender[2];
    emc_control(&s.role[EMC_ATTACKER], attacker);
    emc_control(&s.role[EMC_DEFENDER], defender);
    assert_memory_equal(out.target_mps[tick], attacker, sizeof attacker); // robot 0 at first, then robot 1
    assert_memory_equal(out.target_mps[1 - tick], defender, sizeof defender);
  }
}

static void command_pid_and_uvf_stay_with_the_role_at_a_swap(void **state) {
  (void)state;
  emc_input in;
  emc_state s = scene((vs_point){0.8, 0.6}, (vs_point){0.5, 0.6}, (vs_point){0.7, 0.4}, (vs_point){0.155, 0.6}, &in);
  s.role[EMC_ATTACKER].pid[0].integral = 0.4;
  in.at[2] = (vs_point){0.155, 0.59};
  in.wheel_mps[0][0] = 0.3; // of robot 0, which still gets the attacker's wheels in this tick
  emc_output out;
  emc_tick(&s, &in, &out);
  double target[2];
  emc_control(&s.role[EMC_ATTACKER], target);
  assert_near(s.role[EMC_ATTACKER].pid[0].integral, vs_clamp(0.4 + (target[0] - 0.3) / 30, -0.5, 0.5), 1e-12);
}

// One sample among zeros weighs 1/15 + 18 * 7/280 = 0.51667.
static void first_sample_of_the_ball_counts_for_half(void **state) {
  (void)state;
  emc_state s;
  emc_init(&s);
  emc_input in = {.ball = {0.9, 0.6}, .dt_s = 1.0 / 30};
  emc_output out;
  emc_tick(&s, &in, &out);
  assert_near(s.ahead.x, 0.9 * (1.0 / 15 + 0.45), 1e-12);
  assert_near(s.ahead.y, 0.6 * (1.0 / 15 + 0.45), 1e-12);
}

// A ball on a straight line is seen 11 samples ahead once the zeros have left the window.
static void steady_ball_is_extrapolated_by_eleven_samples(void **state) {
  (void)state;
  emc_state s;
  emc_init(&s);
  emc_output out;
  for (int k = 0; k < 15; k++) {
    emc_input in = {.ball = {0.2 + 0.01 * k, 1.0 - 0.02 * k}, .dt_s = 1.0 / 30};
    emc_tick(&s, &in, &out);
  }
  assert_near(s.ahead.x, 0.2 + 0.01 * 25, 1e-12);
  assert_near(s.ahead.y, 1.0 - 0.02 * 25, 1e-12);
}

int main(void) {
  const struct CMUnitTest ticks[] = {
      cmocka_unit_test(nothing_swaps_in_the_first_two_seconds),
      cmocka_unit_test(swapped_robots_carry_each_others_commands_for_one_tick),
      cmocka_unit_test(command_pid_and_uvf_stay_with_the_role_at_a_swap),
      cmocka_unit_test(first_sample_of_the_ball_counts_for_half),
      cmocka_unit_test(steady_ball_is_extrapolated_by_eleven_samples),
  };
  int failed = RUN_ROWS("swaps", rows, run);
  failed += RUN_ROWS("directions", directions, run_direction);
  return failed + cmocka_run_group_tests(ticks, NULL, NULL);
}
