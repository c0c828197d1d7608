// src/vision/colours_learn.c and src/vision/colours_save.c
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/colours.h"

enum { W = 80, H = 20 };
static uint8_t bgr[H][W][3];

// Four squares of 20 px: orange (hue 20), yellow (hue 60), blue (hue 220), pink (hue 333, saturation 0.5).
static vs_frame picture(void) {
  static const uint8_t colour[4][3] = {{0, 80, 240}, {40, 240, 240}, {240, 93, 20}, {173, 120, 240}};
  for (int i = 0; i < W * H; i++) memcpy(bgr[i / W][i % W], colour[i % W / 20], 3);
  return (vs_frame){.bgr = &bgr[0][0][0], .width = W, .height = H, .bgr_stride = 3 * W};
}

static vs_status load(const char *text, vs_colour_point *out, int *count, vs_error *why) {
  char path[64];
  snprintf(path, sizeof path, "/tmp/vsss_colours_%d.txt", (int)getpid());
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
  vs_status s = vs_colours_load_points(path, out, 8, count, why);
  unlink(path);
  return s;
}

static void labelled_points_set_ranges_with_room_around_what_was_seen(void **state) {
  (void)state;
  vs_frame frame = picture();
  vs_colour_point points[8];
  int count;
  vs_error why;
  assert_int_equal(load("# venue\n10 10 ball\n30 10 yellow # lit\n50 10 blue\n70 10 pink\n", points, &count, &why),
                   VS_OK);
  assert_int_equal(count, 4);
  vs_detector_def def = vs_detector_def_default();
  assert_ok(vs_colours_learn(&frame, points, count, &def, err));
  // 10 degrees of room: the plane's hue of (240, 80, 0) is atan2(0.866 * 80, 240 - 40) = 19.1 degrees.
  assert_near(def.ball.hue_min_deg, 9.1, 0.1);
  assert_near(def.ball.hue_max_deg, 29.1, 0.1);
  assert_near(def.team[VS_YELLOW].hue_min_deg, 50, 0.1);
  assert_near(def.ball.saturation_min, 0.6, 1e-9); // 0.6 of 1
  assert_near(def.team[VS_YELLOW].saturation_min, 0.6 * 200 / 240, 1e-9);
  assert_near(def.team[VS_BLUE].value_min, 0.6 * 240 / 255, 1e-9);
  // (240, 120, 173): x = 240 - 146.5, y = 0.866 * (120 - 173), over 240.
  assert_near(def.square[VS_PLATE_PINK].hue_deg, 360 + atan2(-45.9, 93.5) * 180 / M_PI, 0.1);
  assert_near(def.square[VS_PLATE_PINK].saturation, hypot(45.9, 93.5) / 240, 0.001);
  assert_near(def.square[VS_PLATE_RED].hue_deg, vs_plate_default[VS_PLATE_RED].hue_deg, 0); // without points
}

static void neighbours_nearer_than_the_room_share_the_way(void **state) {
  (void)state;
  vs_frame frame = picture();
  for (int i = 0; i < H * W; i++)
    if (i % W >= 20 && i % W < 40) memcpy(bgr[i / W][i % W], (uint8_t[]){0, 112, 240}, 3);
  vs_colour_point points[8] = {{10, 10, VS_COLOUR_BALL}, {30, 10, VS_COLOUR_YELLOW}};
  vs_detector_def def = vs_detector_def_default();
  assert_ok(vs_colours_learn(&frame, points, 2, &def, err));
  assert_near(def.ball.hue_max_deg, def.team[VS_YELLOW].hue_min_deg, 1e-9);
  assert_near(def.ball.hue_max_deg, 0.5 * (19.1 + 27.8), 0.1); // atan2(0.866 * 112, 240 - 56) = 27.8
}

static void bad_points_are_refused_with_their_place(void **state) {
  (void)state;
  vs_frame frame = picture();
  vs_colour_point points[8];
  int count;
  vs_error why;
  assert_int_equal(load("10 10 ball\n5 5 purple\n", points, &count, &why), VS_USAGE);
  assert_non_null(strstr(why.text, ":2:"));
  assert_non_null(strstr(why.text, "purple"));
  assert_int_equal(load("# nothing\n", points, &count, &why), VS_USAGE);
  char comment[300]; // its second half would have been read as a point
  memset(comment, '#', sizeof comment);
  snprintf(comment + 255, sizeof comment - 255, "10 10 ball\n");
  assert_int_equal(load(comment, points, &count, &why), VS_USAGE);
  assert_non_null(strstr(why.text, ":1: line longer than 254 characters"));
  vs_detector_def def = vs_detector_def_default();
  points[0] = (vs_colour_point){79, 10, VS_COLOUR_BALL};
  assert_int_equal(vs_colours_learn(&frame, points, 1, &def, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "80 x 20"));
  points[0] = (vs_colour_point){NAN, 10, VS_COLOUR_BALL};
  assert_int_equal(vs_colours_learn(&frame, points, 1, &def, &why), VS_USAGE);
  memset(bgr, 90, sizeof bgr);
  points[0].x_px = 40;
  assert_int_equal(vs_colours_learn(&frame, points, 1, &def, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "grey"));
}

static void a_copy_of_the_configuration_changes_in_its_colours_only(void **state) {
  (void)state;
  char from[80], to[80], text[4096];
  snprintf(from, sizeof from, "/tmp/vsss_from_%d.ini", (int)getpid());
  snprintf(to, sizeof to, "/tmp/vsss_to_%d.ini", (int)getpid());
  FILE *f = fopen(from, "w");
  assert_non_null(f);
  fputs("; ours\n[field]\nteam = blue\n[vision]\nball_hue_min_deg = 1 ; red\nfps = 60\n[lcm]\nimage_hz = 0", f);
  fclose(f);
  vs_detector_def def = vs_detector_def_default();
  def.ball.hue_min_deg = 7.5;
  def.square[VS_PLATE_CYAN].saturation = 0.33;
  assert_ok(vs_colours_save(to, from, &def, err));
  f = fopen(to, "r");
  assert_non_null(f);
  text[fread(text, 1, sizeof text - 1, f)] = '\0';
  fclose(f);
  assert_non_null(strstr(text, "; ours\n[field]\nteam = blue\n[vision]\nball_hue_min_deg = 7.5 ; red\nfps = 60\n"));
  assert_non_null(strstr(text, "\ncyan_saturation = 0.33\n"));
  assert_non_null(strstr(text, "[lcm]\nimage_hz = 0\n"));
  assert_true(strstr(text, "cyan_saturation") < strstr(text, "[lcm]"));
  unlink(from);
  unlink(to);
  vs_error why;
  assert_int_equal(vs_colours_save(to, "/nowhere/field.ini", &def, &why), VS_FAIL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(labelled_points_set_ranges_with_room_around_what_was_seen),
      cmocka_unit_test(neighbours_nearer_than_the_room_share_the_way),
      cmocka_unit_test(bad_points_are_refused_with_their_place),
      cmocka_unit_test(a_copy_of_the_configuration_changes_in_its_colours_only),
  };
  return cmocka_run_group_tests_name("vision/colours", tests, NULL, NULL);
}
