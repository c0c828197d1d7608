// Tests src/learn/gae.c
#include "assert_near.h"
#include "learn/gae.h"

// One row, gamma 0.5, lambda 0.5, four steps:
//   rewards 1 2 3 4, values 1 1 2 2 and 8 after the last step, nothing ends:
//   TD error t3 = 4 + 0.5*8 - 2 = 6;          A3 = 6
//   t2 = 3 + 0.5*2 - 2 = 2;                   A2 = 2 + 0.25*6    = 3.5
//   t1 = 2 + 0.5*2 - 1 = 2;                   A1 = 2 + 0.25*3.5  = 2.875
//   t0 = 1 + 0.5*1 - 1 = 0.5;                 A0 = 0.5 + 0.25*2.875 = 1.21875
static const float rewards[4] = {1, 2, 3, 4}, values[5] = {1, 1, 2, 2, 8};

static void advantages_flow_back_while_the_episode_goes_on(void **state) {
  (void)state;
  const uint8_t end[4] = {0};
  float advantage[4], target[4];
  vs_gae(&(vs_gae_batch){4, 1, 0.5, 0.5, rewards, values, end, NULL}, advantage, target);
  const double expected[4] = {1.21875, 2.875, 3.5, 6.0};
  for (int t = 0; t < 4; t++) {
    assert_near(advantage[t], expected[t], 1e-6);
    assert_near(target[t], expected[t] + values[t], 1e-6);
  }
}

// A goal ends step 1: TD error t1 = 2 + 0 - 1 = 1 = A1; A0 = 0.5 + 0.25*1 = 0.75. Steps 2 and 3 are as above.
static void nothing_follows_a_goal(void **state) {
  (void)state;
  const uint8_t end[4] = {0, VS_TERMINATED, 0, 0};
  float advantage[4], target[4];
  vs_gae(&(vs_gae_batch){4, 1, 0.5, 0.5, rewards, values, end, NULL}, advantage, target);
  assert_near(advantage[1], 1.0, 1e-6);
  assert_near(advantage[0], 0.75, 1e-6);
  assert_near(advantage[2], 3.5, 1e-6);
}

// The clock truncates step 1, where 10 was expected to follow: TD error t1 = 2 + 0.5*10 - 1 = 6 = A1 (nothing of step 2, which
// is another episode); A0 = 0.5 + 0.25*6 = 2.
static void a_time_limit_is_bootstrapped_with_the_value_of_its_own_last_state(void **state) {
  (void)state;
  const uint8_t end[4] = {0, VS_TRUNCATED, 0, 0};
  const float truncated_value[4] = {-99, 10, -99, -99};
  float advantage[4], target[4];
  vs_gae(&(vs_gae_batch){4, 1, 0.5, 0.5, rewards, values, end, truncated_value}, advantage, target);
  assert_near(advantage[1], 6.0, 1e-6);
  assert_near(advantage[0], 2.0, 1e-6);
  assert_near(target[1], 7.0, 1e-6);
}

// Two rows side by side: row 0 as in the first test, row 1 with an end at the last step, whose next value (99) must not
// count: TD error t3 = 4 - 2 = 2 = A3; t2 = 2 + 0.25*2 = 2.5.
static void rows_do_not_mix(void **state) {
  (void)state;
  float reward[8], value[10], advantage[8], target[8];
  uint8_t end[8] = {0};
  for (int t = 0; t < 4; t++) reward[2 * t] = reward[2 * t + 1] = rewards[t];
  for (int t = 0; t < 5; t++) value[2 * t] = value[2 * t + 1] = values[t];
  value[9] = 99;
  end[7] = VS_TERMINATED;
  vs_gae(&(vs_gae_batch){4, 2, 0.5, 0.5, reward, value, end, NULL}, advantage, target);
  assert_near(advantage[0], 1.21875, 1e-6);
  assert_near(advantage[7], 2.0, 1e-6);
  assert_near(advantage[5], 2.5, 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(advantages_flow_back_while_the_episode_goes_on),
      cmocka_unit_test(nothing_follows_a_goal),
      cmocka_unit_test(a_time_limit_is_bootstrapped_with_the_value_of_its_own_last_state),
      cmocka_unit_test(rows_do_not_mix),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
