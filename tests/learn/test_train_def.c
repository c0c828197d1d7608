// Tests src/learn/train_def.c and src/learn/reward_mix.c
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "learn/reward_mix.h"
#include "learn/train_internal.h"
#include "vsss/learn.h"

// Neither the paper nor runs of before the levers had them.
static void assert_without_levers(const vs_train_def *def) {
  assert_string_equal(def->placement, "random");
  assert_string_equal(def->learning_rate_decay, "linear");
  assert_near(def->start_open + def->start_penalty + def->start_free_ball, 0.0, 0.0);
  assert_near(def->still_low_s, def->still_high_s, 0.0);
  assert_near(def->opponent_gain_high + def->opponent_mean, 0.0, 0.0);
  assert_near(def->action_gain, 1.0, 0.0);
  assert_false(def->reversible);
}

// Paper, Table 2 and section VII: lambda 0.95, gamma 0.99, clip 0.2, learning rate 4e-4, 200 environments, 5 epochs,
// batch 128,400 = 200 x 3 x 214, opponent replaced at 0.6.
static void the_paper_preset_is_table_2(void **state) {
  (void)state;
  vs_train_def def;
  assert_ok(vs_train_def_preset("paper", &def, err));
  assert_near(def.lambda, 0.95, 0.0);
  assert_near(def.gamma, 0.99, 0.0);
  assert_near(def.clip, 0.2, 0.0);
  assert_near(def.learning_rate, 4e-4, 0.0);
  assert_near(def.learning_rate_end, 4e-4, 0.0);
  assert_near(def.replace_score, 0.6, 0.0);
  assert_int_equal(def.envs * 3 * def.steps, 128400);
  assert_int_equal(def.epochs, 5);
  assert_int_equal(def.minibatch, 4280);
  assert_string_equal(def.opponent, "frozen");
  assert_string_equal(def.reward, "paper");
  assert_string_equal(def.hidden, "256,256");
  assert_near(def.episode_s, 40.0, 0.0);
  assert_near(def.transitions_m, 160.0, 0.0);
  assert_without_levers(&def);
}

static void settings_read_back_as_they_were_written(void **state) {
  (void)state;
  vs_train_def def, read;
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  char text[4096];
  assert_ok(vs_train_def_preset("paper", &def, err));
  def.gamma = 1.0 - 1.0 / 3.0;
  def.seed = 42;
  def.value_scale = true;
  snprintf(def.reward, sizeof def.reward, "dense,approach=0.3");
  snprintf(def.opponent, sizeof def.opponent, "self=0.5,emc:?pid=1=0.5");
  assert_true(vs_train_def_text(&def, false, text, sizeof text) < sizeof text);
  assert_non_null(strstr(text, "clip = 0.2\n")); // as a person would write it
  assert_ok(vs_train_def_preset("default", &read, err));
  vs_train_schema(&read, keys);
  assert_ok(vs_config_parse("text", text, keys, err));
  assert_memory_equal(&read, &def, offsetof(vs_train_def, opponent));
  assert_near(read.gamma, def.gamma, 0.0);
  assert_string_equal(read.reward, def.reward);
  assert_string_equal(read.opponent, def.opponent);
  assert_true(read.value_scale);
}

static void the_learning_rate_falls_as_it_is_set(void **state) {
  (void)state;
  vs_train_def def;
  assert_ok(vs_train_def_preset("default", &def, err));
  def.learning_rate = 1e-3, def.learning_rate_end = 1e-5, def.transitions_m = 40.0;
  def.learning_rate_hold_m = 0.0;
  snprintf(def.learning_rate_decay, sizeof def.learning_rate_decay, "exponential");
  assert_near(vs_train_learning_rate(&def, 0.0), 1e-3, 1e-12);
  assert_near(vs_train_learning_rate(&def, 20e6), 1e-4, 1e-12);
  assert_near(vs_train_learning_rate(&def, 30e6), sqrt(10.0) * 1e-5, 1e-12);
  assert_near(vs_train_learning_rate(&def, 50e6), 1e-5, 1e-12);
  snprintf(def.learning_rate_decay, sizeof def.learning_rate_decay, "linear");
  assert_near(vs_train_learning_rate(&def, 0.0), 1e-3, 1e-12);
  assert_near(vs_train_learning_rate(&def, 20e6), 5.05e-4, 1e-12);
  assert_near(vs_train_learning_rate(&def, 50e6), 1e-5, 1e-12);
  def.learning_rate_hold_m = 10.0, def.transitions_m = 30.0;
  assert_near(vs_train_learning_rate(&def, 9e6), 1e-3, 1e-12);
  assert_near(vs_train_learning_rate(&def, 20e6), 5.05e-4, 1e-12);
  assert_near(vs_train_learning_rate(&def, 30e6), 1e-5, 1e-12);
  def.learning_rate_hold_m = 0.0;
  def.transitions_m = 0.0; // without an end it stays
  assert_near(vs_train_learning_rate(&def, 50e6), 1e-3, 1e-12);
  snprintf(def.learning_rate_decay, sizeof def.learning_rate_decay, "cosine");
  vs_error err = {0};
  assert_int_equal(vs_train_def_check(&def, &err), VS_USAGE);
  assert_string_equal(err.text, "learning_rate_decay 'cosine': expected linear or exponential");
}

static void runs_of_before_go_on_as_they_were(void **state) {
  (void)state;
  vs_train_def def = vs_train_def_default();
  vs_train_def_before(&def);
  assert_without_levers(&def);
}

static void names_of_before_are_still_read(void **state) {
  (void)state;
  vs_train_def def;
  vs_config_key keys[VS_TRAIN_KEYS_MAX];
  char text[VS_TRAIN_TEXT_MAX];
  assert_ok(vs_train_def_preset("default", &def, err));
  vs_train_schema(&def, keys);
  assert_ok(vs_config_parse("text", "pieces = 7\nfirst_shape = 2.5\n", keys, err));
  assert_ok(vs_config_set("window_of_zeros=true", keys, err));
  assert_int_equal(def.microbatches, 7);
  assert_near(def.initial_concentration, 2.5, 0.0);
  assert_true(def.score_window_zero_filled);
  // What is written has the present names only.
  vs_train_def_text(&def, true, text, sizeof text);
  assert_non_null(strstr(text, "\nmicrobatches = 7\n"));
  assert_non_null(strstr(text, "\ninitial_concentration = 2.5\n"));
  assert_non_null(strstr(text, "\nscore_window_zero_filled = true\n"));
  static const char *const old[] = {"pieces =", "first_shape", "window_of_zeros"};
  for (int i = 0; i < 3; i++) assert_null(strstr(text, old[i]));
  vs_error err = {0};
  assert_int_equal(vs_config_set("pieces=65", keys, &err), VS_USAGE);
  assert_string_equal(err.text, "command line: microbatches = 65: allowed are 1 to 64");
}

static void every_preset_passes_its_own_check(void **state) {
  (void)state;
  static const char *const names[] = {"default", "paper"};
  for (int i = 0; i < 2; i++) {
    vs_train_def def;
    assert_ok(vs_train_def_preset(names[i], &def, err));
    assert_ok(vs_train_def_check(&def, err));
  }
}

static void settings_that_exclude_each_other_are_refused_by_name(void **state) {
  (void)state;
  static const struct {
    const char *set[2], *why;
  } wrong[] = {
      {{"still_low_s=5", "still_high_s=4"}, "still_high_s = 4: must not be below still_low_s = 5"},
      {{"start_open=0.6", "start_free_ball=0.5"}, "start_open + start_penalty + start_free_ball = 1.35: at most 1"},
      {{"anneal_from_m=9", "anneal_to_m=8"}, "anneal_to_m = 8: must not be below anneal_from_m = 9"},
      {{"opponent_gain_low=1.5", "opponent_gain_high=1"},
       "opponent_gain_high = 1: must not be below opponent_gain_low = 1.5"},
      {{"opponent_gain_low=1.5", "opponent_gain_high=0"},
       "opponent_gain_high = 0: must not be below opponent_gain_low = 1.5"},
      {{"canonical=true", "augment=5"},
       "canonical and augment exclude each other: set canonical = false or augment = 0"},
      {{"canonical=true", "export_average=true"},
       "canonical and export_average exclude each other: set one of them to false"},
      {{"precision=bf16", "learner=torch"}, "precision = bf16: is for learner = own; torch computes in fp32"},
      {{"envs=1", "steps=10"}, "minibatch = 1024: a batch of 1 matches x 10 steps has 30 rows with one side learning"},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vs_train_def def = vs_train_def_default();
    vs_config_key keys[VS_TRAIN_KEYS_MAX];
    vs_error err = {0};
    vs_train_schema(&def, keys);
    for (int k = 0; k < 2; k++) assert_int_equal(vs_config_set(wrong[i].set[k], keys, &err), VS_OK);
    assert_int_equal(vs_train_def_check(&def, &err), VS_USAGE);
    assert_string_equal(err.text, wrong[i].why);
  }
}

static void a_reward_is_a_preset_and_changes(void **state) {
  (void)state;
  vs_reward_weights weights, paper = vs_reward_paper();
  assert_ok(vs_reward_mix_parse("paper", &weights, err));
  for (int t = 0; t < VS_REWARD_TERMS; t++) assert_near(weights.weight[t], paper.weight[t], 0.0);
  assert_ok(vs_reward_mix_parse("paper,goal=2.5,approach=-0.25", &weights, err));
  assert_near(weights.weight[VS_REWARD_GOAL], 2.5, 0.0);
  assert_near(weights.weight[VS_REWARD_APPROACH], -0.25, 0.0);
  assert_near(weights.weight[VS_REWARD_SPEED], paper.weight[VS_REWARD_SPEED], 0.0);
  vs_error err = {0};
  assert_int_equal(vs_reward_mix_parse("paper,goal=much", &weights, &err), VS_USAGE);
  assert_int_equal(vs_reward_mix_parse("goal=1", &weights, &err), VS_USAGE);
}

// From 4 to 0 between 10 and 30: 4 before, 2 at 20, 0 after.
static void the_schedule_is_linear_between_its_ends(void **state) {
  (void)state;
  const vs_reward_weights start = {{[VS_REWARD_GOAL] = 4.0}}, end = {{0}};
  assert_near(vs_reward_mix_at(&start, &end, 10, 30, 5).weight[VS_REWARD_GOAL], 4.0, 0.0);
  assert_near(vs_reward_mix_at(&start, &end, 10, 30, 20).weight[VS_REWARD_GOAL], 2.0, 1e-12);
  assert_near(vs_reward_mix_at(&start, &end, 10, 30, 99).weight[VS_REWARD_GOAL], 0.0, 0.0);
  assert_near(vs_reward_mix_at(&start, &end, 10, 10, 9).weight[VS_REWARD_GOAL], 4.0, 0.0);
  assert_near(vs_reward_mix_at(&start, &end, 10, 10, 10).weight[VS_REWARD_GOAL], 0.0, 0.0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_paper_preset_is_table_2),
      cmocka_unit_test(settings_read_back_as_they_were_written),
      cmocka_unit_test(the_learning_rate_falls_as_it_is_set),
      cmocka_unit_test(runs_of_before_go_on_as_they_were),
      cmocka_unit_test(names_of_before_are_still_read),
      cmocka_unit_test(every_preset_passes_its_own_check),
      cmocka_unit_test(settings_that_exclude_each_other_are_refused_by_name),
      cmocka_unit_test(a_reward_is_a_preset_and_changes),
      cmocka_unit_test(the_schedule_is_linear_between_its_ends),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
