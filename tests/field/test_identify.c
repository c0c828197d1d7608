// src/field/identify.c
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/identify.h"
#include "vsss/rng.h"

enum { COMMANDS = 400, SIGHTS = 1200 };
static vs_motion_command command[COMMANDS];
static vs_motion_sight sight[SIGHTS];

typedef struct robot {
  double delay_s, tau_straight_s, tau_turn_s, gain_left, gain_right, noise_m, noise_rad;
} robot;

// 40 s, stepped at 0.1 ms: straight and turning speed each follow the delayed commands with their own time constant.
static void drive(const robot *r, double pushed_s) {
  vs_rng rng = vs_rng_make(5, 0);
  for (int i = 0; i < COMMANDS; i++)
    command[i] = (vs_motion_command){1000000 + 100000LL * i + (int64_t)vs_rng_below(&rng, 5000),
                                     {vs_rng_range(&rng, -7, 7), vs_rng_range(&rng, -7, 7)}};
  double straight = 0, turn = 0, x = 0, y = 0, theta = 0.3, to_straight = 0, to_turn = 0;
  for (int k = 0, next = 0, seen = 0; seen < SIGHTS; k++) {
    double t_s = 1.0 + 1e-4 * k;
    while (next < COMMANDS && 1e-6 * (double)command[next].time_us + r->delay_s <= t_s) {
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
  assert_ok(vs_identify(command, COMMANDS, sight, SIGHTS, &is, err));
  print_message("delay %.1f ms (%.1f), straight %.1f ms (%.1f), turn %.1f ms (%.1f), gains %.3f %.3f, %d pairs\n",
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

static void too_little_is_named(void **state) {
  (void)state;
  vs_identified is;
  vs_error err = {0};
  drive(&(robot){0.060, 0.055, 0.044, 1, 1, 0, 0}, 0);
  assert_int_equal(vs_identify(command, COMMANDS, sight, 50, &is, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "49 pairs of frames"));
  for (int i = 0; i < COMMANDS; i++) command[i].wheels = (vs_wheels){0, 0};
  assert_int_equal(vs_identify(command, COMMANDS, sight, SIGHTS, &is, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "shake:"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(without_noise_every_number_is_found),
      cmocka_unit_test(with_a_cameras_noise_within_5_percent),
      cmocka_unit_test(pushes_are_left_out),
      cmocka_unit_test(too_little_is_named),
  };
  return cmocka_run_group_tests_name("field/identify", tests, NULL, NULL);
}
