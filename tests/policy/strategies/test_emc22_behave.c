// src/policy/strategies/emc22_behave.c: a test per row of the defender's and the keeper's behaviour. Metres from the
// field's lower left corner; upper half y >= 0.65.
#include "emc22_scene.h"

typedef struct row {
  const char *name;
  scene scene;
  wanted want;
} row;

static void run_defender(void **state) {
  const row *r = *state;
  emc22_state s = scene_state(&r->scene);
  emc22_defend(&s);
  assert_command(&s.robot[2].command, &r->want, s.robot[2].at, STORED);
}

static void run_keeper(void **state) {
  const row *r = *state;
  emc22_state s = scene_state(&r->scene);
  emc22_keep(&s);
  assert_command(&s.robot[1].command, &r->want, s.robot[1].at, STORED);
}

static const row defender[] = {
    {"ball at our end, upper: waits at the lower post", {.ball = {0.25, 0.7}}, GOES(0.32, 0.475, 1)},
    {"ball at our end, lower: waits at the upper post", {.ball = {0.25, 0.6}}, GOES(0.32, 0.825, 1)},
    {"attacker has the ball in our half: waits at the other post",
     {.ball = {0.5, 0.7}, .attacker = {0.45, 0.7}},
     GOES(0.32, 0.475, 1)},
    {"attacker 11 cm from the ball: on its line",
     {.ball = {0.5, 0.7}, .attacker = {0.39, 0.7}, .defender = {0.45, 0.5}},
     GOES(0.32, 0.7, 1)},
    {"waiting on its place: faces the ball",
     {.ball = {0.25, 0.7}, .defender = {0.32, 0.49}},
     FACES(atan2(0.21, -0.07), 1)},
    {"ball in their half: 40 cm behind the attacker", {.ball = {1.0, 0.6}}, GOES(0.6, 0.6, 1)},
    // In 0.35 s at x = 0.94, in a second at y = 1.1.
    {"ball rolls into their half: where it will be, within the area's height",
     {.ball = {0.8, 0.6}, .velocity = {0.4, 0.5}},
     GOES(0.6, 0.975, 1)},
    {"ball rolls down in their half: no lower than the area",
     {.ball = {1.0, 0.6}, .velocity = {0, -0.5}},
     GOES(0.6, 0.325, 1)},
    {"ball in their half, on its place: faces the ball", {.ball = {1.0, 0.6}, .defender = {0.59, 0.6}}, FACES(0, 1)},
    {"in our goal: comes to the centre", {.ball = {0.8, 0.6}, .defender = {0.1, 0.65}}, GOES(0.85, 0.65, 1)},
    {"in their goal, ball in their half: comes to the centre",
     {.ball = {1.5, 0.6}, .defender = {1.6, 0.65}},
     GOES(0.85, 0.65, 1)},
    {"touches, ball ahead: spins so that it goes to their goal",
     {.ball = {0.65, 0.4}, .defender = {0.6, 0.4}},
     SPINS(35)},
    {"touches, ball ahead, upper: the other way", {.ball = {0.65, 0.9}, .defender = {0.6, 0.9}}, SPINS(-35)},
    {"ball ahead: its line, level with the ball", {.ball = {0.7, 0.5}}, GOES(0.32, 0.5, 1)},
    {"ball behind, upper: its line, upper post", {.ball = {0.5, 0.7}}, GOES(0.32, 0.825, 1)},
    {"ball behind, lower: its line, lower post", {.ball = {0.5, 0.6}}, GOES(0.32, 0.475, 1)},
    {"on its place within 2 cm: stops, target kept", {.ball = {0.7, 0.5}, .defender = {0.32, 0.51}}, STOPS},
};

#define PENALTY_AGAINST .foul = EMC22_PENALTY, .fresh = true
#define IN_GOAL_AREA    .keeper = {0.17, 0.65}

static const row keeper[] = {
    // From (0.6, 0.7) through (0.475, 0.65): 0.4 down per metre, at x = 0.17 at 0.65 - 0.4 * 0.305.
    {"penalty against us: on the shooter's line",
     {.ball = {0.475, 0.65}, IN_GOAL_AREA, .adversaries = 1, .adversary = {{0.6, 0.7}}, PENALTY_AGAINST},
     GOES(0.145, 0.528, 1)},
    {"penalty against us: the shooter is the nearest adversary",
     {.ball = {0.475, 0.65}, IN_GOAL_AREA, .adversaries = 2, .adversary = {{1.2, 0.2}, {0.6, 0.7}}, PENALTY_AGAINST},
     GOES(0.145, 0.528, 1)},
    {"penalty against us, steep: 15 cm from the middle at most",
     {.ball = {0.475, 0.65}, IN_GOAL_AREA, .adversaries = 1, .adversary = {{0.6, 0.9}}, PENALTY_AGAINST},
     GOES(0.145, 0.5, 1)},
    {"penalty against us, steep from below: 15 cm at most",
     {.ball = {0.475, 0.65}, IN_GOAL_AREA, .adversaries = 1, .adversary = {{0.6, 0.4}}, PENALTY_AGAINST},
     GOES(0.145, 0.8, 1)},
    {"penalty against us, nobody seen: level with the ball",
     {.ball = {0.475, 0.6}, IN_GOAL_AREA, PENALTY_AGAINST},
     GOES(0.145, 0.6, 1)},
    // Within 4 cm of its place; from the ball the robot lies at 180 - 5.8 degrees.
    {"penalty against us, on its place: spins",
     {.ball = {0.475, 0.65}, .keeper = {0.145, 0.62}, PENALTY_AGAINST},
     SPINS(-35)},
    {"penalty against us more than a second ago: as always",
     {.ball = {0.475, 0.6}, IN_GOAL_AREA, .foul = EMC22_PENALTY},
     GOES(0.17, 0.6, 1)},
    {"our own penalty: as always",
     {.ball = {0.475, 0.6}, IN_GOAL_AREA, .foul = EMC22_PENALTY, .ours = true, .fresh = true},
     GOES(0.17, 0.6, 1)},
    {"in our goal: comes out", {.ball = {0.15, 0.7}, .keeper = {0.1, 0.6}}, GOES(0.155, 0.65, 1)},
    {"in their goal: comes home", {.ball = {0.9, 0.6}, .keeper = {1.6, 0.6}}, GOES(0.155, 0.65, 1)},
    {"ball at rest: level with it", {.ball = {0.8, 0.6}}, GOES(0.17, 0.6, 1)},
    {"ball above the goal: its upper post", {.ball = {0.8, 0.9}}, GOES(0.17, 0.825, 1)},
    {"ball below the goal: its lower post", {.ball = {0.8, 0.3}}, GOES(0.17, 0.475, 1)},
    {"ball in the upper corner of the goal: beside it", {.ball = {0.2, 0.83}}, GOES(0.17, 0.935, 1)},
    {"ball in the lower corner of the goal: beside it", {.ball = {0.2, 0.47}}, GOES(0.17, 0.365, 1)},
    {"ball comes: where it will cross the line", {.ball = {0.67, 0.6}, .velocity = {-0.5, 0.1}}, GOES(0.17, 0.7, 1)},
    {"ball will cross above the goal: its upper post",
     {.ball = {0.67, 0.6}, .velocity = {-0.5, 0.4}},
     GOES(0.17, 0.825, 1)},
    {"ball will cross below the goal: its lower post",
     {.ball = {0.67, 0.6}, .velocity = {-0.5, -0.4}},
     GOES(0.17, 0.475, 1)},
    {"ball hardly comes: level with it", {.ball = {0.67, 0.6}, .velocity = {-0.003, 0.003}}, GOES(0.17, 0.6, 1)},
    {"ball leaves: level with it", {.ball = {0.67, 0.6}, .velocity = {0.5, 0.1}}, GOES(0.17, 0.6, 1)},
    {"touches the ball above it: spins right", {.ball = {0.22, 0.66}, IN_GOAL_AREA}, SPINS(-35)},
    {"touches the ball below it: spins left", {.ball = {0.22, 0.64}, IN_GOAL_AREA}, SPINS(35)},
    {"8.4 cm from the ball: no touch, on its place: turns along the line",
     {.ball = {0.254, 0.65}, IN_GOAL_AREA},
     FACES(VS_PI / 2, 1)},
    {"ball comes fast at a keeper on its place: spins",
     {.ball = {0.5, 0.66}, .velocity = {-0.5, 0}, IN_GOAL_AREA},
     SPINS(-35)},
    {"ball comes too slowly: waits along the line",
     {.ball = {0.5, 0.66}, .velocity = {-0.3, 0}, IN_GOAL_AREA},
     FACES(VS_PI / 2, 1)},
    {"ball comes fast, keeper not on its place: goes there",
     {.ball = {0.5, 0.70}, .velocity = {-0.5, 0}, IN_GOAL_AREA},
     GOES(0.17, 0.7, 1)},
    {"ball leaves fast: waits along the line",
     {.ball = {0.5, 0.66}, .velocity = {0.5, 0}, IN_GOAL_AREA},
     FACES(VS_PI / 2, 1)},
    {"attacker in our area, keeper not: stops",
     {.ball = {0.8, 0.6}, .attacker = {0.2, 0.5}},
     {.kind = EMC_SPIN, .target = {0.17, 0.6}, .new_target = true}},
    {"attacker in our area, keeper too: goes on",
     {.ball = {0.8, 0.6}, .attacker = {0.2, 0.5}, IN_GOAL_AREA},
     GOES(0.17, 0.6, 1)},
};

// A millimetre inside and outside of the edges.
static const row defender_edges[] = {
    {"ball at 0.279: waits at the post", {.ball = {0.279, 0.7}}, GOES(0.32, 0.475, 1)},
    {"ball at 0.281: goes to its line", {.ball = {0.281, 0.7}}, GOES(0.32, 0.825, 1)},
    {"ball at 0.529, attacker has it: waits at the post",
     {.ball = {0.529, 0.7}, .attacker = {0.5, 0.7}, .defender = {0.4, 0.4}},
     GOES(0.32, 0.475, 1)},
    {"ball at 0.531, attacker has it: on its line",
     {.ball = {0.531, 0.7}, .attacker = {0.5, 0.7}, .defender = {0.4, 0.4}},
     GOES(0.32, 0.7, 1)},
    {"attacker 9.9 cm from the ball: waits at the post",
     {.ball = {0.5, 0.7}, .attacker = {0.401, 0.7}, .defender = {0.4, 0.4}},
     GOES(0.32, 0.475, 1)},
    {"attacker 10.1 cm from the ball: on its line",
     {.ball = {0.5, 0.7}, .attacker = {0.399, 0.7}, .defender = {0.4, 0.4}},
     GOES(0.32, 0.7, 1)},
    {"ball at 0.919: on its line", {.ball = {0.919, 0.5}}, GOES(0.32, 0.5, 1)},
    {"ball at 0.921: behind the attacker", {.ball = {0.921, 0.5}}, GOES(0.6, 0.5, 1)},
    {"our goal, inside", {.ball = {0.8, 0.6}, .defender = {0.109, 0.5}}, GOES(0.85, 0.65, 1)},
    {"our goal, outside", {.ball = {0.8, 0.6}, .defender = {0.111, 0.5}}, GOES(0.32, 0.6, 1)},
    {"their goal, inside", {.ball = {1.2, 0.6}, .defender = {1.591, 0.5}}, GOES(0.85, 0.65, 1)},
    {"their goal, outside", {.ball = {1.2, 0.6}, .defender = {1.589, 0.5}}, GOES(0.6, 0.6, 1)},
    {"ball 7.9 cm away: touched", {.ball = {0.679, 0.4}}, SPINS(35)},
    {"ball 8.1 cm away: not touched", {.ball = {0.681, 0.4}}, GOES(0.32, 0.4, 1)},
    {"2.1 cm from its place: goes on", {.ball = {0.7, 0.5}, .defender = {0.341, 0.5}}, GOES(0.32, 0.5, 1)},
    {"1.9 cm from its place: stops", {.ball = {0.7, 0.5}, .defender = {0.339, 0.5}}, STOPS},
};

static const row keeper_edges[] = {
    {"goal corner, upper, inside", {.ball = {0.252, 0.826}}, GOES(0.17, 0.935, 1)},
    {"goal corner, upper, below it", {.ball = {0.252, 0.824}}, GOES(0.17, 0.824, 1)},
    {"goal corner, right of it", {.ball = {0.254, 0.9}}, GOES(0.17, 0.825, 1)},
    {"goal corner, left edge, inside", {.ball = {0.081, 0.9}}, GOES(0.17, 0.935, 1)},
    {"goal corner, left of it", {.ball = {0.079, 0.9}}, GOES(0.17, 0.825, 1)},
    {"goal corner, lower, inside", {.ball = {0.252, 0.474}}, GOES(0.17, 0.365, 1)},
    {"goal corner, lower, above it", {.ball = {0.252, 0.476}}, GOES(0.17, 0.476, 1)},
    {"ball 8.2 cm away: touched", {.ball = {0.252, 0.651}, IN_GOAL_AREA}, SPINS(-35)},
    {"2.9 cm from its place, ball comes fast: spins",
     {.ball = {0.5, 0.679}, .velocity = {-0.5, 0}, IN_GOAL_AREA},
     SPINS(-35)},
    {"3.1 cm from its place, ball comes fast: goes there",
     {.ball = {0.5, 0.681}, .velocity = {-0.5, 0}, IN_GOAL_AREA},
     GOES(0.17, 0.681, 1)},
    {"penalty against us, 3.9 cm from its place: spins",
     {.ball = {0.475, 0.65}, .keeper = {0.145, 0.611}, PENALTY_AGAINST},
     SPINS(-35)},
    {"penalty against us, 4.1 cm from its place: goes there",
     {.ball = {0.475, 0.65}, .keeper = {0.145, 0.609}, PENALTY_AGAINST},
     GOES(0.145, 0.65, 1)},
};

int main(void) {
  int failed = RUN_ROWS("defender", defender, run_defender) + RUN_ROWS("keeper", keeper, run_keeper);
  failed += RUN_ROWS("defender's edges", defender_edges, run_defender);
  return failed + RUN_ROWS("keeper's edges", keeper_edges, run_keeper);
}
