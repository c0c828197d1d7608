// src/world/contract.c
#include "assert_near.h"
#include "comma_locale.h"
#include "vsss/contract.h"

#include <string.h>

static void layout_adds_up(void **state) {
  (void)state;
  assert_int_equal(VS_OBS_SIZE, 464);
  assert_string_equal(vs_obs_name(VS_OBS_BALL_XY), "ball_x");
  assert_string_equal(vs_obs_name(VS_OBS_OWN_HEADING), "own_sin");
  assert_string_equal(vs_obs_name(VS_OBS_ANGLES), "robot_ball_sin");
  assert_string_equal(vs_obs_name(VS_OBS_ALLIES_BALL_DISTANCE), "ally0_ball_distance");
  assert_string_equal(vs_obs_name(VS_OBS_BALL_GOAL_DISTANCES + 1), "ball_their_goal_distance");
  assert_string_equal(vs_obs_name(VS_OBS_ADVERSARIES_DISTANCE + 2), "adversary2_distance");
  assert_string_equal(vs_obs_name(VS_OBS_OWN_ACTION), "own_left");
  assert_string_equal(vs_obs_name(VS_OBS_TIME_LEFT), "time_left");
  assert_int_equal(VS_OBS_TIME_LEFT, VS_OBS_FRAME - 1);
}

static void every_value_has_a_name_of_its_own(void **state) {
  (void)state;
  for (int i = 0; i < VS_OBS_FRAME; i++)
    for (int j = 0; j < i; j++) assert_string_not_equal(vs_obs_name(i), vs_obs_name(j));
}

static void hash_is_that_of_version_1(void **state) {
  (void)state;
  // A change of this number makes every trained model unusable: raise VS_CONTRACT_VERSION and say so in the commit.
  assert_string_equal(vs_contract_hash_hex(), "4d7dbdb797302f31");
  assert_non_null(strstr(vs_contract_text(), "vsss contract 1;"));
}

static void hash_is_the_same_in_every_locale(void **state) {
  (void)state;
  set_comma_locale();
  char hash[17];
  snprintf(hash, sizeof hash, "%s", vs_contract_hash_hex());
  setlocale(LC_ALL, "C");
  assert_string_equal(hash, "4d7dbdb797302f31");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(layout_adds_up),
      cmocka_unit_test(every_value_has_a_name_of_its_own),
      cmocka_unit_test(hash_is_that_of_version_1),
      cmocka_unit_test(hash_is_the_same_in_every_locale),
  };
  return cmocka_run_group_tests_name("world/contract", tests, NULL, NULL);
}
