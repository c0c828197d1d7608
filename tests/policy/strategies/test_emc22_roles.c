// src/policy/strategies/emc22.c: the choice of roles, the referee's commands, and how this program's events become them.
#include "emc22_scene.h"
#include "vsss/policy.h"

// Cost of (attacker, keeper): 0.3 (0.85 d(attacker, ball) + 0.15 |turn|) + 0.7 K (0.2 d(keeper, goal) + 0.8 (x - 0.08)),
// goal at (0.08, 0.65); turn between robot -> ball and ball -> (1.7, 0.65).
typedef struct row {
  const char *name;
  vs_point ball, robot[VS_TEAM_SIZE];
  emc22_foul foul;
  bool ours;
  int attacker, keeper;
} row;

static void run(void **state) {
  const row *r = *state;
  emc22_state s;
  emc22_init(&s);
  emc22_input in = {.ball = r->ball, .now_s = 50, .command = r->foul, .command_ours = r->ours};
  for (int i = 0; i < VS_TEAM_SIZE; i++) in.at[i] = r->robot[i];
  double wheel[VS_TEAM_SIZE][2];
  // The weight of a foul stays until the next one; "game on" is none.
  for (int k = 0; k < 3; k++) {
    emc22_tick(&s, &in, wheel);
    assert_int_equal(s.role[EMC22_ATTACKER], r->attacker);
    assert_int_equal(s.role[EMC22_KEEPER], r->keeper);
    assert_int_equal(s.role[EMC22_DEFENDER], 3 - r->attacker - r->keeper);
    in.now_s += 10;
    in.command = k == 0 ? EMC22_OTHER : EMC22_NO_FOUL;
  }
}

#define IN_A_ROW                                                                                                       \
  {                                                                                                                    \
    {0.2, 0.65}, {0.6, 0.65}, { 1.0, 0.65 }                                                                            \
  }
// 0 is at the ball and in front of the goal, 1 and 2 are upfield of the ball.
#define KEEPER_HAS_BALL                                                                                                \
  {0.3, 0.65}, {                                                                                                       \
    {0.2, 0.65}, {0.8, 0.65}, { 1.2, 0.65 }                                                                            \
  }
#define CLOSE_CALL                                                                                                     \
  {0.5, 0.65}, {                                                                                                       \
    {0.4, 0.65}, {0.5, 0.9}, { 1.2, 0.65 }                                                                             \
  }

static const row rows[] = {
    {"in a row: the last keeps, the first attacks", {1.1, 0.65}, IN_A_ROW, EMC22_NO_FOUL, false, 2, 0},
    // (0, 1): 0.0255 + 0.504; (1, 0): 0.2689 + 0.084.
    {"last robot has the ball: it keeps, another attacks", KEEPER_HAS_BALL, EMC22_NO_FOUL, false, 1, 0},
    // K 0.1, (0, 1): 0.0255 + 0.0504; (1, 0): 0.2689 + 0.0084.
    {"our goal kick: the last robot attacks", KEEPER_HAS_BALL, EMC22_GOAL_KICK, true, 0, 1},
    {"their goal kick: as always", KEEPER_HAS_BALL, EMC22_GOAL_KICK, false, 1, 0},
    // (0, 1): 0.0255 + 0.3036; (1, 0): 0.1344 + 0.224.
    {"close call: the robot behind the ball attacks", CLOSE_CALL, EMC22_NO_FOUL, false, 0, 1},
    // K 5: 0.0255 + 1.518 against 0.1344 + 1.12.
    {"penalty against us: the robot nearest to the goal keeps", CLOSE_CALL, EMC22_PENALTY, false, 1, 0},
    {"our penalty: as always", CLOSE_CALL, EMC22_PENALTY, true, 0, 1},
    {"free ball: as always", CLOSE_CALL, EMC22_FREE_BALL, false, 0, 1},
    {"equals: the first", {1.1, 0.65}, {{0.6, 0.65}, {0.6, 0.65}, {0.6, 0.65}}, EMC22_NO_FOUL, false, 0, 1},
};

// What a player makes of an event, read from its state.
typedef struct event_row {
  const char *name;
  vs_event_kind kind;
  vs_team team; // blue: ours
  emc22_foul foul;
  bool ours, restarts; // ... the one-second windows
} event_row;

static void run_event(void **state) {
  const event_row *r = *state;
  vs_player *player;
  assert_ok(vs_player_open("emc22:", &player, err));
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  for (int k = 0; k < 100; k++) assert_ok(vs_player_step(player, &world, &game, 0.03125, out, err));
  game.last_event = (vs_event){r->kind, r->team, 0, 3};
  emc22_state s;
  for (int k = 0; k < 4; k++) { // told once, however long it stays the last
    assert_ok(vs_player_step(player, &world, &game, 0.03125, out, err));
    vs_player_save(player, &s);
    assert_int_equal(s.foul, r->foul);
    if (r->foul != EMC22_NO_FOUL) assert_int_equal(s.foul_ours, r->ours);
    assert_near(s.command_s, r->restarts ? 101 * 0.03125 : 0, 1e-9);
    assert_int_equal(emc22_fresh(&s), r->restarts);
  }
  vs_player_close(player);
}

static const event_row events[] = {
    {"our kick-off", VS_EVENT_KICK_OFF, VS_BLUE, EMC22_KICKOFF, true, true},
    {"their kick-off", VS_EVENT_KICK_OFF, VS_YELLOW, EMC22_KICKOFF, false, true},
    {"our goal is their kick-off", VS_EVENT_GOAL, VS_BLUE, EMC22_KICKOFF, false, true},
    {"their goal is our kick-off", VS_EVENT_GOAL, VS_YELLOW, EMC22_KICKOFF, true, true},
    {"our penalty", VS_EVENT_PENALTY, VS_BLUE, EMC22_PENALTY, true, true},
    {"penalty against us", VS_EVENT_PENALTY, VS_YELLOW, EMC22_PENALTY, false, true},
    {"free ball", VS_EVENT_FREE_BALL, VS_BLUE, EMC22_FREE_BALL, true, true},
    {"our goal kick", VS_EVENT_GOAL_KICK, VS_BLUE, EMC22_GOAL_KICK, true, true},
    {"their goal kick", VS_EVENT_GOAL_KICK, VS_YELLOW, EMC22_GOAL_KICK, false, true},
    {"halt is no foul", VS_EVENT_HALT, VS_BLUE, EMC22_NO_FOUL, false, true},
    {"half time is no foul", VS_EVENT_HALF_TIME, VS_BLUE, EMC22_NO_FOUL, false, true},
    {"nothing", VS_EVENT_NONE, VS_YELLOW, EMC22_NO_FOUL, false, false},
};

// World centre -> (0.85, 0.65).
static void player_sees_the_world_in_its_frame(void **state) {
  (void)state;
  vs_player *player;
  assert_ok(vs_player_open("emc22:", &player, err));
  vs_world world = {.ball = {.x_m = 0.1, .y_m = -0.2, .vx_mps = 0.3, .vy_mps = 0.4}};
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    world.robot[VS_OWN][i] = (vs_robot){.pose = {-0.5 + 0.2 * i, 0.3 - 0.1 * i, 0.5 * i}, .omega_radps = i};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  assert_ok(vs_player_step(player, &world, &game, 0.03125, out, err));
  emc22_state s;
  vs_player_save(player, &s);
  assert_near(s.ball.x, 0.95, 1e-12);
  assert_near(s.ball.y, 0.45, 1e-12);
  assert_near(s.velocity_mps.x, 0.3, 0);
  assert_near(s.velocity_mps.y, 0.4, 0);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(s.robot[i].at.x, 0.35 + 0.2 * i, 1e-12);
    assert_near(s.robot[i].at.y, 0.95 - 0.1 * i, 1e-12);
    assert_near(s.robot[i].theta_rad, 0.5 * i, 1e-12);
    assert_near(s.robot[i].omega_radps, i, 0);
    assert_near(out[i].left_radps, vs_clamp(s.robot[i].wheel_mps[0] / 0.03, -46.66, 46.66), 1e-9);
    assert_near(out[i].right_radps, vs_clamp(s.robot[i].wheel_mps[1] / 0.03, -46.66, 46.66), 1e-9);
  }
  vs_player_close(player);
}

static void unseen_adversaries_are_no_obstacles(void **state) {
  (void)state;
  vs_player *player;
  assert_ok(vs_player_open("emc22:", &player, err));
  vs_world world = {0};
  world.robot[VS_ADVERSARY][1].valid = true;
  world.robot[VS_ADVERSARY][1].pose.x_m = 0.3;
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  for (int i = 0; i < VS_TEAM_SIZE; i++) world.robot[VS_OWN][i].pose = (vs_pose){-0.2 * i, 0.1 * i, 0};
  assert_ok(vs_player_step(player, &world, &game, 0.03125, out, err));
  emc22_state s;
  vs_player_save(player, &s);
  assert_int_equal(s.adversaries, 1);
  assert_near(s.adversary[0].x, 0.3 + 0.85, 1e-12);
  vs_player_close(player);
}

int main(void) {
  const struct CMUnitTest others[] = {cmocka_unit_test(player_sees_the_world_in_its_frame),
                                      cmocka_unit_test(unseen_adversaries_are_no_obstacles)};
  int failed = RUN_ROWS("roles", rows, run) + RUN_ROWS("events", events, run_event);
  return failed + cmocka_run_group_tests(others, NULL, NULL);
}
