// src/world/world.c
#include "assert_near.h"
#include "vsss/geom.h"
#include "vsss/world.h"

#include <string.h>

static vs_world some_world(void) {
  vs_world w = {0};
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      vs_robot *r = &w.robot[t][i];
      *r = (vs_robot){{0.1 * i + 0.3 * t, 0.2 - 0.1 * i, 0.5 * i}, 0.1, -0.2, 0.3, 4, 5, true};
    }
  w.ball = (vs_ball){0.3, -0.4, 0.02, 1.0, -2.0, 0.0, true};
  w.time_us = 1234;
  w.seq = 7;
  return w;
}

static void yellow_sees_itself_first_and_the_field_turned_by_pi(void **state) {
  (void)state;
  vs_world w = some_world(), v;
  vs_world_for_team(&w, VS_YELLOW, &v);
  // Yellow robot 1 at (0.4, 0.1), heading 0.5: turned (-0.4, -0.1), heading 0.5 + pi - 2 pi.
  assert_near(v.robot[VS_OWN][1].pose.x_m, -0.4, 1e-15);
  assert_near(v.robot[VS_OWN][1].pose.y_m, -0.1, 1e-15);
  assert_near(v.robot[VS_OWN][1].pose.theta_rad, 0.5 - VS_PI, 1e-15);
  assert_near(v.robot[VS_OWN][1].vx_mps, -0.1, 0);
  assert_near(v.robot[VS_OWN][1].omega_radps, 0.3, 0); // turning does not change its sense
  assert_near(v.robot[VS_ADVERSARY][1].pose.x_m, -0.1, 1e-15);
  assert_near(v.ball.x_m, -0.3, 0);
  assert_near(v.ball.vy_mps, 2.0, 0);
}

static void seeing_as_yellow_twice_gives_the_world_back(void **state) {
  (void)state;
  vs_world w = some_world(), v;
  vs_world_for_team(&w, VS_YELLOW, &v);
  vs_world_for_team(&v, VS_YELLOW, &v);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      assert_near(v.robot[t][i].pose.x_m, w.robot[t][i].pose.x_m, 0);
      assert_near(v.robot[t][i].pose.theta_rad, w.robot[t][i].pose.theta_rad, 1e-15);
    }
  assert_near(v.ball.y_m, w.ball.y_m, 0);
}

static void blue_sees_the_absolute_world(void **state) {
  (void)state;
  vs_world w = some_world(), v;
  vs_world_for_team(&w, VS_BLUE, &v);
  assert_int_equal(vs_world_hash(VS_HASH_START, &v), vs_world_hash(VS_HASH_START, &w));
}

static void a_game_turns_score_team_and_quadrant(void **state) {
  (void)state;
  vs_game g = {10, 120, {2, 5}, {VS_EVENT_FREE_BALL, VS_YELLOW, 2, 9}}, v;
  vs_game_for_team(&g, VS_YELLOW, &v);
  assert_int_equal(v.score[0], 5);
  assert_int_equal(v.score[1], 2);
  assert_int_equal(v.last_event.team, VS_BLUE); // "ours"
  assert_int_equal(v.last_event.quadrant, 4);   // (-x, +y) turned by pi is (+x, -y)
}

static void check_names_the_robot_that_is_off_or_not_a_number(void **state) {
  (void)state;
  vs_error err = {0};
  vs_world w = some_world();
  assert_int_equal(vs_world_check(&w, &err), VS_OK);
  w.robot[VS_YELLOW][2].pose.y_m = NAN;
  assert_int_equal(vs_world_check(&w, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "yellow robot 2"));
  w = some_world();
  w.ball.vx_mps = INFINITY;
  assert_int_equal(vs_world_check(&w, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "ball"));
  w = some_world();
  w.robot[VS_BLUE][0].pose.x_m = 1.8;
  assert_int_equal(vs_world_check(&w, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "not on the field"));
}

static void hash_sees_every_number(void **state) {
  (void)state;
  vs_world w = some_world();
  uint64_t before = vs_world_hash(VS_HASH_START, &w);
  w.robot[VS_YELLOW][2].right_radps = nextafter(w.robot[VS_YELLOW][2].right_radps, 10);
  assert_int_not_equal(vs_world_hash(VS_HASH_START, &w), before);
  w = some_world();
  w.ball.valid = false;
  assert_int_not_equal(vs_world_hash(VS_HASH_START, &w), before);
}

static void robots_that_nobody_saw_stand_in_their_own_corners(void **state) {
  (void)state;
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      vs_pose p = vs_world_parked(VS_3V3, (vs_team)team, i);
      assert_near(p.x_m, team == VS_BLUE ? -0.70 : 0.70, 1e-12);
      assert_true(fabs(p.y_m) > 0.40 && fabs(p.y_m) < 0.62); // beside the goal area (0.35) and inside the wall (0.65)
      for (int k = 0; k < i; k++) assert_true(fabs(p.y_m - vs_world_parked(VS_3V3, (vs_team)team, k).y_m) > 0.11);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(robots_that_nobody_saw_stand_in_their_own_corners),
      cmocka_unit_test(yellow_sees_itself_first_and_the_field_turned_by_pi),
      cmocka_unit_test(seeing_as_yellow_twice_gives_the_world_back),
      cmocka_unit_test(blue_sees_the_absolute_world),
      cmocka_unit_test(a_game_turns_score_team_and_quadrant),
      cmocka_unit_test(check_names_the_robot_that_is_off_or_not_a_number),
      cmocka_unit_test(hash_sees_every_number),
  };
  return cmocka_run_group_tests_name("world/world", tests, NULL, NULL);
}
