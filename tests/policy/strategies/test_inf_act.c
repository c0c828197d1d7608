// src/policy/strategies/inf_act.c: what each tactic makes of a robot's command, a test per rule. Pixels; the command held
// GOTO (1, 2) at 0.5 towards (3, 4) before.
#include "policy/strategies/inf.h"
#include "rows.h"

typedef struct row {
  const char *name;
  inf_tactic tactic;
  vs_point robot, ball;
  inf_kind kind;
  vs_point target;  // {1, 2}: the old one
  vs_point toward;  // {3, 4}: the old one
  double angle_rad; // instead of toward, where not 0
  double speed;
  bool locked, clockwise;
} row;

static void run(void **state) {
  const row *r = *state;
  inf_state s;
  inf_init(&s);
  s.ball = r->ball;
  s.sample[0] = r->ball;
  s.samples = 1;
  inf_robot *robot = &s.robot[1];
  robot->at = r->robot;
  robot->tactic = r->tactic;
  robot->locked = true; // of the last tick: cleared first
  robot->command = (inf_command){.kind = INF_GOTO, .target = {1, 2}, .toward = {3, 4}, .speed = 0.5};
  inf_act(&s, 1);
  const inf_command *c = &robot->command;
  assert_int_equal(c->kind, r->kind);
  assert_near(c->target.x, r->target.x, 1e-12);
  assert_near(c->target.y, r->target.y, 1e-12);
  assert_int_equal(c->toward_angle, r->angle_rad != 0);
  if (c->toward_angle) {
    assert_near(c->angle_rad, r->angle_rad, 1e-12);
  } else {
    assert_near(c->toward.x, r->toward.x, 1e-12);
    assert_near(c->toward.y, r->toward.y, 1e-12);
  }
  assert_near(c->speed, r->speed, 1e-12);
  assert_int_equal(robot->locked, r->locked);
  if (r->kind == INF_TURN) assert_int_equal(c->clockwise, r->clockwise);
}

#define PAST_GOAL  .toward = {696, 240}
#define OLD_TARGET .target = {1, 2}
#define OLD_TOWARD .toward = {3, 4}
#define GO         .kind = INF_GOTO
#define LOOKS      .kind = INF_LOOK, OLD_TARGET, .locked = true
#define TURNS(cw)  .kind = INF_TURN, OLD_TARGET, OLD_TOWARD, .speed = 1, .locked = true, .clockwise = cw

static const row rows[] = {
    {"kick: into their goal, full speed", INF_KICK, {300, 240}, {320, 240}, GO, {640, 240}, PAST_GOAL, .speed = 1},
    {"push, far: at the ball", INF_PUSHB, {300, 240}, {340, 200}, GO, {340, 200}, PAST_GOAL, .speed = 0.8},
    {"push, touching: into their goal", INF_PUSHB, {300, 240}, {320, 240}, GO, {640, 240}, PAST_GOAL, .speed = 0.8},
    {"catch a ball ahead: at the ball", INF_CATCH, {300, 240}, {340, 200}, GO, {340, 200}, PAST_GOAL, .speed = 0.8},
    {"catch a ball 29 px behind: at the ball",
     INF_CATCH,
     {300, 240},
     {271, 200},
     GO,
     {271, 200},
     PAST_GOAL,
     .speed = 0.8},
    {"catch a ball behind, upper: around below it",
     INF_CATCH,
     {300, 240},
     {260, 300},
     GO,
     {200, 282},
     PAST_GOAL,
     .speed = 0.8},
    {"catch a ball behind, lower: around above it",
     INF_CATCH,
     {300, 240},
     {260, 200},
     GO,
     {200, 218},
     PAST_GOAL,
     .speed = 0.8},
    {"side, upper: along +90 degrees",
     INF_SIDE,
     {300, 240},
     {340, 300},
     GO,
     {340, 300},
     .angle_rad = VS_PI / 2,
     .speed = 0.8},
    {"side, lower: along -90 degrees",
     INF_SIDE,
     {300, 240},
     {340, 200},
     GO,
     {340, 200},
     .angle_rad = -VS_PI / 2,
     .speed = 0.8},
    {"side with the ball behind: around it",
     INF_SIDE,
     {300, 240},
     {260, 200},
     GO,
     {200, 218},
     .angle_rad = -VS_PI / 2,
     .speed = 0.8},
    {"block, upper half: to the line, level with the ball",
     INF_BLOCK,
     {300, 260},
     {340, 200},
     GO,
     {68, 200},
     .toward = {68, 480},
     .speed = 0.8},
    {"block, lower half: the other wall",
     INF_BLOCK,
     {300, 220},
     {340, 200},
     GO,
     {68, 200},
     .toward = {68, 0},
     .speed = 0.8},
    {"block above the goal: its upper end",
     INF_BLOCK,
     {300, 220},
     {340, 400},
     GO,
     {68, 315.5},
     .toward = {68, 0},
     .speed = 0.8},
    {"block below the goal: its lower end",
     INF_BLOCK,
     {300, 220},
     {340, 20},
     GO,
     {68, 164.5},
     .toward = {68, 0},
     .speed = 0.8},
    {"block on its place: looks along the line",
     INF_BLOCK,
     {80, 220},
     {340, 210},
     LOOKS,
     .toward = {68, 0},
     .speed = 0.8},
    {"opening: before the area, level with the ball",
     INF_OPENING,
     {300, 260},
     {340, 420},
     GO,
     {124, 420},
     .toward = {68, 480},
     .speed = 0.8},
    {"opening: keeps 30 px from the upper wall",
     INF_OPENING,
     {300, 260},
     {340, 470},
     GO,
     {124, 450},
     .toward = {68, 480},
     .speed = 0.8},
    {"opening: keeps 30 px from the lower wall",
     INF_OPENING,
     {300, 220},
     {340, 10},
     GO,
     {124, 30},
     .toward = {68, 0},
     .speed = 0.8},
    {"opening, ball at our end: no higher than the area",
     INF_OPENING,
     {300, 220},
     {100, 420},
     GO,
     {124, 390.5},
     .toward = {68, 0},
     .speed = 0.8},
    {"opening, ball at our end: no lower than the area",
     INF_OPENING,
     {300, 220},
     {100, 20},
     GO,
     {124, 89.5},
     .toward = {68, 0},
     .speed = 0.8},
    {"opening on its place: looks at the ball",
     INF_OPENING,
     {124, 220},
     {340, 230},
     LOOKS,
     .toward = {340, 230},
     .speed = 0.8},
    {"wait: 160 px behind the ball in the middle",
     INF_WAIT,
     {500, 100},
     {400, 300},
     GO,
     {240, 240},
     .toward = {400, 300},
     .speed = 0.8},
    {"wait: not nearer to our goal than 56 px",
     INF_WAIT,
     {500, 100},
     {200, 300},
     GO,
     {56, 240},
     .toward = {200, 300},
     .speed = 0.8},
    {"wait where the ball is: looks past it",
     INF_WAIT,
     {500, 100},
     {56, 240},
     GO,
     {56, 240},
     .toward = {66, 250},
     .speed = 0.8},
    {"wait on its place: looks at the ball, speed as it was",
     INF_WAIT,
     {250, 240},
     {400, 300},
     LOOKS,
     .toward = {400, 300},
     .speed = 0.5},
    {"spin, ball well below: counter-clockwise", INF_SPIN, {300, 240}, {300, 209}, TURNS(false)},
    {"spin, ball well above: clockwise", INF_SPIN, {300, 240}, {300, 271}, TURNS(true)},
    {"spin, ball level, robot upper: clockwise", INF_SPIN, {300, 250}, {300, 240}, TURNS(true)},
    {"spin, ball level, robot lower: counter-clockwise", INF_SPIN, {300, 230}, {300, 240}, TURNS(false)},
    {"spin before their goal, ball above: clockwise", INF_SPIN, {400, 230}, {400, 240}, TURNS(true)},
    {"spin before their goal, ball below: counter-clockwise", INF_SPIN, {400, 300}, {400, 290}, TURNS(false)},
    {"spin in their half, beside the goal: as elsewhere", INF_SPIN, {400, 340}, {400, 330}, TURNS(true)},
};

// Along the orientation (0.5 rad here), 100 px, forwards or backwards by the team's sign; looks where it looked.
static void unlock_drives_along_the_orientation_by_the_sign(void **state) {
  (void)state;
  for (int sign = -1; sign <= 1; sign += 2) {
    inf_state s;
    inf_init(&s);
    s.unlock_sign = sign;
    s.robot[0] = (inf_robot){.at = {300, 200}, .o_rad = 0.5, .tactic = INF_UNLOCK, .command = s.robot[0].command};
    inf_act(&s, 0);
    const inf_command *c = &s.robot[0].command;
    assert_int_equal(c->kind, INF_GOTO);
    assert_near(c->target.x, 300 + sign * 87.758256189, 1e-6);
    assert_near(c->target.y, 200 + sign * 47.942553860, 1e-6);
    assert_near(c->toward.x, 696, 0); // never set before: past their goal
    assert_near(c->speed, 0.8, 0);
  }
}

// Through the oldest and the newest sample, here 20 px apart in x, to x = 68, 112 px on.
static void block_extrapolates_a_ball_at_the_lower_wall(void **state) {
  (void)state;
  inf_state s;
  inf_init(&s);
  s.robot[0].tactic = INF_BLOCK;
  s.robot[0].at = (vs_point){300, 200};
  s.ball = (vs_point){180, -5};
  s.sample[0] = (vs_point){200, -125};
  s.sample[1] = s.ball;
  s.samples = 2;
  inf_act(&s, 0);
  // Slope (-5 + 125) / (180 - 200) = -6: y = -5 + 6 * 112 = 667, held at the upper end of the goal.
  assert_near(s.robot[0].command.target.y, 315.5, 1e-12);
  s.sample[0] = (vs_point){200, -39};
  inf_act(&s, 0);
  // Slope 34 / -20 = -1.7: y = -5 + 1.7 * 112 = 185.4.
  assert_near(s.robot[0].command.target.y, 185.4, 1e-9);
  s.sample[0] = (vs_point){180, -39}; // straight along y: the newest
  inf_act(&s, 0);
  assert_near(s.robot[0].command.target.y, 164.5, 1e-12);
}

int main(void) {
  const struct CMUnitTest others[] = {
      cmocka_unit_test(unlock_drives_along_the_orientation_by_the_sign),
      cmocka_unit_test(block_extrapolates_a_ball_at_the_lower_wall),
  };
  return RUN_ROWS("tactics", rows, run) + cmocka_run_group_tests(others, NULL, NULL);
}
