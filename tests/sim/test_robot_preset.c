// Tests src/sim/robot_preset.c and the bounds of acceleration in src/sim/drive.c: what each preset does on both drives.
#include "sim/arena.h"
#include "vsss/robot_preset.h"

#define FULL VS_WHEEL_LIMIT_RADPS

static const vs_robot_preset *preset(const char *name) {
  const vs_robot_preset *found = NULL;
  assert_ok(vs_robot_preset_find(name, &found, err));
  return found;
}

static void unknown_preset_is_refused_with_the_known_ones(void **state) {
  (void)state;
  const vs_robot_preset *found = NULL;
  vs_error err = {0};
  assert_int_equal(vs_robot_preset_find("tractor", &found, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "'tractor'"));
  assert_non_null(strstr(err.text, "firasim"));
}

// 30 rad/s of a 2 cm wheel is 0.6 m/s at the rim, 20 rad/s of our 3 cm.
static void commands_mean_the_presets_wheel(void **state) {
  (void)state;
  vs_wheels ours = vs_robot_preset_wheels(preset("firasim"), (vs_wheels){30, -15});
  assert_near(ours.left_radps, 20, 1e-12);
  assert_near(ours.right_radps, -10, 1e-12);
  ours = vs_robot_preset_wheels(preset("paper"), (vs_wheels){30, -15});
  assert_near(ours.left_radps, 30, 1e-12);
  ours = vs_robot_preset_wheels(preset("travesim"), (vs_wheels){30, -15});
  assert_near(ours.left_radps, 25, 1e-12);
}

static void paper_preset_is_the_nominal_robot(void **state) {
  (void)state;
  vs_sim_params nominal = vs_sim_params_default(), params = vs_robot_preset_params(preset("paper"));
  assert_memory_equal(&nominal, &params, sizeof nominal);
}

// Speeds up at 1.19 m/s2: from 0.2 s to 0.6 s after the start it gains 0.476 m/s. From 0.9 m/s it brakes at 5.07 m/s2:
// the first 0.1 s, less the servo's lag of about 20 ms, takes 0.4 to 0.51 m/s.
static void firasim_accelerates_and_brakes_as_fitted(void **state) {
  (void)state;
  const arena_commands ahead = {{{FULL, FULL}}}, stop = {{{0, 0}}};
  vs_sim_params params = vs_robot_preset_params(preset("firasim"));
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    vs_sim_reset(sim, &params);
    arena_place(sim, (vs_pose){-0.7, 0, 0}, 0.6, -0.5);
    arena_frames(sim, 6, ahead);
    double early = arena_blue0(sim).vx_mps;
    arena_frames(sim, 12, ahead);
    assert_near((arena_blue0(sim).vx_mps - early) / 0.4, 1.19, 0.03);
    arena_frames(sim, 6, ahead);
    double fast = arena_blue0(sim).vx_mps;
    assert_near(fast, 0.9, 0.07);
    arena_frames(sim, 1, stop); // the servo takes hold
    double before = arena_blue0(sim).vx_mps;
    arena_frames(sim, 3, stop);
    assert_near((before - arena_blue0(sim).vx_mps) / 0.1, 5.07, 0.3);
    arena_frames(sim, 8, stop);
    assert_near(arena_blue0(sim).vx_mps, 0, 0.01);
    vs_sim_reset(sim, NULL);
  }
}

static void firasim_ball_rolls_far(void **state) {
  (void)state;
  const arena_commands stop = {{{0, 0}}};
  vs_sim_params params = vs_robot_preset_params(preset("firasim"));
  for (int drive = 0; drive < 2; drive++) {
    vs_sim *sim = arena_sim[drive];
    vs_sim_reset(sim, &params);
    arena_place(sim, (vs_pose){-0.6, -0.5, 0}, -0.6, 0);
    arena_roll(sim, drive, 0.6, 0, 1);
    arena_frames(sim, 6, stop);
    double start = arena_ball(sim).vx_mps;
    arena_frames(sim, 45, stop);
    assert_near((start - arena_ball(sim).vx_mps) / 1.5, 0.071, 0.004);
    vs_sim_reset(sim, NULL);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_preset_is_refused_with_the_known_ones),
      cmocka_unit_test(commands_mean_the_presets_wheel),
      cmocka_unit_test(paper_preset_is_the_nominal_robot),
      cmocka_unit_test(firasim_accelerates_and_brakes_as_fitted),
      cmocka_unit_test(firasim_ball_rolls_far),
  };
  return cmocka_run_group_tests(tests, arena_open, arena_close);
}
