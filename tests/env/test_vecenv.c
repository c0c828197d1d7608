// src/env/vecenv.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "planar_model.h"
#include "count_allocations.h"
#include "vsss/vecenv.h"

enum { ENVS = 6, ROWS = VS_VECENV_ROWS(ENVS) };

// Everything a vecenv writes.
typedef struct arrays {
  float observation[ROWS][VS_OBS_SIZE], final_observation[ROWS][VS_OBS_SIZE];
  float action[ROWS][VS_ACTION_SIZE];
  double reward_terms[ROWS][VS_REWARD_TERMS];
  uint8_t done[ENVS], time_limit[ENVS];
  int32_t score[ENVS][VS_TEAMS];
  float episode_s[ENVS];
  int32_t event[ENVS][2];
} arrays;

static vs_vecenv_buffers buffers_of(arrays *a) {
  return (vs_vecenv_buffers){.observation = a->observation[0],
                             .action = a->action[0],
                             .reward_terms = a->reward_terms[0],
                             .done = a->done,
                             .time_limit = a->time_limit,
                             .final_observation = a->final_observation[0],
                             .score = a->score[0],
                             .episode_s = a->episode_s,
                             .event = a->event[0]};
}

// Blue external, yellow EMC, episodes of 2 s, a realistic camera and radio.
static vs_vecenv *new_vecenv(int threads) {
  vs_vecenv_def def = {.env = vs_env_def_default(model), .envs = ENVS, .threads = threads, .seed = 12};
  def.env.player[VS_YELLOW] = "emc:";
  def.env.referee = vs_referee_def_training();
  def.env.referee.duration_s = 2.0;
  def.env.realism.latency_s = (vs_range){0.0, 0.08};
  def.env.realism.floor_friction_scale = (vs_range){0.8, 1.2};
  def.env.shuffle_adversaries = true;
  vs_vecenv *vec = NULL;
  assert_ok(vs_vecenv_new(&def, &vec, err));
  return vec;
}

// Blue's actions: a function of the step, so that every run gives the same.
static void steer(arrays *a, int step) {
  for (int row = 0; row < ROWS; row++) {
    if (row / VS_TEAM_SIZE % VS_TEAMS == VS_YELLOW) continue;
    a->action[row][0] = (float)((row * 7 + step * 3) % 11 - 5) / 5.0f;
    a->action[row][1] = (float)((row * 5 + step) % 13 - 6) / 6.0f;
  }
}

static void step(vs_vecenv *vec, arrays *a, int number) {
  vs_vecenv_buffers b = buffers_of(a);
  steer(a, number);
  assert_ok(vs_vecenv_step(vec, &b, err));
}

static uint64_t run(vs_vecenv *vec, arrays *a, int first, int last) {
  uint64_t hash = VS_HASH_START;
  for (int i = first; i < last; i++) {
    step(vec, a, i);
    hash = vs_hash_bytes(hash, a, sizeof *a);
  }
  return hash;
}

static arrays *start(vs_vecenv *vec) {
  arrays *a = calloc(1, sizeof *a);
  vs_vecenv_buffers b = buffers_of(a);
  assert_ok(vs_vecenv_reset(vec, &b, err));
  return a;
}

static void every_array_is_the_same_for_1_2_and_4_threads(void **state) {
  (void)state;
  uint64_t rows[3], worlds[3];
  const int threads[3] = {1, 2, 4};
  for (int k = 0; k < 3; k++) {
    vs_vecenv *vec = new_vecenv(threads[k]);
    arrays *a = start(vec);
    rows[k] = run(vec, a, 0, 50); // two episodes end
    worlds[k] = vs_vecenv_hash(vec);
    free(a);
    vs_vecenv_free(vec);
  }
  for (int k = 1; k < 3; k++) {
    assert_int_equal(rows[k], rows[0]);
    assert_int_equal(worlds[k], worlds[0]);
  }
}

static void a_step_allocates_nothing(void **state) {
  (void)state;
#if COUNTS_ALLOCATIONS
  vs_vecenv *vec = new_vecenv(2);
  arrays *a = start(vec);
  vs_vecenv_buffers b = buffers_of(a);
  free(malloc(1));
  assert_true(allocations_so_far() > 0); // the counter counts
  long before = allocations_so_far();
  vs_error err;
  for (int i = 0; i < 50; i++) {
    steer(a, i);
    if (vs_vecenv_step(vec, &b, &err) != VS_OK) fail_msg("%s", err.text);
  }
  long counted = allocations_so_far() - before;
  assert_int_equal(counted, 0);
  free(a);
  vs_vecenv_free(vec);
#else
  print_message("note: a sanitizer owns the allocator\n");
  skip();
#endif
}

// Matches differ, since their seeds do; an episode of 2 s is 20 steps unless a goal ends it.
static void episodes_end_restart_and_report(void **state) {
  (void)state;
  vs_vecenv *vec = new_vecenv(2);
  arrays *a = start(vec);
  assert_memory_not_equal(a->observation[0], a->observation[6], sizeof a->observation[0]);
  int ended = 0, by_clock = 0;
  for (int i = 0; i < 45; i++) {
    memset(a->final_observation, 0x7f, sizeof a->final_observation);
    step(vec, a, i);
    for (int e = 0; e < ENVS; e++) {
      bool untouched = true;
      const unsigned char *final = (const unsigned char *)a->final_observation[e * 6];
      for (size_t k = 0; k < sizeof a->final_observation[0]; k++) untouched &= final[k] == 0x7f;
      assert_int_equal(untouched, !a->done[e]);
      if (!a->done[e]) continue;
      ended++;
      by_clock += a->time_limit[e];
      assert_true(a->episode_s[e] > 0.0f && a->episode_s[e] <= 2.0f + 1e-5f);
      if (a->time_limit[e]) {
        assert_near(a->episode_s[e], 2.0, 1e-5);
        assert_int_equal(a->score[e][0] + a->score[e][1], 0);
        assert_int_equal(a->event[e][0], VS_EVENT_END);
        // The episode's clock: all used up in its last observation, all left in the first of the new one.
        assert_near(a->final_observation[e * 6][(VS_OBS_STACK - 1) * VS_OBS_FRAME + VS_OBS_TIME_LEFT], 0.0, 1e-5);
      } else {
        assert_int_equal(a->score[e][0] + a->score[e][1], 1);
        assert_int_equal(a->event[e][0], VS_EVENT_GOAL);
        assert_int_equal(a->score[e][a->event[e][1]], 1);
        // A goal leaves some time; the last observation still shows the old episode's clock.
        assert_near(a->final_observation[e * 6][(VS_OBS_STACK - 1) * VS_OBS_FRAME + VS_OBS_TIME_LEFT],
                    (2.0 - a->episode_s[e]) / 2.0, 1e-4);
      }
      assert_near(a->observation[e * 6][(VS_OBS_STACK - 1) * VS_OBS_FRAME + VS_OBS_TIME_LEFT], 1.0, 1e-5);
    }
  }
  assert_true(ended >= 2 * ENVS);
  assert_true(by_clock > 0);
  free(a);
  vs_vecenv_free(vec);
}

static void scripted_rows_hold_their_actions_and_external_rows_are_kept(void **state) {
  (void)state;
  vs_vecenv *vec = new_vecenv(2);
  arrays *a = start(vec);
  double moved = 0;
  for (int i = 0; i < 10; i++) {
    step(vec, a, i);
    arrays given;
    steer(&given, i);
    for (int row = 0; row < ROWS; row++) {
      bool external = row / VS_TEAM_SIZE % VS_TEAMS == VS_BLUE;
      if (external) assert_memory_equal(a->action[row], given.action[row], sizeof given.action[row]);
      if (!external) moved += fabs(a->action[row][0]);
      for (int k = 0; k < VS_ACTION_SIZE; k++) assert_true(fabsf(a->action[row][k]) <= 1.0f);
    }
  }
  assert_true(moved > 1.0);
  free(a);
  vs_vecenv_free(vec);
}

static void a_snapshot_continues_bit_identically_with_other_threads(void **state) {
  (void)state;
  vs_vecenv *vec = new_vecenv(1), *other = new_vecenv(3);
  arrays *a = start(vec), *b = start(other);
  run(vec, a, 0, 15);
  void *snapshot = aligned_alloc(64, vs_vecenv_state_size(vec));
  arrays *kept = malloc(sizeof *kept);
  vs_vecenv_save(vec, snapshot);
  memcpy(kept, a, sizeof *a);
  uint64_t expected = run(vec, a, 15, 40); // over the end of an episode
  run(other, b, 0, 3);
  assert_ok(vs_vecenv_restore(other, snapshot, err));
  memcpy(b, kept, sizeof *b);
  assert_int_equal(run(other, b, 15, 40), expected);
  assert_int_equal(vs_vecenv_hash(other), vs_vecenv_hash(vec));
  free(snapshot);
  free(kept);
  free(a);
  free(b);
  vs_vecenv_free(vec);
  vs_vecenv_free(other);
}

static void a_player_changes_between_episodes_never_within_one(void **state) {
  (void)state;
  vs_vecenv *vec = new_vecenv(2);
  arrays *a = start(vec);
  step(vec, a, 0);
  assert_ok(vs_vecenv_set_player(vec, 0, VS_YELLOW, NULL, err));
  const int row = VS_TEAM_SIZE; // yellow of match 0
  bool ended = false;
  for (int i = 1; i < 25; i++) {
    for (int k = 0; k < VS_ACTION_SIZE; k++) a->action[row][k] = 0.123f;
    step(vec, a, i);
    // While EMC plays on, its row is overwritten; from the next episode on the row is the caller's.
    bool kept = a->action[row][0] == 0.123f && a->action[row][1] == 0.123f;
    assert_int_equal(kept, ended);
    ended |= a->done[0];
  }
  assert_true(ended);
  vs_error err = {0};
  assert_int_equal(vs_vecenv_set_player(vec, ENVS, VS_BLUE, "zero:", &err), VS_USAGE);
  free(a);
  vs_vecenv_free(vec);
}

static void the_lowest_failing_match_is_reported_for_any_number_of_threads(void **state) {
  (void)state;
  char text[2][512];
  for (int k = 0; k < 2; k++) {
    vs_vecenv *vec = new_vecenv(1 + 2 * k);
    arrays *a = start(vec);
    steer(a, 0);
    a->action[2 * 6 + 1][0] = NAN;
    a->action[4 * 6][1] = NAN;
    vs_vecenv_buffers b = buffers_of(a);
    vs_error err = {0};
    assert_int_equal(vs_vecenv_step(vec, &b, &err), VS_FAIL);
    memcpy(text[k], err.text, sizeof text[k]);
    free(a);
    vs_vecenv_free(vec);
  }
  char seed[32];
  snprintf(seed, sizeof seed, "seed %llu", (unsigned long long)vs_seed_mix(vs_seed_mix(12, 2), 0));
  assert_non_null(strstr(text[0], seed));
  assert_string_equal(text[0], text[1]);
}

static vs_vecenv_def short_episodes(void) {
  vs_vecenv_def def = {.env = vs_env_def_default(model), .envs = ENVS, .threads = 2, .seed = 12};
  def.env.player[VS_YELLOW] = "emc:";
  def.env.referee = vs_referee_def_training();
  def.env.referee.duration_s = 1.0;
  return def;
}

// Row env * 3 + robot of one team is row (env * 2 + team) * 3 + robot of both.
static void rows_of_one_team_are_those_of_both(void **state) {
  (void)state;
  vs_vecenv_def def = short_episodes();
  vs_vecenv *both = NULL, *blue = NULL;
  assert_ok(vs_vecenv_new(&def, &both, err));
  def.teams = VS_ROWS_BLUE;
  assert_ok(vs_vecenv_new(&def, &blue, err));
  assert_int_equal(vs_vecenv_rows(both), ENVS * 6);
  assert_int_equal(vs_vecenv_rows(blue), ENVS * 3);
  arrays *a = start(both), *b = start(blue);
  for (int i = 0; i < 15; i++) {
    vs_vecenv_buffers to = buffers_of(b);
    steer(a, i);
    for (int row = 0; row < ROWS; row++)
      if (row / 3 % 2 == VS_BLUE) memcpy(b->action[row / 6 * 3 + row % 3], a->action[row], sizeof a->action[row]);
    step(both, a, i);
    assert_ok(vs_vecenv_step(blue, &to, err));
    for (int row = 0; row < ROWS; row++) {
      if (row / 3 % 2 != VS_BLUE) continue;
      int one = row / 6 * 3 + row % 3;
      assert_memory_equal(b->observation[one], a->observation[row], sizeof a->observation[row]);
      assert_memory_equal(b->reward_terms[one], a->reward_terms[row], sizeof a->reward_terms[row]);
      if (a->done[row / 6])
        assert_memory_equal(b->final_observation[one], a->final_observation[row], sizeof a->observation[row]);
    }
  }
  assert_int_equal(vs_vecenv_hash(both), vs_vecenv_hash(blue));
  free(a);
  free(b);
  vs_vecenv_free(both);
  vs_vecenv_free(blue);
  vs_error err = {0};
  def.teams = VS_ROWS_YELLOW; // blue would be external without rows
  assert_int_equal(vs_vecenv_new(&def, &blue, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "blue has no rows"));
}

static void a_seed_repeats_its_episodes_and_a_start_goes_on_to_the_next(void **state) {
  (void)state;
  vs_vecenv_def def = short_episodes();
  vs_vecenv *vec = NULL;
  assert_ok(vs_vecenv_new(&def, &vec, err));
  arrays *a = start(vec);
  vs_vecenv_buffers b = buffers_of(a);
  uint64_t first = run(vec, a, 0, 12);
  vs_vecenv_seed(vec, 13);
  assert_ok(vs_vecenv_reset(vec, &b, err));
  assert_true(run(vec, a, 0, 12) != first);
  vs_vecenv_seed(vec, 12);
  memset(a, 0, sizeof *a);
  assert_ok(vs_vecenv_reset(vec, &b, err));
  assert_int_equal(run(vec, a, 0, 12), first);

  // Of two matches with the same seed one goes on to its next episode: they differ until the other does too.
  assert_ok(vs_vecenv_seed_match(vec, 1, 77, err));
  assert_ok(vs_vecenv_seed_match(vec, 4, 77, err));
  const uint8_t these[ENVS] = {0, 1, 0, 0, 1, 0}, one[ENVS] = {0, 1, 0, 0, 0, 0}, other[ENVS] = {0, 0, 0, 0, 1, 0};
  uint64_t match_0 = vs_env_hash(vs_vecenv_env(vec, 0));
  assert_ok(vs_vecenv_start(vec, these, &b, err));
  assert_memory_equal(a->observation[1 * 6], a->observation[4 * 6], sizeof a->observation[0]);
  assert_ok(vs_vecenv_start(vec, one, &b, err));
  assert_memory_not_equal(a->observation[1 * 6], a->observation[4 * 6], sizeof a->observation[0]);
  assert_ok(vs_vecenv_start(vec, other, &b, err));
  assert_memory_equal(a->observation[1 * 6], a->observation[4 * 6], sizeof a->observation[0]);
  assert_int_equal(vs_env_hash(vs_vecenv_env(vec, 0)), match_0);
  // An episode's seed given outright: the one that the match seed leads to.
  assert_ok(vs_vecenv_start_from(vec, 2, vs_seed_mix(77, 1), &b, err));
  assert_memory_equal(a->observation[2 * 6], a->observation[4 * 6], sizeof a->observation[0]);
  vs_error err = {0};
  assert_int_equal(vs_vecenv_seed_match(vec, ENVS, 1, &err), VS_USAGE);
  assert_int_equal(vs_vecenv_start_from(vec, -1, 1, &b, &err), VS_USAGE);
  free(a);
  vs_vecenv_free(vec);
}

static void a_match_that_is_to_stay_over_rests_until_it_is_started(void **state) {
  (void)state;
  vs_vecenv_def def = short_episodes();
  def.stay_over = true;
  vs_vecenv *vec = NULL;
  assert_ok(vs_vecenv_new(&def, &vec, err));
  arrays *a = start(vec);
  vs_vecenv_buffers b = buffers_of(a);
  run(vec, a, 0, 10); // 1 s: all are over
  arrays *kept = malloc(sizeof *kept);
  memcpy(kept, a, sizeof *a);
  for (int e = 0; e < ENVS; e++) {
    assert_true(a->done[e]);
    assert_memory_equal(a->observation[e * 6], a->final_observation[e * 6], sizeof a->observation[0]);
  }
  step(vec, a, 10);
  assert_memory_equal(a->observation, kept->observation, sizeof a->observation);
  for (int row = 0; row < ROWS; row++)
    for (int k = 0; k < VS_REWARD_TERMS; k++) assert_true(a->reward_terms[row][k] == 0.0);
  assert_ok(vs_vecenv_start(vec, NULL, &b, err));
  step(vec, a, 11);
  for (int e = 0; e < ENVS; e++) assert_false(a->done[e]);
  free(kept);
  free(a);
  vs_vecenv_free(vec);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_array_is_the_same_for_1_2_and_4_threads),
      cmocka_unit_test(a_step_allocates_nothing),
      cmocka_unit_test(episodes_end_restart_and_report),
      cmocka_unit_test(scripted_rows_hold_their_actions_and_external_rows_are_kept),
      cmocka_unit_test(a_snapshot_continues_bit_identically_with_other_threads),
      cmocka_unit_test(a_player_changes_between_episodes_never_within_one),
      cmocka_unit_test(rows_of_one_team_are_those_of_both),
      cmocka_unit_test(a_seed_repeats_its_episodes_and_a_start_goes_on_to_the_next),
      cmocka_unit_test(a_match_that_is_to_stay_over_rests_until_it_is_started),
      cmocka_unit_test(the_lowest_failing_match_is_reported_for_any_number_of_threads),
  };
  return cmocka_run_group_tests_name("env/vecenv", tests, load_model, free_model);
}
