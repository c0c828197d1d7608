// src/policy/player_process.c
#include "policy/plugins/compile.h"
#include "vsss/clock.h"
#include "vsss/isolate.h"

enum { PATIENCE_MS = 300 };

static vs_player *isolated(const char *options) {
  char uri[256];
  vs_player *player;
  snprintf(uri, sizeof uri, "plugin:%s/bad.so%s", folder, options);
  assert_ok(vs_player_open_isolated(uri, PATIENCE_MS, &player, err));
  assert_ok(vs_player_reset(player, 1, err));
  return player;
}

static vs_status step(vs_player *player, double *left, vs_error *err) {
  vs_world view = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE] = {0};
  vs_status s = vs_player_step(player, &view, &game, 1.0 / 30, out, err);
  *left = out[0].left_radps;
  return s;
}

// Calls until one succeeds.
static int64_t wait_for_life(vs_player *player, double *left) {
  int64_t start_us = vs_clock_monotonic_us(), now_us = start_us;
  for (; now_us - start_us < 30000000; now_us = vs_clock_monotonic_us()) {
    if (step(player, left, NULL) == VS_OK) return now_us - start_us;
    vs_clock_sleep_until_us(now_us + 5000);
  }
  fail_msg("the player did not come back");
  return 0;
}

// What it does at its third call, what is said of it; then it plays on from its start: its first wheel counts the calls.
static void one_that_fails_is_named_and_started_again(void **state) {
  (void)state;
  static const struct {
    const char *options, *said;
  } row[] = {{"?step=segv", "SIGSEGV"},
             {"?step=abort", "SIGABRT"},
             {"?step=overflow", "stack overflow"},
             {"?step=nan", "nan rad/s"},
             {"?step=hang", "no answer within 300 ms"}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    vs_player *player = isolated(row[i].options);
    vs_error why = {0};
    double left;
    assert_ok(step(player, &left, err));
    assert_ok(step(player, &left, err));
    assert_near(left, 2, 0);
    int64_t before_us = vs_clock_monotonic_us();
    assert_int_equal(step(player, &left, &why), VS_FAIL);
    assert_true(vs_clock_monotonic_us() - before_us < 20000000); // on however busy a machine: it does not hang
    if (!strstr(why.text, row[i].said) || !strstr(why.text, "bad.so")) fail_msg("%s: %s", row[i].options, why.text);
    assert_int_equal(vs_player_failures(player), 1);
    wait_for_life(player, &left);
    assert_near(left, 1, 0);
    vs_player_close(player);
  }
}

static void one_that_is_killed_is_started_again(void **state) {
  (void)state;
  vs_player *player = isolated("");
  double left;
  assert_ok(step(player, &left, err));
  // The worker is the keeper's only child, the keeper ours.
  char command[256];
  snprintf(command, sizeof command, "for k in $(pgrep -P %ld); do pkill -KILL -P $k; done; true", (long)getpid());
  assert_int_equal(system(command), 0);
  vs_error why = {0};
  for (int i = 0; i < 1000 && step(player, &left, &why) == VS_OK; i++)
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 2000);
  assert_non_null(strstr(why.text, "signal 9"));
  wait_for_life(player, &left);
  assert_int_equal(vs_player_failures(player), 1);
  vs_player_close(player);
}

static void it_plays_as_it_does_in_this_process(void **state) {
  (void)state;
  static const char *const uris[] = {"random:", "emc:", "inf:"};
  for (int k = 0; k < 3; k++) {
    vs_player *here, *there;
    assert_ok(vs_player_open(uris[k], &here, err));
    assert_ok(vs_player_open_isolated(uris[k], PATIENCE_MS, &there, err));
    assert_ok(vs_player_reset(here, 7, err));
    assert_ok(vs_player_reset(there, 7, err));
    assert_string_equal(vs_player_name(there), vs_player_name(here));
    assert_near(vs_player_rate_hz(there), vs_player_rate_hz(here), 0);
    assert_int_equal(vs_player_state_size(there), 0);
    for (int i = 0; i < 20; i++) {
      vs_world view = {.ball = {.x_m = 0.01 * i, .y_m = -0.02 * i, .valid = true}};
      vs_game game = {.duration_s = 60};
      vs_wheels a[VS_TEAM_SIZE], b[VS_TEAM_SIZE];
      for (int r = 0; r < VS_TEAM_SIZE; r++) {
        view.robot[0][r] = (vs_robot){.pose = {-0.2 * r, 0.1 * i * r - 0.1, 0.1 * i}, .valid = true};
        view.robot[1][r] = (vs_robot){.pose = {0.2 * r, 0.1 * r, 0}, .valid = true};
      }
      assert_ok(vs_player_step(here, &view, &game, 1.0 / 30, a, err));
      assert_ok(vs_player_step(there, &view, &game, 1.0 / 30, b, err));
      assert_memory_equal(a, b, sizeof a);
    }
    vs_player_close(here);
    vs_player_close(there);
  }
}

static void what_cannot_be_opened_says_why(void **state) {
  (void)state;
  vs_player *player;
  vs_error why = {0};
  assert_int_equal(vs_player_open_isolated("clever:", PATIENCE_MS, &player, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "'clever:' is no player"));
  assert_int_equal(vs_player_open_isolated("plugin:/nonexistent.so", PATIENCE_MS, &player, &why), VS_FAIL);
  assert_non_null(strstr(why.text, "/nonexistent.so"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_that_fails_is_named_and_started_again),
      cmocka_unit_test(one_that_is_killed_is_started_again),
      cmocka_unit_test(it_plays_as_it_does_in_this_process),
      cmocka_unit_test(what_cannot_be_opened_says_why),
  };
  return cmocka_run_group_tests_name("policy/player_process", tests, make_folder, remove_folder);
}
