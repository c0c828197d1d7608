// src/vision/detect.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vision/scene.h"
#include "vsss/calib.h"
#include "vsss/geom.h"
#include "vsss/paths.h"

static vs_detector *detector_for(const vs_calib *c, vs_team adversary) {
  vs_detector_def def = vs_detector_def_default();
  def.adversary = adversary;
  def.px_per_m = vs_calib_px_per_m(c, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  assert_ok(vs_detector_new(&def, &detector, err));
  return detector;
}

static void put(scene *s, int team, int index, double x_m, double y_m, double theta_rad) {
  s->world.robot[team][index] = (vs_robot){.pose = {x_m, y_m, theta_rad}, .valid = true};
}

static void a_full_field(scene *s) {
  put(s, VS_BLUE, 0, -0.60, 0.10, 0.3);
  put(s, VS_BLUE, 1, -0.20, -0.50, -2.0);
  put(s, VS_BLUE, 2, 0.30, 0.55, 1.7);
  put(s, VS_YELLOW, 0, 0.65, 0.02, 0.5);
  put(s, VS_YELLOW, 1, 0.10, 0.20, 2.5);
  put(s, VS_YELLOW, 2, 0.45, -0.45, -0.8);
  s->world.ball = (vs_ball){.x_m = -0.41, .y_m = 0.33, .valid = true};
}

// Distance in mm between a blob on the plane z = h and the nearest of three robots.
static double nearest_mm(const vs_calib *c, const vs_blob *blob, double h, const vs_robot *robot) {
  double x, y, best = INFINITY;
  assert_true(vs_calib_to_field(c, blob->x_px, blob->y_px, h, &x, &y));
  for (int i = 0; i < VS_TEAM_SIZE; i++) best = fmin(best, hypot(x - robot[i].pose.x_m, y - robot[i].pose.y_m));
  return 1000 * best;
}

static void everything_on_a_noisy_field_is_seen_once_and_in_place(int width, int height) {
  static scene s;
  scene_init(&s, width, height);
  a_full_field(&s);
  vs_calib c = vs_calib_overhead(width, height, s.height_m, scene_fov_rad(&s));
  vs_detector *detector = detector_for(&c, VS_YELLOW);
  vs_frame frame = scene_draw(&s, 5000, 17);
  vs_detections seen;
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.capture_us, 5000);
  assert_int_equal(seen.seq, 17);
  assert_int_equal(seen.tags, 3);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(seen.tag[i].id, i);
    assert_true(seen.tag[i].margin > 100);
    double x, y;
    assert_true(vs_calib_to_field(&c, seen.tag[i].centre_px[0], seen.tag[i].centre_px[1], VS_ROBOT_HEIGHT_M, &x, &y));
    const vs_pose *p = &s.world.robot[VS_BLUE][i].pose;
    assert_near(hypot(x - p->x_m, y - p->y_m), 0, 0.001);
  }
  assert_int_equal(seen.balls, 1);
  double x, y;
  assert_true(vs_calib_to_field(&c, seen.ball[0].x_px, seen.ball[0].y_px, VS_BALL_RADIUS_M, &x, &y));
  assert_near(hypot(x - s.world.ball.x_m, y - s.world.ball.y_m), 0, 0.0015);
  assert_int_equal(seen.adversaries, 3);
  for (int i = 0; i < 3; i++)
    assert_near(nearest_mm(&c, &seen.adversary[i], VS_ROBOT_HEIGHT_M, s.world.robot[VS_YELLOW]), 0, 1.5);
  vs_detector_free(detector);
  scene_free(&s);
}

static void a_field_at_640x480_is_seen_within_a_millimetre(void **state) {
  (void)state;
  everything_on_a_noisy_field_is_seen_once_and_in_place(640, 480);
}

static void a_field_at_1280x720_is_seen_within_a_millimetre(void **state) {
  (void)state;
  everything_on_a_noisy_field_is_seen_once_and_in_place(1280, 720);
}

static void blue_adversaries_are_looked_for_when_we_are_yellow(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  s.own = VS_YELLOW;
  a_full_field(&s);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector *detector = detector_for(&c, VS_BLUE);
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_detections seen;
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 3);
  assert_int_equal(seen.adversaries, 3);
  for (int i = 0; i < 3; i++)
    assert_near(nearest_mm(&c, &seen.adversary[i], VS_ROBOT_HEIGHT_M, s.world.robot[VS_BLUE]), 0, 1.5);
  vs_detector_free(detector);
  scene_free(&s);
}

static void adversaries_side_by_side_are_still_three(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  put(&s, VS_YELLOW, 0, 0.2, 0.10, 0);
  put(&s, VS_YELLOW, 1, 0.2, 0.18, 0); // caps touch, patches are 2 cm apart
  put(&s, VS_YELLOW, 2, 0.28, 0.10, 0);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector *detector = detector_for(&c, VS_YELLOW);
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_detections seen;
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 0);
  assert_int_equal(seen.balls, 0);
  assert_int_equal(seen.adversaries, 3);
  vs_detector_free(detector);
  scene_free(&s);
}

static void a_tag_of_another_size_is_not_ours(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  a_full_field(&s);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = 1.5 * vs_calib_px_per_m(&c, VS_ROBOT_HEIGHT_M); // as if the tags were half as large again
  vs_detector *detector;
  assert_ok(vs_detector_new(&def, &detector, err));
  vs_frame frame = scene_draw(&s, 0, 0);
  vs_detections seen;
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 0);
  vs_detector_free(detector);
  scene_free(&s);
}

static void colour_on_an_own_cap_is_neither_ball_nor_adversary(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  a_full_field(&s);
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector *detector = detector_for(&c, VS_YELLOW);
  vs_frame frame = scene_draw(&s, 0, 0);
  double x, y;
  assert_true(vs_calib_to_pixel(&c, -0.60, 0.10, VS_ROBOT_HEIGHT_M, &x, &y)); // robot 0
  vs_image image = {s.bgr, 640, 480, 3 * 640};
  vs_image_disc(&image, x, y, 5.5, scene_orange); // the grey plane still shows the tag
  vs_detections seen;
  assert_ok(vs_detect(detector, &frame, &seen, err));
  assert_int_equal(seen.tags, 3);
  assert_int_equal(seen.balls, 1);
  assert_true(vs_calib_to_field(&c, seen.ball[0].x_px, seen.ball[0].y_px, VS_BALL_RADIUS_M, &x, &y));
  assert_near(x, s.world.ball.x_m, 0.002);
  vs_detector_free(detector);
  scene_free(&s);
}

static void a_silly_definition_is_a_usage_error(void **state) {
  (void)state;
  vs_error err;
  vs_detector *detector;
  vs_detector_def def = vs_detector_def_default();
  def.patch_m = 0;
  assert_int_equal(vs_detector_new(&def, &detector, &err), VS_USAGE);
  def = vs_detector_def_default();
  def.tag.family = "arucco";
  assert_int_equal(vs_detector_new(&def, &detector, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "arucco"));
}

// Footage of a real field, of 502 frames: two yellow robots, three blue ones, one moved by hand, an orange ball, patches of
// two colours. What is where in 40 of them was checked by eye: tests/data/vss_sdk_robot_move.csv.
typedef struct label {
  int frame;
  char object[16];
  double x_px, y_px;
} label;
enum { LABELS = 400, FOOTAGE_LEFT_PX = 96 }; // left of it is a window of the program that recorded it

static int load_labels(label *out) {
  char path[4096], line[256];
  assert_ok(vs_path_find("tests/data/vss_sdk_robot_move.csv", path, sizeof path, err));
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  int n = 0;
  while (fgets(line, sizeof line, f) && n < LABELS)
    n += sscanf(line, "%d,%15[a-z_],%lf,%lf", &out[n].frame, out[n].object, &out[n].x_px, &out[n].y_px) == 4;
  fclose(f);
  return n;
}

// The kind's detections, with whether a label explains each: within a robot's width of the place of one of its kind in the
// labelled frames before and after (the moved robot goes less than that in between).
typedef struct kind {
  const char *prefix;
  int seen, labelled; // of the labels
  int phantom_run, longest;
} kind;

static bool near(const vs_blob *b, const label *l, double px) {
  return hypot(b->x_px + FOOTAGE_LEFT_PX - l->x_px, b->y_px - l->y_px) < px;
}

static void compare(kind *k, const label *l, int labels, int frame, const vs_blob *blob, int count) {
  bool phantom = false;
  for (int i = 0; i < count; i++) {
    bool explained = false;
    for (int j = 0; j < labels && !explained; j++)
      explained = !strncmp(l[j].object, k->prefix, strlen(k->prefix)) && abs(l[j].frame - frame) <= 26 &&
                  near(&blob[i], &l[j], !strcmp(l[j].object, "blue_moved") ? 40 : 6);
    phantom = phantom || !explained;
  }
  k->phantom_run = phantom ? k->phantom_run + 1 : 0;
  if (k->phantom_run > k->longest) k->longest = k->phantom_run;
  for (int j = 0; j < labels; j++) {
    if (l[j].frame != frame || strncmp(l[j].object, k->prefix, strlen(k->prefix))) continue;
    k->labelled++;
    int hits = 0;
    for (int i = 0; i < count; i++) hits += near(&blob[i], &l[j], 3);
    k->seen += hits == 1;
  }
}

static void the_real_footage_shows_every_labelled_robot_and_ball_and_no_phantom_by_the_defaults(void **state) {
  (void)state;
  const char *data = getenv("VSSS_REFERENCE_DATA");
  char path[4096];
  snprintf(path, sizeof path, "%s/real/vss_sdk_robot_move.mp4", data ? data : "");
  if (!data || access(path, R_OK)) {
    printf("note: VSSS_REFERENCE_DATA is not set or holds no real/vss_sdk_robot_move.mp4\n");
    skip();
  }
  static label labels[LABELS];
  int count = load_labels(labels);
  assert_int_equal(count, 239); // six objects in 40 frames but for one hidden by a stick
  vs_calib_point points[8];
  int corners;
  char points_path[4096];
  assert_ok(vs_path_find("tests/data/vss_sdk_robot_move_points.txt", points_path, sizeof points_path, err));
  assert_ok(vs_calib_load_points(points_path, points, 8, &corners, err));
  vs_calib calib = {.width = 632, .height = 468};
  assert_ok(vs_calib_solve_from_height(&calib, points, corners, 2.0, err));
  vs_camera_def camera_def = vs_camera_def_default();
  camera_def.every_frame = true;
  vs_camera *camera;
  vs_detector *yellow, *blue;
  assert_ok(vs_camera_open(path, &camera_def, &camera, err));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&calib, VS_ROBOT_HEIGHT_M);
  assert_ok(vs_detector_new(&def, &yellow, err));
  def.adversary = VS_BLUE;
  assert_ok(vs_detector_new(&def, &blue, err));
  kind kinds[3] = {{.prefix = "blue"}, {.prefix = "yellow"}, {.prefix = "ball"}};
  int frames = 0;
  for (;; frames++) {
    vs_frame frame;
    vs_camera_got got;
    assert_ok(vs_camera_read(camera, 1000, &frame, &got, err));
    if (got == VS_CAMERA_END) break;
    frame.bgr += 3 * FOOTAGE_LEFT_PX;
    frame.grey += FOOTAGE_LEFT_PX;
    frame.width -= FOOTAGE_LEFT_PX;
    vs_detections seen;
    assert_ok(vs_detect(blue, &frame, &seen, err));
    compare(&kinds[0], labels, count, frames + 1, seen.adversary, seen.adversaries);
    assert_ok(vs_detect(yellow, &frame, &seen, err));
    compare(&kinds[1], labels, count, frames + 1, seen.adversary, seen.adversaries);
    compare(&kinds[2], labels, count, frames + 1, seen.ball, seen.balls);
  }
  assert_int_equal(frames, 502);
  for (int i = 0; i < 3; i++) {
    print_message("%s: %d of %d labels found, phantoms in %d frames running\n", kinds[i].prefix, kinds[i].seen,
                  kinds[i].labelled, kinds[i].longest);
    assert_true(kinds[i].seen >= 0.98 * kinds[i].labelled);
    assert_true(kinds[i].longest <= 3);
  }
  vs_detector_free(yellow);
  vs_detector_free(blue);
  vs_camera_close(camera);
}

// Orange identification patches: with a ball free on the floor they are none; alone beside a robot, one may be the ball.
static void a_ball_free_on_the_floor_goes_before_orange_beside_a_team_s_colour(void **state) {
  (void)state;
  static scene s;
  scene_init(&s, 640, 480);
  s.world.robot[VS_YELLOW][0] = (vs_robot){.pose = {0.3, 0.2, 0}, .valid = true};
  s.world.ball = (vs_ball){.x_m = -0.4, .y_m = -0.3, .valid = true};
  vs_calib c = vs_calib_overhead(640, 480, s.height_m, scene_fov_rad(&s));
  vs_detector_def def = vs_detector_def_default();
  def.px_per_m = vs_calib_px_per_m(&c, VS_ROBOT_HEIGHT_M);
  vs_detector *detector;
  assert_ok(vs_detector_new(&def, &detector, err));
  for (int free_ball = 1; free_ball >= 0; free_ball--) {
    s.world.ball.valid = free_ball;
    vs_frame frame = scene_draw(&s, 0, 0);
    double x, y;
    assert_true(vs_calib_to_pixel(&c, 0.3, 0.2 + 0.05, VS_ROBOT_HEIGHT_M, &x, &y)); // 5 cm beside the patch's middle
    vs_image image = {s.bgr, 640, 480, 3 * 640};
    vs_image_disc(&image, x, y, 6, scene_orange);
    vs_detections seen;
    assert_ok(vs_detect(detector, &frame, &seen, err));
    assert_int_equal(seen.adversaries, 1);
    assert_int_equal(seen.balls, 1);
    assert_near(seen.ball[0].x_px, free_ball ? 320 - 0.4 * s.focal_px / (s.height_m - VS_BALL_RADIUS_M) : x, 1.5);
  }
  vs_detector_free(detector);
  scene_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_field_at_640x480_is_seen_within_a_millimetre),
      cmocka_unit_test(a_field_at_1280x720_is_seen_within_a_millimetre),
      cmocka_unit_test(blue_adversaries_are_looked_for_when_we_are_yellow),
      cmocka_unit_test(adversaries_side_by_side_are_still_three),
      cmocka_unit_test(a_tag_of_another_size_is_not_ours),
      cmocka_unit_test(colour_on_an_own_cap_is_neither_ball_nor_adversary),
      cmocka_unit_test(a_silly_definition_is_a_usage_error),
      cmocka_unit_test(a_ball_free_on_the_floor_goes_before_orange_beside_a_team_s_colour),
      cmocka_unit_test(the_real_footage_shows_every_labelled_robot_and_ball_and_no_phantom_by_the_defaults),
  };
  return cmocka_run_group_tests_name("vision/detect", tests, NULL, NULL);
}
