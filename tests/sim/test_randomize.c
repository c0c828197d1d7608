// Tests src/sim/randomize.c and the motor in src/sim/drive.c: what each parameter of an episode does, on both drives.
#include "sim/arena.h"

#define FULL VS_WHEEL_LIMIT_RADPS

static const arena_commands stop = {{{0, 0}}};
static const arena_commands full_ahead = {{{FULL, FULL}}};

// Blue 0 after n frames at full command from (-0.6, 0), with these parameters.
static vs_robot drive_with(int drive, const vs_sim_params *params, int n, const arena_commands command) {
  vs_sim_reset(arena_sim[drive], params);
  arena_place(arena_sim[drive], (vs_pose){-0.6, 0, 0}, 0.6, -0.5);
  arena_frames(arena_sim[drive], n, command);
  vs_robot robot = arena_blue0(arena_sim[drive]);
  vs_sim_reset(arena_sim[drive], NULL);
  return robot;
}

static void battery_and_gain_scale_the_speed(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.wheel_limit_scale = 0.85;
    assert_near(drive_with(drive, &params, 24, full_ahead).vx_mps, 0.85 * 1.4, 0.03);
    params = vs_sim_params_default();
    params.wheel_gain[VS_BLUE][0][0] = 0.95;
    params.wheel_gain[VS_BLUE][0][1] = 1.05;
    // 0.1 x 1.4 m/s over 7 cm: turns left at 2 rad/s.
    assert_near(drive_with(drive, &params, 24, full_ahead).omega_radps, 2, 0.15);
  }
}

static void wheel_radius_scales_the_speed_and_track_the_turn(void **state) {
  (void)state;
  const arena_commands spin = {{{-10, 10}}};
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.wheel_radius_scale[VS_BLUE][0] = 1.03;
    assert_near(drive_with(drive, &params, 24, full_ahead).vx_mps, 1.03 * 1.4, 0.02);
    params = vs_sim_params_default();
    params.track_scale[VS_BLUE][0] = 0.97;
    double nominal = drive_with(drive, NULL, 20, spin).omega_radps;
    assert_near(drive_with(drive, &params, 20, spin).omega_radps / nominal, 1 / 0.97, 0.01);
  }
}

// To 8 rad/s, below the torque limit: the servo alone (55 ms) is at 1 - exp(-0.1/0.055) = 84 % after 0.1 s, behind a lag
// of 0.2 s at 1 - (0.2 exp(-0.1/0.2) - 0.055 exp(-0.1/0.055)) / (0.2 - 0.055) = 22 %.
static void motor_lag_delays_the_wheels(void **state) {
  (void)state;
  const arena_commands slow = {{{8, 8}}};
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.motor_tau_s = 0.2;
    assert_near(drive_with(drive, NULL, 3, slow).vx_mps / 0.24, 0.84, 0.05);
    assert_near(drive_with(drive, &params, 3, slow).vx_mps / 0.24, 0.22, 0.05);
    assert_near(drive_with(drive, &params, 40, slow).vx_mps / 0.24, 1, 0.02);
  }
}

static void commands_in_the_dead_zone_do_nothing(void **state) {
  (void)state;
  const arena_commands crawl = {{{1.4, 1.4}}};
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.dead_zone_radps = 1.5;
    assert_near(drive_with(drive, &params, 30, crawl).pose.x_m, -0.6, 1e-3);
    assert_near(drive_with(drive, NULL, 30, crawl).vx_mps, 1.4 * VS_WHEEL_RADIUS_M, 0.005);
  }
}

// Below 2 x 0.0303 / 0.03 N of traction the wheels spin: at half friction 0.45 x 9.81 / (1 + 0.45 x 0.0348 / 0.033)
// = 3.0 m/s2 remain with the skid's load, and less while the wheels' own spinning up tips the robot back.
static void slippery_floor_makes_the_wheels_spin(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.floor_friction_scale = 0.5;
    vs_robot robot = drive_with(drive, &params, 6, full_ahead);
    assert_near(robot.vx_mps, 0.2 * 2.75, 0.08);
    assert_true(robot.left_radps * VS_WHEEL_RADIUS_M > 1.5 * robot.vx_mps);
  }
}

// (0.425 + 0.056) / (2 x 0.425 + 0.056) of the acceleration.
static void heavy_robot_accelerates_less(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.robot_mass_scale = 2;
    double ratio = drive_with(drive, &params, 6, full_ahead).vx_mps / drive_with(drive, NULL, 6, full_ahead).vx_mps;
    assert_near(ratio, 0.481 / 0.906, 0.04);
  }
}

static void ball_parameters_change_its_run(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    vs_sim_params params = vs_sim_params_default();
    params.ball_rolling_scale = 2;
    params.ball_mass_scale = 1.5;
    vs_sim_reset(sim, &params);
    arena_place(sim, (vs_pose){-0.5, 0.5, 0}, -0.7, 0);
    arena_roll(sim, drive, 0.6, 0, 1);
    arena_frames(sim, 30, stop);
    assert_near(arena_ball(sim).vx_mps, 0.6 - 2 * 0.2, 0.02);

    double back[2];
    for (int k = 0; k < 2; k++) {
      params = vs_sim_params_default();
      params.ball_restitution = k ? 0.8 : 0.4;
      vs_sim_reset(sim, &params);
      arena_place(sim, (vs_pose){-0.5, 0.5, 0}, 0.71, -0.4);
      arena_roll(sim, drive, 2, 0, 0);
      arena_frames(sim, 3, stop);
      back[k] = -arena_ball(sim).vx_mps / 2;
    }
    assert_near(back[0], 0.35, 0.15);
    assert_near(back[1], 0.75, 0.15);
    vs_sim_reset(sim, NULL);
  }
}

static void off_centre_mass_keeps_robots_drivable(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim_params params = vs_sim_params_default();
    params.com_offset_m[VS_BLUE][0][0] = 0.005;
    params.com_offset_m[VS_BLUE][0][1] = -0.005;
    vs_robot robot = drive_with(drive, &params, 24, full_ahead);
    assert_near(hypot(robot.vx_mps, robot.vy_mps), 1.4, 0.06);
    assert_near(robot.pose.theta_rad, 0, 1); // the heavier side is left behind while the motors are at their limit
  }
}

static void shoves_come_as_often_and_hard_as_asked_and_from_the_seed(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    double x[3];
    for (int k = 0; k < 3; k++) {
      vs_sim_params params = vs_sim_params_default();
      params.push_per_s = 10;
      params.push_mps = 0.3;
      params.push_seed = k == 2 ? 2 : 1;
      x[k] = drive_with(drive, &params, 30, stop).pose.x_m;
    }
    assert_true(x[0] == x[1] && x[0] != x[2]);
    assert_true(x[0] != -0.6 && fabs(x[0] + 0.6) < 0.2);
  }
}

static void default_parameters_leave_the_shared_model_in_use(void **state) {
  (void)state;
  vs_sim_params params = vs_sim_params_default();
  vs_robot a = drive_with(VS_DRIVE_PLANAR, &params, 30, full_ahead),
           b = drive_with(VS_DRIVE_PLANAR, NULL, 30, full_ahead);
  assert_true(a.pose.x_m == b.pose.x_m && a.left_radps == b.left_radps);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(battery_and_gain_scale_the_speed),
      cmocka_unit_test(wheel_radius_scales_the_speed_and_track_the_turn),
      cmocka_unit_test(motor_lag_delays_the_wheels),
      cmocka_unit_test(commands_in_the_dead_zone_do_nothing),
      cmocka_unit_test(slippery_floor_makes_the_wheels_spin),
      cmocka_unit_test(heavy_robot_accelerates_less),
      cmocka_unit_test(ball_parameters_change_its_run),
      cmocka_unit_test(off_centre_mass_keeps_robots_drivable),
      cmocka_unit_test(shoves_come_as_often_and_hard_as_asked_and_from_the_seed),
      cmocka_unit_test(default_parameters_leave_the_shared_model_in_use),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
