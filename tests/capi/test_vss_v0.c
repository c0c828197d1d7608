// src/capi/vss_v0.c
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "capi/vss_v0.h"
#include "vsss/field.h"
#include "vsss/geom.h"

static vs_model *model;
static vs_sim *sim;

static int open_sim(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_PLANAR);
  def.frame_hz = CAPI_VSS_HZ;
  def.substeps_per_frame = 4;
  return vs_model_load(&def, &model, NULL) != VS_OK || vs_sim_new(model, &sim, NULL) != VS_OK;
}

static int close_sim(void **state) {
  (void)state;
  vs_sim_free(sim);
  vs_model_free(model);
  return 0;
}

// Fields by hand: 0.45 m is half of 0.9 m, 0.599 m/s half of 1.198 m/s, 858 degrees/s half of 1716.
static void fields_have_rsoccers_order_and_scales(void **state) {
  (void)state;
  vss_v0 e = {0};
  e.world.ball = (vs_ball){.x_m = 0.45, .y_m = -0.09, .vx_mps = VSS_V0_MAX_MPS / 2, .vy_mps = -9};
  e.world.robot[VS_BLUE][1] = (vs_robot){
      .pose = {0.18, 0.27, VS_PI / 6}, .vx_mps = VSS_V0_MAX_MPS, .vy_mps = 0, .omega_radps = 858 * VS_PI / 180};
  e.world.robot[VS_YELLOW][2] = (vs_robot){.pose = {-0.9, 0.36, 1}, .omega_radps = -858 * VS_PI / 180};
  float o[CAPI_VSS_OBSERVATION];
  vss_v0_observe(&e, o);
  const float ball[] = {0.5f, -0.1f, 0.5f, -1.2f}, blue1[] = {0.2f, 0.3f, 0.5f, 0.8660254f, 1, 0, 0.5f};
  const float yellow2[] = {-1, 0.4f, 0, 0, -0.5f};
  for (int i = 0; i < 4; i++) assert_near(o[i], ball[i], 1e-6);
  for (int i = 0; i < 7; i++) assert_near(o[4 + 7 + i], blue1[i], 1e-4);
  for (int i = 0; i < 5; i++) assert_near(o[4 + 21 + 10 + i], yellow2[i], 1e-4);
}

static void a_seed_repeats_the_episode_and_pieces_do_not_overlap(void **state) {
  (void)state;
  vs_realism ideal = vs_realism_default();
  for (uint64_t seed = 0; seed < 50; seed++) {
    vss_v0 e = {.seed = seed}, again = {.seed = seed};
    vss_v0_reset(&e, sim, &ideal);
    vss_v0_reset(&again, sim, &ideal);
    assert_int_equal(vs_world_hash(VS_HASH_START, &e.world), vs_world_hash(VS_HASH_START, &again.world));
    for (int i = 0; i < 6; i++) {
      vs_pose p = e.world.robot[i / 3][i % 3].pose;
      assert_true(fabs(p.x_m) <= 0.65 && fabs(p.y_m) <= 0.55);
      assert_true(vs_distance_m(p.x_m, p.y_m, e.world.ball.x_m, e.world.ball.y_m) >= 0.12);
      for (int k = 0; k < i; k++) {
        vs_pose q = e.world.robot[k / 3][k % 3].pose;
        assert_true(vs_distance_m(p.x_m, p.y_m, q.x_m, q.y_m) >= 0.12);
      }
    }
  }
}

// A ball that rolls over blue's goal line ends the episode with -10.
static void rewards_are_the_sums_that_info_tells(void **state) {
  (void)state;
  vs_realism ideal = vs_realism_default();
  vss_v0 e = {.seed = 3};
  vss_v0_reset(&e, sim, &ideal);
  double sum = 0;
  bool goal = false;
  for (int i = 0; i < 40 && !goal; i++) {
    float reward;
    const float action[2] = {1, 0.5f};
    assert_ok(vss_v0_step(&e, sim, action, &reward, &goal, err));
    if (!goal) sum += reward;
    assert_near(e.shaping[1] + e.shaping[2] + e.shaping[3], sum, 1e-4);
  }
  assert_int_equal(e.world.time_us, (int64_t)e.steps * 25000);
  // 2e-4 x (1.198 + 0.599) m/s / 2.6 cm in every step.
  assert_near(e.shaping[3], -e.steps * 2e-4 * 1.5 * VSS_V0_MAX_MPS / 0.026, 1e-9);
  vs_world w = e.world;
  w.ball = (vs_ball){.x_m = -VS_FIELD_HALF_LENGTH_M + 0.005, .vx_mps = -1};
  for (int i = 0; i < 6; i++) w.robot[i / 3][i % 3].pose = (vs_pose){0.1 * i, 0.5 - 0.2 * (i % 2), 0};
  vs_sim_place(sim, &w);
  float reward = 0;
  assert_ok(vss_v0_step(&e, sim, (const float[2]){0, 0}, &reward, &goal, err));
  assert_true(goal);
  assert_near(reward, -10, 0);
  assert_near(e.shaping[0], -1, 0);
  assert_near(e.shaping[5], 1, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fields_have_rsoccers_order_and_scales),
      cmocka_unit_test(a_seed_repeats_the_episode_and_pieces_do_not_overlap),
      cmocka_unit_test(rewards_are_the_sums_that_info_tells),
  };
  return cmocka_run_group_tests_name("capi/vss_v0", tests, open_sim, close_sim);
}
