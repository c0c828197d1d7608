// Tests src/sim/sim.c on the contact drive: loading, placing, the true world, bad commands.
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/sim.h"

static vs_model *model;
static vs_sim *sim;

static int open_sim(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_CONTACT);
  vs_error err = {0};
  if (vs_model_load(&def, &model, &err) != VS_OK || vs_sim_new(model, &sim, &err) != VS_OK) {
    print_error("%s\n", err.text);
    return -1;
  }
  return 0;
}

static int close_sim(void **state) {
  (void)state;
  vs_sim_free(sim);
  vs_model_free(model);
  return 0;
}

static void frames(int n, double left, double right) {
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  command[VS_BLUE][1] = (vs_wheels){left, right};
  for (int i = 0; i < n; i++) assert_ok(vs_sim_frame(sim, command, err));
}

// Blue 1 alone on the left half, facing +x, everybody else out of its way.
static void place_alone(void) {
  vs_world world = {0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    world.robot[VS_BLUE][i].pose = (vs_pose){-0.6 + 0.2 * i, 0.55, 0};
    world.robot[VS_YELLOW][i].pose = (vs_pose){0.1 + 0.2 * i, 0.55, 0};
  }
  world.robot[VS_BLUE][1].pose = (vs_pose){-0.6, 0, 0};
  world.ball.x_m = 0.6;
  world.ball.y_m = -0.5;
  vs_sim_place(sim, &world);
}

static void placed_world_reads_back_as_placed(void **state) {
  (void)state;
  vs_world world = {0}, read;
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    world.robot[i / 3][i % 3].pose = (vs_pose){-0.5 + 0.2 * i, 0.3 - 0.1 * i, 3.0 - i};
  }
  world.ball.x_m = 0.2;
  world.ball.y_m = -0.5;
  vs_sim_place(sim, &world);
  vs_sim_world(sim, &read);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    assert_near(read.robot[i / 3][i % 3].pose.x_m, -0.5 + 0.2 * i, 1e-12);
    assert_near(read.robot[i / 3][i % 3].pose.y_m, 0.3 - 0.1 * i, 1e-12);
    assert_near(read.robot[i / 3][i % 3].pose.theta_rad, 3.0 - i, 1e-9);
    assert_near(read.robot[i / 3][i % 3].vx_mps, 0, 0);
  }
  assert_near(read.ball.x_m, 0.2, 1e-12);
  assert_near(read.ball.z_m, VS_BALL_RADIUS_M, 1e-12);
}

// Beside the field a robot stands still for 3 s although walls are half spaces, and one that drives there is not thrown.
static void a_robot_beside_the_field_is_left_alone(void **state) {
  (void)state;
  place_alone();
  vs_world before, read;
  vs_sim_world(sim, &before);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_sim_put_beside(sim, VS_BLUE, i);
    vs_sim_put_beside(sim, VS_YELLOW, i);
  }
  frames(90, 0, 0);
  vs_sim_world(sim, &read);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_pose beside = vs_world_beside(VS_3V3, (vs_team)(i / 3), i % 3);
    assert_near(read.robot[i / 3][i % 3].pose.x_m, beside.x_m, 1e-3);
    assert_near(read.robot[i / 3][i % 3].pose.y_m, beside.y_m, 1e-3);
  }
  assert_near(read.ball.x_m, before.ball.x_m, 1e-3);
}

static void full_command_drives_1_4_mps_straight(void **state) {
  (void)state;
  place_alone();
  frames(24, VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS); // 0.8 s, about 0.95 m
  vs_world world;
  vs_sim_world(sim, &world);
  vs_robot robot = world.robot[VS_BLUE][1];
  assert_near(robot.vx_mps, 1.4, 0.03 * 1.4);
  assert_near(robot.left_radps, VS_WHEEL_LIMIT_RADPS, 0.5);
  assert_near(robot.pose.y_m, 0, 0.01);
  assert_near(robot.pose.theta_rad, 0, 0.01);
}

static void time_counts_frames_and_placing_keeps_it(void **state) {
  (void)state;
  vs_sim_reset(sim, NULL);
  frames(31, 0, 0);
  place_alone();
  vs_world world;
  vs_sim_world(sim, &world);
  assert_int_equal(world.seq, 31);
  assert_int_equal(world.time_us, 1033333); // 31/30 s
}

static void robots_at_rest_stay_where_they_are(void **state) {
  (void)state;
  place_alone();
  frames(60, 0, 0);
  vs_world world;
  vs_sim_world(sim, &world);
  assert_near(world.robot[VS_BLUE][1].pose.x_m, -0.6, 1e-3);
  assert_near(world.robot[VS_BLUE][1].pose.y_m, 0, 1e-3);
  assert_near(world.robot[VS_BLUE][1].pose.theta_rad, 0, 2e-3);
  assert_near(world.ball.x_m, 0.6, 1e-3);
}

static void command_that_is_not_a_number_is_refused_by_name(void **state) {
  (void)state;
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  command[VS_YELLOW][2].right_radps = NAN;
  vs_error err = {0};
  assert_int_equal(vs_sim_frame(sim, command, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "yellow robot 2"));
}

static void broken_state_is_reported_not_reset_silently(void **state) {
  (void)state;
  vs_world world = {0};
  place_alone();
  vs_sim_world(sim, &world);
  world.ball.x_m = NAN;
  vs_sim_place(sim, &world);
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  vs_error err = {0};
  assert_int_equal(vs_sim_frame(sim, command, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "Nan"));
  vs_sim_reset(sim, NULL);
  assert_ok(vs_sim_frame(sim, command, err));
}

// A rolling ball placed at 0.6 m/s slows by its rolling friction alone, 0.20 m/s2 (models/contacts.xml): after 0.5 s it
// has come 0.6 t - 0.1 t^2 = 0.275 m. Were it placed without spin, it would lose 2/7 of its speed sliding and come
// 0.2 m at most.
static void a_ball_is_placed_rolling(void **state) {
  (void)state;
  for (int drive = VS_DRIVE_CONTACT; drive <= VS_DRIVE_PLANAR; drive++) {
    vs_model_def def = vs_model_def_default((vs_drive)drive);
    vs_model *own_model;
    vs_sim *own;
    assert_ok(vs_model_load(&def, &own_model, err));
    assert_ok(vs_sim_new(own_model, &own, err));
    vs_world world = {0};
    for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
      world.robot[i / 3][i % 3].pose = (vs_pose){-0.5 + 0.2 * i, -0.5, 0};
    world.ball.x_m = -0.2;
    world.ball.vx_mps = 0.6 * 0.8;
    world.ball.vy_mps = 0.6 * 0.6;
    vs_sim_place(own, &world);
    const vs_wheels still[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
    for (int k = 0; k < 15; k++) assert_ok(vs_sim_frame(own, still, err));
    vs_sim_world(own, &world);
    assert_near(world.ball.x_m + 0.2, 0.275 * 0.8, 0.01);
    assert_near(world.ball.y_m, 0.275 * 0.6, 0.01);
    vs_sim_free(own);
    vs_model_free(own_model);
  }
}

// A second is a second at any frame rate: 40 frames of 25 ms go as far as 30 of 1/30 s.
static void frames_may_have_another_length(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_CONTACT);
  def.frame_hz = 40;
  def.substeps_per_frame = 4;
  vs_model *quick_model = NULL;
  vs_sim *quick = NULL;
  assert_ok(vs_model_load(&def, &quick_model, err));
  assert_ok(vs_sim_new(quick_model, &quick, err));
  assert_near(vs_model_step_s(quick_model), 0.00625, 1e-12);
  assert_int_equal(vs_model_frame_hz(quick_model), 40);
  vs_world before, after;
  vs_sim_reset(sim, NULL);
  place_alone();
  vs_sim_world(sim, &before);
  frames(30, 20, 20);
  vs_sim_world(sim, &after);
  double gone_m = after.robot[VS_BLUE][1].pose.x_m - before.robot[VS_BLUE][1].pose.x_m;
  vs_sim_place(quick, &before);
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST] = {{{0}}};
  command[VS_BLUE][1] = (vs_wheels){20, 20};
  for (int i = 0; i < 40; i++) assert_ok(vs_sim_frame(quick, (const vs_wheels(*)[VS_TEAM_MOST])command, err));
  vs_sim_world(quick, &after);
  assert_int_equal(after.time_us, 1000000);
  assert_true(gone_m > 0.5);
  assert_near(after.robot[VS_BLUE][1].pose.x_m - before.robot[VS_BLUE][1].pose.x_m, gone_m, 2e-3);
  vs_sim_free(quick);
  vs_model_free(quick_model);
  vs_error err = {0};
  def.frame_hz = 2000;
  assert_int_equal(vs_model_load(&def, &quick_model, &err), VS_USAGE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(placed_world_reads_back_as_placed),
      cmocka_unit_test(a_ball_is_placed_rolling),
      cmocka_unit_test(a_robot_beside_the_field_is_left_alone),
      cmocka_unit_test(full_command_drives_1_4_mps_straight),
      cmocka_unit_test(time_counts_frames_and_placing_keeps_it),
      cmocka_unit_test(frames_may_have_another_length),
      cmocka_unit_test(robots_at_rest_stay_where_they_are),
      cmocka_unit_test(command_that_is_not_a_number_is_refused_by_name),
      cmocka_unit_test(broken_state_is_reported_not_reset_silently),
  };
  return cmocka_run_group_tests(tests, open_sim, close_sim);
}
