// Tests src/observe/observer.c: order of the stack, its filling, and what a restart keeps.
#include <string.h>

#include "assert_near.h"
#include "vsss/observe.h"

static const float no_action[6];

// A world that differs from frame to frame in the ball's x only: frame n has 0.01 n.
static vs_world numbered(int n) {
  vs_world w = {0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    w.robot[VS_OWN][i].pose.x_m = -0.1 * (i + 1);
    w.robot[VS_ADVERSARY][i].pose.x_m = 0.1 * (i + 1);
  }
  w.ball.x_m = 0.01 * n;
  w.ball.y_m = 0.3;
  return w;
}

static void push(vs_observer *observer, int n) {
  vs_world view = numbered(n);
  const vs_game game = {.duration_s = 40};
  vs_observer_push(observer, &view, &game, no_action);
}

static double ball_x_m(const float *stack, int robot, int k) {
  return stack[robot * VS_OBS_SIZE + k * VS_OBS_FRAME + VS_OBS_BALL_XY] * VS_OBS_SCALE_X_M;
}

static void first_frame_fills_all_eight(void **state) {
  (void)state;
  vs_observer observer;
  vs_observer_init(&observer, NULL);
  push(&observer, 5);
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  vs_observer_write(&observer, stack);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_OBS_STACK; k++) {
      assert_near(ball_x_m(stack, i, k), 0.05, 1e-7);
      assert_memory_equal(stack + i * VS_OBS_SIZE + k * VS_OBS_FRAME, stack + i * VS_OBS_SIZE, VS_OBS_FRAME * 4);
    }
}

static void frames_stand_oldest_first_and_the_ninth_pushes_the_first_out(void **state) {
  (void)state;
  vs_observer observer;
  vs_observer_init(&observer, NULL);
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  for (int n = 0; n < 30; n++) {
    push(&observer, n);
    vs_observer_write(&observer, stack);
    for (int i = 0; i < VS_TEAM_SIZE; i++)
      for (int k = 0; k < VS_OBS_STACK; k++) {
        int shown = n - (VS_OBS_STACK - 1) + k; // the newest, n, is last; before the start stands frame 0
        assert_near(ball_x_m(stack, i, k), 0.01 * (shown < 0 ? 0 : shown), 1e-7);
      }
  }
}

static void each_robot_gets_its_own_rows(void **state) {
  (void)state;
  vs_observer observer;
  vs_observer_init(&observer, NULL);
  push(&observer, 1);
  push(&observer, 2);
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  vs_observer_write(&observer, stack);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_OBS_STACK; k++)
      assert_near(stack[i * VS_OBS_SIZE + k * VS_OBS_FRAME] * VS_OBS_SCALE_X_M, -0.1 * (i + 1), 1e-7);
}

static void restart_forgets_the_frames_and_keeps_the_order(void **state) {
  (void)state;
  const int order[] = {1, 2, 0};
  vs_observer observer;
  vs_observer_init(&observer, order);
  for (int n = 0; n < 11; n++) push(&observer, n);
  vs_observer_restart(&observer);
  push(&observer, 20);
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  vs_observer_write(&observer, stack);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    for (int k = 0; k < VS_OBS_STACK; k++) {
      assert_near(ball_x_m(stack, i, k), 0.2, 1e-7);
      // Slot 0 still shows adversary 1, which stands at x = 0.2.
      assert_near(stack[i * VS_OBS_SIZE + k * VS_OBS_FRAME + VS_OBS_ADVERSARIES_XY], 0.2 / 0.85, 1e-7);
    }
}

static void a_copy_continues_like_the_original(void **state) {
  (void)state;
  vs_observer observer;
  vs_observer_init(&observer, NULL);
  for (int n = 0; n < 5; n++) push(&observer, n);
  vs_observer copy = observer;
  push(&observer, 7);
  push(&copy, 7);
  float a[VS_TEAM_SIZE * VS_OBS_SIZE], b[VS_TEAM_SIZE * VS_OBS_SIZE];
  vs_observer_write(&observer, a);
  vs_observer_write(&copy, b);
  assert_memory_equal(a, b, sizeof a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_frame_fills_all_eight),
      cmocka_unit_test(frames_stand_oldest_first_and_the_ninth_pushes_the_first_out),
      cmocka_unit_test(each_robot_gets_its_own_rows),
      cmocka_unit_test(restart_forgets_the_frames_and_keeps_the_order),
      cmocka_unit_test(a_copy_continues_like_the_original),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
