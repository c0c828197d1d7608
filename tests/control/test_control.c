// Tests src/control/control.c: when a team decides, what it sees, and what is kept.
#include "vsss/control.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"

// A scripted player that writes down how it was called: its state block is read through a snapshot of the control.
typedef struct notes {
  uint64_t seed;
  int calls;
  double last_dt_s, ball_x_m, score;
} notes;

static vs_status notes_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  if (*options) return vs_fail(err, VS_USAGE, "notes: takes no options");
  *(notes *)state = (notes){.seed = seed};
  return VS_OK;
}

static void notes_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  notes *n = state;
  n->calls++;
  n->last_dt_s = dt_s;
  n->ball_x_m = world->ball.x_m;
  n->score = game->score[0];
  for (int i = 0; i < VS_TEAM_SIZE; i++) out[i] = (vs_wheels){n->calls, 23.33};
  if (n->calls == 100) out[2].right_radps = NAN;
}

static vsss_player_api notes_api = {.version = VSSS_PLAYER_VERSION,
                                    .name = "notes",
                                    .state_size = sizeof(notes),
                                    .init = notes_init,
                                    .step = notes_step};

static vs_status notes_open(const char *rest, vs_player_given *out, vs_error *err) {
  double rate = atof(rest);
  if (rate == 0) return vs_fail(err, VS_USAGE, "notes: needs a rate");
  notes_api.rate_hz = rate;
  out->api = &notes_api;
  return VS_OK;
}

static vs_control *control_of(const char *uri) {
  vs_player_register("notes:", "RATE, writes down its calls", notes_open);
  vs_player *player = NULL;
  vs_control *control = NULL;
  if (uri) assert_ok(vs_player_open(uri, &player, err));
  assert_ok(vs_control_new(player, &control, err));
  assert_ok(vs_control_reset(control, 1, false, err));
  return control;
}

static notes notes_of(const vs_control *control) {
  char state[sizeof(vs_observer) + 8192];
  notes n;
  size_t size = vs_control_state_size(control);
  assert_true(size >= sizeof n && size <= sizeof state);
  vs_control_save(control, state);
  memcpy(&n, state + size - sizeof n, sizeof n);
  return n;
}

static const vs_game game = {.duration_s = 120, .score = {3, 5}};

static vs_world ball_at(double x_m) {
  vs_world w = {0};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    w.robot[VS_BLUE][i].pose.x_m = -0.1 * (i + 1);
    w.robot[VS_YELLOW][i].pose.x_m = 0.1 * (i + 1);
  }
  w.ball.x_m = x_m;
  return w;
}

static double newest_ball_x_m(const vs_control *control, int robot, int k) {
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  vs_observer_write(vs_control_observer(control), stack);
  return stack[robot * VS_OBS_SIZE + k * VS_OBS_FRAME + VS_OBS_BALL_XY] * VS_OBS_SCALE_X_M;
}

// Steps one frame of dt_s and tells whether it was a decision.
static bool frame(vs_control *control, vs_team team, double ball_x_m, double dt_s, vs_wheels *out) {
  vs_world w = ball_at(ball_x_m);
  vs_wheels mine[VS_TEAM_SIZE];
  bool decided = false;
  assert_ok(vs_control_step(control, team, &w, &game, dt_s, out ? out : mine, &decided, err));
  return decided;
}

static void player_of_10_hz_decides_on_every_third_frame(void **state) {
  (void)state;
  vs_control *control = control_of("notes:10");
  vs_wheels wheels[VS_TEAM_SIZE];
  for (int n = 0; n < 250; n++) {
    assert_int_equal(frame(control, VS_BLUE, 0, 1.0 / 30, wheels), n % 3 == 0);
    notes seen = notes_of(control);
    assert_int_equal(seen.calls, n / 3 + 1);
    assert_near(seen.last_dt_s, 0.1, 1e-12);
    assert_near(wheels[1].left_radps, fmin(n / 3 + 1, VS_WHEEL_LIMIT_RADPS), 0); // held between decisions
  }
  vs_control_free(control);
}

static void player_of_30_hz_decides_on_every_frame_but_is_observed_at_10_hz(void **state) {
  (void)state;
  vs_control *control = control_of("notes:30");
  for (int n = 0; n < 30; n++) {
    assert_true(frame(control, VS_BLUE, 0.01 * n, 1.0 / 30, NULL));
    assert_near(notes_of(control).last_dt_s, 1.0 / 30, 1e-12);
    // The newest observed frame is the last whose number is a multiple of three; the one before is three older.
    assert_near(newest_ball_x_m(control, 0, 7), 0.01 * (n / 3 * 3), 1e-7);
    if (n >= 3) assert_near(newest_ball_x_m(control, 0, 6), 0.01 * (n / 3 * 3 - 3), 1e-7);
  }
  vs_control_free(control);
}

static void camera_of_60_hz_and_lost_frames_keep_the_rate(void **state) {
  (void)state;
  vs_control *control = control_of("notes:10");
  int decisions = 0;
  for (int n = 0; n < 300; n++) decisions += frame(control, VS_BLUE, 0, 1.0 / 60, NULL) ? 1 : 0;
  assert_int_equal(decisions, 50); // 5 s
  // Every other frame of a 30 Hz camera is lost: frames come 0.067 s apart, ticks 0.1 s. Grid: the phase is kept.
  decisions = 0;
  for (int n = 0; n < 60; n++) decisions += frame(control, VS_BLUE, 0, 2.0 / 30, NULL) ? 1 : 0;
  assert_in_range(decisions, 39, 41); // 4 s
  vs_control_free(control);
}

static void gap_of_a_second_makes_one_decision_and_no_burst(void **state) {
  (void)state;
  vs_control *control = control_of("notes:10");
  assert_true(frame(control, VS_BLUE, 0, 1.0 / 30, NULL));
  assert_true(frame(control, VS_BLUE, 0, 1.0, NULL));
  assert_near(notes_of(control).last_dt_s, 1.0, 1e-12); // the player is told how long it was
  assert_false(frame(control, VS_BLUE, 0, 1.0 / 30, NULL));
  assert_false(frame(control, VS_BLUE, 0, 1.0 / 30, NULL));
  assert_true(frame(control, VS_BLUE, 0, 1.0 / 30, NULL));
  vs_control_free(control);
}

static void restart_decides_at_once_and_refills_the_stack(void **state) {
  (void)state;
  vs_control *control = control_of("notes:10");
  for (int n = 0; n < 8; n++) frame(control, VS_BLUE, 0.01 * n, 1.0 / 30, NULL);
  vs_control_restart(control);
  for (int i = 0; i < 6; i++) assert_near(vs_control_action(control)[i], 0, 0);
  assert_true(frame(control, VS_BLUE, 0.5, 1.0 / 30, NULL));
  for (int k = 0; k < VS_OBS_STACK; k++) assert_near(newest_ball_x_m(control, 1, k), 0.5, 1e-7);
  assert_int_equal(notes_of(control).calls, 4); // frames 0, 3, 6 and the one after the restart: its memory went on
  assert_false(frame(control, VS_BLUE, 0.5, 1.0 / 30, NULL));
  vs_control_free(control);
}

static void yellow_sees_itself_attack_plus_x_and_its_own_score_first(void **state) {
  (void)state;
  vs_control *control = control_of("notes:30");
  frame(control, VS_YELLOW, 0.3, 1.0 / 30, NULL);
  assert_near(notes_of(control).ball_x_m, -0.3, 0);
  assert_near(notes_of(control).score, 5, 0);
  assert_near(newest_ball_x_m(control, 0, 7), -0.3, 1e-7);
  vs_control_free(control);
}

static void last_action_is_seen_in_the_next_observation(void **state) {
  (void)state;
  vs_control *control = control_of("notes:10");
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE];
  for (int n = 0; n < 4; n++) frame(control, VS_BLUE, 0, 1.0 / 30, NULL);
  vs_observer_write(vs_control_observer(control), stack);
  const float *newest = stack + 7 * VS_OBS_FRAME;
  assert_near(newest[VS_OBS_OWN_ACTION], 1 / VS_WHEEL_LIMIT_RADPS, 1e-7); // the first call asked for 1 rad/s
  assert_near(newest[VS_OBS_OWN_ACTION + 1], 0.5, 1e-7);                  // 23.33 rad/s
  assert_near(stack[VS_OBS_OWN_ACTION], 0, 0);                            // before it there was none
  vs_control_free(control);
}

// The policy's path: observed at its decisions only, and the action is what the network gives for exactly that stack.
static void learned_player_acts_on_the_written_stack_at_10_hz(void **state) {
  (void)state;
  vs_player *player = NULL, *reference = NULL;
  vs_control *control = NULL;
  vs_error err = {0};
  if (vs_player_open("onnx:build/untrained.onnx", &player, &err) != VS_OK && strstr(err.text, "no ONNX Runtime")) {
    printf("note: this build has no ONNX Runtime\n");
    skip();
  }
  assert_non_null(player);
  assert_ok(vs_player_open("onnx:build/untrained.onnx", &reference, err));
  assert_ok(vs_control_new(player, &control, err));
  assert_ok(vs_control_reset(control, 1, false, err));
  float stack[VS_TEAM_SIZE * VS_OBS_SIZE], action[VS_TEAM_SIZE * VS_ACTION_SIZE];
  vs_wheels wheels[VS_TEAM_SIZE], held[VS_TEAM_SIZE] = {{0, 0}};
  for (int n = 0; n < 30; n++) {
    bool decided = frame(control, VS_YELLOW, 0.01 * n, 1.0 / 30, wheels);
    assert_int_equal(decided, n % 3 == 0);
    assert_near(newest_ball_x_m(control, 0, 7), -0.01 * (n / 3 * 3), 1e-7);
    if (decided) {
      vs_observer_write(vs_control_observer(control), stack);
      assert_ok(vs_player_act(reference, stack, VS_TEAM_SIZE, action, err));
      assert_memory_equal(vs_control_action(control), action, sizeof action);
      assert_ok(vs_action_to_wheels(action, held, err));
    }
    assert_memory_equal(wheels, held, sizeof held);
  }
  vs_player_close(reference);
  vs_control_free(control);
}

static void command_that_is_no_number_fails_and_stops_the_wheels(void **state) {
  (void)state;
  vs_control *control = control_of("notes:30");
  for (int n = 0; n < 99; n++) frame(control, VS_BLUE, 0, 1.0 / 30, NULL);
  vs_world w = ball_at(0);
  vs_wheels wheels[VS_TEAM_SIZE];
  vs_error err = {0};
  assert_int_equal(vs_control_step(control, VS_BLUE, &w, &game, 1.0 / 30, wheels, NULL, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "notes:30"));
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(wheels[i].left_radps, 0, 0);
    assert_near(wheels[i].right_radps, 0, 0);
  }
  vs_control_free(control);
}

static void rate_that_does_not_divide_the_cameras_is_refused(void **state) {
  (void)state;
  vs_player_register("notes:", "RATE, writes down its calls", notes_open);
  static const char *const bad[] = {"notes:12", "notes:60", "notes:-10", "notes:0.7"};
  for (int b = 0; b < 4; b++) {
    vs_player *player = NULL;
    vs_control *control = NULL;
    vs_error err = {0};
    if (vs_player_open(bad[b], &player, &err) != VS_OK) continue; // the policy module may refuse it already
    assert_int_equal(vs_control_new(player, &control, &err), VS_FAIL);
    assert_non_null(strstr(err.text, "30 Hz divided by"));
    vs_player_close(player); // still ours
  }
}

static void external_team_acts_and_observes(void **state) {
  (void)state;
  vs_control *control = control_of(NULL);
  assert_null(vs_control_player(control));
  vs_world w = ball_at(0.2);
  vs_control_observe(control, VS_BLUE, &w, &game);
  assert_near(newest_ball_x_m(control, 0, 7), 0.2, 1e-7);
  const float action[6] = {1, -1, 0.5f, 0, 0, 2};
  assert_ok(vs_control_set_action(control, action, err));
  vs_wheels wheels[VS_TEAM_SIZE];
  assert_false(frame(control, VS_BLUE, 0.2, 1.0 / 30, wheels));
  assert_near(wheels[0].left_radps, VS_WHEEL_LIMIT_RADPS, 0);
  assert_near(wheels[0].right_radps, -VS_WHEEL_LIMIT_RADPS, 0);
  assert_near(wheels[2].right_radps, VS_WHEEL_LIMIT_RADPS, 0);
  assert_near(vs_control_action(control)[5], 1, 0); // what it could do, not what it asked for
  const float bad[6] = {NAN, 0, 0, 0, 0, 0};
  vs_error err = {0};
  assert_int_equal(vs_control_set_action(control, bad, &err), VS_FAIL);
  frame(control, VS_BLUE, 0.2, 1.0 / 30, wheels);
  assert_near(wheels[0].left_radps, VS_WHEEL_LIMIT_RADPS, 0); // the bad one changed nothing
  vs_control_free(control);
}

static void shuffled_adversaries_are_a_permutation_drawn_from_the_seed(void **state) {
  (void)state;
  vs_control *control = control_of(NULL);
  int seen[VS_TEAM_SIZE][VS_TEAM_SIZE] = {{0}};
  for (uint64_t seed = 0; seed < 300; seed++) {
    assert_ok(vs_control_reset(control, seed, true, err));
    const int *order = vs_control_observer(control)->adversary_order;
    assert_int_equal(order[0] + order[1] + order[2], 3);
    assert_int_equal(1 << order[0] | 1 << order[1] | 1 << order[2], 7);
    for (int k = 0; k < VS_TEAM_SIZE; k++) seen[k][order[k]]++;
  }
  for (int k = 0; k < VS_TEAM_SIZE; k++)
    for (int r = 0; r < VS_TEAM_SIZE; r++) assert_in_range(seen[k][r], 60, 140); // 100 expected
  assert_ok(vs_control_reset(control, 5, false, err));
  for (int k = 0; k < VS_TEAM_SIZE; k++) assert_int_equal(vs_control_observer(control)->adversary_order[k], k);
  vs_control_free(control);
}

static void snapshot_continues_like_the_original(void **state) {
  (void)state;
  vs_control *a = control_of("notes:10"), *b = control_of("notes:10");
  for (int n = 0; n < 10; n++) frame(a, VS_BLUE, 0.01 * n, 1.0 / 30, NULL);
  size_t size = vs_control_state_size(a);
  void *kept = test_malloc(size), *end_a = test_malloc(size), *end_b = test_malloc(size);
  vs_control_save(a, kept);
  assert_ok(vs_control_restore(b, kept, err));
  for (int n = 10; n < 20; n++)
    assert_int_equal(frame(a, VS_BLUE, 0.01 * n, 1.0 / 30, NULL), frame(b, VS_BLUE, 0.01 * n, 1.0 / 30, NULL));
  vs_control_save(a, end_a);
  vs_control_save(b, end_b);
  assert_memory_equal(end_a, end_b, size);
  test_free(kept);
  test_free(end_a);
  test_free(end_b);
  vs_control_free(a);
  vs_control_free(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(player_of_10_hz_decides_on_every_third_frame),
      cmocka_unit_test(player_of_30_hz_decides_on_every_frame_but_is_observed_at_10_hz),
      cmocka_unit_test(camera_of_60_hz_and_lost_frames_keep_the_rate),
      cmocka_unit_test(gap_of_a_second_makes_one_decision_and_no_burst),
      cmocka_unit_test(restart_decides_at_once_and_refills_the_stack),
      cmocka_unit_test(yellow_sees_itself_attack_plus_x_and_its_own_score_first),
      cmocka_unit_test(last_action_is_seen_in_the_next_observation),
      cmocka_unit_test(learned_player_acts_on_the_written_stack_at_10_hz),
      cmocka_unit_test(command_that_is_no_number_fails_and_stops_the_wheels),
      cmocka_unit_test(rate_that_does_not_divide_the_cameras_is_refused),
      cmocka_unit_test(external_team_acts_and_observes),
      cmocka_unit_test(shuffled_adversaries_are_a_permutation_drawn_from_the_seed),
      cmocka_unit_test(snapshot_continues_like_the_original),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
