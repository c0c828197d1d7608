// Tests src/reward/reward.c: each term alone, then the sum, by hand.
#include "vsss/reward.h"

#include <string.h>

#include "assert_near.h"
#include "vsss/geom.h"

static const vs_game game = {.time_s = 10, .duration_s = 40};
static const vs_event nothing = {.kind = VS_EVENT_NONE};

// Ball at (0.25, 0) half a metre before their goal; robot 0 at (-0.05, 0.4), 0.5 m from the ball; the others far away.
static vs_world scene(void) {
  vs_world w = {0};
  w.ball.x_m = 0.25;
  w.robot[VS_OWN][0].pose = (vs_pose){-0.05, 0.4, 0};
  w.robot[VS_OWN][1].pose = (vs_pose){-0.75, 0.65, 0};
  w.robot[VS_OWN][2].pose = (vs_pose){-0.15, 0, 0};
  return w;
}

static double term(const vs_world *previous, const vs_world *view, int robot, vs_reward_term which) {
  double terms[VS_TEAM_SIZE][VS_REWARD_TERMS];
  vs_reward_terms(previous, view, &nothing, &game, terms);
  return terms[robot][which];
}

static void speed_of_a_still_ball_is_minus_five_fourteenths(void **state) {
  (void)state;
  vs_world w = scene();
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(term(&w, &w, i, VS_REWARD_SPEED), -0.05 / 0.14, 1e-12); // -0.357142857
    assert_near(term(&w, &w, i, VS_REWARD_PROGRESS), 0, 0);
  }
}

static void speed_counts_the_way_towards_the_goal_centre(void **state) {
  (void)state;
  vs_world before = scene(), now = scene();
  // From (0.35, 0.3), 0.5 m from (0.75, 0), to (0.35, 0), 0.4 m from it: gain 0.1 m.
  before.ball.x_m = 0.35;
  before.ball.y_m = 0.3;
  now.ball.x_m = 0.35;
  now.ball.y_m = 0;
  assert_near(term(&before, &now, 1, VS_REWARD_SPEED), (0.1 - 0.05) / 0.14, 1e-12);
  assert_near(term(&before, &now, 1, VS_REWARD_PROGRESS), 0.1 / 0.14, 1e-12);
  assert_near(term(&now, &before, 1, VS_REWARD_SPEED), -1, 1e-12); // -0.15/0.14 is clipped
  assert_near(term(&now, &before, 1, VS_REWARD_PROGRESS), -0.1 / 0.14, 1e-12);
  before.ball.x_m = -0.25;
  before.ball.y_m = 0; // gain 0.6 m
  assert_near(term(&before, &now, 1, VS_REWARD_SPEED), 1, 0);
  // A hard shot counts whole, so that there and back is nothing.
  assert_near(term(&before, &now, 1, VS_REWARD_PROGRESS), 0.6 / 0.14, 1e-12);
  assert_near(term(&now, &before, 1, VS_REWARD_PROGRESS), -0.6 / 0.14, 1e-12);
}

static void a_ball_that_moves_less_than_a_centimetre_is_still(void **state) {
  (void)state;
  vs_world before = scene(), now = scene();
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_near(term(&before, &now, i, VS_REWARD_STILL), -1, 0);
  now.ball.x_m = before.ball.x_m + 0.006;
  now.ball.y_m = before.ball.y_m - 0.0079; // 0.0099 m
  assert_near(term(&before, &now, 0, VS_REWARD_STILL), -1, 0);
  now.ball.y_m = before.ball.y_m - 0.0081; // 0.0101 m
  assert_near(term(&before, &now, 0, VS_REWARD_STILL), 0, 0);
}

static void distance_is_the_nearest_team_mates_for_all(void **state) {
  (void)state;
  vs_world w = scene();
  // Robot 2 is 0.4 m away, robot 0 0.5 m, robot 1 root(1 + 0.4225) = 1.19 m.
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_near(term(&w, &w, i, VS_REWARD_DISTANCE), -0.4, 1e-12);
  assert_near(term(&w, &w, 0, VS_REWARD_OWN_DISTANCE), -0.5, 1e-12);
  vs_world before = w; // what counts is where the ball is now, not where it was
  before.ball.x_m += 0.2;
  assert_near(term(&before, &w, 0, VS_REWARD_OWN_DISTANCE), -0.5, 1e-12);
  assert_near(term(&w, &w, 1, VS_REWARD_OWN_DISTANCE), -1, 0); // capped
  assert_near(term(&w, &w, 2, VS_REWARD_OWN_DISTANCE), -0.4, 1e-12);
  for (int i = 0; i < VS_TEAM_SIZE; i++) w.robot[VS_OWN][i].pose = (vs_pose){-0.75, 0.65, 0};
  assert_near(term(&w, &w, 0, VS_REWARD_DISTANCE), -1, 0); // capped
  w.robot[VS_ADVERSARY][0].pose = (vs_pose){0.2, 0, 0};    // the adversary's does not count
  assert_near(term(&w, &w, 0, VS_REWARD_DISTANCE), -1, 0);
}

static void offence_is_each_robots_own_angle_at_the_ball(void **state) {
  (void)state;
  vs_world w = scene();
  // Robot 2, ball, goal on one line, robot behind: angle 180 degrees, term 0.
  assert_near(term(&w, &w, 2, VS_REWARD_OFFENCE), 0, 1e-12);
  // Robot 0 at (-0.3, 0.4) from the ball, the goal at (0.5, 0): 126.869898 degrees.
  assert_near(term(&w, &w, 0, VS_REWARD_OFFENCE), 126.869897646 / 180 - 1, 1e-9);
  w.robot[VS_OWN][0].pose = (vs_pose){0.25, -0.3, 0}; // beside the ball: 90 degrees
  assert_near(term(&w, &w, 0, VS_REWARD_OFFENCE), -0.5, 1e-12);
  w.robot[VS_OWN][0].pose = (vs_pose){0.45, 0, 0}; // before it: 0 degrees
  assert_near(term(&w, &w, 0, VS_REWARD_OFFENCE), -1, 1e-12);
}

static void defence_is_the_angle_at_the_robot_between_ball_and_own_goal(void **state) {
  (void)state;
  vs_world w = scene();
  // Robot 2 stands on the line from (-0.75, 0) to the ball.
  assert_near(term(&w, &w, 2, VS_REWARD_DEFENCE), 0, 1e-12);
  // From robot 0: ball (0.3, -0.4), own goal (-0.7, -0.4): cos = (-0.21 + 0.16)/(0.5 root 0.65) = -0.124034735,
  // 97.125016 degrees.
  assert_near(term(&w, &w, 0, VS_REWARD_DEFENCE), 97.125016349 / 180 - 1, 1e-9);
  // From robot 1 at (-0.75, 0.65): ball (1, -0.65), own goal (0, -0.65): 56.976132 degrees.
  assert_near(term(&w, &w, 1, VS_REWARD_DEFENCE), 56.976132478 / 180 - 1, 1e-9);
}

static void points_that_coincide_give_the_worst_angle_not_nan(void **state) {
  (void)state;
  vs_world w = scene();
  w.robot[VS_OWN][0].pose = (vs_pose){0.25, 0, 0};
  w.robot[VS_OWN][1].pose = (vs_pose){-0.75, 0, 0};
  assert_near(term(&w, &w, 0, VS_REWARD_OFFENCE), -1, 0);
  assert_near(term(&w, &w, 0, VS_REWARD_DEFENCE), -1, 0);
  assert_near(term(&w, &w, 1, VS_REWARD_DEFENCE), -1, 0);
}

static void approach_is_each_robots_own_way_to_the_ball(void **state) {
  (void)state;
  vs_world before = scene(), now = scene();
  now.robot[VS_OWN][0].pose.x_m = 0.01; // to (0.24, 0.4) from the ball
  now.robot[VS_OWN][2].pose.x_m = 0.15; // 0.3 m nearer
  assert_near(term(&before, &now, 0, VS_REWARD_APPROACH), (0.5 - 0.466476152) / 0.14, 1e-8);
  assert_near(term(&before, &now, 1, VS_REWARD_APPROACH), 0, 1e-12);
  assert_near(term(&before, &now, 2, VS_REWARD_APPROACH), 1, 0);
  assert_near(term(&now, &before, 2, VS_REWARD_APPROACH), -1, 0);
}

static void goal_is_worth_more_early_and_replaces_everything(void **state) {
  (void)state;
  vs_world before = scene(), now = scene();
  now.ball.x_m = 0.78;
  double terms[VS_TEAM_SIZE][VS_REWARD_TERMS];
  const vs_reward_weights paper = vs_reward_paper();
  float reward[VS_TEAM_SIZE];
  static const struct {
    double time_s;
    vs_team scorer;
    double reward;
  } row[] = {
      {0, VS_BLUE, 20},       // 10 (1 + 40/40)
      {10, VS_BLUE, 17.5},    // 10 (1 + 30/40)
      {40, VS_BLUE, 10},      // 10 (1 + 0)
      {10, VS_YELLOW, -17.5}, // conceded
      {41, VS_YELLOW, -10},   // a frame too late is not worth less
  };
  for (size_t r = 0; r < sizeof row / sizeof *row; r++) {
    vs_event event = {.kind = VS_EVENT_GOAL, .team = row[r].scorer, .time_s = row[r].time_s};
    vs_reward_terms(&before, &now, &event, &game, terms);
    vs_reward_sum((const double(*)[VS_REWARD_TERMS])terms, &paper, reward);
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      assert_near(reward[i], row[r].reward, 1e-6);
      for (int k = 0; k < VS_REWARD_TERMS; k++)
        if (k != VS_REWARD_GOAL) assert_near(terms[i][k], 0, 0);
    }
  }
}

static void penalty_costs_the_fouling_team_one_and_leaves_the_other_its_reward(void **state) {
  (void)state;
  vs_world w = scene();
  double terms[VS_TEAM_SIZE][VS_REWARD_TERMS], dense[VS_TEAM_SIZE][VS_REWARD_TERMS];
  const vs_reward_weights paper = vs_reward_paper();
  float reward[VS_TEAM_SIZE];
  vs_event event = {.kind = VS_EVENT_PENALTY, .team = VS_YELLOW}; // the adversary takes the kick
  vs_reward_terms(&w, &w, &event, &game, terms);
  vs_reward_sum((const double(*)[VS_REWARD_TERMS])terms, &paper, reward);
  for (int i = 0; i < VS_TEAM_SIZE; i++) assert_near(reward[i], -1, 0);
  event.team = VS_BLUE;
  vs_reward_terms(&w, &w, &event, &game, terms);
  vs_reward_terms(&w, &w, &nothing, &game, dense);
  assert_memory_equal(terms, dense, sizeof terms);
}

static void other_restarts_leave_the_dense_terms(void **state) {
  (void)state;
  vs_world w = scene();
  double terms[VS_TEAM_SIZE][VS_REWARD_TERMS], dense[VS_TEAM_SIZE][VS_REWARD_TERMS];
  vs_reward_terms(&w, &w, &nothing, &game, dense);
  static const vs_event_kind kind[] = {VS_EVENT_FREE_BALL, VS_EVENT_GOAL_KICK, VS_EVENT_HALF_TIME, VS_EVENT_END};
  for (size_t k = 0; k < sizeof kind / sizeof *kind; k++) {
    vs_event event = {.kind = kind[k], .team = VS_YELLOW};
    vs_reward_terms(&w, &w, &event, &game, terms);
    assert_memory_equal(terms, dense, sizeof terms);
  }
}

static void papers_sum_weighs_seven_one_one_one(void **state) {
  (void)state;
  vs_world w = scene();
  double terms[VS_TEAM_SIZE][VS_REWARD_TERMS];
  const vs_reward_weights paper = vs_reward_paper();
  float reward[VS_TEAM_SIZE];
  vs_reward_terms(&w, &w, &nothing, &game, terms);
  vs_reward_sum((const double(*)[VS_REWARD_TERMS])terms, &paper, reward);
  // Robot 2: speed -0.357142857, distance -0.4, offence 0, defence 0: -0.25 - 0.04.
  assert_near(reward[2], -0.29, 1e-7);
  // Robot 0: offence -0.295167235, defence -0.460416576: -0.29 - 0.029516724 - 0.046041658.
  assert_near(reward[0], -0.365558381, 1e-7);
}

static void every_term_has_its_name(void **state) {
  (void)state;
  for (int a = 0; a < VS_REWARD_TERMS; a++)
    for (int b = 0; b < a; b++) assert_string_not_equal(vs_reward_name(a), vs_reward_name(b));
  assert_string_equal(vs_reward_name(VS_REWARD_SPEED), "speed");
  assert_string_equal(vs_reward_name(VS_REWARD_OWN_DISTANCE), "own_distance");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(speed_of_a_still_ball_is_minus_five_fourteenths),
      cmocka_unit_test(speed_counts_the_way_towards_the_goal_centre),
      cmocka_unit_test(a_ball_that_moves_less_than_a_centimetre_is_still),
      cmocka_unit_test(distance_is_the_nearest_team_mates_for_all),
      cmocka_unit_test(offence_is_each_robots_own_angle_at_the_ball),
      cmocka_unit_test(defence_is_the_angle_at_the_robot_between_ball_and_own_goal),
      cmocka_unit_test(points_that_coincide_give_the_worst_angle_not_nan),
      cmocka_unit_test(approach_is_each_robots_own_way_to_the_ball),
      cmocka_unit_test(goal_is_worth_more_early_and_replaces_everything),
      cmocka_unit_test(penalty_costs_the_fouling_team_one_and_leaves_the_other_its_reward),
      cmocka_unit_test(other_restarts_leave_the_dense_terms),
      cmocka_unit_test(papers_sum_weighs_seven_one_one_one),
      cmocka_unit_test(every_term_has_its_name),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
