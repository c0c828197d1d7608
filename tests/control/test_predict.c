// Tests src/control/predict.c: the prediction to the moment when a command acts, against the simulator's own future.
#include <math.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/control.h"
#include "vsss/env.h"
#include "vsss/geom.h"

// Plays one side with commands that change at every decision, with latency, and measures how far the shown own poses are
// from where the robots are when the command acts.
typedef struct errors {
  double place_m, heading_rad, ball_m; // means
} errors;

static void drive_of(int decision, float *action) {
  for (int k = 0; k < VS_TEAM_SIZE * VS_ACTION_SIZE; k++) action[k] = (float)(0.7 * sin(0.9 * decision + 1.7 * k));
}

// The newest frame of the observations tells what blue was shown.
static errors play(vs_predicts who) {
  vs_model_def model_def = vs_model_def_default(VS_DRIVE_CONTACT);
  vs_model *model = NULL;
  assert_ok(vs_model_load(&model_def, &model, err));
  vs_env_def def = vs_env_def_default(model);
  def.predicts = who;
  def.realism.latency_s = (vs_range){0.1, 0.1};
  vs_env *env = NULL;
  assert_ok(vs_env_new(&def, &env, err));
  assert_ok(vs_env_reset(env, 5, err));
  static float seen[VS_TEAM_SIZE][VS_OBS_SIZE];
  errors sum = {0};
  int count = 0;
  bool have = false;
  for (int decision = 0; decision < 60; decision++) {
    vs_world now;
    vs_env_truth(env, &now); // a decision later than what was seen: latency is just that long
    for (int i = 0; have && i < VS_TEAM_SIZE; i++, count++) {
      const float *frame = seen[i] + VS_OBS_SIZE - VS_OBS_FRAME;
      const vs_pose *true_pose = &now.robot[VS_BLUE][i].pose;
      sum.place_m += hypot(frame[VS_OBS_OWN_XY] * VS_OBS_SCALE_X_M - true_pose->x_m,
                           frame[VS_OBS_OWN_XY + 1] * VS_OBS_SCALE_Y_M - true_pose->y_m);
      double heading = atan2(frame[VS_OBS_OWN_HEADING], frame[VS_OBS_OWN_HEADING + 1]);
      sum.heading_rad += fabs(vs_wrap_rad(heading - true_pose->theta_rad));
      sum.ball_m += hypot(frame[VS_OBS_BALL_XY] * VS_OBS_SCALE_X_M - now.ball.x_m,
                          frame[VS_OBS_BALL_XY + 1] * VS_OBS_SCALE_Y_M - now.ball.y_m);
    }
    vs_env_observation(env, VS_BLUE, &seen[0][0]);
    float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
    drive_of(decision, action);
    assert_ok(vs_env_set_action(env, VS_BLUE, action, err));
    vs_env_result result;
    assert_ok(vs_env_step(env, &result, err));
    have = result.event.kind == VS_EVENT_NONE;
  }
  vs_env_free(env);
  vs_model_free(model);
  return (errors){sum.place_m / count, sum.heading_rad / count, sum.ball_m / count};
}

static void own_robots_are_shown_where_they_will_be(void **state) {
  (void)state;
  errors raw = play(VS_PREDICTS_NONE), predicted = play(VS_PREDICTS_LEARNED);
  print_message("raw %.1f mm %.1f deg, predicted %.1f mm %.1f deg\n", 1e3 * raw.place_m, raw.heading_rad * 180 / VS_PI,
                1e3 * predicted.place_m, predicted.heading_rad * 180 / VS_PI);
  assert_true(predicted.place_m < 0.5 * raw.place_m && predicted.place_m < 0.015);
  assert_true(predicted.heading_rad < 0.5 * raw.heading_rad && predicted.heading_rad < 0.25);
}

static vs_world still_world(void) {
  vs_world w = {.time_us = 1000000};
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    vs_robot *r = &w.robot[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE];
    r->pose = (vs_pose){i < VS_TEAM_SIZE ? -0.5 : 0.5, 0.3 * (i % VS_TEAM_SIZE - 1), 0};
    r->valid = true;
  }
  w.ball.valid = true;
  return w;
}

static vs_control *outsider(double latency_s) {
  vs_control *control = NULL;
  assert_ok(vs_control_new(NULL, &control, err));
  assert_ok(vs_control_reset(control, 1, false, err));
  assert_ok(vs_control_set_latency(control, latency_s, err));
  return control;
}

static void shown(vs_control *control, const vs_world *world, float *frame) {
  static float stack[VS_TEAM_SIZE][VS_OBS_SIZE];
  const vs_game game = {.duration_s = 120};
  vs_observer observer;
  vs_control_peek(control, VS_BLUE, world, &game, &observer);
  vs_observer_write(&observer, &stack[0][0]);
  memcpy(frame, stack[0] + VS_OBS_SIZE - VS_OBS_FRAME, VS_OBS_FRAME * sizeof *frame);
}

static void a_rolling_ball_is_ahead_and_stays_on_the_field(void **state) {
  (void)state;
  float frame[VS_OBS_FRAME];
  vs_control *control = outsider(0.1);
  vs_world w = still_world();
  w.ball.vx_mps = 1;
  shown(control, &w, frame);
  assert_near(frame[VS_OBS_BALL_XY] * VS_OBS_SCALE_X_M, 0.1 - 0.5 * 0.2 * 0.01, 2e-3);
  w.ball = (vs_ball){.y_m = 0.6, .vy_mps = 2, .valid = true};
  shown(control, &w, frame);
  double y_m = frame[VS_OBS_BALL_XY + 1] * VS_OBS_SCALE_Y_M;
  assert_true(y_m < 0.6287 && y_m > 0.45);
  w.ball.valid = false; // nothing is made up about what is not seen
  shown(control, &w, frame);
  assert_near(frame[VS_OBS_BALL_XY + 1] * VS_OBS_SCALE_Y_M, 0.6, 1e-6);
  vs_control_free(control);
}

static void without_latency_the_world_is_shown_as_it_is(void **state) {
  (void)state;
  float frame[VS_OBS_FRAME];
  vs_control *control = outsider(0);
  vs_world w = still_world();
  w.ball.vx_mps = 1;
  shown(control, &w, frame);
  assert_near(frame[VS_OBS_BALL_XY], 0, 1e-9);
  vs_control_free(control);
}

static void a_latency_that_cannot_be_is_refused(void **state) {
  (void)state;
  vs_control *control = outsider(0.05);
  vs_error why = {0};
  const double wrong[] = {-0.01, 0.31, NAN};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_int_equal(vs_control_set_latency(control, wrong[i], &why), VS_USAGE);
  assert_non_null(strstr(why.text, "expected 0 to 0.3"));
  vs_control_free(control);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(own_robots_are_shown_where_they_will_be),
      cmocka_unit_test(a_rolling_ball_is_ahead_and_stays_on_the_field),
      cmocka_unit_test(without_latency_the_world_is_shown_as_it_is),
      cmocka_unit_test(a_latency_that_cannot_be_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
