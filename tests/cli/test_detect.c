// src/cli/cmd_detect.c, through the real binary
#include <unistd.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "vision/scene.h"

static char folder[] = "/tmp/vsss_detect_XXXXXX";
static char arguments[1024];

static const char *in_folder(const char *format) {
  snprintf(arguments, sizeof arguments, format, folder, folder);
  return arguments;
}

// A field with tags 0, 1, 2, a ball and three yellow robots.
static int make_picture(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  static scene s;
  scene_init(&s, 640, 480);
  for (int i = 0; i < 3; i++) {
    s.world.robot[VS_BLUE][i] = (vs_robot){.pose = {-0.5 + 0.5 * i, 0.3, i}, .valid = true};
    s.world.robot[VS_YELLOW][i] = (vs_robot){.pose = {-0.5 + 0.5 * i, -0.3, i}, .valid = true};
  }
  s.world.ball.valid = true;
  vs_frame frame = scene_draw(&s, 0, 0);
  char path[64];
  snprintf(path, sizeof path, "%s/field.png", folder);
  vs_error err;
  vs_status status = vs_image_save(path, frame.bgr, frame.bgr_stride, 640, 480, &err);
  scene_free(&s);
  return status == VS_OK ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static void tags_are_listed_with_their_corners(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("detect %s/field.png --field"));
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "3 tags\n"));
  double x, y;
  assert_int_equal(sscanf(run.out, "tag 0 centre %lf %lf", &x, &y), 2);
  // (-0.5, 0.3) at 8 cm under a lens at 2.2 m, focal length 320 px/m * 2.2 m: scale 704 / 2.12 = 332.1 px/m.
  assert_near(x, 320 - 0.5 * 332.1, 0.3);
  assert_near(y, 240 - 0.3 * 332.1, 0.3);
}

static void json_and_colours_and_a_drawing_are_given_on_request(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("detect %s/field.png --json --colours --draw %s/seen.png"));
  assert_int_equal(run.status, 0);
  assert_int_equal(run.out[0], '{');
  assert_non_null(strstr(run.out, "\"tags\": ["));
  assert_non_null(strstr(run.out, "\"colour\": \"ball\""));
  int yellow = 0;
  for (char *p = run.out; (p = strstr(p, "\"colour\": \"yellow\"")); p++) yellow++;
  assert_int_equal(yellow, 3);
  char path[64];
  snprintf(path, sizeof path, "%s/seen.png", folder);
  assert_int_equal(access(path, R_OK), 0);
}

// The colours that the field plays with are the ones shown: a file that knows no yellow shows none.
static void colours_are_those_of_the_configuration(void **state) {
  (void)state;
  static vsss_run run;
  char path[64];
  snprintf(path, sizeof path, "%s/venue.ini", folder);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs("[vision]\nyellow_hue_min_deg = 120\nyellow_hue_max_deg = 130\n", f);
  fclose(f);
  vsss(&run, in_folder("detect %s/field.png --colours --config %s/venue.ini"));
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "1 ball, 0 blue, 0 yellow"));
  assert_refused("detect /dev/null --colours --config /nowhere/venue.ini", 1, "/dev/null");
  assert_refused(in_folder("detect %s/field.png --colours --config /nowhere/venue.ini"), 1, "/nowhere/venue.ini");
}

static void another_family_finds_nothing_and_is_no_error(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, in_folder("detect %s/field.png --family tag25h9"));
  assert_int_equal(run.status, 0);
  assert_string_equal(run.out, "0 tags\n");
}

static void bad_requests_are_one_line_with_the_fix(void **state) {
  (void)state;
  assert_refused("detect", 2, "give one picture");
  assert_refused("detect /nowhere/a.png", 1, "/nowhere/a.png");
  assert_refused("detect /dev/null", 1, "/dev/null");
  assert_refused("detect x:y", 2, "unknown camera 'x:y'");
  assert_refused(in_folder("detect %s/field.png --family tag99"), 2, "tagStandard41h12");
  assert_refused(in_folder("detect %s/field.png --decimate 0"), 2, "allowed are 1 to 8");
  assert_refused(in_folder("detect %s/field.png --draw /nowhere/a.png"), 1, "/nowhere/a.png");
}

static void the_real_photograph_gives_twelve_tags(void **state) {
  (void)state;
  const char *data = getenv("VSSS_REFERENCE_DATA");
  if (!data) {
    printf("note: VSSS_REFERENCE_DATA is not set\n");
    skip();
  }
  static vsss_run run;
  snprintf(arguments, sizeof arguments,
           "detect '%s/real/apriltag_33369213973_9d9bb4cc96_c.jpg' --family tag36h11 --decimate 1", data);
  vsss(&run, arguments);
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "12 tags\n"));
  int zeros = 0;
  for (char *p = run.out; (p = strstr(p, "tag 0  centre")); p++) zeros++;
  assert_int_equal(zeros, 12);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tags_are_listed_with_their_corners),
      cmocka_unit_test(json_and_colours_and_a_drawing_are_given_on_request),
      cmocka_unit_test(colours_are_those_of_the_configuration),
      cmocka_unit_test(another_family_finds_nothing_and_is_no_error),
      cmocka_unit_test(bad_requests_are_one_line_with_the_fix),
      cmocka_unit_test(the_real_photograph_gives_twelve_tags),
  };
  return cmocka_run_group_tests_name("cli/detect", tests, make_picture, remove_folder);
}
