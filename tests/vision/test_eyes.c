// src/vision/detect.c, src/vision/calib.c and src/vision/track.c together: drawn frames in, the world out, against truth
#include "assert_near.h"
#include "vision/scene.h"
#include "vsss/calib.h"
#include "vsss/geom.h"
#include "vsss/track.h"

enum { FRAMES = 24, SETTLE = 4 };

// Robots on arcs at up to 0.8 m/s and 4 rad/s, the ball straight at 1 m/s.
static void move(scene *s, double t_s) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    double radius = 0.1 + 0.03 * (i % 3), rate = i % 2 ? 4.0 : -3.0, phase = i + rate * t_s;
    double x = -0.5 + 0.5 * (i % 3), y = i < 3 ? 0.38 : -0.38;
    s->world.robot[i / 3][i % 3] = (vs_robot){.pose = {x + radius * cos(phase), y + radius * sin(phase),
                                                       vs_wrap_rad(phase + (rate > 0 ? 1 : -1) * VS_PI / 2)},
                                              .valid = true};
  }
  s->world.ball = (vs_ball){.x_m = -0.6 + 1.0 * t_s, .y_m = 0.05, .valid = true};
}

typedef struct rms {
  double own_mm, own_deg, ball_mm, adversary_mm;
} rms;

static rms run(scene *s, vs_detector *detector, const vs_calib *calib, vs_tracker *tracker) {
  double own = 0, turn = 0, ball = 0, adversary = 0;
  int n = 0;
  for (int k = 0; k < FRAMES; k++) {
    int64_t us = 1000000 + 33333 * (int64_t)k;
    move(s, 1e-6 * (double)(us - 1000000));
    vs_frame frame = scene_draw(s, us, (uint32_t)k);
    vs_detections seen;
    assert_ok(vs_detect(detector, &frame, &seen, err));
    vs_track_update(tracker, calib, &seen);
    vs_world w;
    vs_track_world(tracker, 0, &w);
    if (k < SETTLE) continue;
    n++;
    assert_true(w.ball.valid);
    ball += pow(hypot(w.ball.x_m - s->world.ball.x_m, w.ball.y_m - s->world.ball.y_m), 2);
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      const vs_pose *p = &w.robot[VS_BLUE][i].pose, *q = &s->world.robot[VS_BLUE][i].pose;
      assert_true(w.robot[VS_BLUE][i].valid && w.robot[VS_YELLOW][i].valid);
      own += pow(hypot(p->x_m - q->x_m, p->y_m - q->y_m), 2) / VS_TEAM_SIZE;
      turn += pow(vs_wrap_rad(p->theta_rad - q->theta_rad), 2) / VS_TEAM_SIZE;
      double best = INFINITY;
      for (int j = 0; j < VS_TEAM_SIZE; j++)
        best = fmin(best, hypot(w.robot[VS_YELLOW][j].pose.x_m - s->world.robot[VS_YELLOW][i].pose.x_m,
                                w.robot[VS_YELLOW][j].pose.y_m - s->world.robot[VS_YELLOW][i].pose.y_m));
      adversary += best * best / VS_TEAM_SIZE;
    }
  }
  return (rms){1000 * sqrt(own / n), 180 / VS_PI * sqrt(turn / n), 1000 * sqrt(ball / n), 1000 * sqrt(adversary / n)};
}

static void poses_at_640x480_are_within_2_mm_and_1_degree_of_the_truth(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&c, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  assert_ok(vs_detector_new(&def, &detector, err));
  vs_tracker tracker;
  vs_track_def track = vs_track_def_default();
  vs_track_init(&tracker, &track);
  rms e = run(&s, detector, &c, &tracker);
  print_message("own %.2f mm %.2f deg, ball %.2f mm, adversaries %.2f mm rms\n", e.own_mm, e.own_deg, e.ball_mm,
                e.adversary_mm);
  // The task's bound is 5 mm and 2 degrees on the rig; drawn frames have no blur and must do better.
  assert_true(e.own_mm < 2.0);
  assert_true(e.own_deg < 1.0);
  assert_true(e.ball_mm < 2.0);
  assert_true(e.adversary_mm < 2.0);
  assert_int_equal(tracker.stats.refused, 0);
  assert_int_equal(tracker.stats.lost[VS_OWN][0] + tracker.stats.lost[VS_OWN][1] + tracker.stats.lost[VS_OWN][2], 0);
  vs_detector_free(detector);
  scene_free(&s);
}

// Motion during the exposure: 8 mm is 2 ms at full speed and what tags bear (field.md, Tags); colours bear more.
// LARC 2026: ArUco marks of 70 mm on both teams, the adversaries' headings with them.
static void the_league_s_marks_of_both_teams_are_within_2_mm_and_1_degree_of_the_truth(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    scene_wear(&s, i / VS_TEAM_SIZE, i % VS_TEAM_SIZE, VS_MARK_ARUCO,
               vs_aruco_league_id[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE]);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  vs_track_def track = vs_track_def_default();
  def.own = def.their = track.own = track.their = VS_MARK_ARUCO;
  def.px_per_m = vs_calib_px_per_m(&c, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  assert_ok(vs_detector_new(&def, &detector, err));
  vs_tracker tracker;
  vs_track_init(&tracker, &track);
  rms e = run(&s, detector, &c, &tracker);
  vs_world w;
  vs_track_world(&tracker, 0, &w);
  for (int i = 0; i < VS_TEAM_SIZE; i++)
    assert_near(vs_wrap_rad(w.robot[VS_YELLOW][i].pose.theta_rad - s.world.robot[VS_YELLOW][i].pose.theta_rad), 0,
                0.02);
  print_message("own %.2f mm %.2f deg, ball %.2f mm, adversaries %.2f mm rms\n", e.own_mm, e.own_deg, e.ball_mm,
                e.adversary_mm);
  assert_true(e.own_mm < 2.0 && e.own_deg < 1.0 && e.ball_mm < 2.0 && e.adversary_mm < 2.0);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++)
    assert_int_equal(tracker.stats.lost[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE], 0);
  vs_detector_free(detector);
  scene_free(&s);
}

static void a_field_smeared_by_8_mm_is_still_seen_whole(void **state) {
  (void)state;
  enum { STEPS = 5, W = 640, H = 480 };
  static scene s;
  static float sum[3 * W * H];
  scene_init(&s, W, H);
  s.noise = 0;
  move(&s, 0.2);
  const vs_world middle = s.world;
  memset(sum, 0, sizeof sum);
  for (int k = 0; k < STEPS; k++) {
    double offset_m = 0.008 * ((double)k / (STEPS - 1) - 0.5);
    s.world = middle;
    s.world.ball.x_m += offset_m;
    for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
      vs_pose *p = &s.world.robot[i / 3][i % 3].pose;
      p->x_m += offset_m * cos(p->theta_rad);
      p->y_m += offset_m * sin(p->theta_rad);
    }
    scene_draw(&s, 0, 0);
    for (int i = 0; i < 3 * W * H; i++) sum[i] += (float)s.bgr[i] / STEPS;
  }
  for (int i = 0; i < 3 * W * H; i++) s.bgr[i] = (uint8_t)sum[i];
  vs_image_grey(s.bgr, 3 * W, W, H, s.grey, W);
  vs_frame frame = {s.grey, s.bgr, W, H, W, 3 * W, 1, 1};
  vs_calib c = vs_calib_overhead(W, H, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&c, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  vs_detections seen;
  assert_ok(vs_detector_new(&def, &detector, err));
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 3);
  assert_int_equal(seen.balls, 1);
  assert_int_equal(seen.adversaries, 3);
  for (int i = 0; i < seen.tags; i++) {
    double x, y;
    const vs_pose *p = &middle.robot[VS_BLUE][i].pose;
    assert_true(vs_calib_to_field(&c, seen.tag[i].centre_px[0], seen.tag[i].centre_px[1], VS_ROBOT_HEIGHT_M, &x, &y));
    assert_near(hypot(x - p->x_m, y - p->y_m), 0, 0.0015);
  }
  vs_detector_free(detector);
  scene_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_field_smeared_by_8_mm_is_still_seen_whole),
      cmocka_unit_test(the_league_s_marks_of_both_teams_are_within_2_mm_and_1_degree_of_the_truth),
      cmocka_unit_test(poses_at_640x480_are_within_2_mm_and_1_degree_of_the_truth),
  };
  return cmocka_run_group_tests_name("vision/eyes", tests, NULL, NULL);
}
