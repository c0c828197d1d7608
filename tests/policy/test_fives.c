// src/policy/fives.c: strategies of three robots in 5 against 5 (through src/policy/policy.c)
#include <string.h>

#include "../../src/policy/policy_internal.h"
#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"

static vs_world scene(double ball_x_m, double ball_y_m) {
  vs_world w = {.division = VS_5V5, .ball = {.x_m = ball_x_m, .y_m = ball_y_m, .valid = true}};
  const vs_pose own[5] = {{-1.0, 0, 0}, {0.2, 0.1, 0}, {-0.2, -0.1, 0}, {-0.6, 0.1, 0}, {-0.1, -0.5, 0}};
  for (int i = 0; i < 5; i++) {
    w.robot[VS_OWN][i] = (vs_robot){.pose = own[i], .valid = true};
    w.robot[VS_ADVERSARY][i] = (vs_robot){.pose = {0.8, 0.3 * (i - 2), VS_PI}, .valid = true};
  }
  return w;
}

// Walls: 10 cm from the end wall stays 10 cm, 5 cm from the side wall 5 cm, the goal's line is its line.
static void distances_to_walls_are_shown_as_they_are(void **state) {
  (void)state;
  vs_world w = scene(0, 0), three;
  w.robot[VS_OWN][0].pose = (vs_pose){-1.0, 0.85, 1};
  vs_fives_show(&w, &three);
  assert_int_equal(three.division, VS_3V3);
  assert_near(three.robot[VS_OWN][0].pose.x_m, -0.65, 1e-12);
  assert_near(three.robot[VS_OWN][0].pose.y_m, 0.60, 1e-12);
  assert_near(three.robot[VS_OWN][0].pose.theta_rad, 1, 0);
  w = scene(1.1, 0);
  vs_fives_show(&w, &three);
  assert_near(three.ball.x_m, VS_FIELD_HALF_LENGTH_M, 1e-12);
}

// A robot 7 cm behind the ball is shown 7 cm behind it wherever that is, so that "has the ball" means what it meant.
static void distances_around_the_ball_are_shown_as_they_are(void **state) {
  (void)state;
  for (double x_m = -0.9; x_m < 1.0; x_m += 0.1)
    for (double y_m = -0.8; y_m < 0.81; y_m += 0.2) {
      vs_world w = scene(x_m, y_m), three;
      w.robot[VS_OWN][1].pose = (vs_pose){x_m - 0.07, y_m + 0.03, 0};
      vs_fives_show(&w, &three);
      assert_near(three.ball.x_m - three.robot[VS_OWN][1].pose.x_m, 0.07, 1e-12);
      assert_near(three.robot[VS_OWN][1].pose.y_m - three.ball.y_m, 0.03, 1e-12);
    }
}

// Who is farther from the ball is shown farther, and everybody on the field.
static void what_is_shown_keeps_the_order_and_the_field(void **state) {
  (void)state;
  double before_m = -1;
  for (double x_m = -0.5; x_m < 1.06; x_m += 0.01) {
    vs_world w = scene(-0.5, 0), three;
    w.robot[VS_OWN][1].pose = (vs_pose){x_m, 0, 0};
    vs_fives_show(&w, &three);
    double shown_m = three.robot[VS_OWN][1].pose.x_m - three.ball.x_m;
    assert_true(shown_m > before_m);
    assert_true(fabs(three.robot[VS_OWN][1].pose.x_m) < VS_FIELD_HALF_LENGTH_M);
    before_m = shown_m;
  }
}

// Wheels of robot i a while after: where they lead, in metres along its heading, and turned left.
static void step_of(const char *uri, const vs_world *w, vs_wheels out[VS_TEAM_MOST]) {
  vs_player *player;
  vs_game game = {.duration_s = 600};
  assert_ok(vs_player_open(uri, &player, err));
  assert_ok(vs_player_plays(player, VS_5V5, err));
  assert_ok(vs_player_step(player, w, &game, 1.0 / 30, out, err));
  vs_player_close(player);
}

// The sweeper is kept between ball and goal, a third of the way out: (-0.47, 0) with the ball at (0.8, 0); it stands at
// (-0.6, 0.1), heading +x.
static void the_sweeper_comes_between_ball_and_goal(void **state) {
  (void)state;
  vs_world w = scene(0.8, 0);
  vs_wheels out[VS_TEAM_MOST];
  const char *const uri[] = {"emc:", "inf:", "emc22:"};
  for (int k = 0; k < 3; k++) {
    step_of(uri[k], &w, out);
    assert_true(out[3].left_radps + out[3].right_radps > 0); // ahead
    assert_true(out[3].right_radps < out[3].left_radps);     // and to its right
  }
}

// The ball in the own area: the sweeper stays out of it, 25 cm and more before the goal line.
static void the_sweeper_never_enters_the_own_area(void **state) {
  (void)state;
  vs_world w = scene(-1.05, 0.05);
  w.robot[VS_OWN][3].pose = (vs_pose){-0.85, 0.05, VS_PI}; // its place, in the direction of the area
  vs_wheels out[VS_TEAM_MOST];
  step_of("emc:", &w, out);
  assert_true(fabs(out[3].left_radps) < 1 && fabs(out[3].right_radps) < 1);
}

// The ball at (0.3, 0.4): the wing goes to the other side, (0, -0.4).
static void the_wing_takes_the_other_side_of_the_field(void **state) {
  (void)state;
  vs_world w = scene(0.3, 0.4);
  w.robot[VS_OWN][4].pose = (vs_pose){0.0, 0.2, -VS_PI / 2};
  w.robot[VS_OWN][1].pose = (vs_pose){0.25, 0.38, 0}; // nearer to the ball than the wing
  vs_wheels out[VS_TEAM_MOST];
  step_of("inf:", &w, out);
  assert_true(out[4].left_radps > 10 && out[4].right_radps > 10);
}

// Nobody else is near: the wing, behind the ball and pointed at their goal, goes through it.
static void the_nearest_of_the_two_plays_the_ball(void **state) {
  (void)state;
  vs_world w = scene(0.2, -0.5);
  w.robot[VS_OWN][1].pose = (vs_pose){-0.5, 0.6, 0};
  w.robot[VS_OWN][2].pose = (vs_pose){-0.5, 0.4, 0};
  w.robot[VS_OWN][4].pose = (vs_pose){0.0, -0.61, atan2(0.5, 0.9)};
  vs_wheels out[VS_TEAM_MOST];
  step_of("emc:", &w, out);
  assert_true(out[4].left_radps > 20 && out[4].right_radps > 20);
}

static void random_and_zero_command_all_five(void **state) {
  (void)state;
  vs_world w = scene(0, 0);
  vs_wheels out[VS_TEAM_MOST];
  step_of("random:", &w, out);
  for (int i = 0; i < 5; i++) assert_true(out[i].left_radps != 0 && out[i].right_radps != 0);
  step_of("zero:", &w, out);
  for (int i = 0; i < 5; i++) assert_true(out[i].left_radps == 0 && out[i].right_radps == 0);
}

static void who_plays_three_alone_is_refused_with_the_reason(void **state) {
  (void)state;
  vs_world w = scene(0, 0);
  vs_game game = {0};
  vs_wheels out[VS_TEAM_MOST];
  vs_player *player;
  vs_error why = {0};
  assert_ok(vs_player_open("shake:", &player, err));
  assert_int_equal(vs_player_plays(player, VS_5V5, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "shake: does not play 5v5"));
  assert_int_equal(vs_player_step(player, &w, &game, 0.1, out, NULL), VS_USAGE);
  vs_player_close(player);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distances_to_walls_are_shown_as_they_are),
      cmocka_unit_test(distances_around_the_ball_are_shown_as_they_are),
      cmocka_unit_test(what_is_shown_keeps_the_order_and_the_field),
      cmocka_unit_test(the_sweeper_comes_between_ball_and_goal),
      cmocka_unit_test(the_sweeper_never_enters_the_own_area),
      cmocka_unit_test(the_wing_takes_the_other_side_of_the_field),
      cmocka_unit_test(the_nearest_of_the_two_plays_the_ball),
      cmocka_unit_test(random_and_zero_command_all_five),
      cmocka_unit_test(who_plays_three_alone_is_refused_with_the_reason),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
