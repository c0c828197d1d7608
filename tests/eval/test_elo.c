// src/eval/elo.c
#include "assert_near.h"
#include "vsss/eval.h"

// 74.5 points of 99 games and the virtual draw make 75 of 100: odds of 3, so 400 log10(3) = 190.849 points apart.
static void two_players_stand_apart_by_the_odds(void **state) {
  (void)state;
  const double points[4] = {0, 74.5, 24.5, 0};
  const int games[4] = {0, 99, 99, 0};
  double rating[2];
  vs_elo(2, points, games, rating);
  assert_near(rating[0] - rating[1], 190.849, 0.001);
  assert_near(rating[0] + rating[1], 0, 1e-9);
}

// a beat b 7 of 10 and c 9 of 10, b took 5.5 of 9 from c. Reference: gradient ascent on the log-likelihood with half a
// point added to each side of a pair, written separately in another language.
static void three_players_get_the_most_likely_ratings(void **state) {
  (void)state;
  const double points[9] = {0, 7, 9, 3, 0, 5.5, 1, 3.5, 0};
  const int games[9] = {0, 10, 10, 10, 0, 9, 10, 9, 0};
  double rating[3];
  vs_elo(3, points, games, rating);
  assert_near(rating[0], 144.4905, 0.001);
  assert_near(rating[1], -20.8852, 0.001);
  assert_near(rating[2], -123.6053, 0.001);
}

// 100 wins of 100 and the virtual draw: 100.5 of 101, odds of 201, 400 log10(201) = 921.278.
static void a_player_who_always_wins_stays_finite(void **state) {
  (void)state;
  const double points[4] = {0, 100, 0, 0};
  const int games[4] = {0, 100, 100, 0};
  double rating[2];
  vs_elo(2, points, games, rating);
  assert_near(rating[0] - rating[1], 921.278, 0.001);
}

// 99 games and a virtual one at p = 0.75: the curvature is 100 * 0.75 * 0.25 = 18.75 per natural logarithm of the odds,
// whose deviation is 1/sqrt(18.75) = 0.23094; half of it for each player about the mean, times 400/ln 10 = 173.718.
static void the_deviation_is_the_likelihoods_even_for_who_always_wins(void **state) {
  (void)state;
  const int games[4] = {0, 99, 99, 0};
  const double rating[2] = {95.4243, -95.4243};
  double deviation[2];
  assert_ok(vs_elo_deviations(2, games, rating, deviation, err));
  assert_near(deviation[0], 20.060, 0.01);
  assert_near(deviation[1], 20.060, 0.01);
  // 100 of 100: p = 201/202, 101 p (1 - p) = 0.49751; 0.5/sqrt(0.49751) * 173.718 = 123.144.
  const int hundred[4] = {0, 100, 100, 0};
  const double apart[2] = {921.278 / 2, -921.278 / 2};
  assert_ok(vs_elo_deviations(2, hundred, apart, deviation, err));
  assert_near(deviation[0], 123.144, 0.05);
}

static void a_player_without_games_gets_a_finite_rating(void **state) {
  (void)state;
  const double points[9] = {0, 5, 0, 5, 0, 0, 0, 0, 0};
  const int games[9] = {0, 10, 0, 10, 0, 0, 0, 0, 0};
  double rating[3];
  vs_elo(3, points, games, rating);
  for (int i = 0; i < 3; i++) assert_near(rating[i], 0, 1e-9);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_players_stand_apart_by_the_odds),
      cmocka_unit_test(three_players_get_the_most_likely_ratings),
      cmocka_unit_test(a_player_who_always_wins_stays_finite),
      cmocka_unit_test(the_deviation_is_the_likelihoods_even_for_who_always_wins),
      cmocka_unit_test(a_player_without_games_gets_a_finite_rating),
  };
  return cmocka_run_group_tests_name("eval/elo", tests, NULL, NULL);
}
