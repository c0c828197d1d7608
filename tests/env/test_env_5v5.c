// src/env/env.c and src/control/control.c with five robots a team
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/env.h"
#include "vsss/field.h"

static vs_model *model;

static int open_model(void **state) {
  (void)state;
  vs_model_def def = vs_model_def_default(VS_DRIVE_PLANAR);
  def.division = VS_5V5;
  return vs_model_load(&def, &model, NULL) == VS_OK ? 0 : -1;
}

static int close_model(void **state) {
  (void)state;
  vs_model_free(model);
  return 0;
}

static vs_env_def a_match(void) {
  vs_env_def def = vs_env_def_default(model);
  def.referee = vs_referee_def_default(VS_RULES_LARC_2026);
  def.referee.duration_s = 30;
  def.player[VS_BLUE] = "emc:";
  def.player[VS_YELLOW] = "inf:";
  return def;
}

// Everybody plays: each of the ten robots has been commanded and has gone somewhere, and stays on the field.
static void a_match_of_ten_robots_is_played_to_its_end(void **state) {
  (void)state;
  vs_env_def def = a_match();
  vs_env *env;
  double went_m[VS_TEAMS][VS_TEAM_MOST] = {{0}};
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 4, err));
  vs_world first, w;
  vs_env_truth(env, &first);
  while (!vs_env_over(env)) {
    assert_ok(vs_env_frame(env, NULL, err));
    vs_env_truth(env, &w);
    assert_ok(vs_world_check(&w, err));
    for (int i = 0; i < 10; i++) {
      const vs_pose *a = &first.robot[i / 5][i % 5].pose, *b = &w.robot[i / 5][i % 5].pose;
      went_m[i / 5][i % 5] = fmax(went_m[i / 5][i % 5], hypot(a->x_m - b->x_m, a->y_m - b->y_m));
    }
  }
  assert_int_equal(w.division, VS_5V5);
  for (int i = 0; i < 10; i++) assert_true(went_m[i / 5][i % 5] > 0.1);
  vs_env_free(env);
}

static uint64_t play_on(vs_env *env) {
  while (!vs_env_over(env)) assert_ok(vs_env_frame(env, NULL, err));
  return vs_env_hash(env);
}

static void the_same_seed_is_the_same_match_also_from_a_snapshot(void **state) {
  (void)state;
  vs_env_def def = a_match();
  def.realism.latency_s = (vs_range){0.05, 0.05};
  def.predicts = VS_PREDICTS_ALL;
  vs_env *env, *other;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_new(&def, &other, err));
  assert_ok(vs_env_reset(env, 9, err));
  for (int f = 0; f < 200; f++) assert_ok(vs_env_frame(env, NULL, err));
  size_t size = vs_env_state_size(env);
  void *kept = calloc(1, size);
  vs_env_save(env, kept);
  uint64_t hash = play_on(env);
  assert_ok(vs_env_reset(other, 1, err));
  assert_ok(vs_env_restore(other, kept, err));
  assert_true(play_on(other) == hash);
  assert_ok(vs_env_reset(other, 9, err));
  assert_true(play_on(other) == hash);
  free(kept);
  vs_env_free(env);
  vs_env_free(other);
}

static void refused(const char *blue, const char *word) {
  vs_env_def def = a_match();
  def.player[VS_BLUE] = blue;
  vs_env *env;
  vs_error why = {0};
  assert_int_equal(vs_env_new(&def, &env, &why), VS_USAGE);
  if (!strstr(why.text, word)) fail_msg("%s", why.text);
}

static void teams_from_outside_and_steps_with_rewards_are_refused(void **state) {
  (void)state;
  refused(NULL, "a team that is commanded from outside plays 3v3 only, not 5v5: use --division 3v3");
  refused("shake:", "does not play 5v5");
  vs_env_def def = a_match();
  vs_env *env;
  vs_env_result result;
  vs_error why = {0};
  assert_ok(vs_env_new(&def, &env, err));
  assert_int_equal(vs_env_step(env, &result, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "a step with rewards plays 3v3 only"));
  why = (vs_error){0};
  assert_int_equal(vs_env_set_player(env, VS_BLUE, "shake:", &why), VS_USAGE);
  float obs[VS_TEAM_SIZE * VS_OBS_SIZE] = {1};
  vs_env_observation(env, VS_BLUE, obs);
  for (int k = 0; k < VS_TEAM_SIZE * VS_OBS_SIZE; k++) assert_true(obs[k] == 0);
  vs_env_free(env);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_match_of_ten_robots_is_played_to_its_end),
      cmocka_unit_test(the_same_seed_is_the_same_match_also_from_a_snapshot),
      cmocka_unit_test(teams_from_outside_and_steps_with_rewards_are_refused),
  };
  return cmocka_run_group_tests(tests, open_model, close_model);
}
