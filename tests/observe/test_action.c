// Tests src/observe/action.c.
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/observe.h"

static void full_action_is_the_wheel_limit(void **state) {
  (void)state;
  const float action[6] = {1, -1, 0.5f, -0.25f, 0, 0.1f};
  vs_wheels wheels[VS_TEAM_SIZE];
  assert_ok(vs_action_to_wheels(action, wheels, err));
  assert_near(wheels[0].left_radps, 46.66, 1e-9);
  assert_near(wheels[0].right_radps, -46.66, 1e-9);
  assert_near(wheels[1].left_radps, 23.33, 1e-9);
  assert_near(wheels[1].right_radps, -11.665, 1e-9);
  assert_near(wheels[2].left_radps, 0, 0);
  assert_near(wheels[2].right_radps, 4.666, 1e-6);
}

static void action_beyond_one_is_clamped(void **state) {
  (void)state;
  const float action[6] = {1.5f, -7, 1, 1, 1, 1};
  vs_wheels wheels[VS_TEAM_SIZE];
  assert_ok(vs_action_to_wheels(action, wheels, err));
  assert_near(wheels[0].left_radps, VS_WHEEL_LIMIT_RADPS, 0);
  assert_near(wheels[0].right_radps, -VS_WHEEL_LIMIT_RADPS, 0);
}

static void action_that_is_no_number_names_robot_and_wheel(void **state) {
  (void)state;
  const float bad[] = {NAN, INFINITY, -INFINITY};
  for (int b = 0; b < 3; b++) {
    float action[6] = {0};
    action[3] = bad[b];
    vs_wheels wheels[VS_TEAM_SIZE];
    vs_error err = {0};
    assert_int_equal(vs_action_to_wheels(action, wheels, &err), VS_FAIL);
    assert_non_null(strstr(err.text, "robot 1, right wheel"));
  }
}

static void wheels_become_the_action_that_made_them(void **state) {
  (void)state;
  const float action[6] = {1, -1, 0.5f, -0.25f, 0.125f, 0.1f};
  vs_wheels wheels[VS_TEAM_SIZE];
  float back[6];
  assert_ok(vs_action_to_wheels(action, wheels, err));
  vs_action_from_wheels(wheels, back);
  for (int i = 0; i < 6; i++) assert_near(back[i], action[i], 1e-7);
  wheels[2].left_radps = 1000; // a scripted player may ask for more than there is
  vs_action_from_wheels(wheels, back);
  assert_near(back[4], 1, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(full_action_is_the_wheel_limit),
      cmocka_unit_test(action_beyond_one_is_clamped),
      cmocka_unit_test(action_that_is_no_number_names_robot_and_wheel),
      cmocka_unit_test(wheels_become_the_action_that_made_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
