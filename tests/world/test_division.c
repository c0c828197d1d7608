// src/world/division.c and what worlds of five robots a side change in src/world/world.c
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/world.h"

static void three_against_three_is_the_field_header(void **state) {
  (void)state;
  const vs_pitch *p = vs_pitch_of(VS_3V3);
  assert_int_equal(p->team_size, VS_TEAM_SIZE);
  assert_true(p->half_length_m == VS_FIELD_HALF_LENGTH_M && p->half_width_m == VS_FIELD_HALF_WIDTH_M);
  assert_true(p->goal_half_width_m == VS_GOAL_HALF_WIDTH_M && p->goal_depth_m == VS_GOAL_DEPTH_M);
  assert_true(p->area_depth_m == VS_AREA_DEPTH_M && p->area_half_width_m == VS_AREA_HALF_WIDTH_M);
}

// 2.2 x 1.8 m, areas of 50 x 15 cm, the penalty mark 37.5 cm before the goal line: FIRASim's Division A.
static void five_against_five_has_its_own_field(void **state) {
  (void)state;
  const vs_pitch *p = vs_pitch_of(VS_5V5);
  assert_int_equal(p->team_size, 5);
  assert_near(2 * p->half_length_m, 2.2, 1e-12);
  assert_near(2 * p->half_width_m, 1.8, 1e-12);
  assert_near(2 * p->area_half_width_m, 0.5, 1e-12);
  assert_near(p->half_length_m - p->penalty_mark_x_m, 0.375, 1e-12);
  assert_true(p->team_size <= VS_TEAM_MOST);
}

static void divisions_are_found_by_name_and_others_refused(void **state) {
  (void)state;
  vs_division division = VS_3V3;
  vs_error why = {0};
  assert_ok(vs_division_parse("5v5", &division, err));
  assert_int_equal(division, VS_5V5);
  assert_int_equal(vs_division_parse("4v4", &division, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "expected 3v3 or 5v5"));
  assert_ok(vs_division_wants_3v3(VS_3V3, "x", err));
  assert_int_equal(vs_division_wants_3v3(VS_5V5, "the learned policy", &why), VS_USAGE);
  assert_non_null(strstr(why.text, "the learned policy plays 3v3 only"));
  assert_non_null(strstr(why.text, "--division 3v3"));
}

static vs_world five(void) {
  vs_world w = {.division = VS_5V5};
  for (int i = 0; i < 10; i++) w.robot[i / 5][i % 5].pose = (vs_pose){0.1 * i, 0.05 * i, 0.2};
  return w;
}

static void yellow_sees_all_five_turned(void **state) {
  (void)state;
  vs_world w = five(), view;
  vs_world_for_team(&w, VS_YELLOW, &view);
  assert_near(view.robot[VS_OWN][4].pose.x_m, -0.9, 1e-12);
  assert_near(view.robot[VS_ADVERSARY][3].pose.x_m, -0.3, 1e-12);
  assert_int_equal(view.division, VS_5V5);
}

static void the_fifth_robot_counts_for_hash_and_check_in_5v5_alone(void **state) {
  (void)state;
  vs_world w = five();
  uint64_t hash = vs_world_hash(VS_HASH_START, &w);
  w.robot[VS_YELLOW][4].pose.x_m += 1e-9;
  assert_true(vs_world_hash(VS_HASH_START, &w) != hash);
  w.robot[VS_YELLOW][4].pose.x_m = 1.5; // on a field of 1.1, but far from one of 0.75
  assert_ok(vs_world_check(&w, err));
  w.robot[VS_YELLOW][4].pose.x_m = 3;
  assert_int_equal(vs_world_check(&w, NULL), VS_FAIL);
  w.division = VS_3V3;
  assert_ok(vs_world_check(&w, err));
  hash = vs_world_hash(VS_HASH_START, &w);
  w.robot[VS_YELLOW][4].pose.x_m = 0;
  assert_true(vs_world_hash(VS_HASH_START, &w) == hash);
  w.division = (vs_division)7;
  assert_false(vs_world_ok(&w));
}

static void five_unseen_and_five_sent_off_stand_apart(void **state) {
  (void)state;
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < 5; i++) {
      vs_pose parked = vs_world_parked(VS_5V5, (vs_team)t, i), beside = vs_world_beside(VS_5V5, (vs_team)t, i);
      assert_true(fabs(parked.x_m) < 1.06 && fabs(parked.y_m) < 0.86 && fabs(parked.y_m) > 0.5);
      assert_true(beside.y_m > 0.9 + VS_BESIDE_M && fabs(beside.x_m) < 1.1);
      for (int k = 0; k < i; k++) {
        vs_pose other = vs_world_parked(VS_5V5, (vs_team)t, k);
        assert_true(vs_distance_m(parked.x_m, parked.y_m, other.x_m, other.y_m) > 0.11);
      }
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_against_three_is_the_field_header),
      cmocka_unit_test(five_against_five_has_its_own_field),
      cmocka_unit_test(divisions_are_found_by_name_and_others_refused),
      cmocka_unit_test(yellow_sees_all_five_turned),
      cmocka_unit_test(the_fifth_robot_counts_for_hash_and_check_in_5v5_alone),
      cmocka_unit_test(five_unseen_and_five_sent_off_stand_apart),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
