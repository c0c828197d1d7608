// src/world/unseen.c, and that the tracker (src/vision/track.c) tells the same by it.
#include "assert_near.h"
#include "vsss/track.h"
#include "vsss/unseen.h"

static void it_goes_on_for_a_tenth_of_a_second_and_then_stays(void **state) {
  (void)state;
  const vs_robot seen = {.pose = {0.1, -0.2, 0.5}, .vx_mps = 1, .vy_mps = -0.5, .omega_radps = 4, .valid = true};
  static const struct {
    int64_t since_us;
    double ahead_s;
    bool valid;
  } row[] = {{0, 0, true}, {40000, 0.04, true}, {100000, 0.1, true}, {100001, 0.1, false}, {INT64_MAX, 0.1, false}};
  for (int i = 0; i < 5; i++) {
    vs_robot r;
    vs_unseen_robot(&seen, 0, row[i].since_us, &r);
    assert_near(r.pose.x_m, 0.1 + row[i].ahead_s, 1e-12);
    assert_near(r.pose.y_m, -0.2 - 0.5 * row[i].ahead_s, 1e-12);
    assert_near(r.pose.theta_rad, 0.5 + 4 * row[i].ahead_s, 1e-12);
    assert_int_equal(r.valid, row[i].valid);
    assert_true((r.vx_mps == 1) == row[i].valid && (r.omega_radps == 4) == row[i].valid);
    const vs_ball ball = {.x_m = 0.3, .vx_mps = -2, .z_m = 0.02};
    vs_ball b;
    vs_unseen_ball(&ball, 0, row[i].since_us, &b);
    assert_near(b.x_m, 0.3 - 2 * row[i].ahead_s, 1e-12);
    assert_int_equal(b.valid, row[i].valid);
  }
  vs_robot r; // an estimate that was moved on already
  vs_unseen_robot(&seen, 60000, 80000, &r);
  assert_near(r.pose.x_m, 0.1 + 0.02, 1e-12);
  vs_unseen_robot(&seen, 100000, 500000, &r);
  assert_near(r.pose.x_m, 0.1, 1e-12);
}

static void the_tracker_tells_the_same(void **state) {
  (void)state;
  vs_track_def def = vs_track_def_default();
  vs_tracker tracker;
  vs_world told;
  vs_track_init(&tracker, &def);
  vs_track_world(&tracker, 1000000, &told);
  vs_pose parked = vs_world_parked(VS_3V3, VS_YELLOW, 1);
  assert_true(told.robot[VS_YELLOW][1].pose.x_m == parked.x_m && !told.robot[VS_YELLOW][1].valid);
  assert_true(told.ball.x_m == 0 && !told.ball.valid);
  vs_object *o = &tracker.robot[VS_OWN][0];
  *o = (vs_object){.seen = true, .ever = true, .seen_us = 1000000, .time_us = 1000000};
  o->x = (vs_kalman){.value = 0.1, .rate = 1};
  o->theta = (vs_kalman){.value = 0.5, .rate = 4};
  const vs_robot seen = {.pose = {0.1, 0, 0.5}, .vx_mps = 1, .omega_radps = 4};
  for (int64_t since_us = 0; since_us <= 300000; since_us += 50000) {
    vs_robot expected;
    vs_unseen_robot(&seen, 0, since_us, &expected);
    vs_track_world(&tracker, 1000000 + since_us, &told);
    const vs_robot *r = &told.robot[VS_BLUE][0];
    assert_near(r->pose.x_m, expected.pose.x_m, 1e-12);
    assert_near(r->pose.theta_rad, expected.pose.theta_rad, 1e-12);
    assert_true(r->vx_mps == expected.vx_mps && r->valid == expected.valid);
  }
  vs_track_restart(&tracker); // a placement: it stays and is not valid
  vs_track_world(&tracker, 1010000, &told);
  assert_true(told.robot[VS_BLUE][0].pose.x_m == 0.1 && !told.robot[VS_BLUE][0].valid);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_goes_on_for_a_tenth_of_a_second_and_then_stays),
      cmocka_unit_test(the_tracker_tells_the_same),
  };
  return cmocka_run_group_tests_name("world/unseen", tests, NULL, NULL);
}
