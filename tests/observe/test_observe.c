// Tests src/observe/observe.c: every value of a frame against numbers worked out by hand.
#include "vsss/observe.h"

#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"

// Robot 1 stands at the centre of 3-4-5 triangles: every pair it takes part in is 0.5 m apart.
static vs_world scene(void) {
  vs_world w = {0};
  w.robot[VS_OWN][0].pose = (vs_pose){-0.2, 0.3, VS_PI / 2};
  w.robot[VS_OWN][1].pose = (vs_pose){0.1, -0.1, VS_PI / 6};
  w.robot[VS_OWN][2].pose = (vs_pose){0.1, 0.4, -VS_PI / 4};
  w.robot[VS_ADVERSARY][0].pose = (vs_pose){0.6, -0.1, 1};
  w.robot[VS_ADVERSARY][1].pose = (vs_pose){-0.4, -0.1, 2};
  w.robot[VS_ADVERSARY][2].pose = (vs_pose){0.1, -0.6, 3};
  w.ball.x_m = 0.4;
  w.ball.y_m = -0.5;
  return w;
}

static const vs_game game_quarter = {.time_s = 30, .duration_s = 120};
static const float actions[6] = {0.1f, 0.2f, 0.3f, -0.4f, 0.5f, 0.6f};

static void every_value_of_a_frame_is_the_one_worked_out_by_hand(void **state) {
  (void)state;
  static const double expected[VS_OBS_FRAME] = {
      0.1 / 0.85,
      -0.1 / 0.65, // itself
      -0.2 / 0.85,
      0.3 / 0.65,
      0.1 / 0.85,
      0.4 / 0.65, // allies 0 and 2
      0.6 / 0.85,
      -0.1 / 0.65,
      -0.4 / 0.85,
      -0.1 / 0.65, // adversaries 0, 1
      0.1 / 0.85,
      -0.6 / 0.65, // adversary 2
      0.4 / 0.85,
      -0.5 / 0.65, // ball
      0.5,
      0.866025404,
      1.0 / 6, // heading 30 degrees
      -0.8,
      0.6,
      -0.295167235, // to the ball (0.3, -0.4): -53.130102 degrees / 180
      -5.0 / 13,
      12.0 / 13,
      -0.125665916, // own goal (-0.8, 0) to the ball (1.2, -0.5): -22.619865 degrees
      -0.780868809,
      -0.624695048,
      -0.714776712, // their goal to the ball (-0.4, -0.5)/0.640312: -128.659808 degrees
      0.8,
      -0.6,
      0.704832765, // to ally 0 (-0.3, 0.4): 126.869898 degrees
      1,
      0,
      0.5, // to ally 2 (0, 0.5)
      0,
      1,
      0, // to adversary 0 (0.5, 0)
      0,
      -1,
      1, // to adversary 1 (-0.5, 0)
      -1,
      0,
      -0.5,               // to adversary 2 (0, -0.5)
      1.0 / 2.14,         // ally 0 to the ball: (0.6, -0.8)
      0.948683298 / 2.14, // ally 2 to the ball: (0.3, -0.9), root of 0.9
      0.5 / 2.14,         // its own distance to the ball
      1.3 / 1.82,
      0.640312424 / 1.82, // ball to own goal, to their goal
      0.5 / 2.14,
      0.5 / 2.14, // to the allies
      0.5 / 2.14,
      0.5 / 2.14,
      0.5 / 2.14, // to the adversaries
      0.3,
      -0.4, // its own last action
      0.1,
      0.2,
      0.5,
      0.6,  // the allies'
      0.75, // 90 s of 120 s are left
  };
  vs_world view = scene();
  float frame[VS_TEAM_SIZE][VS_OBS_FRAME];
  vs_observe_frame(&view, &game_quarter, actions, NULL, &frame[0][0]);
  for (int i = 0; i < VS_OBS_FRAME; i++) {
    if (fabs(frame[1][i] - expected[i]) > 2e-7)
      fail_msg("%d %s: %.9g, expected %.9g", i, vs_obs_name(i), (double)frame[1][i], expected[i]);
  }
}

static void allies_come_in_index_order_for_every_robot(void **state) {
  (void)state;
  vs_world view = scene();
  float frame[VS_TEAM_SIZE][VS_OBS_FRAME];
  vs_observe_frame(&view, &game_quarter, actions, NULL, &frame[0][0]);
  // Robot 0's allies are 1 and 2, robot 2's are 0 and 1.
  assert_near(frame[0][VS_OBS_ALLIES_XY], 0.1 / 0.85, 1e-7);
  assert_near(frame[0][VS_OBS_ALLIES_XY + 1], -0.1 / 0.65, 1e-7);
  assert_near(frame[0][VS_OBS_ALLIES_XY + 3], 0.4 / 0.65, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_XY], -0.2 / 0.85, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_XY + 2], 0.1 / 0.85, 1e-7);
  assert_near(frame[0][VS_OBS_ALLIES_ACTION], 0.3, 1e-7);
  assert_near(frame[0][VS_OBS_ALLIES_ACTION + 2], 0.5, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_ACTION + 1], 0.2, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_ACTION + 3], -0.4, 1e-7);
  // Robot 0 sees robot 1 at (0.3, -0.4), the reverse of what robot 1 sees: 126.869898 - 180 degrees.
  assert_near(frame[0][VS_OBS_ANGLES + 9], -0.8, 1e-7);
  assert_near(frame[0][VS_OBS_ANGLES + 10], 0.6, 1e-7);
  assert_near(frame[0][VS_OBS_ANGLES + 11], -0.295167235, 1e-7);
  // Robot 2 sees robot 1 straight below, robot 0 at (-0.3, -0.1): 180 - 18.434949 degrees, downwards.
  assert_near(frame[2][VS_OBS_ANGLES + 14], -0.5, 1e-7);
  assert_near(frame[2][VS_OBS_ANGLES + 11], -(180 - 18.434949) / 180, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_DISTANCE], 0.316227766 / 2.14, 1e-7);
  assert_near(frame[2][VS_OBS_ALLIES_BALL_DISTANCE + 1], 0.5 / 2.14, 1e-7);
}

static void adversary_order_moves_positions_angles_and_distances_together(void **state) {
  (void)state;
  vs_world view = scene();
  float plain[VS_TEAM_SIZE][VS_OBS_FRAME], shuffled[VS_TEAM_SIZE][VS_OBS_FRAME];
  const int order[] = {2, 0, 1};
  vs_observe_frame(&view, &game_quarter, actions, NULL, &plain[0][0]);
  vs_observe_frame(&view, &game_quarter, actions, order, &shuffled[0][0]);
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    for (int k = 0; k < VS_TEAM_SIZE; k++) {
      const float *a = plain[i], *b = shuffled[i];
      assert_memory_equal(b + VS_OBS_ADVERSARIES_XY + 2 * k, a + VS_OBS_ADVERSARIES_XY + 2 * order[k], 8);
      assert_memory_equal(b + VS_OBS_ANGLES + 15 + 3 * k, a + VS_OBS_ANGLES + 15 + 3 * order[k], 12);
      assert_memory_equal(b + VS_OBS_ADVERSARIES_DISTANCE + k, a + VS_OBS_ADVERSARIES_DISTANCE + order[k], 4);
    }
    // Nothing else moves.
    assert_memory_equal(shuffled[i], plain[i], VS_OBS_ADVERSARIES_XY * 4);
    assert_memory_equal(shuffled[i] + VS_OBS_BALL_XY, plain[i] + VS_OBS_BALL_XY, (VS_OBS_ANGLES + 15 - 12) * 4);
  }
}

static void yellow_in_a_turned_world_sees_the_same_floats_as_blue(void **state) {
  (void)state;
  vs_world blue = scene(), turned, yellow_view;
  // The same situation with the sides swapped, then seen by yellow.
  vs_world_for_team(&blue, VS_YELLOW, &turned);
  vs_world_for_team(&turned, VS_YELLOW, &yellow_view);
  vs_game absolute = game_quarter, seen;
  vs_game_for_team(&absolute, VS_YELLOW, &seen);
  float a[VS_TEAM_SIZE * VS_OBS_FRAME], b[VS_TEAM_SIZE * VS_OBS_FRAME];
  vs_observe_frame(&blue, &game_quarter, actions, NULL, a);
  vs_observe_frame(&yellow_view, &seen, actions, NULL, b);
  assert_memory_equal(a, b, sizeof a);
}

static void kick_off_looks_the_same_to_both_teams(void **state) {
  (void)state;
  vs_world absolute = {0};
  const vs_pose blue[] = {{-0.675, 0, 0}, {-0.2, 0, 0}, {-0.4, 0, 0}};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    absolute.robot[VS_BLUE][i].pose = blue[i];
    absolute.robot[VS_YELLOW][i].pose = vs_pose_rotate_pi(blue[i]);
  }
  vs_world view;
  vs_world_for_team(&absolute, VS_YELLOW, &view); // here the ball lies at (-0, -0)
  float a[VS_TEAM_SIZE * VS_OBS_FRAME], b[VS_TEAM_SIZE * VS_OBS_FRAME];
  vs_observe_frame(&absolute, &game_quarter, actions, NULL, a);
  vs_observe_frame(&view, &game_quarter, actions, NULL, b);
  for (int i = 0; i < VS_TEAM_SIZE * VS_OBS_FRAME; i++) assert_near(b[i], a[i], 0);
  // Their goal to the ball points along -x: angle pi, not -pi, for either.
  assert_near(b[VS_OBS_ANGLES + 8], 1, 0);
}

static void everything_stays_within_one_even_outside_the_field(void **state) {
  (void)state;
  vs_world view = scene();
  view.robot[VS_OWN][0].pose = (vs_pose){-1.7, 1.6, 9.0};
  view.robot[VS_ADVERSARY][0].pose = (vs_pose){1.7, -1.6, -9.0};
  view.ball.x_m = 1.7;
  view.ball.y_m = -1.6;
  const vs_game late = {.time_s = 130, .duration_s = 120};
  const float wild[6] = {3, -3, 1, -1, 0, 2};
  float frame[VS_TEAM_SIZE][VS_OBS_FRAME];
  vs_observe_frame(&view, &late, wild, NULL, &frame[0][0]);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_OBS_FRAME; k++) assert_true(frame[i][k] >= -1 && frame[i][k] <= 1);
  assert_near(frame[0][VS_OBS_OWN_XY], -1, 0);
  assert_near(frame[0][VS_OBS_OWN_ACTION + 1], -1, 0);
  assert_near(frame[0][VS_OBS_OWN_BALL_DISTANCE], 1, 0);
  assert_near(frame[0][VS_OBS_OWN_HEADING + 2], (9.0 - 2 * VS_PI) / VS_PI, 1e-6); // wrapped
  assert_near(frame[0][VS_OBS_TIME_LEFT], 0, 0);                                  // never negative
}

static void two_things_at_one_point_point_along_x(void **state) {
  (void)state;
  vs_world view = scene();
  view.ball.x_m = view.robot[VS_OWN][1].pose.x_m;
  view.ball.y_m = view.robot[VS_OWN][1].pose.y_m;
  float frame[VS_TEAM_SIZE][VS_OBS_FRAME];
  vs_observe_frame(&view, &game_quarter, actions, NULL, &frame[0][0]);
  assert_near(frame[1][VS_OBS_ANGLES], 0, 0);
  assert_near(frame[1][VS_OBS_ANGLES + 1], 1, 0);
  assert_near(frame[1][VS_OBS_ANGLES + 2], 0, 0);
  assert_near(frame[1][VS_OBS_OWN_BALL_DISTANCE], 0, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_value_of_a_frame_is_the_one_worked_out_by_hand),
      cmocka_unit_test(allies_come_in_index_order_for_every_robot),
      cmocka_unit_test(adversary_order_moves_positions_angles_and_distances_together),
      cmocka_unit_test(yellow_in_a_turned_world_sees_the_same_floats_as_blue),
      cmocka_unit_test(kick_off_looks_the_same_to_both_teams),
      cmocka_unit_test(everything_stays_within_one_even_outside_the_field),
      cmocka_unit_test(two_things_at_one_point_point_along_x),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
