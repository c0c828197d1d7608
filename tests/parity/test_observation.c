// Tests src/observe/observer.c from both ends: what a team observes of one and the same match in the simulator (true
// world -> control, src/control/control.c) and on the field (pixels -> src/vision/track.c -> control).
#include <string.h>

#include "assert_near.h"
#include "vsss/control.h"
#include "vsss/geom.h"
#include "vsss/track.h"

#define FRAMES 90

// Robots drive circles of 10 cm at 0.2 m/s, each its own; the ball rolls from blue's half to yellow's.
static vs_world truth_at(int frame) {
  static const double centre[VS_TEAMS][VS_TEAM_SIZE][2] = {{{-0.55, 0.1}, {-0.2, -0.4}, {0.1, 0.35}},
                                                           {{0.55, -0.1}, {0.3, 0.05}, {-0.25, 0.3}}};
  vs_world w = {.seq = (uint32_t)frame, .time_us = 1000000 + (int64_t)frame * 1000000 / 30};
  double t_s = frame / 30.0;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      double angle = 2.0 * t_s + t + 2.0 * i;
      w.robot[t][i].pose = (vs_pose){centre[t][i][0] + 0.1 * cos(angle), centre[t][i][1] + 0.1 * sin(angle),
                                     vs_wrap_rad(angle + VS_PI / 2)};
      w.robot[t][i].valid = true;
    }
  w.ball = (vs_ball){.x_m = -0.45 + 0.3 * t_s, .y_m = -0.1, .z_m = VS_BALL_RADIUS_M, .valid = true};
  return w;
}

// The pixels of that world; turned: the camera's picture lies the other way round.
static vs_detections seen_at(int frame, const vs_calib *calib, const vs_track_def *def, bool turned) {
  vs_world w = truth_at(frame);
  vs_team other = def->team == VS_BLUE ? VS_YELLOW : VS_BLUE;
  double side = turned ? -1 : 1;
  vs_detections seen = {.capture_us = w.time_us, .seq = w.seq, .tags = 3, .adversaries = 3, .balls = 1};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_pose *own = &w.robot[def->team][i].pose, *adversary = &w.robot[other][i].pose;
    vs_tag *tag = &seen.tag[i];
    vs_blob *patch = &seen.adversary[i];
    double theta = own->theta_rad + (turned ? VS_PI : 0), h = def->tag_height_m;
    *tag = (vs_tag){.id = def->tag_id[i], .margin = 150};
    vs_calib_to_pixel(calib, side * own->x_m, side * own->y_m, h, &tag->centre_px[0], &tag->centre_px[1]);
    for (int k = 0; k < 4; k++) { // bottom left, bottom right, top right, top left; the top is the robot's front
      double ahead = k < 2 ? -0.02 : 0.02, left = k == 0 || k == 3 ? 0.02 : -0.02;
      vs_calib_to_pixel(calib, side * own->x_m + ahead * cos(theta) - left * sin(theta),
                        side * own->y_m + ahead * sin(theta) + left * cos(theta), h, &tag->corner_px[k][0],
                        &tag->corner_px[k][1]);
    }
    *patch = (vs_blob){.area_px = 180, .elongation = 1, .confidence = 1};
    vs_calib_to_pixel(calib, side * adversary->x_m, side * adversary->y_m, def->patch_height_m, &patch->x_px,
                      &patch->y_px);
  }
  seen.ball[0] = (vs_blob){.area_px = 150, .elongation = 1, .confidence = 1};
  vs_calib_to_pixel(calib, side * w.ball.x_m, side * w.ball.y_m, def->ball_height_m, &seen.ball[0].x_px,
                    &seen.ball[0].y_px);
  return seen;
}

static void stack_of(const vs_control *control, float *out) { vs_observer_write(vs_control_observer(control), out); }

static void compare(const vs_control *sim, const vs_control *field, double tolerance, int frame) {
  float a[VS_TEAM_SIZE * VS_OBS_SIZE], b[VS_TEAM_SIZE * VS_OBS_SIZE];
  stack_of(sim, a);
  stack_of(field, b);
  for (int i = 0; i < VS_TEAM_SIZE * VS_OBS_SIZE; i++) {
    double difference = fabs((double)a[i] - (double)b[i]);
    difference = fmin(difference, fabs(difference - 2)); // angle/pi: 1 and -1 are one direction
    if (!(difference <= tolerance))
      fail_msg("frame %d, robot %d, %s: simulator %g, field %g", frame, i / VS_OBS_SIZE, vs_obs_name(i % VS_OBS_FRAME),
               (double)a[i], (double)b[i]);
  }
}

static void field_and_simulator_observe_the_same_match_alike(void **state) {
  (void)state;
  const vs_calib calib = vs_calib_overhead(640, 480, 2.2, 2 * atan(0.5));
  for (int kind = 0; kind < 4; kind++) {
    vs_track_def def = vs_track_def_default();
    def.team = kind & 1 ? VS_YELLOW : VS_BLUE;
    def.attack_plus_x = (kind & 2) != 0;
    bool turned = (def.team == VS_BLUE) != def.attack_plus_x;
    vs_tracker tracker;
    vs_track_init(&tracker, &def);
    vs_control *sim, *field;
    assert_ok(vs_control_new(NULL, &sim, err));
    assert_ok(vs_control_new(NULL, &field, err));
    for (int n = 0; n < FRAMES; n++) {
      vs_detections seen = seen_at(n, &calib, &def, turned);
      vs_world truth = truth_at(n), tracked;
      const vs_game game = {.time_s = n / 30.0, .duration_s = 40};
      vs_track_update(&tracker, &calib, &seen);
      vs_track_world(&tracker, 0, &tracked);
      if (n % 3) continue;
      vs_control_observe(sim, def.team, &truth, &game);
      vs_control_observe(field, def.team, &tracked, &game);
      // The first sight is exact; then the filters follow curves by a millimetre and a degree.
      compare(sim, field, n == 0 ? 1e-5 : 0.005, n);
    }
    vs_control_free(sim);
    vs_control_free(field);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(field_and_simulator_observe_the_same_match_alike),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
