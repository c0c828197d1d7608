// src/referee/placement.c, src/referee/referee.c and src/referee/idle.c with five robots a team on 2.2 x 1.8 m
#include <string.h>

#include "referee/referee_world.h"
#include "vsss/geom.h"

static vs_world quiet(double ball_x_m, double ball_y_m) {
  vs_world w = {.division = VS_5V5};
  for (int i = 0; i < 5; i++) {
    w.robot[VS_BLUE][i].pose = (vs_pose){-0.6, 0.2 * (i - 2), 0};
    w.robot[VS_YELLOW][i].pose = (vs_pose){0.6, 0.2 * (i - 2), 0};
  }
  w.ball = (vs_ball){.x_m = ball_x_m, .y_m = ball_y_m, .z_m = VS_BALL_RADIUS_M, .valid = true};
  return w;
}

static const struct {
  vs_event_kind kind;
  int first_quadrant, last_quadrant;
} restarts[] = {{VS_EVENT_KICK_OFF, 0, 0},  {VS_EVENT_PENALTY, 0, 0},   {VS_EVENT_FREE_BALL, 0, 4},
                {VS_EVENT_GOAL_KICK, 1, 4}, {VS_EVENT_FREE_KICK, 0, 0}, {VS_EVENT_SHOOT_OUT, 0, 0},
                {VS_EVENT_GOAL, 0, 0}};

// Legal, apart from one another and from the ball: the fixed poses and 20 draws of the random ones, for either team.
static void every_restart_places_ten_robots_legally(void **state) {
  (void)state;
  const vs_world before = quiet(0, 0);
  vs_rng rng = vs_rng_make(7, 0);
  for (size_t k = 0; k < sizeof restarts / sizeof *restarts; k++)
    for (int q = restarts[k].first_quadrant; q <= restarts[k].last_quadrant; q++)
      for (int draw = 0; draw < 2 * 21; draw++) {
        vs_event event = {.kind = restarts[k].kind, .team = draw % 2 ? VS_YELLOW : VS_BLUE, .quadrant = q};
        vs_world w;
        vs_place(draw < 2 ? VS_PLACEMENT_PAPER : VS_PLACEMENT_RANDOM, &event, &before, &rng, &w);
        assert_int_equal(w.division, VS_5V5);
        for (int t = 0; t < VS_TEAMS; t++) {
          vs_pose pose[VS_TEAM_MOST];
          for (int i = 0; i < 5; i++) pose[i] = w.robot[t][i].pose;
          vs_error why = {0};
          // A random kicker of a kick-off may stand anywhere in its half.
          bool drawn_kick_off = draw >= 2 && (event.kind == VS_EVENT_KICK_OFF || event.kind == VS_EVENT_GOAL);
          if (!drawn_kick_off && vs_placement_check(VS_5V5, &event, (vs_team)t, pose, &why) != VS_OK)
            fail_msg("%s, quadrant %d, draw %d, %s: %s", vs_event_name(event.kind), q, draw, vs_team_name((vs_team)t),
                     why.text);
        }
        for (int i = 0; i < 10; i++)
          for (int j = 0; j < i; j++) {
            const vs_pose *a = &w.robot[i / 5][i % 5].pose, *b = &w.robot[j / 5][j % 5].pose;
            assert_true(vs_distance_m(a->x_m, a->y_m, b->x_m, b->y_m) > 0.09);
          }
      }
}

// Of the ball: penalty 37.5 cm before the goal line, free balls at a quarter and a third, goal kicks from the area's corner.
static void the_ball_lies_on_the_divisions_marks(void **state) {
  (void)state;
  const struct {
    vs_event event;
    double x_m, y_m;
  } row[] = {{{.kind = VS_EVENT_PENALTY, .team = VS_BLUE}, 0.725, 0},
             {{.kind = VS_EVENT_PENALTY, .team = VS_YELLOW}, -0.725, 0},
             {{.kind = VS_EVENT_FREE_BALL, .quadrant = 2}, -0.55, 0.6},
             {{.kind = VS_EVENT_GOAL_KICK, .team = VS_BLUE, .quadrant = 3}, -0.95, -0.25},
             {{.kind = VS_EVENT_GOAL_KICK, .team = VS_YELLOW, .quadrant = 1}, 0.95, 0.25}};
  const vs_world before = quiet(0, 0);
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    vs_world w;
    vs_place(VS_PLACEMENT_PAPER, &row[k].event, &before, NULL, &w);
    assert_near(w.ball.x_m, row[k].x_m, 1e-12);
    assert_near(w.ball.y_m, row[k].y_m, 1e-12);
  }
}

static void open_play_is_drawn_on_the_whole_field(void **state) {
  (void)state;
  const vs_world before = quiet(0, 0);
  vs_rng rng = vs_rng_make(1, 0);
  double farthest_m = 0;
  for (int k = 0; k < 200; k++) {
    vs_world w;
    vs_place_open_play(&before, &rng, &w);
    for (int i = 0; i < 10; i++) {
      const vs_pose *p = &w.robot[i / 5][i % 5].pose;
      assert_true(fabs(p->x_m) < 1.06 && fabs(p->y_m) < 0.86);
      farthest_m = fmax(farthest_m, fabs(p->x_m));
    }
  }
  assert_true(farthest_m > 1.0);
}

// 1.1 m and the ball's radius: a ball at 1.1 m has not crossed the line, one at 0.9 m is no goal.
static void a_goal_is_behind_the_longer_field(void **state) {
  (void)state;
  vs_world w = quiet(1.1, 0);
  vs_referee r = referee_of(VS_RULES_LEAGUE, &w);
  assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  w.ball.x_m = 0.9;
  assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  w.ball.x_m = 1.13;
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_GOAL, VS_BLUE, 0);
  w = quiet(0, 0.89);
  r = referee_of(VS_RULES_LEAGUE, &w);
  assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  w.ball.y_m = 0.93; // over the wall
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 1);
}

// Two defenders, the fifth robot one of them, in the area of 50 x 15 cm; at y = 0.30 it would be 3 against 3's.
static void the_fifth_defender_in_the_area_is_a_penalty(void **state) {
  (void)state;
  vs_world w = quiet(-1.0, 0.1);
  put(&w, VS_BLUE, 0, -1.05, 0);
  put(&w, VS_BLUE, 4, -1.0, 0.30);
  vs_referee r = referee_of(VS_RULES_PAPER, &w);
  assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_NONE);
  put(&w, VS_BLUE, 4, -1.0, 0.20);
  assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_PENALTY, VS_YELLOW, 0);
}

static void the_idle_rule_sends_the_fifth_robot_off(void **state) {
  (void)state;
  vs_world w = quiet(0.3, 0.3);
  vs_referee r = referee_of(VS_RULES_LARC_2026, &w);
  bool off = false;
  for (int f = 0; f < 25 * 30 && !off; f++) {
    for (int i = 0; i < 9; i++) w.robot[i / 5][i % 5].pose.x_m += f % 30 < 15 ? 0.01 : -0.01; // all but yellow 4 move
    w.ball.x_m = 0.3 + 0.1 * (f / 30 % 2);
    vs_event event = vs_referee_step(&r, &w, FRAME_S);
    off = event.kind == VS_EVENT_SENT_OFF && event.team == VS_YELLOW;
  }
  assert_true(off && vs_referee_off(&r, VS_YELLOW, 4));
  for (int i = 0; i < 9; i++) assert_false(vs_referee_off(&r, (vs_team)(i / 5), i % 5));
  vs_world placed = w;
  vs_place_without(&r, &placed);
  assert_near(placed.robot[VS_YELLOW][4].pose.y_m, 0.9 + VS_BESIDE_M + 0.05, 1e-12);
}

// Receivers at a free kick: two at their area's line, one a quadrant; the others beyond the half-way line and nowhere else.
static void a_free_kicks_third_and_fourth_receiver_wait_beyond_the_half_line(void **state) {
  (void)state;
  const vs_event event = {.kind = VS_EVENT_FREE_KICK, .team = VS_BLUE};
  vs_error why = {0};
  vs_pose pose[VS_TEAM_MOST];
  vs_place_team(VS_5V5, &event, VS_YELLOW, pose);
  assert_ok(vs_placement_check(VS_5V5, &event, VS_YELLOW, pose, err));
  pose[4] = (vs_pose){0.3, -0.6, 0};
  assert_int_equal(vs_placement_check(VS_5V5, &event, VS_YELLOW, pose, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "robot 4"));
  pose[4] = (vs_pose){0.91, 0.1, 0};
  assert_int_equal(vs_placement_check(VS_5V5, &event, VS_YELLOW, pose, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "second of its quadrant"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_restart_places_ten_robots_legally),
      cmocka_unit_test(the_ball_lies_on_the_divisions_marks),
      cmocka_unit_test(open_play_is_drawn_on_the_whole_field),
      cmocka_unit_test(a_goal_is_behind_the_longer_field),
      cmocka_unit_test(the_fifth_defender_in_the_area_is_a_penalty),
      cmocka_unit_test(the_idle_rule_sends_the_fifth_robot_off),
      cmocka_unit_test(a_free_kicks_third_and_fourth_receiver_wait_beyond_the_half_line),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
