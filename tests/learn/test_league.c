// Tests src/learn/league.c
#include <string.h>

#include "assert_near.h"
#include "learn/league.h"

enum { SIZE = 4 };
static const float first[SIZE] = {1, 1, 1, 1}, second[SIZE] = {2, 2, 2, 2};

static double score_of(const vs_league *league) {
  const vs_league_window results = vs_league_results(league);
  return vs_league_window_score(&results);
}

static vs_status after_update(vs_league *league, long long update, bool *replaced, vs_error *err) {
  const vs_league_window results = vs_league_results(league);
  return vs_league_after_update(league, update, second, &results, replaced, err);
}

static vs_league_def paper_rule(void) {
  vs_league_def def = {.replace_score = 0.6, .score_window_zero_filled = true, .pool_size = 3, .pool_every = 1};
  assert_ok(vs_league_parse("frozen", &def, err));
  return def;
}

static void the_mix_is_shared_out_by_weight(void **state) {
  (void)state;
  vs_league_def def = {.pool_size = 1, .pool_every = 1};
  vs_league league;
  assert_ok(vs_league_parse("self=5,pool=3,emc:?pid=1=2", &def, err));
  assert_string_equal(def.share[2].uri, "emc:?pid=1");
  assert_ok(vs_league_init(&league, &def, 20, SIZE, first, 1, err));
  int count[3] = {0}, blue = 0;
  for (int i = 0; i < 20; i++) {
    count[league.slot[i].share]++;
    blue += league.slot[i].learner == VS_BLUE;
  }
  assert_int_equal(count[0], 10);
  assert_int_equal(count[1], 6);
  assert_int_equal(count[2], 4);
  assert_int_equal(blue, 10); // both sides of the field
  vs_league_free(&league);
}

// 100 results in a window that starts as zeros: 60 wins by one goal give 0.6, which is not more than 0.6.
static void the_frozen_self_is_replaced_when_the_score_passes_the_threshold(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  vs_league league;
  bool replaced;
  assert_ok(vs_league_init(&league, &def, 1, SIZE, first, 1, err));
  for (int i = 0; i < 60; i++) vs_league_episode_over(&league, 0, 1, 0);
  assert_near(score_of(&league), 0.6, 1e-12);
  assert_ok(after_update(&league, 1, &replaced, err));
  assert_false(replaced);
  vs_league_episode_over(&league, 0, 1, 0);
  assert_ok(after_update(&league, 2, &replaced, err));
  assert_true(replaced);
  assert_near(league.self[league.frozen].parameters[0], 2.0, 0.0);
  vs_league_free(&league);
}

// PufferLib's failure (its issue 620): a swap must not reach into an episode that is being played.
static void the_opponent_stays_the_same_for_a_whole_episode(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  vs_league league;
  bool replaced;
  assert_ok(vs_league_init(&league, &def, 2, SIZE, first, 1, err));
  int at_start = league.slot[1].self;
  for (int i = 0; i < 61; i++) vs_league_episode_over(&league, 0, 1, 0); // slot 1 plays on
  assert_ok(after_update(&league, 1, &replaced, err));
  assert_true(replaced);
  assert_int_equal(league.slot[1].self, at_start);
  assert_near(league.self[league.slot[1].self].parameters[0], 1.0, 0.0); // its weights, too
  vs_league_episode_over(&league, 1, 0, 0);
  assert_int_equal(league.slot[1].self, league.frozen);
  assert_near(league.self[league.slot[1].self].parameters[0], 2.0, 0.0);
  vs_league_free(&league);
}

// An episode that began before the swap must not count for the opponent after it.
static void no_result_is_credited_across_a_swap(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  def.score_window_zero_filled = false; // cleared at a swap
  vs_league league;
  bool replaced;
  assert_ok(vs_league_init(&league, &def, 2, SIZE, first, 1, err));
  for (int i = 0; i < 100; i++) vs_league_episode_over(&league, 0, 1, 0);
  assert_ok(after_update(&league, 1, &replaced, err));
  assert_true(replaced);
  assert_int_equal(league.window_filled, 0);
  vs_league_episode_over(&league, 1, 5, 0); // began against the first self
  assert_int_equal(league.window_filled, 0);
  vs_league_episode_over(&league, 1, 0, 2); // this one was against the second
  assert_int_equal(league.window_filled, 1);
  assert_near(score_of(&league), -2.0, 1e-12);
  vs_league_free(&league);
}

static void a_window_that_is_not_full_replaces_nobody(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  def.score_window_zero_filled = false;
  vs_league league;
  bool replaced;
  assert_ok(vs_league_init(&league, &def, 1, SIZE, first, 1, err));
  for (int i = 0; i < 99; i++) vs_league_episode_over(&league, 0, 10, 0);
  assert_ok(after_update(&league, 1, &replaced, err));
  assert_false(replaced);
  vs_league_free(&league);
}

static int ids_of_pool(const vs_league *league, int *id) {
  int members = 0;
  for (int i = 0; i < league->selves; i++) {
    if (!league->self[i].in_pool) continue;
    int at = members++;
    for (; at > 0 && id[at - 1] > league->self[i].id; at--) id[at] = id[at - 1];
    id[at] = league->self[i].id;
  }
  return members;
}

// pool_size 8, one addition an update, 100 of them: the first and the newest are there, and the six between them span
// the run, no gap above twice the 100/7 of an even spread.
static void the_pool_spans_the_whole_run(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  def.pool_size = 8;
  assert_ok(vs_league_parse("pool", &def, err));
  vs_league league;
  assert_ok(vs_league_init(&league, &def, 4, SIZE, first, 1, err));
  for (long long update = 1; update <= 100; update++) {
    assert_ok(after_update(&league, update, NULL, err));
    for (int slot = 0; slot < 4; slot++) vs_league_episode_over(&league, slot, 0, 0);
  }
  int id[101], members = ids_of_pool(&league, id);
  assert_int_equal(members, 8);
  assert_int_equal(id[0], 1);
  assert_int_equal(id[7], 101);
  for (int k = 1; k < 8; k++) assert_in_range(id[k] - id[k - 1], 1, 28);
  assert_true(league.selves <= 8 + 4 + 1); // places are used again
  vs_league_free(&league);
}

// One that is always beaten weighs 0.03, one that wins half of the time 0.03 + 0.25: it is met 9 times as often, here
// at least 5 times.
static void those_that_are_hard_to_beat_are_met_more_often(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  assert_ok(vs_league_parse("pool", &def, err));
  vs_league league;
  assert_ok(vs_league_init(&league, &def, 1, SIZE, first, 1, err));
  for (int i = 0; i < 100; i++) vs_league_episode_over(&league, 0, 1, 0); // the only member is beaten
  assert_ok(after_update(&league, 1, NULL, err));
  int met[2] = {0}, easy = league.slot[0].self;
  for (int i = 0; i < 2000; i++) {
    bool is_easy = league.slot[0].self == easy;
    met[is_easy]++;
    vs_league_episode_over(&league, 0, is_easy || i % 2, !is_easy && i % 2 == 0);
  }
  assert_true(met[1] > 20);
  assert_true(met[0] > 5 * met[1]);
  vs_league_free(&league);
}

// A pool of one: the newest takes the place, and the one before goes when its last episode is over.
static void a_self_leaves_after_its_last_episode(void **state) {
  (void)state;
  vs_league_def def = paper_rule();
  def.pool_size = 1;
  assert_ok(vs_league_parse("pool", &def, err));
  vs_league league;
  assert_ok(vs_league_init(&league, &def, 2, SIZE, first, 1, err));
  int old = league.self[league.slot[0].self].id;
  assert_ok(after_update(&league, 1, NULL, err));
  int id[2];
  assert_int_equal(ids_of_pool(&league, id), 1);
  assert_int_not_equal(id[0], old);
  assert_int_equal(league.self[league.slot[1].self].id, old);
  for (int slot = 0; slot < 2; slot++) vs_league_episode_over(&league, slot, 0, 0);
  for (int i = 0; i < league.selves; i++) assert_int_not_equal(league.self[i].id, old);
  vs_league_free(&league);
}

static void wrong_mixes_are_refused_with_the_word(void **state) {
  (void)state;
  vs_league_def def;
  static const char *const wrong[] = {
      "", "nobody", "self=0", "self=-1", "frozen=x", "=1", "a:,b:,c:,d:,e:,f:,g:,h:,i:"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vs_error err = {0};
    assert_int_equal(vs_league_parse(wrong[i], &def, &err), VS_USAGE);
    assert_non_null(strstr(err.text, "opponent"));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_mix_is_shared_out_by_weight),
      cmocka_unit_test(the_frozen_self_is_replaced_when_the_score_passes_the_threshold),
      cmocka_unit_test(the_opponent_stays_the_same_for_a_whole_episode),
      cmocka_unit_test(no_result_is_credited_across_a_swap),
      cmocka_unit_test(a_window_that_is_not_full_replaces_nobody),
      cmocka_unit_test(the_pool_spans_the_whole_run),
      cmocka_unit_test(those_that_are_hard_to_beat_are_met_more_often),
      cmocka_unit_test(a_self_leaves_after_its_last_episode),
      cmocka_unit_test(wrong_mixes_are_refused_with_the_word),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
