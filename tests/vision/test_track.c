// src/vision/track.c
#include <string.h>

#include "assert_near.h"
#include "vsss/geom.h"
#include "vsss/rng.h"
#include "vsss/tag.h"
#include "vsss/track.h"

#define FRAME_US 33333

static vs_calib calib(void) { return vs_calib_overhead(640, 480, 2.2, 2 * atan(0.5)); }

static void see_tag(vs_detections *seen, const vs_calib *c, int id, double x_m, double y_m, double theta_rad) {
  vs_tag *t = &seen->tag[seen->tags++];
  *t = (vs_tag){.id = id, .margin = 150};
  // Half the border, 5 of 9 cells; corners: bottom left, bottom right, top right, top left, the top is the front.
  const double half = 0.5 * VS_TAG_PAPER_M * 5 / 9, u[4] = {-half, -half, half, half},
               v[4] = {half, -half, -half, half};
  for (int i = 0; i < 4; i++) {
    double x = x_m + cos(theta_rad) * u[i] - sin(theta_rad) * v[i];
    double y = y_m + sin(theta_rad) * u[i] + cos(theta_rad) * v[i];
    vs_calib_to_pixel(c, x, y, VS_ROBOT_HEIGHT_M, &t->corner_px[i][0], &t->corner_px[i][1]);
  }
  vs_calib_to_pixel(c, x_m, y_m, VS_ROBOT_HEIGHT_M, &t->centre_px[0], &t->centre_px[1]);
}

static void see_ball(vs_detections *seen, const vs_calib *c, double x_m, double y_m) {
  vs_blob *b = &seen->ball[seen->balls++];
  *b = (vs_blob){.area_px = 150, .elongation = 1, .confidence = 1};
  vs_calib_to_pixel(c, x_m, y_m, VS_BALL_RADIUS_M, &b->x_px, &b->y_px);
}

static void see_adversary(vs_detections *seen, const vs_calib *c, double x_m, double y_m) {
  vs_blob *b = &seen->adversary[seen->adversaries++];
  *b = (vs_blob){.area_px = 180, .elongation = 1, .confidence = 1};
  vs_calib_to_pixel(c, x_m, y_m, VS_ROBOT_HEIGHT_M, &b->x_px, &b->y_px);
}

static vs_detections at(int frame) {
  return (vs_detections){.capture_us = 1000000 + (int64_t)frame * FRAME_US, .seq = (uint32_t)frame};
}

static vs_world world_of(const vs_tracker *t) {
  vs_world w;
  vs_track_world(t, 0, &w);
  assert_ok(vs_world_check(&w, err));
  return w;
}

static void a_tag_gives_place_and_heading_of_its_robot_corrected_for_height(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  def.tag_id[1] = 7;
  for (double theta = -3.1; theta < 3.2; theta += 0.31) {
    vs_track_init(&t, &def);
    vs_detections seen = at(0);
    see_tag(&seen, &c, 7, 0.70, -0.60, theta);
    see_tag(&seen, &c, 3, 0.10, 0.10, 0); // nobody's
    vs_track_update(&t, &c, &seen);
    vs_world w = world_of(&t);
    assert_int_equal(w.time_us, 1000000);
    assert_true(w.robot[VS_BLUE][1].valid);
    assert_false(w.robot[VS_BLUE][0].valid);
    assert_false(w.robot[VS_YELLOW][0].valid);
    assert_near(w.robot[VS_YELLOW][0].pose.x_m, 0.70, 1e-12); // never seen: in its own corner
    assert_near(w.robot[VS_BLUE][0].pose.x_m, -0.70, 1e-12);
    assert_false(w.ball.valid);
    assert_near(w.robot[VS_BLUE][1].pose.x_m, 0.70, 1e-9);
    assert_near(w.robot[VS_BLUE][1].pose.y_m, -0.60, 1e-9);
    assert_near(vs_wrap_rad(w.robot[VS_BLUE][1].pose.theta_rad - theta), 0, 1e-9);
  }
}

// LARC 2026: both teams' marks have numbers, so an adversary keeps its place in the world and shows its heading.
static void adversaries_with_marks_keep_their_number_and_show_their_heading(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  def.own = def.their = VS_MARK_ARUCO;
  for (int plus = 0; plus < 2; plus++) {
    def.attack_plus_x = plus;
    vs_track_init(&t, &def);
    vs_detections seen = at(0);
    see_tag(&seen, &c, 273, -0.5, 0.1, 0.3);  // blue 2
    see_tag(&seen, &c, 771, 0.4, 0.2, 1.2);   // yellow 1
    see_tag(&seen, &c, 955, 0.4, -0.3, -2.0); // yellow 0
    see_tag(&seen, &c, 0, 0, 0, 0);           // an AprilTag that nobody wears
    for (int i = 0; i < 3; i++) seen.tag[i].kind = VS_MARK_ARUCO;
    vs_track_update(&t, &c, &seen);
    vs_world w = world_of(&t);
    double sign = plus ? 1 : -1, turn = plus ? 0 : VS_PI;
    assert_true(w.robot[VS_BLUE][2].valid && w.robot[VS_YELLOW][0].valid && w.robot[VS_YELLOW][1].valid);
    assert_false(w.robot[VS_BLUE][0].valid || w.robot[VS_YELLOW][2].valid);
    assert_near(w.robot[VS_YELLOW][1].pose.x_m, sign * 0.4, 1e-9);
    assert_near(w.robot[VS_YELLOW][1].pose.y_m, sign * 0.2, 1e-9);
    assert_near(vs_wrap_rad(w.robot[VS_YELLOW][1].pose.theta_rad - 1.2 - turn), 0, 1e-9);
    assert_near(vs_wrap_rad(w.robot[VS_YELLOW][0].pose.theta_rad + 2.0 - turn), 0, 1e-9);
    assert_near(vs_wrap_rad(w.robot[VS_BLUE][2].pose.theta_rad - 0.3 - turn), 0, 1e-9);
  }
}

static void a_tag_glued_on_askew_is_put_right_by_its_yaw(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  def.tag_yaw_rad[0] = VS_PI / 2; // the pattern's top shows to the robot's left
  vs_track_init(&t, &def);
  vs_detections seen = at(0);
  see_tag(&seen, &c, 0, 0, 0, 0.4 + VS_PI / 2);
  vs_track_update(&t, &c, &seen);
  assert_near(world_of(&t).robot[VS_BLUE][0].pose.theta_rad, 0.4, 1e-9);
}

static void the_world_is_turned_so_that_blue_attacks_plus_x(void **state) {
  (void)state;
  // team, attack: turned by half a turn where blue would attack -x of the calibration's frame.
  const struct {
    vs_team team;
    bool plus;
    double sign;
  } rows[4] = {{VS_BLUE, true, 1}, {VS_BLUE, false, -1}, {VS_YELLOW, true, -1}, {VS_YELLOW, false, 1}};
  vs_calib c = calib();
  for (int i = 0; i < 4; i++) {
    vs_tracker t;
    vs_track_def def = vs_track_def_default();
    def.team = rows[i].team;
    def.attack_plus_x = rows[i].plus;
    vs_track_init(&t, &def);
    for (int k = 0; k < 30; k++) { // all move with 0.3 m/s along +x
      vs_detections seen = at(k);
      double dx = 0.3 * k * FRAME_US * 1e-6;
      see_tag(&seen, &c, 2, -0.3 + dx, 0.2, 0.5);
      see_adversary(&seen, &c, -0.1 + dx, -0.3);
      see_ball(&seen, &c, -0.2 + dx, 0.4);
      vs_track_update(&t, &c, &seen);
    }
    double sign = rows[i].sign, end = 0.3 * 29 * FRAME_US * 1e-6;
    vs_world w = world_of(&t);
    const vs_robot *own = &w.robot[rows[i].team][2], *other = &w.robot[1 - rows[i].team][0];
    assert_near(own->pose.x_m, sign * (-0.3 + end), 1e-3);
    assert_near(own->pose.y_m, sign * 0.2, 1e-3);
    assert_near(own->pose.theta_rad, sign > 0 ? 0.5 : 0.5 - VS_PI, 1e-3);
    assert_near(own->vx_mps, sign * 0.3, 0.01);
    assert_near(other->pose.x_m, sign * (-0.1 + end), 1e-3);
    assert_near(other->pose.y_m, sign * -0.3, 1e-3);
    assert_near(other->vx_mps, sign * 0.3, 0.02);
    assert_near(w.ball.x_m, sign * (-0.2 + end), 1e-3);
    assert_near(w.ball.vx_mps, sign * 0.3, 0.02);
  }
}

static void real_time_steps_give_the_true_velocity_at_any_frame_rate(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  vs_rng rng = vs_rng_make(1, 0);
  int64_t us = 500000;
  for (int k = 0; k < 60; k++) { // 12 to 80 fps, mixed: a filter that assumes one rate sees the speed jump
    us += 12500 + (int64_t)vs_rng_below(&rng, 70000);
    double s = 1e-6 * (double)(us - 500000);
    vs_detections seen = {.capture_us = us, .seq = (uint32_t)k};
    see_tag(&seen, &c, 0, -0.6 + 0.4 * s, 0.1 * s, 2.0 * s);
    vs_track_update(&t, &c, &seen);
    if (k < 10) continue;
    vs_world w = world_of(&t);
    assert_near(w.robot[0][0].vx_mps, 0.4, 0.005);
    assert_near(w.robot[0][0].vy_mps, 0.1, 0.005);
    assert_near(w.robot[0][0].omega_radps, 2.0, 0.05); // through several turns of +-pi
  }
}

static void a_lost_object_is_predicted_for_100_ms_then_invalid_and_kept_in_place(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  int k = 0;
  for (; k <= 30; k++) {
    vs_detections seen = at(k);
    see_tag(&seen, &c, 0, -0.5 + 0.9 * k * FRAME_US * 1e-6, 0, 0);
    vs_track_update(&t, &c, &seen);
  }
  double last = -0.5 + 0.9 * 30 * FRAME_US * 1e-6; // seen in frame 30
  for (; k <= 33; k++) {                           // 33.3, 66.7, 100.0 ms after: still predicted
    vs_detections nothing = at(k);
    vs_track_update(&t, &c, &nothing);
    vs_world w = world_of(&t);
    assert_true(w.robot[0][0].valid);
    assert_near(w.robot[0][0].pose.x_m, last + 0.9 * (k - 30) * FRAME_US * 1e-6, 0.003);
  }
  vs_detections nothing = at(34); // 133 ms
  vs_track_update(&t, &c, &nothing);
  vs_world w = world_of(&t);
  assert_false(w.robot[0][0].valid);
  assert_near(w.robot[0][0].pose.x_m, last + 0.9 * 0.1, 0.003);
  assert_near(w.robot[0][0].vx_mps, 0, 0);
  assert_int_equal(t.stats.lost[VS_OWN][0], 4);
  vs_detections again = at(40); // and taken up wherever it is seen again
  see_tag(&again, &c, 0, 0.1, 0.5, 1.0);
  vs_track_update(&t, &c, &again);
  w = world_of(&t);
  assert_true(w.robot[0][0].valid);
  assert_near(w.robot[0][0].pose.y_m, 0.5, 1e-6);
}

static void asked_later_than_the_newest_frame_the_world_is_predicted_and_at_last_invalid(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  for (int k = 0; k <= 30; k++) {
    vs_detections seen = at(k);
    see_tag(&seen, &c, 0, -0.5 + 0.9 * k * FRAME_US * 1e-6, 0, 0);
    vs_track_update(&t, &c, &seen);
  }
  vs_world now, later, frozen;
  vs_track_world(&t, 0, &now);
  vs_track_world(&t, now.time_us + 50000, &later);
  assert_near(later.robot[0][0].pose.x_m - now.robot[0][0].pose.x_m, 0.045, 0.002);
  assert_true(later.robot[0][0].valid);
  vs_track_world(&t, now.time_us + 500000, &frozen); // the camera stopped: nothing is valid, nothing runs away
  assert_false(frozen.robot[0][0].valid);
  assert_near(frozen.robot[0][0].pose.x_m - now.robot[0][0].pose.x_m, 0.09, 0.003);
}

static void one_wild_measurement_is_refused_and_two_at_one_place_are_believed(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  int k = 0;
  for (; k < 10; k++) {
    vs_detections seen = at(k);
    see_tag(&seen, &c, 0, 0.2, 0.2, 0);
    vs_track_update(&t, &c, &seen);
  }
  vs_detections wild = at(k++);
  see_tag(&wild, &c, 0, -0.4, 0.0, 0);
  vs_track_update(&t, &c, &wild);
  assert_near(world_of(&t).robot[0][0].pose.x_m, 0.2, 1e-3);
  assert_int_equal(t.stats.refused, 1);
  vs_detections calm = at(k++);
  see_tag(&calm, &c, 0, 0.2, 0.2, 0);
  vs_track_update(&t, &c, &calm);
  for (int i = 0; i < 2; i++) { // carried away by a hand
    vs_detections moved = at(k++);
    see_tag(&moved, &c, 0, -0.4, 0.01 * i, 1.0);
    vs_track_update(&t, &c, &moved);
  }
  vs_world w = world_of(&t);
  assert_near(w.robot[0][0].pose.x_m, -0.4, 1e-6);
  assert_near(w.robot[0][0].pose.theta_rad, 1.0, 1e-6);
}

// A robot that has stood at (0.2, 0.2) for ten frames, seen without noise: the gate is its 6 cm alone.
static int stand(vs_tracker *t, const vs_calib *c) {
  vs_track_def def = vs_track_def_default();
  def.position_noise_m = 1e-6;
  def.robot_acceleration_mps2 = 0;
  vs_track_init(t, &def);
  int k = 0;
  for (; k < 10; k++) {
    vs_detections seen = at(k);
    see_tag(&seen, c, 0, 0.2, 0.2, 0);
    vs_track_update(t, c, &seen);
  }
  return k;
}

static void a_jump_of_6_cm_is_refused_and_two_within_10_cm_are_believed(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  const double jump_m[] = {0.058, 0.062}, apart_m[] = {0.098, 0.102};
  for (int far = 0; far < 2; far++) {
    vs_detections moved = at(stand(&t, &c));
    see_tag(&moved, &c, 0, 0.2 + jump_m[far], 0.2, 0);
    vs_track_update(&t, &c, &moved);
    assert_int_equal(t.stats.refused, far);

    int k = stand(&t, &c);
    for (int i = 0; i < 2; i++) {
      vs_detections wild = at(k + i);
      see_tag(&wild, &c, 0, -0.4 + apart_m[far] * i, 0.2, 0);
      vs_track_update(&t, &c, &wild);
    }
    assert_int_equal(t.stats.refused, 1 + far);
    assert_near(world_of(&t).robot[0][0].pose.x_m, far ? 0.2 : -0.4 + apart_m[0], 1e-4);
  }
}

static void after_a_restart_the_next_sight_is_taken_as_it_is(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  for (int k = 0; k < 10; k++) {
    vs_detections seen = at(k);
    see_tag(&seen, &c, 0, 0.2, 0.2, 0);
    see_ball(&seen, &c, 0.5, 0);
    vs_track_update(&t, &c, &seen);
  }
  vs_track_restart(&t);
  vs_detections placed = at(10);
  see_tag(&placed, &c, 0, -0.5, 0, 0);
  see_ball(&placed, &c, 0, 0);
  vs_track_update(&t, &c, &placed);
  vs_world w = world_of(&t);
  assert_near(w.robot[0][0].pose.x_m, -0.5, 1e-6);
  assert_near(w.ball.x_m, 0, 1e-6);
  assert_near(w.ball.vx_mps, 0, 1e-6);
}

static void things_off_the_field_are_not_believed(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  vs_detections seen = at(0);
  see_tag(&seen, &c, 0, 0.90, 0, 0); // half a field length is 0.75, the margin 0.10
  see_ball(&seen, &c, 0, 0.80);
  see_adversary(&seen, &c, -0.95, 0);
  vs_track_update(&t, &c, &seen);
  vs_world w = world_of(&t);
  assert_false(w.robot[0][0].valid);
  assert_false(w.ball.valid);
  assert_false(w.robot[1][0].valid);
  assert_int_equal(t.stats.refused, 3);
  seen = at(1);
  see_tag(&seen, &c, 0, 0.83, 0, 0); // in the goal
  vs_track_update(&t, &c, &seen);
  assert_true(world_of(&t).robot[0][0].valid);
}

static void the_ball_nearest_to_its_track_is_ours_and_a_new_one_the_best(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  vs_detections seen = at(0);
  see_ball(&seen, &c, 0.3, 0.1); // best first
  see_ball(&seen, &c, -0.5, 0.0);
  vs_track_update(&t, &c, &seen);
  assert_near(world_of(&t).ball.x_m, 0.3, 1e-6);
  seen = at(1);
  see_ball(&seen, &c, -0.5, 0.0); // now listed first, yet the track goes on
  see_ball(&seen, &c, 0.31, 0.1);
  vs_track_update(&t, &c, &seen);
  assert_near(world_of(&t).ball.x_m, 0.31, 0.01);
  for (int k = 2; k < 4; k++) { // the referee puts it elsewhere
    seen = at(k);
    see_ball(&seen, &c, -0.375, 0.4);
    vs_track_update(&t, &c, &seen);
  }
  assert_near(world_of(&t).ball.x_m, -0.375, 1e-6);
}

static void adversaries_keep_their_slots_while_they_cross_and_are_listed_in_any_order(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  vs_rng rng = vs_rng_make(5, 0);
  int slot[3] = {-1, -1, -1};
  for (int k = 0; k < 60; k++) {
    double s = k * FRAME_US * 1e-6;
    // Two pass each other 10 cm apart at a relative speed of 1.2 m/s, the third circles.
    const double x[3] = {-0.6 + 0.6 * s, 0.6 - 0.6 * s, 0.3 * cos(2 * s)},
                 y[3] = {0.05, -0.05, 0.45 + 0.1 * sin(2 * s)};
    int order[3] = {0, 1, 2};
    vs_rng_shuffle(&rng, order, 3);
    vs_detections seen = at(k);
    for (int i = 0; i < 3; i++)
      if (k % 11 != 7 || order[i] != 1) see_adversary(&seen, &c, x[order[i]], y[order[i]]); // sometimes one is missed
    vs_track_update(&t, &c, &seen);
    vs_world w = world_of(&t);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        if (k == 0 && hypot(w.robot[1][j].pose.x_m - x[i], w.robot[1][j].pose.y_m - y[i]) < 0.01) slot[i] = j;
    for (int i = 0; i < 3; i++) {
      assert_true(slot[i] >= 0);
      assert_near(w.robot[1][slot[i]].pose.x_m, x[i], 0.02);
      assert_near(w.robot[1][slot[i]].pose.y_m, y[i], 0.02);
      assert_true(w.robot[1][slot[i]].valid);
    }
  }
}

static void a_fourth_blob_of_the_adversarys_colour_takes_nobodys_slot(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  for (int k = 0; k < 20; k++) {
    vs_detections seen = at(k);
    if (k > 3) see_adversary(&seen, &c, 0.6, 0.5);
    for (int i = 0; i < 3; i++) see_adversary(&seen, &c, -0.4 + 0.3 * i, 0);
    vs_track_update(&t, &c, &seen);
  }
  vs_world w = world_of(&t);
  for (int i = 0; i < 3; i++) assert_near(w.robot[1][i].pose.y_m, 0, 0.001);
}

static void late_frames_are_ignored_and_a_source_that_began_anew_is_followed(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  vs_track_init(&t, &def);
  vs_detections seen = at(100);
  see_tag(&seen, &c, 0, 0.2, 0, 0);
  vs_track_update(&t, &c, &seen);
  seen = at(99);
  see_tag(&seen, &c, 0, 0.21, 0, 0);
  vs_track_update(&t, &c, &seen);
  seen = at(100);
  see_tag(&seen, &c, 0, 0.21, 0, 0);
  vs_track_update(&t, &c, &seen);
  assert_int_equal(t.stats.late, 2);
  assert_near(world_of(&t).robot[0][0].pose.x_m, 0.2, 1e-9);
  seen = at(0); // 3.3 s back: a recording that starts again
  see_tag(&seen, &c, 0, -0.6, 0, 0);
  vs_track_update(&t, &c, &seen);
  vs_world w = world_of(&t);
  assert_true(w.robot[0][0].valid);
  assert_near(w.robot[0][0].pose.x_m, -0.6, 1e-9);
  assert_int_equal(t.stats.frames, 2);
}

static void noise_is_smoothed_by_a_calm_model(void **state) {
  (void)state;
  vs_calib c = calib();
  vs_tracker t;
  vs_track_def def = vs_track_def_default();
  def.position_noise_m = 0.002;
  def.robot_acceleration_mps2 = 0.5;
  vs_track_init(&t, &def);
  vs_rng rng = vs_rng_make(9, 0);
  double in = 0, out = 0;
  int n = 0;
  for (int k = 0; k < 400; k++) {
    double x = -0.6 + 0.003 * k, noise = 0.002 * vs_rng_normal(&rng);
    vs_detections seen = at(k);
    see_tag(&seen, &c, 0, x + noise, 0.0, 0.0);
    vs_track_update(&t, &c, &seen);
    if (k < 20) continue;
    double e = world_of(&t).robot[0][0].pose.x_m - x;
    in += noise * noise, out += e * e, n++;
  }
  assert_near(sqrt(in / n), 0.002, 0.0002);
  assert_true(sqrt(out / n) < 0.7 * sqrt(in / n));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_tag_gives_place_and_heading_of_its_robot_corrected_for_height),
      cmocka_unit_test(adversaries_with_marks_keep_their_number_and_show_their_heading),
      cmocka_unit_test(a_tag_glued_on_askew_is_put_right_by_its_yaw),
      cmocka_unit_test(the_world_is_turned_so_that_blue_attacks_plus_x),
      cmocka_unit_test(real_time_steps_give_the_true_velocity_at_any_frame_rate),
      cmocka_unit_test(a_lost_object_is_predicted_for_100_ms_then_invalid_and_kept_in_place),
      cmocka_unit_test(asked_later_than_the_newest_frame_the_world_is_predicted_and_at_last_invalid),
      cmocka_unit_test(one_wild_measurement_is_refused_and_two_at_one_place_are_believed),
      cmocka_unit_test(a_jump_of_6_cm_is_refused_and_two_within_10_cm_are_believed),
      cmocka_unit_test(after_a_restart_the_next_sight_is_taken_as_it_is),
      cmocka_unit_test(things_off_the_field_are_not_believed),
      cmocka_unit_test(the_ball_nearest_to_its_track_is_ours_and_a_new_one_the_best),
      cmocka_unit_test(adversaries_keep_their_slots_while_they_cross_and_are_listed_in_any_order),
      cmocka_unit_test(a_fourth_blob_of_the_adversarys_colour_takes_nobodys_slot),
      cmocka_unit_test(late_frames_are_ignored_and_a_source_that_began_anew_is_followed),
      cmocka_unit_test(noise_is_smoothed_by_a_calm_model),
  };
  return cmocka_run_group_tests_name("vision/track", tests, NULL, NULL);
}
