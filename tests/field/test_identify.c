// src/field/identify.c
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/identify.h"
#include "vsss/player.h"
#include "vsss/policy.h"
#include "vsss/rng.h"
#include "vsss/sim.h"

enum { COMMANDS = 1200, STEPS = 400, SIGHTS = 1200 };
static vs_motion_command command[COMMANDS];
static vs_motion_sight sight[SIGHTS];

typedef struct robot {
  double delay_s, tau_straight_s, tau_turn_s, gain_left, gain_right, noise_m, noise_rad;
} robot;

// 40 s, stepped at 0.1 ms: straight and turning speed each follow the delayed commands with their own time constant.
static void drive(const robot *r, double pushed_s) {
  vs_rng rng = vs_rng_make(5, 0);
  for (int i = 0; i < STEPS; i++)
    command[i] = (vs_motion_command){1000000 + 100000LL * i + (int64_t)vs_rng_below(&rng, 5000),
                                     {vs_rng_range(&rng, -7, 7), vs_rng_range(&rng, -7, 7)}};
  double straight = 0, turn = 0, x = 0, y = 0, theta = 0.3, to_straight = 0, to_turn = 0;
  for (int k = 0, next = 0, seen = 0; seen < SIGHTS; k++) {
    double t_s = 1.0 + 1e-4 * k;
    while (next < STEPS && 1e-6 * (double)command[next].time_us + r->delay_s <= t_s) {
      double left = r->gain_left * command[next].wheels.left_radps,
             right = r->gain_right * command[next].wheels.right_radps;
      to_straight = 0.5 * VS_WHEEL_RADIUS_M * (left + right);
      to_turn = 0.5 * VS_WHEEL_RADIUS_M / VS_HALF_TRACK_M * (right - left);
      next++;
    }
    if (k % 333 == 0)
      sight[seen++] = (vs_motion_sight){1000000 + 100LL * k,
                                        {x + r->noise_m * vs_rng_range(&rng, -1.7, 1.7),
                                         y + r->noise_m * vs_rng_range(&rng, -1.7, 1.7),
                                         vs_wrap_rad(theta + r->noise_rad * vs_rng_range(&rng, -1.7, 1.7))}};
    straight += 1e-4 * (to_straight - straight) / r->tau_straight_s;
    turn += 1e-4 * (to_turn - turn) / r->tau_turn_s;
    bool pushed = pushed_s > 0 && fmod(t_s, pushed_s) < 0.1;
    theta += 1e-4 * turn;
    x += 1e-4 * (pushed ? -0.8 : straight) * cos(theta);
    y += 1e-4 * (pushed ? -0.8 : straight) * sin(theta);
  }
}

static void check(const robot *r, double pushed_s, double share) {
  vs_identified is;
  drive(r, pushed_s);
  assert_ok(vs_identify(command, STEPS, sight, SIGHTS, &is, err));
  print_message("delay %.1f ms (%.1f), straight %.1f ms (%.1f), turn %.1f ms (%.1f), gains %.3f %.3f, %d frames\n",
                1e3 * is.delay_s, 1e3 * r->delay_s, 1e3 * is.tau_straight_s, 1e3 * r->tau_straight_s,
                1e3 * is.tau_turn_s, 1e3 * r->tau_turn_s, is.gain_left, is.gain_right, is.samples);
  assert_near(is.delay_s, r->delay_s, share * r->delay_s + 0.0005);
  assert_near(is.tau_straight_s, r->tau_straight_s, share * r->tau_straight_s + 0.0005);
  assert_near(is.tau_turn_s, r->tau_turn_s, share * r->tau_turn_s + 0.0005);
  assert_near(is.gain_left, r->gain_left, share * r->gain_left);
  assert_near(is.gain_right, r->gain_right, share * r->gain_right);
}

static void without_noise_every_number_is_found(void **state) {
  (void)state;
  check(&(robot){0.060, 0.055, 0.044, 1, 1, 0, 0}, 0, 0.01);
  check(&(robot){0.012, 0.120, 0.090, 0.9, 1.05, 0, 0}, 0, 0.01);
  check(&(robot){0.150, 0.020, 0.030, 1.1, 0.8, 0, 0}, 0, 0.01);
}

static void with_a_cameras_noise_within_5_percent(void **state) {
  (void)state;
  check(&(robot){0.060, 0.055, 0.044, 1, 0.95, 0.001, 0.01}, 0, 0.05);
  check(&(robot){0.100, 0.080, 0.060, 0.9, 1.05, 0.002, 0.02}, 0, 0.05);
}

static void pushes_are_left_out(void **state) {
  (void)state;
  check(&(robot){0.060, 0.055, 0.044, 1, 0.95, 0.001, 0.01}, 3.0, 0.05);
}

// The simulator's robot, which a camera with some noise looks at. What is commanded 10 ms after a frame acts at the next one:
// after 23.3 ms, of which its motion hides half a physics step of 6.7 ms (it moves by the speed at each step's end).
#define ACTS_S 0.020

typedef struct rig {
  vs_model *model;
  vs_sim *sim;
  vs_player *player; // NULL: turns round at once, every 0.4 s
} rig;

static rig open_rig(vs_drive drive, const char *player) {
  rig r = {0};
  vs_model_def def = vs_model_def_default(drive);
  assert_ok(vs_model_load(&def, &r.model, err));
  assert_ok(vs_sim_new(r.model, &r.sim, err));
  if (player) {
    assert_ok(vs_player_open(player, &r.player, err));
    assert_ok(vs_player_reset(r.player, 1, err));
  }
  vs_world world = {0};
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    world.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].pose = (vs_pose){-0.5 + 0.2 * i, i == 0 ? 0 : 0.6, 0};
  world.ball.y_m = -0.6;
  vs_sim_place(r.sim, &world);
  return r;
}

static vs_wheels command_of(const rig *r, const vs_world *world, int frame) {
  static const vs_wheels way[] = {{1, 1}, {1, -1}, {1, 0}, {0, 1}};
  vs_wheels out[VS_TEAM_SIZE], w = way[frame / 24 % 4];
  vs_game game = {0};
  if (!r->player)
    return frame / 12 % 2 ? (vs_wheels){-7 * w.left_radps, -7 * w.right_radps}
                          : (vs_wheels){7 * w.left_radps, 7 * w.right_radps};
  assert_ok(vs_player_step(r->player, world, &game, 1.0 / 30, out, err));
  return out[0];
}

static void look_at(vs_drive drive, const char *player, vs_identified *is) {
  rig r = open_rig(drive, player);
  vs_rng rng = vs_rng_make(7, 0);
  vs_wheels all[VS_TEAMS][VS_TEAM_MOST] = {{{0}}}, said = {0};
  for (int k = 0; k < SIGHTS; k++) {
    vs_world world;
    vs_sim_world(r.sim, &world);
    vs_pose pose = world.robot[VS_BLUE][0].pose;
    pose.x_m += 0.0001 * vs_rng_range(&rng, -1.7, 1.7);
    pose.theta_rad += 0.004 * vs_rng_range(&rng, -1.7, 1.7);
    sight[k] = (vs_motion_sight){1000000 + 1000000LL * k / 30, pose};
    all[VS_BLUE][0] = said;
    said = command_of(&r, &world, k);
    command[k] = (vs_motion_command){sight[k].time_us + 10000, said};
    assert_ok(vs_sim_frame(r.sim, all, err));
  }
  assert_ok(vs_identify(command, SIGHTS, sight, SIGHTS, is, err));
  print_message("delay %.1f ms, straight %.1f ms, turn %.1f ms, gains %.3f %.3f, limit %.1f rad/s\n", 1e3 * is->delay_s,
                1e3 * is->tau_straight_s, 1e3 * is->tau_turn_s, is->gain_left, is->gain_right, is->limit_radps);
  vs_player_close(r.player);
  vs_sim_free(r.sim);
  vs_model_free(r.model);
}

static void a_simulated_robot_is_found_within_a_tenth_and_its_delay_within_a_twentieth(void **state) {
  (void)state;
  for (int drive = 0; drive < 2; drive++) {
    vs_identified is;
    look_at((vs_drive)drive, "shake:", &is);
    assert_near(is.delay_s, ACTS_S, 0.05 * ACTS_S);
    assert_near(is.tau_straight_s, VS_SERVO_TAU_S, 0.1 * VS_SERVO_TAU_S);
    assert_near(is.gain_left, 1, 0.01);
    assert_near(is.gain_right, 1, 0.01);
    assert_near(is.limit_radps, 0, 0); // shake: rests before it turns round
  }
}

// Steps of 14 rad/s; a motor's torque ends at 0.0303 N m / 3.94e-3 N m s/rad = 7.69 rad/s.
static void the_torques_limit_is_found_where_it_is_met(void **state) {
  (void)state;
  vs_identified is;
  look_at(VS_DRIVE_PLANAR, NULL, &is);
  double limit_radps = VS_SERVO_LIMIT_NM / VS_SERVO_GAIN_NMSPRAD;
  assert_near(is.limit_radps, limit_radps, 0.1 * limit_radps);
  assert_near(is.delay_s, ACTS_S, 0.05 * ACTS_S);
  assert_near(is.tau_straight_s, VS_SERVO_TAU_S, 0.1 * VS_SERVO_TAU_S);
}

static void too_little_is_named(void **state) {
  (void)state;
  vs_identified is;
  vs_error err = {0};
  drive(&(robot){0.060, 0.055, 0.044, 1, 1, 0, 0}, 0);
  assert_int_equal(vs_identify(command, STEPS, sight, 50, &is, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "50 frames"));
  for (int i = 0; i < STEPS; i++) command[i].wheels = (vs_wheels){0, 0};
  assert_int_equal(vs_identify(command, STEPS, sight, SIGHTS, &is, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "shake:"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_noise_every_number_is_found),
      cmocka_unit_test(with_a_cameras_noise_within_5_percent),
      cmocka_unit_test(pushes_are_left_out),
      cmocka_unit_test(a_simulated_robot_is_found_within_a_tenth_and_its_delay_within_a_twentieth),
      cmocka_unit_test(the_torques_limit_is_found_where_it_is_met),
      cmocka_unit_test(too_little_is_named),
  };
  return cmocka_run_group_tests_name("field/identify", tests, NULL, NULL);
}
