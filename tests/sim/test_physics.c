// Tests src/sim/sim.c, src/sim/drive.c, src/sim/ball.c and models/*.xml as a physical test bench: the same experiments on
// both drives, against values from paper.md (1.4 m/s), from the servo's numbers (src/sim/drive.h) and from mechanics.
#include <stdio.h>

#include "sim/arena.h"

#define FULL VS_WHEEL_LIMIT_RADPS

static const arena_commands stop = {{{0, 0}}};
static const arena_commands full_ahead = {{{FULL, FULL}}};

// Time in s at which blue 0, driving at full command from rest, passes the share of 1.4 m/s.
static double time_to(vs_sim *sim, double share) {
  arena_place(sim, (vs_pose){-0.6, 0, 0}, 0.6, -0.5);
  double before = 0;
  for (int f = 1; f <= 24; f++) {
    arena_frames(sim, 1, full_ahead);
    double now = arena_blue0(sim).vx_mps;
    if (now >= share * 1.4) return (f - 1 + (share * 1.4 - before) / (now - before)) / 30;
    before = now;
  }
  return 1;
}

static void full_command_reaches_1_4_mps_straight(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.6, -0.1, 0}, 0.6, -0.5);
    arena_frames(sim, 24, full_ahead); // 0.8 s, about 0.9 m
    vs_robot robot = arena_blue0(sim);
    assert_near(robot.vx_mps, 1.4, 0.03 * 1.4);
    assert_near(robot.vy_mps, 0, 0.01);
    assert_near(robot.pose.y_m, -0.1, 0.005);
    assert_near(robot.pose.theta_rad, 0, 0.01);
    assert_near(robot.left_radps, FULL, 0.01 * FULL);
  }
}

// Torque limit: 2 x 0.0303 N m / 0.03 m on 0.425 kg + 2 x 2.54e-5 kg m2 / (0.03 m)2 = 0.481 kg: 4.2 m/s2.
static void full_command_accelerates_as_the_torque_limit_says(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.6, 0, 0}, 0.6, -0.5);
    arena_frames(sim, 2, full_ahead);
    double before = arena_blue0(sim).vx_mps;
    arena_frames(sim, 5, full_ahead);
    assert_near((arena_blue0(sim).vx_mps - before) * 30 / 5, 4.2, 0.15);
  }
}

static void top_speed_is_reached_in_0_3_to_0_4_s(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    assert_near(time_to(arena_sim[drive], 0.95), 0.34, 0.04);
    assert_in_range((int)(1000 * time_to(arena_sim[drive], 0.975)), 300, 400);
  }
}

static void wheels_slip_less_than_20_percent_when_starting(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.6, 0, 0}, 0.6, -0.5);
    for (int f = 0; f < 20; f++) {
      arena_frames(sim, 1, full_ahead);
      vs_robot robot = arena_blue0(sim);
      double rim = robot.left_radps * VS_WHEEL_RADIUS_M;
      assert_true(fabs(rim - robot.vx_mps) < 0.2 * rim);
    }
  }
}

// 4.2 m/s2 down to 0.23 m/s and the rest with 55 ms: (1.4^2 - 0.23^2) / (2 x 4.2) + 0.23 x 0.055 = 0.24 m.
static void full_speed_is_stopped_within_0_35_m(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.65, 0, 0}, 0.6, -0.5);
    arena_frames(sim, 20, full_ahead);
    vs_robot moving = arena_blue0(sim);
    assert_near(moving.vx_mps, 1.4, 0.06);
    arena_frames(sim, 20, stop);
    vs_robot stopped = arena_blue0(sim);
    assert_near(stopped.vx_mps, 0, 0.01);
    assert_near(stopped.pose.x_m - moving.pose.x_m, 0.24, 0.04);
  }
}

// Wheels against each other: 1.4 m/s / 0.035 m = 40 rad/s, on the spot.
static void opposite_wheels_spin_at_40_radps_on_the_spot(void **state) {
  (void)state;
  const arena_commands spin = {{{-FULL, FULL}}};
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.3, 0, 0}, 0.6, -0.5);
    arena_frames(sim, 30, spin);
    vs_robot robot = arena_blue0(sim);
    assert_near(robot.omega_radps, 40, 2);
    assert_near(robot.pose.x_m, -0.3, 0.01);
    assert_near(robot.pose.y_m, 0, 0.01);
  }
}

// 20 and 30 rad/s: 0.75 m/s and (30 - 20) x 0.03 / 0.07 = 4.29 rad/s.
static void different_wheels_drive_an_arc(void **state) {
  (void)state;
  const arena_commands arc = {{{20, 30}}};
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.3, -0.2, 0}, 0.6, -0.5);
    arena_frames(sim, 30, arc);
    vs_robot robot = arena_blue0(sim);
    assert_near(robot.omega_radps, 4.29, 0.1);
    assert_near(hypot(robot.vx_mps, robot.vy_mps), 0.75, 0.02);
  }
}

// mu_roll 6.1e-4 m: 5/7 x 6.1e-4 / 0.02135 x 9.81 = 0.200 m/s2 (models/vsss_contact.xml, class ball_floor).
static void rolling_ball_slows_by_0_20_mps2(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.5, 0.5, 0}, -0.7, 0);
    arena_roll(sim, drive, 0.6, 0, 1);
    arena_frames(sim, 45, stop); // 1.5 s, 0.675 m
    assert_near(arena_ball(sim).vx_mps, 0.6 - 1.5 * 0.200, 0.02);
    arena_frames(sim, 90, stop); // stands after 3 s and 0.9 m
    assert_near(arena_ball(sim).vx_mps, 0, 0.005);
    assert_near(arena_ball(sim).x_m, -0.7 + 0.9, 0.03);
    assert_near(arena_ball(sim).y_m, 0, 0.002);
  }
}

// A solid sphere that starts sliding rolls at 5/7 of its speed, here after 2/7 x 0.7 / (0.3 x 9.81) = 68 ms, and then
// loses 0.2 m/s2 for 132 ms more.
static void sliding_ball_starts_to_roll_at_five_sevenths(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){-0.5, 0.5, 0}, -0.7, 0);
    arena_roll(sim, drive, 0.7, 0, 0);
    arena_frames(sim, 6, stop);
    assert_near(arena_ball(sim).vx_mps, 0.7 * 5 / 7 - 0.2 * 0.132, 0.025);
  }
}

// Largest speed back, seen at the frames, of a ball that slides into something close by.
static double rebound(vs_sim *sim, int drive, double speed) {
  arena_roll(sim, drive, speed, 0, 0);
  double back = 0;
  for (int f = 0; f < 15; f++) {
    arena_frames(sim, 1, stop);
    back = fmin(back, arena_ball(sim).vx_mps);
  }
  return -back / speed;
}

// Nominal 0.6; until the frame ends sliding takes up to 0.3 x 9.81 / 30 = 0.1 m/s more.
static void ball_rebounds_from_the_wall_with_about_0_6(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    for (double speed = 1; speed < 6.6; speed += 0.5) {
      arena_place(arena_sim[drive], (vs_pose){-0.5, 0.5, 0}, 0.71, -0.4);
      assert_near(rebound(arena_sim[drive], drive, speed), 0.57, 0.15);
    }
  }
}

// Nominal 0.4 of the relative speed; a free robot, nine times heavier, would leave (0.4 x 425 - 46) / (425 + 46) = 0.26.
static void ball_rebounds_from_a_robot_with_about_0_3(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    for (double speed = 1; speed < 6.6; speed += 0.5) {
      arena_place(arena_sim[drive], (vs_pose){0.3, -0.3, 0}, 0.22, -0.3);
      assert_near(rebound(arena_sim[drive], drive, speed), 0.3, 0.2);
    }
  }
}

static void robot_pushes_a_standing_robot_ahead_of_it(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    vs_world world = {0};
    for (int i = 0; i < 6; i++) world.robot[i / 3][i % 3].pose = (vs_pose){-0.5 + 0.2 * i, 0.6, 0};
    world.robot[VS_BLUE][0].pose = (vs_pose){-0.3, 0, 0};
    world.robot[VS_YELLOW][0].pose = (vs_pose){-0.1, 0, 0};
    world.ball.x_m = 0.6;
    world.ball.y_m = -0.5;
    vs_sim_place(sim, &world);
    arena_frames(sim, 36, full_ahead);
    vs_sim_world(sim, &world);
    vs_robot pusher = world.robot[VS_BLUE][0], pushed = world.robot[VS_YELLOW][0];
    assert_true(pushed.pose.x_m > 0.0);                                     // moved by more than 10 cm
    assert_near(pushed.pose.x_m - pusher.pose.x_m, VS_ROBOT_SIZE_M, 0.005); // touching
    assert_near(pushed.vx_mps, pusher.vx_mps, 0.05);                        // together
    assert_true(pusher.vx_mps < 0.9 && pusher.left_radps < 0.95 * FULL);    // the load is felt
    assert_near(pushed.pose.y_m, 0, 0.03);
  }
}

static void robot_against_the_wall_stays_on_the_field(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){0.2, -0.4, 0}, -0.6, -0.5);
    arena_frames(sim, 60, full_ahead);
    vs_robot robot = arena_blue0(sim);
    assert_near(robot.pose.x_m, VS_FIELD_HALF_LENGTH_M - VS_ROBOT_SIZE_M / 2, 0.003);
    assert_near(robot.vx_mps, 0, 0.01);
  }
}

static void robot_drives_into_the_goal_up_to_its_end(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    arena_place(sim, (vs_pose){0.3, 0, 0}, -0.6, -0.5);
    arena_frames(sim, 45, full_ahead);
    assert_near(arena_blue0(sim).pose.x_m, VS_FIELD_HALF_LENGTH_M + VS_GOAL_DEPTH_M - VS_ROBOT_SIZE_M / 2, 0.003);
  }
}

// Free play without motor power: everything starts fast, servos brake. Contact springs may store and give back what a
// crash took, so the bound is the energy at the start of the second before.
static void crashes_never_create_energy(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    for (int round = 0; round < 12; round++) {
      vs_world world = {0};
      for (int i = 0; i < 6; i++) {
        world.robot[i / 3][i % 3].pose = (vs_pose){-0.25 + 0.15 * (i % 3), i < 3 ? 0.12 : -0.12, 0.5 * i + round};
      }
      vs_sim_place(sim, &world);
      for (int i = 0; i < 6; i++) {
        char joint[16];
        snprintf(joint, sizeof joint, "%s%d%s", i < 3 ? "blue" : "yellow", i % 3, drive == VS_DRIVE_PLANAR ? "_x" : "");
        double *v = arena_qvel(sim, drive, joint);
        v[0] = 0.7 * sin(3 * i + round);
        v[1] = (i < 3 ? -1 : 1) * (0.8 + 0.1 * (round % 5));
      }
      arena_roll(sim, drive, 2 * sin(round), 2 * cos(round), 0);
      double bound = arena_kinetic_energy_j(sim, drive);
      for (int f = 0; f < 45; f++) {
        arena_frames(sim, 1, stop);
        double energy = arena_kinetic_energy_j(sim, drive);
        assert_true(energy <= bound * 1.01);
      }
      assert_true(arena_kinetic_energy_j(sim, drive) < 0.05 * bound);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(full_command_reaches_1_4_mps_straight),
      cmocka_unit_test(full_command_accelerates_as_the_torque_limit_says),
      cmocka_unit_test(top_speed_is_reached_in_0_3_to_0_4_s),
      cmocka_unit_test(wheels_slip_less_than_20_percent_when_starting),
      cmocka_unit_test(full_speed_is_stopped_within_0_35_m),
      cmocka_unit_test(opposite_wheels_spin_at_40_radps_on_the_spot),
      cmocka_unit_test(different_wheels_drive_an_arc),
      cmocka_unit_test(rolling_ball_slows_by_0_20_mps2),
      cmocka_unit_test(sliding_ball_starts_to_roll_at_five_sevenths),
      cmocka_unit_test(ball_rebounds_from_the_wall_with_about_0_6),
      cmocka_unit_test(ball_rebounds_from_a_robot_with_about_0_3),
      cmocka_unit_test(robot_pushes_a_standing_robot_ahead_of_it),
      cmocka_unit_test(robot_against_the_wall_stays_on_the_field),
      cmocka_unit_test(robot_drives_into_the_goal_up_to_its_end),
      cmocka_unit_test(crashes_never_create_energy),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
