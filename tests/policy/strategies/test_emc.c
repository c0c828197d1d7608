// src/policy/strategies/emc.c
#include "policy/strategies/emc.h"
#include "vectors.h"
#include "vsss/field.h"
#include "vsss/policy.h"

// Columns of emc2019.csv.gz.
enum { SEQ, TICK, TIME, BALL, ROBOT = 5, ROBOT_STEP = 5, OUT = 20, OUT_STEP = 4, ROLES = 32 };

static emc_input input_of(const vectors *v) {
  emc_input in = {.ball = {vectors_number(v, BALL) + 0.81, vectors_number(v, BALL + 1) + 0.63}, .dt_s = 0.033333};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int c = ROBOT + i * ROBOT_STEP;
    in.at[i] = (vs_point){vectors_number(v, c) + 0.81, vectors_number(v, c + 1) + 0.63};
    in.theta_rad[i] = vectors_number(v, c + 2);
    in.wheel_mps[i][0] = vectors_number(v, c + 3);
    in.wheel_mps[i][1] = vectors_number(v, c + 4);
  }
  return in;
}

static void assert_tick(const vectors *v, const emc_state *s, const emc_output *out, double *worst) {
  const char *letter = "ADG";
  for (int r = 0; r < EMC_ROLES; r++)
    if (v->column[ROLES][s->role[r].robot] != letter[r])
      fail_msg("sequence %s tick %s: roles %s, robot %d is %c here", v->column[SEQ], v->column[TICK], v->column[ROLES],
               s->role[r].robot, letter[r]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    for (int w = 0; w < 2; w++) {
      double target = fabs(out->target_mps[i][w] - vectors_number(v, OUT + i * OUT_STEP + w));
      double pid = fabs(out->pid_mps[i][w] - vectors_number(v, OUT + i * OUT_STEP + 2 + w));
      if (!(target <= 2e-4) || !(pid <= 1e-3))
        fail_msg("sequence %s tick %s robot %d wheel %d (roles %s): target off by %g m/s, out by %g m/s",
                 v->column[SEQ], v->column[TICK], i, w, v->column[ROLES], target, pid);
      worst[0] = fmax(worst[0], target);
      worst[1] = fmax(worst[1], pid);
    }
  }
}

static void every_recorded_tick_of_the_original_is_repeated(void **state) {
  (void)state;
  vectors v;
  vectors_open(&v, "emc2019");
  emc_state s;
  int commands = 0;
  double worst[2] = {0};
  for (; vectors_next(&v); commands += VS_TEAM_SIZE) {
    if (vectors_number(&v, TICK) == 0) emc_init(&s);
    emc_input in = input_of(&v);
    emc_output out;
    emc_tick(&s, &in, &out);
    assert_tick(&v, &s, &out, worst);
  }
  vectors_close(&v);
  assert_int_equal(commands, VECTORS_COMMANDS);
  printf("%d commands, worst target %.2g m/s, worst out %.2g m/s\n", commands, worst[0], worst[1]);
}

static vs_world world_of(const vectors *v) {
  vs_world world = vectors_world(v, BALL, ROBOT, ROBOT_STEP);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    int c = ROBOT + i * ROBOT_STEP;
    vs_robot *r = &world.robot[VS_OWN][i];
    r->left_radps = vectors_number(v, c + 3) / VS_WHEEL_RADIUS_M;
    r->right_radps = vectors_number(v, c + 4) / VS_WHEEL_RADIUS_M;
  }
  return world;
}

// The player's commands are those of the column at `first`, in rad/s of a 3 cm wheel, within the wheel's limit.
static void assert_player_repeats(const char *uri, int first, double tolerance_mps) {
  vectors v;
  vectors_open(&v, "emc2019");
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  while (vectors_next(&v)) {
    if (vectors_number(&v, TICK) == 0) assert_ok(vs_player_reset(player, 1, err));
    vs_world world = world_of(&v);
    vs_game game = {0};
    vs_wheels out[VS_TEAM_SIZE];
    assert_ok(vs_player_step(player, &world, &game, 0.033333, out, err));
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      int c = first + i * OUT_STEP;
      double left = vs_clamp(vectors_number(&v, c) / 0.03, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
      double right = vs_clamp(vectors_number(&v, c + 1) / 0.03, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
      assert_near(out[i].left_radps, left, tolerance_mps / 0.03);
      assert_near(out[i].right_radps, right, tolerance_mps / 0.03);
    }
  }
  vs_player_close(player);
  vectors_close(&v);
}

static void player_sends_the_recorded_wheel_targets(void **state) {
  (void)state;
  assert_player_repeats("emc:", OUT, 2e-4);
}

static void player_with_pid_sends_the_recorded_outputs(void **state) {
  (void)state;
  assert_player_repeats("emc:?pid=1", OUT + 2, 1e-3);
}

// World centre -> (0.81, 0.63), headings as they are; its own robots, not the others.
static void player_sees_the_world_in_its_frame(void **state) {
  (void)state;
  vs_player *player;
  assert_ok(vs_player_open("emc:", &player, err));
  vs_world world = {.ball = {.x_m = 0.1, .y_m = -0.2}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    world.robot[VS_OWN][i].pose = (vs_pose){-0.5 + 0.2 * i, 0.3 - 0.1 * i, 0.5 * i};
    world.robot[VS_ADVERSARY][i].pose = (vs_pose){0.7, 0.6, -1};
  }
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
  emc_state s;
  assert_int_equal(vs_player_state_size(player), sizeof s);
  vs_player_save(player, &s);
  assert_near(s.ball.x, 0.91, 1e-12);
  assert_near(s.ball.y, 0.43, 1e-12);
  for (int r = 0; r < EMC_ROLES; r++) {
    assert_near(s.role[r].at.x, 0.31 + 0.2 * r, 1e-12);
    assert_near(s.role[r].at.y, 0.93 - 0.1 * r, 1e-12);
    assert_near(s.role[r].theta_rad, 0.5 * r, 1e-12);
  }
  vs_player_close(player);
}

// A robot that drives north-east at 0.3 m/s and turns at 2 rad/s: its wheels run at 0.3 -+ 0.035 * 2 m/s, known or not.
static void player_with_pid_derives_wheel_speeds_it_is_not_told(void **state) {
  (void)state;
  vs_player *told, *left_alone;
  assert_ok(vs_player_open("emc:?pid=1", &told, err));
  assert_ok(vs_player_open("emc:?pid=1", &left_alone, err));
  vs_world world = {.ball = {.x_m = 0.2, .y_m = 0.1}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_robot *r = &world.robot[VS_OWN][i];
    r->pose = (vs_pose){-0.6 + 0.3 * i, 0.2 * i, VS_PI / 4};
    r->vx_mps = r->vy_mps = 0.3 * sqrt(0.5);
    r->omega_radps = 2;
  }
  vs_game game = {0};
  vs_wheels a[VS_TEAM_SIZE], b[VS_TEAM_SIZE];
  assert_ok(vs_player_step(left_alone, &world, &game, 1.0 / 30, a, err));
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    world.robot[VS_OWN][i].left_radps = 0.23 / 0.03;
    world.robot[VS_OWN][i].right_radps = 0.37 / 0.03;
  }
  assert_ok(vs_player_step(told, &world, &game, 1.0 / 30, b, err));
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(a[i].left_radps, b[i].left_radps, 1e-9);
    assert_near(a[i].right_radps, b[i].right_radps, 1e-9);
  }
  vs_player_close(told);
  vs_player_close(left_alone);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_recorded_tick_of_the_original_is_repeated),
      cmocka_unit_test(player_sends_the_recorded_wheel_targets),
      cmocka_unit_test(player_with_pid_sends_the_recorded_outputs),
      cmocka_unit_test(player_sees_the_world_in_its_frame),
      cmocka_unit_test(player_with_pid_derives_wheel_speeds_it_is_not_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
