// Tests src/sim/sensor_model.c: noise, offsets, lost detections, latency and lost radio frames.
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/sensor_model.h"

static vs_world truth_at_rest(void) {
  vs_world world = {0};
  for (int i = 0; i < 6; i++) {
    world.robot[i / 3][i % 3].pose = (vs_pose){-0.3 + 0.1 * i, 0.2, 0.5};
    world.robot[i / 3][i % 3].left_radps = 7;
    world.robot[i / 3][i % 3].valid = true;
  }
  world.ball = (vs_ball){.x_m = 0.1, .y_m = -0.1, .z_m = VS_BALL_RADIUS_M, .valid = true};
  return world;
}

static vs_realism silent(void) {
  vs_realism realism = vs_realism_default();
  realism.noise = false;
  return realism;
}

static void default_noise_has_the_papers_deviations(void **state) {
  (void)state;
  enum { N = 4000 };
  vs_realism realism = vs_realism_default();
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 11);
  vs_world truth = truth_at_rest(), seen;
  double mean = 0, x2 = 0, y2 = 0, t2 = 0, ball2 = 0;
  for (int i = 0; i < N; i++) {
    vs_sensors_measure(&sensors, &truth, &seen);
    vs_pose a = seen.robot[1][2].pose, b = truth.robot[1][2].pose;
    mean += (a.x_m - b.x_m) / N;
    x2 += (a.x_m - b.x_m) * (a.x_m - b.x_m) / N;
    y2 += (a.y_m - b.y_m) * (a.y_m - b.y_m) / N;
    t2 += (a.theta_rad - b.theta_rad) * (a.theta_rad - b.theta_rad) / N;
    ball2 += (seen.ball.x_m - truth.ball.x_m) * (seen.ball.x_m - truth.ball.x_m) / N;
    assert_true(seen.robot[0][0].valid && seen.ball.valid);
    assert_near(seen.robot[0][0].left_radps, 0, 0);
  }
  // The deviation of N samples scatters by 1 / sqrt(2 N) = 1.1 %: 5 % is 4.5 sigma.
  assert_near(mean, 0, 5 * 1.854e-3 / sqrt(N));
  assert_near(sqrt(x2), 1.854e-3, 0.05 * 1.854e-3);
  assert_near(sqrt(y2), 1.679e-3, 0.05 * 1.679e-3);
  assert_near(sqrt(t2), 3.123e-2, 0.05 * 3.123e-2);
  assert_near(sqrt(ball2), 1.854e-3, 0.05 * 1.854e-3);
}

static void without_noise_the_truth_is_seen(void **state) {
  (void)state;
  vs_realism realism = silent();
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 1);
  vs_world truth = truth_at_rest(), seen;
  vs_sensors_measure(&sensors, &truth, &seen);
  assert_true(seen.robot[0][1].pose.x_m == truth.robot[0][1].pose.x_m);
  assert_true(seen.robot[0][1].pose.theta_rad == truth.robot[0][1].pose.theta_rad);
  assert_true(seen.ball.y_m == truth.ball.y_m && seen.time_us == truth.time_us);
}

static void heading_stays_wrapped(void **state) {
  (void)state;
  vs_realism realism = vs_realism_default();
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 4);
  vs_world truth = truth_at_rest(), seen;
  truth.robot[0][0].pose.theta_rad = VS_PI;
  for (int i = 0; i < 100; i++) {
    vs_sensors_measure(&sensors, &truth, &seen);
    assert_true(fabs(seen.robot[0][0].pose.theta_rad) <= VS_PI);
  }
}

static void offset_and_scale_last_the_episode(void **state) {
  (void)state;
  vs_realism realism = silent();
  realism.position_bias_m = (vs_range){0.005, 0.005};
  realism.heading_bias_rad = (vs_range){0.02, 0.02};
  realism.position_scale = (vs_range){1.01, 1.01};
  vs_sensors sensors;
  vs_world truth = truth_at_rest(), seen;
  double first = 0;
  for (int episode = 0; episode < 2; episode++) {
    vs_sensors_reset(&sensors, &realism, (uint64_t)episode);
    for (int f = 0; f < 3; f++) {
      vs_sensors_measure(&sensors, &truth, &seen);
      double dx = seen.ball.x_m - 1.01 * truth.ball.x_m, dy = seen.ball.y_m - 1.01 * truth.ball.y_m;
      assert_near(hypot(dx, dy), 0.005, 1e-12);
      assert_near(fabs(seen.robot[1][0].pose.theta_rad - 0.5), 0.02, 1e-12);
      if (f == 0 && episode == 0) first = dx;
      if (episode == 0) assert_true(dx == first);
      if (episode == 1) assert_true(dx != first); // another direction
    }
  }
}

// A ball at 0.3 m/s goes on so for 100 ms, three frames, then lies where it would be; its first sights are of another loss.
static void what_is_lost_goes_on_for_a_moment_and_then_stays_and_is_not_valid(void **state) {
  (void)state;
  enum { BALL = VS_SENSOR_OBJECTS - 1 };
  vs_realism realism = silent();
  realism.detection_loss = (vs_range){0.1, 0.1};
  realism.detection_burst_frames = (vs_range){9, 9};
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 2);
  vs_world truth = truth_at_rest(), seen, last = {0};
  int in_sight = 0, checked = 0;
  for (int f = 0; f < 400; f++) {
    truth.ball.x_m = 0.01 * (f % 60) - 0.3;
    if (f % 60 == 0) { // put back by a referee
      vs_sensors_restart(&sensors);
      in_sight = 0;
    }
    vs_sensors_measure(&sensors, &truth, &seen);
    int held = sensors.held_frames[BALL];
    if (held == 0) {
      assert_true(seen.ball.valid && seen.ball.x_m == truth.ball.x_m);
      last = seen;
      in_sight++;
    } else if (in_sight > 10) {
      assert_near(seen.ball.x_m, last.ball.x_m + last.ball.vx_mps * (held < 3 ? held : 3) / 30.0, 1e-6);
      assert_near(seen.ball.x_m, last.ball.x_m + 0.01 * (held < 3 ? held : 3), 2e-3);
      assert_int_equal(seen.ball.valid, held <= 3);
      assert_true(held <= 3 || seen.ball.vx_mps == 0.0);
      checked++;
      if (held > 3) in_sight = 0; // it will begin anew
    }
  }
  assert_true(checked > 20);
}

static void what_was_never_seen_is_parked_and_such_robots_stand(void **state) {
  (void)state;
  vs_realism realism = silent();
  realism.detection_loss = (vs_range){0.9, 0.9};
  realism.detection_burst_frames = (vs_range){30, 30};
  vs_world truth = truth_at_rest(), seen;
  int unseen = 0;
  for (uint64_t seed = 0; seed < 10; seed++) {
    vs_sensors sensors;
    vs_sensors_reset(&sensors, &realism, seed);
    vs_sensors_measure(&sensors, &truth, &seen);
    vs_wheels in[VS_TEAMS][VS_TEAM_MOST], out[VS_TEAMS][VS_TEAM_MOST];
    for (int i = 0; i < 6; i++) in[i / 3][i % 3] = (vs_wheels){5, 6};
    vs_sensors_command(&sensors, (const vs_wheels(*)[VS_TEAM_MOST])in, out);
    for (int i = 0; i < 6; i++) {
      const vs_robot *r = &seen.robot[i / 3][i % 3];
      vs_pose parked = vs_world_parked(VS_3V3, (vs_team)(i / 3), i % 3);
      bool told = sensors.held_frames[i / 3 * VS_TEAM_MOST + i % 3] == 0;
      assert_int_equal(r->valid, told);
      assert_near(r->pose.x_m, told ? truth.robot[i / 3][i % 3].pose.x_m : parked.x_m, 1e-12);
      assert_near(r->pose.y_m, told ? truth.robot[i / 3][i % 3].pose.y_m : parked.y_m, 1e-12);
      assert_true(out[i / 3][i % 3].left_radps == (told ? 5 : 0));
      assert_true(r->left_radps == 0 && r->vx_mps == 0);
      unseen += !told;
    }
    if (seen.ball.valid) continue;
    assert_true(seen.ball.x_m == 0 && seen.ball.y_m == 0);
  }
  assert_true(unseen > 30);
}

static void losses_come_as_often_as_asked_and_twice_near_walls(void **state) {
  (void)state;
  enum { N = 20000 };
  vs_realism realism = silent();
  realism.detection_loss = (vs_range){0.04, 0.04};
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 3);
  vs_world truth = truth_at_rest(), seen;
  truth.robot[0][0].pose.y_m = 0.6; // within 10 cm of the wall
  int middle = 0, wall = 0;
  for (int f = 0; f < N; f++) {
    vs_sensors_measure(&sensors, &truth, &seen);
    wall += sensors.held_frames[0] > 0;
    middle += sensors.held_frames[1] > 0;
  }
  // sqrt(0.04 x 0.96 / N) = 0.0014.
  assert_near((double)middle / N, 0.04, 0.007);
  assert_near((double)wall / N, 0.08, 0.01);
}

// A step command in frame 0; the commands that arrive in frames 0, 1, 2, ...
static void arrivals(const vs_realism *realism, uint64_t seed, double *left, int frames) {
  vs_sensors sensors;
  vs_sensors_reset(&sensors, realism, seed);
  vs_wheels in[VS_TEAMS][VS_TEAM_MOST], out[VS_TEAMS][VS_TEAM_MOST];
  for (int i = 0; i < 6; i++) in[i / 3][i % 3] = (vs_wheels){10, -10};
  for (int f = 0; f < frames; f++) {
    vs_sensors_command(&sensors, (const vs_wheels(*)[VS_TEAM_MOST])in, out);
    assert_near(out[0][2].right_radps, -out[0][2].left_radps, 1e-12);
    left[f] = out[0][2].left_radps;
  }
}

static void commands_arrive_at_once_by_default(void **state) {
  (void)state;
  double left[2];
  vs_realism realism = vs_realism_default();
  arrivals(&realism, 1, left, 2);
  assert_true(left[0] == 10 && left[1] == 10);
}

// 60 ms are 1.8 frames: nothing in frame 0, a fifth of frame 1 (the mean over the frame), all from frame 2.
static void latency_is_kept_to_a_fraction_of_a_frame(void **state) {
  (void)state;
  double left[4];
  vs_realism realism = silent();
  realism.latency_s = (vs_range){0.06, 0.06};
  arrivals(&realism, 1, left, 4);
  assert_near(left[0], 0, 1e-12);
  assert_near(left[1], 2, 1e-9);
  assert_near(left[2], 10, 1e-9);
  assert_near(left[3], 10, 1e-9);
}

static void longest_latency_still_arrives(void **state) {
  (void)state;
  double left[10];
  vs_realism realism = silent();
  realism.latency_s = (vs_range){0.2, 0.2};
  realism.latency_jitter_s = (vs_range){0.03, 0.03};
  arrivals(&realism, 1, left, 10);
  assert_near(left[4], 0, 1e-12); // 0.17 s are 5.1 frames
  assert_near(left[8], 10, 1e-9); // 0.23 s are 6.9 frames
}

static void lost_radio_frames_keep_the_last_command(void **state) {
  (void)state;
  enum { N = 20000 };
  vs_realism realism = silent();
  realism.radio_loss = (vs_range){0.05, 0.05};
  realism.radio_burst_frames = (vs_range){3, 3};
  vs_sensors sensors;
  vs_sensors_reset(&sensors, &realism, 6);
  vs_wheels in[VS_TEAMS][VS_TEAM_MOST], out[VS_TEAMS][VS_TEAM_MOST];
  int lost = 0, run = 0;
  double last = 0;
  for (int f = 0; f < N; f++) {
    for (int i = 0; i < 6; i++) in[i / 3][i % 3] = (vs_wheels){f + 1, 0};
    vs_sensors_command(&sensors, (const vs_wheels(*)[VS_TEAM_MOST])in, out);
    bool arrived = out[1][0].left_radps == f + 1;
    if (arrived) {
      assert_int_equal(run % 3, 0);
      run = 0;
      last = f + 1;
    } else {
      assert_true(out[1][0].left_radps == last);
      run++;
      lost++;
    }
    assert_true(out[1][0].left_radps == out[1][2].left_radps); // one radio per team
  }
  // A burst of 3 begins with 5 % where none runs: 0.15 / 1.10 of the frames; sigma of the estimate about 0.004.
  assert_near((double)lost / N, 0.15 / 1.10, 0.02);
}

static void same_seed_same_measurements_and_copy_continues(void **state) {
  (void)state;
  vs_realism realism = vs_realism_default();
  realism.detection_loss = (vs_range){0, 0.1};
  realism.latency_jitter_s = (vs_range){0, 0.02};
  vs_sensors a, b;
  vs_sensors_reset(&a, &realism, 42);
  vs_sensors_reset(&b, &realism, 42);
  vs_world truth = truth_at_rest(), seen_a, seen_b;
  for (int f = 0; f < 50; f++) {
    vs_sensors_measure(&a, &truth, &seen_a);
    vs_sensors_measure(&b, &truth, &seen_b);
    assert_true(vs_world_hash(VS_HASH_START, &seen_a) == vs_world_hash(VS_HASH_START, &seen_b));
    if (f == 25) b = a;
  }
  vs_sensors_reset(&b, &realism, 43);
  vs_sensors_measure(&a, &truth, &seen_a);
  vs_sensors_measure(&b, &truth, &seen_b);
  assert_true(vs_world_hash(VS_HASH_START, &seen_a) != vs_world_hash(VS_HASH_START, &seen_b));
}

// The truth claims to stand still while its places move: velocities come from the places that were seen, as on a field,
// and begin anew after a placement.
static void velocities_are_estimated_from_what_was_measured(void **state) {
  (void)state;
  vs_realism realism = silent();
  vs_sensors sensors;
  vs_world seen;
  vs_sensors_reset(&sensors, &realism, 3);
  for (int k = 0; k < 60; k++) {
    vs_world truth = truth_at_rest();
    truth.robot[1][0].pose.x_m += 0.01 * k;                                                     // 0.3 m/s
    truth.robot[1][0].pose.theta_rad = vs_wrap_rad(truth.robot[1][0].pose.theta_rad + 0.1 * k); // 3 rad/s
    truth.ball.y_m += 0.02 * k;                                                                 // 0.6 m/s
    vs_sensors_measure(&sensors, &truth, &seen);
  }
  assert_near(seen.robot[1][0].vx_mps, 0.3, 1e-6);
  assert_near(seen.robot[1][0].omega_radps, 3, 1e-3);
  assert_near(seen.ball.vy_mps, 0.6, 1e-6);
  assert_near(seen.robot[1][1].vx_mps, 0, 1e-6);
  vs_sensors_restart(&sensors);
  vs_world placed = truth_at_rest();
  vs_sensors_measure(&sensors, &placed, &seen);
  assert_near(seen.ball.vy_mps, 0, 0);
  assert_near(seen.robot[1][0].vx_mps, 0, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(default_noise_has_the_papers_deviations),
      cmocka_unit_test(without_noise_the_truth_is_seen),
      cmocka_unit_test(heading_stays_wrapped),
      cmocka_unit_test(offset_and_scale_last_the_episode),
      cmocka_unit_test(what_is_lost_goes_on_for_a_moment_and_then_stays_and_is_not_valid),
      cmocka_unit_test(what_was_never_seen_is_parked_and_such_robots_stand),
      cmocka_unit_test(losses_come_as_often_as_asked_and_twice_near_walls),
      cmocka_unit_test(commands_arrive_at_once_by_default),
      cmocka_unit_test(latency_is_kept_to_a_fraction_of_a_frame),
      cmocka_unit_test(longest_latency_still_arrives),
      cmocka_unit_test(velocities_are_estimated_from_what_was_measured),
      cmocka_unit_test(lost_radio_frames_keep_the_last_command),
      cmocka_unit_test(same_seed_same_measurements_and_copy_continues),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
