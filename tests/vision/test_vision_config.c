// src/vision/vision_config.c and the [vision] section of deploy/config/field.ini
#include <stdio.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/paths.h"
#include "vsss/tag.h"
#include "vsss/vision_config.h"

enum { ROOM = 120 };
static vs_detector_def detector;
static vs_track_def tracker;
static vs_camera_def camera;
static vs_vision_words words;
static vs_config_key rows[ROOM + 1];

static int schema(void) {
  memset(rows, 0, sizeof rows);
  detector = vs_detector_def_default();
  tracker = vs_track_def_default();
  camera = vs_camera_def_default();
  return vs_vision_schema(&detector, &tracker, &camera, &words, rows, ROOM);
}

static void every_row_has_a_name_of_the_section_a_target_and_help(void **state) {
  (void)state;
  int n = schema();
  assert_true(n > 30 && n < ROOM); // below its capacity: nothing was cut off
  for (int i = 0; i < n; i++) {
    assert_int_equal(strncmp(rows[i].name, "vision.", 7), 0);
    assert_non_null(rows[i].target);
    assert_true(strlen(rows[i].help) > 3);
    for (int j = 0; j < i; j++) {
      assert_string_not_equal(rows[i].name, rows[j].name);
      assert_ptr_not_equal(rows[i].target, rows[j].target);
    }
  }
}

static void a_file_sets_what_it_names_and_leaves_the_rest(void **state) {
  (void)state;
  schema();
  assert_ok(vs_config_parse("field.ini",
                            "[vision]\ntag_family = tag25h9\nrobot2_tag = 11\nrobot2_yaw_rad = 1.5\n"
                            "ball_hue_min_deg = 8\nexposure_ms = 3\ntag_decimate = 1.5\n",
                            rows, err));
  assert_string_equal(detector.tag.family, "tag25h9");
  assert_int_equal(tracker.tag_id[2], 11);
  assert_int_equal(tracker.tag_id[1], 1);
  assert_near(tracker.tag_yaw_rad[2], 1.5, 0);
  assert_near(detector.ball.hue_min_deg, 8, 0);
  assert_near(detector.ball.hue_max_deg, vs_detector_def_default().ball.hue_max_deg, 0);
  assert_near(camera.exposure_ms, 3, 0);
  assert_near(detector.tag.decimate, 1.5, 0);
}

static void without_a_file_the_family_is_the_default(void **state) {
  (void)state;
  schema();
  assert_string_equal(detector.tag.family, VS_TAG_FAMILY);
  assert_ptr_equal(detector.tag.family, words.family);
}

static void kinds_of_marks_and_their_ids_are_taken_from_the_file(void **state) {
  (void)state;
  schema();
  assert_ok(
      vs_config_parse("field.ini", "[vision]\nown_tags = aruco\ntheir_tags = aruco\nyellow1_aruco = -1\n", rows, err));
  assert_ok(vs_vision_take(&words, &detector, &tracker, err));
  assert_true(detector.own == VS_MARK_ARUCO && detector.their == VS_MARK_ARUCO);
  assert_true(tracker.own == VS_MARK_ARUCO && tracker.their == VS_MARK_ARUCO);
  assert_int_equal(tracker.aruco_id[VS_BLUE][0], 256);
  assert_int_equal(detector.tag.ids, 5);
  vs_error err;
  strcpy(words.their_tags, "april");
  assert_int_equal(vs_vision_take(&words, &detector, &tracker, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "vision.their_tags"));
}

static void a_value_out_of_range_is_refused_with_its_line(void **state) {
  (void)state;
  schema();
  vs_error err;
  assert_int_equal(vs_config_parse("field.ini", "[vision]\n\ntag_height_m = 80\n", rows, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "field.ini:3"));
  assert_non_null(strstr(err.text, "vision.tag_height_m"));
}

static void no_more_than_the_capacity_is_written(void **state) {
  (void)state;
  memset(rows, 0, sizeof rows);
  assert_int_equal(vs_vision_schema(&detector, &tracker, &camera, &words, rows, 5), 5);
  assert_null(rows[5].name);
}

// The shipped file shows every key of the section with the default that the program has.
static void the_shipped_file_shows_every_key_at_its_default(void **state) {
  (void)state;
  int n = schema();
  char path[4096];
  assert_ok(vs_path_find("deploy/config/field.ini", path, sizeof path, err));
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  char line[512], section[512] = "";
  bool inside = false;
  size_t used = 0;
  static char text[16384];
  while (fgets(line, sizeof line, f)) {
    if (line[0] == '[') inside = sscanf(line, "[%[a-z]]", section) == 1 && !strcmp(section, "vision");
    if (inside) used += (size_t)snprintf(text + used, sizeof text - used, "%s", line);
  }
  fclose(f);
  for (int i = 0; i < n; i++) {
    char key[96];
    snprintf(key, sizeof key, "\n%s = ", rows[i].name + strlen("vision."));
    if (!strstr(text, key)) fail_msg("deploy/config/field.ini does not show %s", rows[i].name);
    if (rows[i].type == VS_CONFIG_REAL) *(double *)rows[i].target += 0.01; // to see that the file sets it
  }
  assert_ok(vs_config_parse("field.ini", text, rows, err));
  vs_detector_def d = vs_detector_def_default();
  vs_track_def t = vs_track_def_default();
  vs_camera_def c = vs_camera_def_default();
  vs_vision_words name;
  static vs_config_key defaults[ROOM];
  assert_int_equal(vs_vision_schema(&d, &t, &c, &name, defaults, ROOM), n);
  for (int i = 0; i < n; i++) {
    const void *file = rows[i].target, *own = defaults[i].target;
    bool same = rows[i].type == VS_CONFIG_REAL  ? fabs(*(const double *)file - *(const double *)own) < 1e-12
                : rows[i].type == VS_CONFIG_INT ? *(const int *)file == *(const int *)own
                                                : !strcmp(file, own);
    if (!same) fail_msg("deploy/config/field.ini: %s is not the default", rows[i].name);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_has_a_name_of_the_section_a_target_and_help),
      cmocka_unit_test(a_file_sets_what_it_names_and_leaves_the_rest),
      cmocka_unit_test(without_a_file_the_family_is_the_default),
      cmocka_unit_test(kinds_of_marks_and_their_ids_are_taken_from_the_file),
      cmocka_unit_test(a_value_out_of_range_is_refused_with_its_line),
      cmocka_unit_test(the_shipped_file_shows_every_key_at_its_default),
      cmocka_unit_test(no_more_than_the_capacity_is_written),
  };
  return cmocka_run_group_tests_name("vision/vision_config", tests, NULL, NULL);
}
