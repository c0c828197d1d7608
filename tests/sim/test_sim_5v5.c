// src/sim/sim_model.c, src/sim/sim.c and src/sim/nearby.c with five robots a team on 2.2 x 1.8 m
#include "../../src/sim/sim_internal.h"
#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/sensor_model.h"

static vs_model *models[2];
static vs_sim *sims[2];

static int open_both(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_model_def def = vs_model_def_default((vs_drive)drive);
    vs_error err = {0};
    def.division = VS_5V5;
    if (vs_model_load(&def, &models[drive], &err) != VS_OK || vs_sim_new(models[drive], &sims[drive], &err) != VS_OK) {
      print_error("%s\n", err.text);
      return -1;
    }
  }
  return 0;
}

static int close_both(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_free(sims[drive]);
    vs_model_free(models[drive]);
  }
  return 0;
}

static void a_reset_gives_ten_robots_on_their_own_sides(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_world w;
    vs_sim_reset(sims[drive], NULL);
    vs_sim_world(sims[drive], &w);
    assert_int_equal(w.division, VS_5V5);
    for (int i = 0; i < 5; i++) {
      assert_true(w.robot[VS_BLUE][i].valid && w.robot[VS_BLUE][i].pose.x_m < -0.3);
      assert_true(w.robot[VS_YELLOW][i].valid && w.robot[VS_YELLOW][i].pose.x_m > 0.3);
    }
  }
}

// Yellow 4 alone is told to go; then blue 3.
static void a_command_moves_its_robot_and_no_other(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++)
    for (int k = 0; k < 2; k++) {
      int team = k ? VS_BLUE : VS_YELLOW, robot = k ? 3 : 4;
      vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
      vs_world before, after;
      vs_sim_reset(sims[drive], NULL);
      vs_sim_world(sims[drive], &before);
      command[team][robot] = (vs_wheels){5, 5};
      for (int f = 0; f < 15; f++) assert_ok(vs_sim_frame(sims[drive], (const vs_wheels(*)[VS_TEAM_MOST])command, err));
      vs_sim_world(sims[drive], &after);
      for (int t = 0; t < VS_TEAMS; t++)
        for (int i = 0; i < 5; i++) {
          double moved_m = fabs(after.robot[t][i].pose.x_m - before.robot[t][i].pose.x_m);
          if (t == team && i == robot)
            assert_true(moved_m > 0.04);
          else
            assert_true(moved_m < 0.001);
        }
    }
}

// The side wall is at 0.9 m, the goal's end 0.15 m behind the line at 1.1 m.
static void walls_stand_where_the_division_says(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_wheels still[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
    const struct {
      double x_m, y_m, vx_mps, vy_mps, most_x_m, most_y_m;
    } shot[] = {{0.3, 0.7, 0, 2, 0.31, 0.9 - VS_BALL_RADIUS_M + 0.015},
                {0.9, 0.0, 2, 0, 1.25 - VS_BALL_RADIUS_M + 0.015, 0.01}};
    for (int k = 0; k < 2; k++) {
      vs_world w;
      double most_x_m = 0, most_y_m = 0;
      vs_sim_reset(sims[drive], NULL);
      vs_sim_world(sims[drive], &w);
      w.ball = (vs_ball){.x_m = shot[k].x_m, .y_m = shot[k].y_m, .vx_mps = shot[k].vx_mps, .vy_mps = shot[k].vy_mps};
      vs_sim_place(sims[drive], &w);
      for (int f = 0; f < 20; f++) {
        assert_ok(vs_sim_frame(sims[drive], (const vs_wheels(*)[VS_TEAM_MOST])still, err));
        vs_sim_world(sims[drive], &w);
        most_x_m = fmax(most_x_m, w.ball.x_m);
        most_y_m = fmax(most_y_m, w.ball.y_m);
      }
      assert_true(most_x_m <= shot[k].most_x_m && most_y_m <= shot[k].most_y_m);
      assert_true(k == 0 ? most_y_m > 0.87 : most_x_m > 1.2);
    }
  }
}

// Robots chase the ball, so that everything meets everything and every wall.
static uint64_t chase(vs_sim *sim, bool all_pairs, int *fewest) {
  uint64_t hash = VS_HASH_START;
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  vs_rng rng = vs_rng_make(5, 0);
  vs_world w;
  sim->test_all_pairs = all_pairs;
  vs_sim_reset(sim, NULL);
  vs_sim_world(sim, &w);
  for (int f = 0; f < 300; f++) {
    for (int i = 0; i < 10 && f % 3 == 0; i++) {
      vs_pose pose = w.robot[i / 5][i % 5].pose;
      double to = atan2(w.ball.y_m - pose.y_m, w.ball.x_m - pose.x_m) - pose.theta_rad;
      double v = 46 * cos(to) + vs_rng_range(&rng, -20, 20), turn = 30 * sin(to);
      command[i / 5][i % 5] = (vs_wheels){v - turn, v + turn};
    }
    assert_ok(vs_sim_frame(sim, (const vs_wheels(*)[VS_TEAM_MOST])command, err));
    vs_sim_world(sim, &w);
    hash = vs_world_hash(hash, &w);
    if (sim->view.npair < *fewest) *fewest = sim->view.npair;
  }
  sim->test_all_pairs = false;
  return hash;
}

static void leaving_out_pairs_out_of_reach_changes_nothing(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    int all = models[drive]->mj->npair, fewest = all, fewest_of_all = all;
    uint64_t some = chase(sims[drive], false, &fewest);
    assert_true(some == chase(sims[drive], true, &fewest_of_all));
    assert_true(fewest < all / 2 && fewest_of_all == all);
  }
}

// What a seed draws for the first three robots is the same for either division, and the others differ from robot to robot.
static void realism_draws_the_fourth_and_fifth_robot_too(void **state) {
  (void)state;
  vs_realism realism = vs_realism_default();
  realism.wheel_gain = (vs_range){0.9, 1.1};
  vs_sim_params p = vs_realism_draw(&realism, 3);
  assert_true(p.wheel_gain[VS_BLUE][4][0] != 1 && p.wheel_gain[VS_YELLOW][3][1] != 1);
  assert_true(p.wheel_gain[VS_BLUE][3][0] != p.wheel_gain[VS_BLUE][4][0]);
  assert_true(p.wheel_gain[VS_BLUE][4][0] != p.wheel_gain[VS_YELLOW][4][0]);
}

static void sensors_measure_and_command_all_ten(void **state) {
  (void)state;
  vs_realism realism = vs_realism_default();
  vs_sensors sensors;
  vs_world truth = {.division = VS_5V5}, seen;
  vs_wheels in[VS_TEAMS][VS_TEAM_MOST], out[VS_TEAMS][VS_TEAM_MOST];
  for (int i = 0; i < 10; i++) truth.robot[i / 5][i % 5].pose.x_m = 0.1 * i;
  vs_sensors_reset(&sensors, &realism, 1);
  vs_sensors_measure(&sensors, &truth, &seen);
  for (int i = 0; i < 10; i++) {
    in[i / 5][i % 5] = (vs_wheels){i, -i};
    assert_true(seen.robot[i / 5][i % 5].valid);
    assert_near(seen.robot[i / 5][i % 5].pose.x_m, 0.1 * i, 0.02);
    assert_true(seen.robot[i / 5][i % 5].pose.x_m != 0.1 * i);
  }
  vs_sensors_command(&sensors, (const vs_wheels(*)[VS_TEAM_MOST])in, out);
  for (int i = 0; i < 10; i++) assert_true(out[i / 5][i % 5].left_radps == i && out[i / 5][i % 5].right_radps == -i);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_reset_gives_ten_robots_on_their_own_sides),
      cmocka_unit_test(a_command_moves_its_robot_and_no_other),
      cmocka_unit_test(walls_stand_where_the_division_says),
      cmocka_unit_test(leaving_out_pairs_out_of_reach_changes_nothing),
      cmocka_unit_test(realism_draws_the_fourth_and_fifth_robot_too),
      cmocka_unit_test(sensors_measure_and_command_all_ten),
  };
  return cmocka_run_group_tests(tests, open_both, close_both);
}
