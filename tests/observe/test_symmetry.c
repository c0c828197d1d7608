// Tests src/observe/symmetry.c: the observation of a situation, of its mirror image and of any numbering of the others
// have the same canonical version; a robot turned round is the same robot seen by its other end.
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/geom.h"
#include "vsss/observe.h"
#include "vsss/rng.h"

enum { SITUATIONS = 50, FRAMES = VS_OBS_STACK };
static const int orders[6][VS_TEAM_SIZE] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

// One moment of a situation: the world in team view and what the team last commanded.
typedef struct moment {
  vs_world view;
  float action[VS_TEAM_SIZE][2];
} moment;

static void draw(vs_rng *rng, moment *m) {
  memset(m, 0, sizeof *m);
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_pose *p = &m->view.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].pose;
    *p = (vs_pose){vs_rng_range(rng, -0.7, 0.7), vs_rng_range(rng, -0.6, 0.6), vs_rng_range(rng, -3.1, 3.1)};
  }
  m->view.ball.x_m = vs_rng_range(rng, -0.7, 0.7);
  m->view.ball.y_m = vs_rng_range(rng, -0.6, 0.6);
  for (int k = 0; k < VS_TEAM_SIZE * 2; k++) m->action[k / 2][k % 2] = (float)vs_rng_range(rng, -1, 1);
}

static moment mirror_image(const moment *m) {
  moment out = *m;
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_pose *p = &out.view.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE].pose;
    p->y_m = -p->y_m;
    p->theta_rad = -p->theta_rad;
  }
  out.view.ball.y_m = -out.view.ball.y_m;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    out.action[i][0] = m->action[i][1];
    out.action[i][1] = m->action[i][0];
  }
  return out;
}

// Robot 0 stays the one that observes.
static moment renumbered(const moment *m, bool exchange_allies, const int *adversaries) {
  moment out = *m;
  for (int i = 1; exchange_allies && i < VS_TEAM_SIZE; i++) {
    out.view.robot[VS_OWN][i] = m->view.robot[VS_OWN][VS_TEAM_SIZE - i];
    memcpy(out.action[i], m->action[VS_TEAM_SIZE - i], sizeof out.action[i]);
  }
  for (int i = 0; i < VS_TEAM_SIZE; i++) out.view.robot[VS_ADVERSARY][i] = m->view.robot[VS_ADVERSARY][adversaries[i]];
  return out;
}

static void observe(const moment moments[FRAMES], float *out) {
  vs_observer observer;
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  const vs_game game = {.duration_s = 40, .time_s = 11};
  vs_observer_init(&observer, NULL);
  for (int k = 0; k < FRAMES; k++) vs_observer_push(&observer, &moments[k].view, &game, &moments[k].action[0][0]);
  vs_observer_write(&observer, stack);
  memcpy(out, stack, VS_OBS_SIZE * sizeof *out);
}

static void canonical(const float *observation, float *out, int *version) {
  vs_symmetry_table table;
  vs_symmetry_table_init(&table);
  *version = vs_symmetry_canonical(observation);
  vs_symmetry_apply(&table, *version, observation, out);
}

static void all_24_versions_of_a_situation_have_one_canonical_observation(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(3, 0);
  for (int n = 0; n < SITUATIONS; n++) {
    moment original[FRAMES], changed[FRAMES];
    float seen[VS_OBS_SIZE], first[VS_OBS_SIZE], other[VS_OBS_SIZE];
    bool met[VS_SYMMETRIES] = {false};
    int version;
    for (int k = 0; k < FRAMES; k++) draw(&rng, &original[k]);
    observe(original, seen);
    canonical(seen, first, &version);
    for (int s = 0; s < VS_SYMMETRIES; s++) {
      for (int k = 0; k < FRAMES; k++) {
        changed[k] = renumbered(&original[k], s / 6 % 2, orders[s % 6]);
        if (s / 12) changed[k] = mirror_image(&changed[k]);
      }
      observe(changed, seen);
      canonical(seen, other, &version);
      assert_false(met[version]); // each of the 24 is undone by another one
      met[version] = true;
      for (int i = 0; i < VS_OBS_SIZE; i++) assert_near(other[i], first[i], 2e-6);
    }
    // It is the one the header promises, in its newest frame.
    const float *newest = first + VS_OBS_SIZE - VS_OBS_FRAME;
    assert_true(newest[VS_OBS_BALL_XY + 1] >= 0);
    assert_true(newest[VS_OBS_ALLIES_BALL_DISTANCE] <= newest[VS_OBS_ALLIES_BALL_DISTANCE + 1]);
    for (int k = 0; k < 2; k++)
      assert_true(newest[VS_OBS_ADVERSARIES_DISTANCE + k] <= newest[VS_OBS_ADVERSARIES_DISTANCE + k + 1]);
  }
}

// By hand: the ball to the right (y < 0), ally 1 nearer to it, adversaries at 0.3, 0.1, 0.2 m of the robot.
static void the_mirror_image_turns_y_and_exchanges_the_wheels(void **state) {
  (void)state;
  moment moments[FRAMES];
  float seen[VS_OBS_SIZE], out[VS_OBS_SIZE];
  int version;
  memset(moments, 0, sizeof moments);
  for (int k = 0; k < FRAMES; k++) {
    moment *m = &moments[k];
    m->view.ball.y_m = -0.13;
    m->view.robot[VS_OWN][0].pose.theta_rad = 1.0;
    m->view.robot[VS_OWN][1].pose.x_m = 0.5;
    m->view.robot[VS_OWN][2].pose.x_m = -0.4;
    m->view.robot[VS_ADVERSARY][0].pose.x_m = 0.3;
    m->view.robot[VS_ADVERSARY][1].pose.x_m = 0.1;
    m->view.robot[VS_ADVERSARY][2].pose.x_m = 0.2;
    m->action[0][0] = 0.25f;
    m->action[0][1] = -0.5f;
    m->action[2][0] = 0.75f;
  }
  observe(moments, seen);
  canonical(seen, out, &version);
  assert_true(vs_symmetry_mirrored(version));
  assert_near(out[VS_OBS_BALL_XY + 1], 0.13 / 0.65, 1e-6);
  assert_near(out[VS_OBS_OWN_HEADING], -0.8414709848, 1e-6); // sin(-1)
  assert_near(out[VS_OBS_OWN_HEADING + 1], 0.5403023059, 1e-6);
  assert_near(out[VS_OBS_OWN_ACTION], -0.5, 0);
  assert_near(out[VS_OBS_OWN_ACTION + 1], 0.25, 0);
  assert_near(out[VS_OBS_ALLIES_XY], -0.4 / 0.85, 1e-6);
  assert_near(out[VS_OBS_ALLIES_ACTION + 1], 0.75, 0);
  for (int k = 0; k < VS_TEAM_SIZE; k++) assert_near(out[VS_OBS_ADVERSARIES_XY + 2 * k], (k + 1) * 0.1 / 0.85, 1e-6);
}

// The robot put the other way round, its wheels exchanged and turning the other way: what its other end sees.
static void a_robot_turned_round_observes_what_its_other_end_sees(void **state) {
  (void)state;
  vs_rng rng = vs_rng_make(4, 0);
  int backs = 0;
  for (int n = 0; n < SITUATIONS; n++) {
    moment original[FRAMES], round[FRAMES];
    float seen[VS_OBS_SIZE], expected[VS_OBS_SIZE], out[VS_OBS_SIZE];
    for (int k = 0; k < FRAMES; k++) {
      draw(&rng, &original[k]);
      round[k] = original[k];
      round[k].view.robot[VS_OWN][0].pose.theta_rad += VS_PI;
      round[k].action[0][0] = -original[k].action[0][1];
      round[k].action[0][1] = -original[k].action[0][0];
    }
    observe(original, seen);
    observe(round, expected);
    vs_observation_reverse(seen, out);
    for (int i = 0; i < VS_OBS_SIZE; i++) assert_near(out[i], expected[i], 2e-6);
    assert_int_equal(vs_observation_faces_back(seen),
                     cos(original[FRAMES - 1].view.robot[VS_OWN][0].pose.theta_rad) < 0);
    assert_int_equal(vs_observation_faces_back(out), !vs_observation_faces_back(seen));
    backs += vs_observation_faces_back(seen);
  }
  assert_in_range(backs, SITUATIONS / 4, SITUATIONS * 3 / 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_24_versions_of_a_situation_have_one_canonical_observation),
      cmocka_unit_test(the_mirror_image_turns_y_and_exchanges_the_wheels),
      cmocka_unit_test(a_robot_turned_round_observes_what_its_other_end_sees),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
