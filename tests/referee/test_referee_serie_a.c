// Tests src/referee/referee_serie_a.c: one test a row of both tables, in both areas.
#include "referee/referee_world.h"

#include "vsss/geom.h"

static vs_world turned(const vs_world *w, int defender) {
  vs_world out;
  vs_world_for_team(w, (vs_team)defender, &out);
  return out;
}

static vs_team other(int team) { return team == VS_BLUE ? VS_YELLOW : VS_BLUE; }

// The ball in defender's area at (-0.65, 0.05), or turned; its keeper on the line.
static vs_world in_area(void) {
  vs_world w = quiet_world(-0.65, 0.05);
  put(&w, VS_BLUE, 0, -0.71, -0.1);
  return w;
}

#define FOR_BOTH(rules, defender)                                                                                      \
  for (int rules = VS_RULES_SERIE_A_2023; rules <= VS_RULES_LARC_2026; rules++)                                        \
    for (int defender = 0; defender < VS_TEAMS; defender++)

static void a_match_is_two_halves_of_five_minutes_and_ends_at_ten_goals(void **state) {
  (void)state;
  for (int rules = VS_RULES_SERIE_A_2023; rules <= VS_RULES_LARC_2026; rules++) {
    vs_referee_def def = vs_referee_def_default((vs_rules)rules);
    assert_near(def.duration_s, 600, 0);
    assert_int_equal(def.halves, 2);
    assert_int_equal(def.goal_difference_stop, 10);
    vs_world w = quiet_world(0.1, 0);
    vs_referee r = referee_of((vs_rules)rules, &w);
    r.game.time_s = 300 - FRAME_S;
    assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
    r.game.time_s = 600 - FRAME_S;
    assert_int_equal(vs_referee_step(&r, &w, FRAME_S).kind, VS_EVENT_END);
  }
}

// The league's automatic referee would count the two; here only a touch matters, and a goal counts.
static void two_defenders_alone_are_no_foul_and_a_goal_counts(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world play = in_area(), goal = quiet_world(-0.8, 0.05);
    put(&play, VS_BLUE, 1, -0.65, 0.25);
    play = turned(&play, d);
    goal = turned(&goal, d);
    vs_referee r = referee_of((vs_rules)rules, &play);
    for (int k = 0; k < 150; k++) assert_int_equal(vs_referee_step(&r, &play, FRAME_S).kind, VS_EVENT_NONE);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, other(d), 0);
  }
}

// The second one touches the ball: nothing until the ball leaves the area, then a penalty; a goal meanwhile counts.
static void second_defender_that_touches_is_a_penalty_once_the_ball_is_out(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    for (int scored = 0; scored < 2; scored++) {
      vs_world touch = in_area(), after = quiet_world(scored ? -0.8 : -0.5, 0.05);
      put(&touch, VS_BLUE, 1, -0.65, 0.11); // 6 cm from the ball: 4 cm of robot, 2.1 of ball
      touch = turned(&touch, d);
      after = turned(&after, d);
      vs_referee r = referee_of((vs_rules)rules, &touch);
      for (int k = 0; k < 30; k++) assert_int_equal(vs_referee_step(&r, &touch, FRAME_S).kind, VS_EVENT_NONE);
      assert_event(vs_referee_step(&r, &after, FRAME_S), scored ? VS_EVENT_GOAL : VS_EVENT_PENALTY, other(d), 0);
    }
  }
}

static void the_keeper_may_touch(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world touch = in_area(), after = quiet_world(-0.5, 0.05);
    put(&touch, VS_BLUE, 0, -0.71, 0.05);
    touch = turned(&touch, d);
    after = turned(&after, d);
    vs_referee r = referee_of((vs_rules)rules, &touch);
    for (int k = 0; k < 30; k++) assert_int_equal(vs_referee_step(&r, &touch, FRAME_S).kind, VS_EVENT_NONE);
    assert_int_equal(vs_referee_step(&r, &after, FRAME_S).kind, VS_EVENT_NONE);
  }
}

// One attacker at the ball is allowed, and another that stands by; one that touches the keeper is not.
static void second_attacker_that_interferes_is_a_goal_kick(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world w = in_area();
    put(&w, VS_YELLOW, 0, -0.58, 0.05);
    put(&w, VS_YELLOW, 0, -0.61, 0.1);
    put(&w, VS_YELLOW, 1, -0.62, -0.3);
    vs_world by = turned(&w, d);
    vs_referee r = referee_of((vs_rules)rules, &by);
    assert_int_equal(vs_referee_step(&r, &by, FRAME_S).kind, VS_EVENT_NONE);
    put(&w, VS_YELLOW, 1, -0.63, -0.1); // 8 cm from the keeper
    vs_world pushes = turned(&w, d);
    assert_event(vs_referee_step(&r, &pushes, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, d == VS_BLUE ? 2 : 4);
  }
}

static void an_attackers_goal_with_a_second_one_interfering_is_a_goal_kick(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world w = in_area(), goal = quiet_world(-0.8, 0.05);
    put(&w, VS_YELLOW, 0, -0.61, 0.1);
    put(&w, VS_YELLOW, 1, -0.63, -0.1);
    w = turned(&w, d);
    goal = turned(&goal, d);
    vs_referee r = referee_of((vs_rules)rules, &w);
    assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_GOAL_KICK, (vs_team)d, d == VS_BLUE ? 2 : 4);
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, other(d), 0); // the foul is done with
  }
}

static void a_keeper_that_does_not_clear_for_10_s_is_a_penalty(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world w = in_area();
    w = turned(&w, d);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_PENALTY, other(d), 0);
    assert_near(took_s, 10, FRAME_S);
  }
}

// An attacker within 1.5 robots of the ball contests it.
static void a_contested_ball_in_an_area_for_10_s_is_a_goal_kick(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world w = in_area();
    put(&w, VS_YELLOW, 0, -0.58, 0.1);
    w = turned(&w, d);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_GOAL_KICK, (vs_team)d, d == VS_BLUE ? 2 : 4);
    assert_near(took_s, 10, FRAME_S);
  }
}

static void a_contested_ball_after_the_defenders_foul_is_a_penalty(void **state) {
  (void)state;
  FOR_BOTH(rules, d) {
    vs_world w = in_area();
    put(&w, VS_YELLOW, 0, -0.58, 0.0);
    put(&w, VS_BLUE, 1, -0.65, 0.11);
    w = turned(&w, d);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_PENALTY, other(d), 0);
    assert_near(took_s, 10, FRAME_S);
  }
}

// Yellow 1 drives at 0.3 m/s against blue 1 and moves it; the ball is elsewhere. At (x, y) or turned.
static vs_world pushing_at(double x_m, double y_m) {
  vs_world w = quiet_world(0.3, -0.5);
  put(&w, VS_BLUE, 1, x_m, y_m);
  put(&w, VS_YELLOW, 1, x_m + 0.08, y_m);
  w.robot[VS_BLUE][1].vx_mps = w.robot[VS_YELLOW][1].vx_mps = -0.3;
  return w;
}

static void pushing_without_the_ball_for_1_s_is_a_free_kick(void **state) {
  (void)state;
  FOR_BOTH(rules, pushed) {
    vs_world w = pushing_at(-0.2, 0.3);
    w = turned(&w, pushed);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 5, &took_s), VS_EVENT_FREE_KICK, (vs_team)pushed, 0);
    assert_near(took_s, 1, FRAME_S);
  }
}

// Not a foul: at the ball, against one that stands, not touching, or for less than a second at a time.
static void a_fight_for_the_ball_or_a_short_bump_is_no_pushing(void **state) {
  (void)state;
  for (int rules = VS_RULES_SERIE_A_2023; rules <= VS_RULES_LARC_2026; rules++)
    for (int what = 0; what < 4; what++) {
      vs_world w = pushing_at(-0.2, 0.3), apart = quiet_world(0.3, -0.5);
      if (what == 0) w.ball.x_m = -0.25, w.ball.y_m = 0.4;
      if (what == 1) w.robot[VS_BLUE][1].vx_mps = 0;
      if (what == 2) put(&w, VS_YELLOW, 1, -0.1, 0.3);
      vs_referee r = referee_of((vs_rules)rules, &w);
      for (int k = 0; k < 120; k++) {
        const vs_world *now = what == 3 && k % 29 == 28 ? &apart : &w;
        assert_int_equal(vs_referee_step(&r, now, FRAME_S).kind, VS_EVENT_NONE);
      }
    }
}

static void a_keeper_pushed_in_its_area_is_a_goal_kick(void **state) {
  (void)state;
  FOR_BOTH(rules, pushed) {
    vs_world w = pushing_at(-0.7, -0.1);
    w = turned(&w, pushed);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 5, &took_s), VS_EVENT_GOAL_KICK, (vs_team)pushed, pushed == VS_BLUE ? 3 : 1);
    assert_near(took_s, 1, FRAME_S);
  }
}

static void pushing_in_the_own_area_is_a_penalty(void **state) {
  (void)state;
  FOR_BOTH(rules, pushed) {
    vs_world w = pushing_at(0.65, 0.2);
    w = turned(&w, pushed);
    vs_referee r = referee_of((vs_rules)rules, &w);
    double took_s;
    assert_event(wait_for_event(&r, &w, 5, &took_s), VS_EVENT_PENALTY, (vs_team)pushed, 0);
  }
}

// From face to centre 4 cm, the ball's diameter 4.27 cm: with the centres 5.07 cm apart a quarter of it is covered, with 4.64 cm 35 %.
static void covering_more_than_30_percent_of_the_ball_is_holding(void **state) {
  (void)state;
  const struct {
    double x_m, y_m; // of the ball
    double apart_m;
    vs_event_kind kind; // blue 1 holds, behind the ball
    int quadrant;
  } row[] = {{0.2, 0.3, 0.0507, VS_EVENT_NONE, 0},
             {0.2, 0.3, 0.0464, VS_EVENT_FREE_KICK, 0},
             {-0.65, 0.2, 0.0464, VS_EVENT_PENALTY, 0},
             {0.7, 0.2, 0.0464, VS_EVENT_GOAL_KICK, 1}};
  FOR_BOTH(rules, holder) {
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
      vs_world w = quiet_world(row[k].x_m, row[k].y_m);
      put(&w, VS_BLUE, 1, row[k].x_m - row[k].apart_m, row[k].y_m);
      vs_world over = w;
      over.ball.z_m = 0.11;
      w = turned(&w, holder);
      over = turned(&over, holder);
      vs_referee r = referee_of((vs_rules)rules, &w);
      assert_int_equal(vs_referee_step(&r, &over, FRAME_S).kind, VS_EVENT_NONE); // it flies over the robot
      vs_event event = vs_referee_step(&r, &w, FRAME_S);
      int quadrant = row[k].quadrant && holder == VS_YELLOW ? 3 : row[k].quadrant;
      assert_event(event, row[k].kind, row[k].kind == VS_EVENT_NONE ? VS_BLUE : other(holder), quadrant);
    }
  }
}

// Who has left its place by more than 3 cm before play begins: nobody, one team, both; in a shoot-out there is no free kick.
static void a_false_start_is_the_others_free_kick(void **state) {
  (void)state;
  for (int rules = VS_RULES_PAPER; rules <= VS_RULES_LARC_2026; rules++)
    for (int who = 0; who < 4; who++)
      for (int shoot_out = 0; shoot_out < 2; shoot_out++) {
        vs_world placed = quiet_world(0, 0), now = placed;
        for (int t = 0; t < VS_TEAMS; t++) {
          now.robot[t][1].pose.x_m += who & 1 << t ? 0.031 : 0.029;
          now.robot[t][2].pose.theta_rad += 1; // turning is no leaving
        }
        vs_referee r = referee_of((vs_rules)rules, &placed);
        if (shoot_out) r.half = VS_HALF_SHOOT_OUT;
        r.free_balls = 1;
        vs_event event;
        vs_start start = vs_referee_start(&r, &placed, &now, &event);
        bool judged = rules >= VS_RULES_SERIE_A_2023 && who != 0, foul = judged && who != 3 && !shoot_out;
        assert_int_equal(start, foul ? VS_START_FOUL : judged ? VS_START_PUT_BACK : VS_START_PLAY);
        assert_event(event, foul ? VS_EVENT_FREE_KICK : VS_EVENT_NONE, foul && who == 1 ? VS_YELLOW : VS_BLUE, 0);
        assert_int_equal(r.game.last_event.kind, foul ? VS_EVENT_FREE_KICK : VS_EVENT_KICK_OFF);
        assert_int_equal(r.free_balls, !foul);
      }
}

// Blue 1 stands, the others move. Warned after 10 s, sent off after 20 by LARC's rules alone, back at half time; play and
// its clocks go on.
static void an_idle_robot_is_sent_off_until_half_time_in_larc_only(void **state) {
  (void)state;
  for (int rules = VS_RULES_PAPER; rules <= VS_RULES_LARC_2026; rules++) {
    vs_world w = quiet_world(0.1, 0.1);
    vs_referee r = referee_of((vs_rules)rules, &w);
    r.free_balls = 1;
    int sent_off = 0;
    for (int k = 0; k < 21 * 30; k++) {
      for (int t = 0; t < VS_TEAMS; t++)
        for (int i = 0; i < VS_TEAM_SIZE; i++)
          if (t != VS_BLUE || i != 1) put(&w, (vs_team)t, i, (t ? 0.4 : -0.4) + 0.1 * sin(k * FRAME_S), 0.2 * (i - 1));
      w.ball.x_m = 0.1 + 0.05 * sin(k * FRAME_S);
      vs_event event = vs_referee_step(&r, &w, FRAME_S);
      if (event.kind == VS_EVENT_NONE || event.kind == VS_EVENT_FREE_BALL) continue;
      assert_event(event, VS_EVENT_SENT_OFF, VS_BLUE, 0);
      assert_near(event.time_s, 20, 2 * FRAME_S);
      assert_int_equal(r.game.last_event.kind, VS_EVENT_SENT_OFF);
      assert_int_equal(r.free_balls, 1);
      sent_off++;
    }
    bool larc = rules == VS_RULES_LARC_2026;
    assert_int_equal(sent_off, larc);
    for (int i = 0; i < VS_TEAM_SIZE; i++) assert_int_equal(vs_referee_off(&r, VS_BLUE, i), larc && i == 1);
    assert_true(vs_referee_ok(&r, &r.def));
    r.game.time_s = r.def.duration_s / 2 - FRAME_S;
    if (larc) assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_HALF_TIME, VS_YELLOW, 0);
    assert_false(vs_referee_off(&r, VS_BLUE, 1));
  }
}

static void a_ball_over_the_wall_is_a_free_ball(void **state) {
  (void)state;
  for (int rules = VS_RULES_SERIE_A_2023; rules <= VS_RULES_LARC_2026; rules++) {
    vs_world start = quiet_world(0.3, 0.5), w = quiet_world(0.3, 0.7);
    vs_referee r = referee_of((vs_rules)rules, &start);
    assert_event(vs_referee_step(&r, &w, FRAME_S), VS_EVENT_FREE_BALL, VS_BLUE, 1);
  }
}

// 2023: always at the quadrant's mark. 2026: the second and the third in a row in the middle, until something else
// happens.
static void stalemates_are_free_balls_and_in_2026_again_ones_in_the_middle(void **state) {
  (void)state;
  for (int rules = VS_RULES_SERIE_A_2023; rules <= VS_RULES_LARC_2026; rules++) {
    bool larc = rules == VS_RULES_LARC_2026;
    vs_world w = quiet_world(-0.3, 0.4), goal = quiet_world(0.8, 0);
    vs_referee r = referee_of((vs_rules)rules, &w);
    const int expected[] = {2, larc ? 0 : 2, larc ? 0 : 2};
    double took_s;
    for (int k = 0; k < 3; k++) {
      assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_FREE_BALL, VS_BLUE, expected[k]);
      assert_near(took_s, 10, FRAME_S);
      vs_referee_restarted(&r, &w);
    }
    assert_event(vs_referee_step(&r, &goal, FRAME_S), VS_EVENT_GOAL, VS_BLUE, 0);
    vs_referee_restarted(&r, &w);
    assert_event(wait_for_event(&r, &w, 20, &took_s), VS_EVENT_FREE_BALL, VS_BLUE, 2);
  }
}

// The ball in the middle, everybody in its own half, outside the circle; teams may place themselves so too.
static void a_free_ball_in_the_middle_keeps_the_circle_clear(void **state) {
  (void)state;
  const vs_event event = {.kind = VS_EVENT_FREE_BALL, .quadrant = 0};
  vs_world before = quiet_world(0.3, 0.3), w;
  for (int mode = VS_PLACEMENT_PAPER; mode <= VS_PLACEMENT_RANDOM; mode++)
    for (uint64_t seed = 0; seed < 200; seed++) {
      vs_rng rng = vs_rng_make(seed, 0);
      vs_place((vs_placement_mode)mode, &event, &before, &rng, &w);
      assert_near(w.ball.x_m, 0, 0);
      assert_near(w.ball.y_m, 0, 0);
      for (int t = 0; t < VS_TEAMS; t++) {
        vs_pose pose[VS_TEAM_SIZE];
        for (int i = 0; i < VS_TEAM_SIZE; i++) {
          pose[i] = w.robot[t][i].pose;
          assert_true((t == VS_BLUE ? -1 : 1) * pose[i].x_m > 0);
          assert_true(hypot(pose[i].x_m, pose[i].y_m) > VS_CIRCLE_RADIUS_M + VS_ROBOT_SIZE_M / 2 - 1e-9);
        }
        assert_ok(vs_placement_check(VS_3V3, &event, (vs_team)t, pose, err));
        pose[2] = (vs_pose){t == VS_BLUE ? -0.1 : 0.1, 0.08, 0};
        assert_int_equal(vs_placement_check(VS_3V3, &event, (vs_team)t, pose, NULL), VS_FAIL);
      }
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_match_is_two_halves_of_five_minutes_and_ends_at_ten_goals),
      cmocka_unit_test(two_defenders_alone_are_no_foul_and_a_goal_counts),
      cmocka_unit_test(second_defender_that_touches_is_a_penalty_once_the_ball_is_out),
      cmocka_unit_test(the_keeper_may_touch),
      cmocka_unit_test(second_attacker_that_interferes_is_a_goal_kick),
      cmocka_unit_test(an_attackers_goal_with_a_second_one_interfering_is_a_goal_kick),
      cmocka_unit_test(a_keeper_that_does_not_clear_for_10_s_is_a_penalty),
      cmocka_unit_test(a_contested_ball_in_an_area_for_10_s_is_a_goal_kick),
      cmocka_unit_test(a_contested_ball_after_the_defenders_foul_is_a_penalty),
      cmocka_unit_test(pushing_without_the_ball_for_1_s_is_a_free_kick),
      cmocka_unit_test(a_fight_for_the_ball_or_a_short_bump_is_no_pushing),
      cmocka_unit_test(a_keeper_pushed_in_its_area_is_a_goal_kick),
      cmocka_unit_test(pushing_in_the_own_area_is_a_penalty),
      cmocka_unit_test(covering_more_than_30_percent_of_the_ball_is_holding),
      cmocka_unit_test(a_false_start_is_the_others_free_kick),
      cmocka_unit_test(an_idle_robot_is_sent_off_until_half_time_in_larc_only),
      cmocka_unit_test(a_ball_over_the_wall_is_a_free_ball),
      cmocka_unit_test(stalemates_are_free_balls_and_in_2026_again_ones_in_the_middle),
      cmocka_unit_test(a_free_ball_in_the_middle_keeps_the_circle_clear),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
