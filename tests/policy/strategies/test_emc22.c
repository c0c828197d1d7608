// src/policy/strategies/emc22.c
#include "policy/strategies/emc22.h"
#include "vectors.h"
#include "vsss/policy.h"

// Columns of emc2022.csv.gz.
enum { SEQ, TICK, TIME, REF, BALL, VELOCITY = 6, ROBOT = 8, ROBOT_STEP = 4, OPPONENT = 20, OUT = 26, ROLES = 32 };

static emc22_foul command_of(const char *text, bool *ours) {
  static const struct {
    const char *name;
    emc22_foul foul;
  } names[] = {{"KICKOFF", EMC22_KICKOFF},     {"PENALTY_KICK", EMC22_PENALTY},
               {"FREE_BALL", EMC22_FREE_BALL}, {"FREE_KICK", EMC22_FREE_KICK},
               {"GOAL_KICK", EMC22_GOAL_KICK}, {"GAME_ON", EMC22_OTHER},
               {"STOP", EMC22_OTHER},          {"HALT", EMC22_OTHER}};
  *ours = strstr(text, ":ours") != NULL;
  if (!*text) return EMC22_NO_FOUL;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (!strncmp(text, names[i].name, strlen(names[i].name))) return names[i].foul;
  fail_msg("unknown referee command %s", text);
  return EMC22_NO_FOUL;
}

static emc22_input input_of(const vectors *v) {
  emc22_input in = {.ball = {vectors_number(v, BALL) + 0.85, vectors_number(v, BALL + 1) + 0.65},
                    .velocity_mps = {vectors_number(v, VELOCITY), vectors_number(v, VELOCITY + 1)},
                    .now_s = 5.0 + 0.033 * vectors_number(v, TICK),
                    .adversaries = VS_TEAM_SIZE};
  in.command = command_of(v->column[REF], &in.command_ours);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int c = ROBOT + i * ROBOT_STEP;
    in.at[i] = (vs_point){vectors_number(v, c) + 0.85, vectors_number(v, c + 1) + 0.65};
    in.theta_rad[i] = vectors_number(v, c + 2);
    in.omega_radps[i] = vectors_number(v, c + 3);
    c = OPPONENT + i * 2;
    in.adversary[i] = (vs_point){vectors_number(v, c) + 0.85, vectors_number(v, c + 1) + 0.65};
  }
  return in;
}

static void assert_tick(const vectors *v, const emc22_state *s, double out[VS_TEAM_SIZE][2], double *worst) {
  const char *letter = "AGD";
  for (int r = 0; r < EMC22_ROLES; r++)
    if (v->column[ROLES][s->role[r]] != letter[r])
      fail_msg("sequence %s tick %s: roles %s, robot %d is %c here", v->column[SEQ], v->column[TICK], v->column[ROLES],
               s->role[r], letter[r]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    for (int w = 0; w < 2; w++) {
      double off = fabs(out[i][w] - vectors_number(v, OUT + i * 2 + w));
      if (!(off <= 1e-4))
        fail_msg("sequence %s tick %s robot %d wheel %d (roles %s, command %d): %g, off by %g m/s", v->column[SEQ],
                 v->column[TICK], i, w, v->column[ROLES], s->robot[i].command.kind, out[i][w], off);
      *worst = fmax(*worst, off);
    }
  }
}

static void every_recorded_tick_of_the_original_is_repeated(void **state) {
  (void)state;
  vectors v;
  vectors_open(&v, "emc2022");
  emc22_state s;
  int commands = 0;
  double worst = 0;
  for (; vectors_next(&v); commands += VS_TEAM_SIZE) {
    if (vectors_number(&v, TICK) == 0) emc22_init(&s);
    emc22_input in = input_of(&v);
    double out[VS_TEAM_SIZE][2];
    emc22_tick(&s, &in, out);
    assert_tick(&v, &s, out, &worst);
  }
  vectors_close(&v);
  assert_int_equal(commands, VECTORS_COMMANDS);
  printf("%d commands, worst difference %.2g m/s\n", commands, worst);
}

static vs_event event_of(const vectors *v, double time_s) {
  bool ours;
  vs_event_kind kind = VS_EVENT_HALT; // restarts the one-second windows, as game on and stop do
  switch (command_of(v->column[REF], &ours)) {
  case EMC22_KICKOFF: kind = VS_EVENT_KICK_OFF; break;
  case EMC22_PENALTY: kind = VS_EVENT_PENALTY; break;
  case EMC22_FREE_BALL: kind = VS_EVENT_FREE_BALL; break;
  case EMC22_GOAL_KICK: kind = VS_EVENT_GOAL_KICK; break;
  default: break;
  }
  return (vs_event){kind, ours ? VS_BLUE : VS_YELLOW, 0, time_s};
}

static vs_world world_of(const vectors *v) {
  vs_world world = vectors_world(v, BALL, ROBOT, ROBOT_STEP);
  world.ball.vx_mps = vectors_number(v, VELOCITY);
  world.ball.vy_mps = vectors_number(v, VELOCITY + 1);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int c = ROBOT + i * ROBOT_STEP;
    vs_robot *own = &world.robot[VS_OWN][i], *other = &world.robot[VS_ADVERSARY][i];
    own->omega_radps = vectors_number(v, c + 3);
    other->pose = (vs_pose){vectors_number(v, OPPONENT + i * 2), vectors_number(v, OPPONENT + i * 2 + 1), 0};
    other->valid = true;
  }
  return world;
}

// The recordings start 5 s after the start of the program.
static void start_at_five_seconds(vs_player *player) {
  emc22_state s;
  assert_int_equal(vs_player_state_size(player), sizeof s);
  vs_player_save(player, &s);
  s.now_s = 5.0 - 0.033;
  assert_ok(vs_player_restore(player, &s, err));
}

// The player, told of events, sends the recorded commands; sequences after a free kick, which our referee does not
// have, are left out from there on.
static void player_sends_the_recorded_commands_of_a_three_centimetre_wheel(void **state) {
  (void)state;
  vectors v;
  vectors_open(&v, "emc2022");
  vs_player *player;
  assert_ok(vs_player_open("emc22:", &player, err));
  vs_game game = {0};
  bool skip = false;
  int compared = 0;
  while (vectors_next(&v)) {
    if (vectors_number(&v, TICK) == 0) {
      assert_ok(vs_player_reset(player, 1, err));
      start_at_five_seconds(player);
      game = (vs_game){0};
      skip = false;
    }
    skip |= !strncmp(v.column[REF], "FREE_KICK", 9);
    if (skip) continue;
    if (*v.column[REF]) game.last_event = event_of(&v, vectors_number(&v, TIME));
    vs_world world = world_of(&v);
    vs_wheels out[VS_TEAM_SIZE];
    assert_ok(vs_player_step(player, &world, &game, 0.033, out, err));
    for (int i = 0; i < VS_TEAM_SIZE; i++, compared++) {
      double left = vs_clamp(vectors_number(&v, OUT + i * 2) / 0.03, -46.66, 46.66);
      double right = vs_clamp(vectors_number(&v, OUT + i * 2 + 1) / 0.03, -46.66, 46.66);
      assert_near(out[i].left_radps, left, 1e-4 / 0.03);
      assert_near(out[i].right_radps, right, 1e-4 / 0.03);
    }
  }
  vs_player_close(player);
  vectors_close(&v);
  assert_true(compared > 30000);
  printf("%d commands compared\n", compared);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_recorded_tick_of_the_original_is_repeated),
      cmocka_unit_test(player_sends_the_recorded_commands_of_a_three_centimetre_wheel),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
