// src/policy/strategies/inf.c
#include "policy/strategies/inf.h"
#include "vectors.h"
#include "vsss/policy.h"

// Columns of inf.csv.gz.
enum { SEQ, TICK, TIME, BALL, ROBOT = 5, ROBOT_STEP = 3, OUT = 14, ROLES = 20, TACTIC = 21 };

static vs_point pixels(double x_m, double y_m) {
  return (vs_point){(x_m + 0.80838742) * 640 / 1.61677484, (y_m + 0.58339083) * 480 / 1.16678166};
}

static inf_input input_of(const vectors *v) {
  inf_input in = {.ball = pixels(vectors_number(v, BALL), vectors_number(v, BALL + 1)), .dt_s = 0.033333};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int c = ROBOT + i * ROBOT_STEP;
    in.at[i] = pixels(vectors_number(v, c), vectors_number(v, c + 1));
    in.o_rad[i] = -vectors_number(v, c + 2);
  }
  return in;
}

static void assert_tick(const vectors *v, const inf_state *s, double out[VS_TEAM_SIZE][2], double *worst) {
  static const char *const tactic[] = {"catch", "catchsideways", "block", "blockopening", "push",
                                       "spin",  "wait",          "kick",  "unlock"};
  const char *letter = "AMG";
  for (int r = 0; r < INF_ROLES; r++)
    if (v->column[ROLES][s->role[r]] != letter[r])
      fail_msg("sequence %s tick %s: roles %s, robot %d is %c here", v->column[SEQ], v->column[TICK], v->column[ROLES],
               s->role[r], letter[r]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    if (strcmp(v->column[TACTIC + i], tactic[s->robot[i].tactic]) != 0)
      fail_msg("sequence %s tick %s robot %d: %s, here %s", v->column[SEQ], v->column[TICK], i, v->column[TACTIC + i],
               tactic[s->robot[i].tactic]);
    for (int w = 0; w < 2; w++) {
      double off = fabs(out[i][w] - vectors_number(v, OUT + i * 2 + w));
      if (!(off <= 1e-4))
        fail_msg("sequence %s tick %s robot %d (%s) wheel %d: off by %g", v->column[SEQ], v->column[TICK], i,
                 v->column[TACTIC + i], w, off);
      *worst = fmax(*worst, off);
    }
  }
}

static void every_recorded_tick_of_the_original_is_repeated(void **state) {
  (void)state;
  vectors v;
  vectors_open(&v, "inf");
  inf_state s;
  int commands = 0;
  double worst = 0;
  for (; vectors_next(&v); commands += VS_TEAM_SIZE) {
    if (vectors_number(&v, TICK) == 0) inf_init(&s);
    inf_input in = input_of(&v);
    double out[VS_TEAM_SIZE][2];
    inf_tick(&s, &in, out);
    assert_tick(&v, &s, out, &worst);
  }
  vectors_close(&v);
  assert_int_equal(commands, VECTORS_COMMANDS);
  printf("%d commands, worst difference %.2g\n", commands, worst);
}

static void player_sends_thirty_radians_a_second_times_the_recorded_command(void **state) {
  (void)state;
  vectors v;
  vectors_open(&v, "inf");
  vs_player *player;
  assert_ok(vs_player_open("inf:", &player, err));
  while (vectors_next(&v)) {
    if (vectors_number(&v, TICK) == 0) assert_ok(vs_player_reset(player, 1, err));
    vs_world world = vectors_world(&v, BALL, ROBOT, ROBOT_STEP);
    vs_game game = {0};
    vs_wheels out[VS_TEAM_SIZE];
    assert_ok(vs_player_step(player, &world, &game, 0.033333, out, err));
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      assert_near(out[i].left_radps, 30 * vectors_number(&v, OUT + i * 2), 30 * 1e-4);
      assert_near(out[i].right_radps, 30 * vectors_number(&v, OUT + i * 2 + 1), 30 * 1e-4);
    }
  }
  vs_player_close(player);
  vectors_close(&v);
}

// The world's centre is (0.80838742, 0.58339083) m = (320, 240) px; 395.85 px and 411.39 px are a metre; the orientation
// is the mirrored heading.
static void player_sees_the_world_in_its_frame(void **state) {
  (void)state;
  vs_player *player;
  assert_ok(vs_player_open("inf:", &player, err));
  vs_world world = {.ball = {.x_m = 0.1, .y_m = -0.2}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    world.robot[VS_OWN][i].pose = (vs_pose){-0.5 + 0.2 * i, 0.3 - 0.1 * i, 0.5 * i};
    world.robot[VS_ADVERSARY][i].pose = (vs_pose){0.7, 0.6, -1};
  }
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
  inf_state s;
  assert_int_equal(vs_player_state_size(player), sizeof s);
  vs_player_save(player, &s);
  assert_near(s.ball.x, 320 + 39.585, 2e-2);
  assert_near(s.ball.y, 240 - 82.278, 2e-2);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(s.robot[i].at.x, 320 + 395.85 * (-0.5 + 0.2 * i), 2e-2);
    assert_near(s.robot[i].at.y, 240 + 411.39 * (0.3 - 0.1 * i), 2e-2);
    assert_near(s.robot[i].o_rad, -0.5 * i, 1e-12);
  }
  vs_player_close(player);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_recorded_tick_of_the_original_is_repeated),
      cmocka_unit_test(player_sends_thirty_radians_a_second_times_the_recorded_command),
      cmocka_unit_test(player_sees_the_world_in_its_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
