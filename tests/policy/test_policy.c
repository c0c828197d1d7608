// src/policy/policy.c
#include "assert_near.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/policy.h"
#include "vsss/rng.h"

#include <string.h>

static vs_player *opened(const char *uri) {
  vs_player *player = NULL;
  assert_ok(vs_player_open(uri, &player, err));
  return player;
}

static void assert_refused(const char *uri, vs_status status, const char *word) {
  vs_player *player = (vs_player *)1;
  vs_error err = {0};
  assert_int_equal(vs_player_open(uri, &player, &err), status);
  assert_null(player);
  if (!strstr(err.text, word)) fail_msg("'%s' does not name '%s'", err.text, word);
}

static void unknown_scheme_is_a_usage_error_that_lists_the_known_ones(void **state) {
  (void)state;
  assert_refused("ecm:", VS_USAGE, "'ecm:'");
  assert_refused("ecm:", VS_USAGE, "random:");
  assert_refused("random", VS_USAGE, "plugin:");
  assert_refused("", VS_USAGE, "onnx:");
}

static void unknown_options_are_usage_errors(void **state) {
  (void)state;
  assert_refused("zero:?pid=1", VS_USAGE, "takes no options");
  assert_refused("random:?speed=1", VS_USAGE, "speed=1");
}

static void words_after_a_built_in_scheme_are_usage_errors(void **state) {
  (void)state;
  assert_refused("zero:x", VS_USAGE, "zero:x");
  assert_refused("plugin:", VS_USAGE, "needs a file");
}

static void zero_stands_still(void **state) {
  (void)state;
  vs_player *player = opened("zero:");
  assert_int_equal(vs_player_kind(player), VS_SEES_WORLD);
  assert_string_equal(vs_player_uri(player), "zero:");
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE] = {{1, 2}, {3, 4}, {5, 6}};
  assert_ok(vs_player_step(player, &world, &game, 0.1, out, err));
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    assert_near(out[i].left_radps, 0, 0);
    assert_near(out[i].right_radps, 0, 0);
  }
  vs_player_close(player);
}

static void random_is_uniform_within_the_limit_and_repeats_by_seed(void **state) {
  (void)state;
  vs_player *a = opened("random:"), *b = opened("random:");
  vs_world world = {0};
  vs_game game = {0};
  assert_near(vs_player_rate_hz(a), 10, 0);
  assert_ok(vs_player_reset(a, 5, err));
  assert_ok(vs_player_reset(b, 5, err));
  double sum = 0, squares = 0;
  const int n = 20000;
  for (int k = 0; k < n; k++) {
    vs_wheels x[VS_TEAM_SIZE], y[VS_TEAM_SIZE];
    assert_ok(vs_player_step(a, &world, &game, 0.1, x, err));
    assert_ok(vs_player_step(b, &world, &game, 0.1, y, err));
    assert_memory_equal(x, y, sizeof x);
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      assert_true(fabs(x[i].left_radps) <= VS_WHEEL_LIMIT_RADPS && fabs(x[i].right_radps) <= VS_WHEEL_LIMIT_RADPS);
      sum += x[i].left_radps + x[i].right_radps;
      squares += x[i].left_radps * x[i].left_radps + x[i].right_radps * x[i].right_radps;
    }
  }
  // Uniform on [-L, L]: mean 0, variance L^2/3 = 725.7; 120,000 draws put the mean within 0.31 (four deviations).
  assert_near(sum / (6.0 * n), 0.0, 0.31);
  assert_near(squares / (6.0 * n), VS_WHEEL_LIMIT_RADPS * VS_WHEEL_LIMIT_RADPS / 3.0, 8.0);
  vs_player_close(a);
  vs_player_close(b);
}

static void restored_random_player_repeats_its_commands(void **state) {
  (void)state;
  vs_player *player = opened("random:");
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels first[VS_TEAM_SIZE], again[VS_TEAM_SIZE];
  unsigned char saved[64];
  assert_true(vs_player_state_size(player) > 0 && vs_player_state_size(player) <= sizeof saved);
  vs_player_save(player, saved);
  assert_ok(vs_player_step(player, &world, &game, 0.1, first, err));
  assert_ok(vs_player_restore(player, saved, err));
  assert_ok(vs_player_step(player, &world, &game, 0.1, again, err));
  assert_memory_equal(first, again, sizeof first);
  vs_player_close(player);
}

// A player of another module, as lcm: is: what its step writes is clamped or refused.
static double given_radps;

static vs_status given_init(void *state, uint64_t seed, const char *options, vs_error *err) {
  (void)state, (void)seed;
  if (strcmp(options, "a=1") != 0) return vs_fail(err, VS_USAGE, "options '%s'", options);
  return VS_OK;
}

static void given_step(void *state, const vs_world *world, const vs_game *game, double dt_s, vs_wheels *out) {
  (void)state, (void)world, (void)game, (void)dt_s;
  memset(out, 0, VS_TEAM_SIZE * sizeof *out);
  out[1].right_radps = given_radps;
}

static const vsss_player_api given = {VSSS_PLAYER_VERSION, "given", 30, 0, given_init, given_step, NULL, 0};

static const char *given_failure(const void *state) {
  (void)state;
  return given_radps == 1234 ? "went home" : NULL;
}

static vs_status given_open(const char *rest, vs_player_given *out, vs_error *err) {
  if (strncmp(rest, "here", 4) != 0) return vs_fail(err, VS_FAIL, "given:%s is nowhere", rest);
  *out = (vs_player_given){.api = &given, .failure = given_failure};
  return VS_OK;
}

static void registered_scheme_opens_with_its_rest_and_options(void **state) {
  (void)state;
  vs_player_register("given:", "what this test gives", given_open);
  assert_refused("given:there", VS_FAIL, "there is nowhere");
  assert_refused("given:here?a=2", VS_USAGE, "options 'a=2'");
  vs_player *player = opened("given:here?a=1");
  assert_string_equal(vs_player_name(player), "given");
  assert_int_equal(vs_player_state_size(player), 0);
  char known[256];
  vs_player_schemes(known, sizeof known);
  assert_non_null(strstr(known, "given:"));
  vs_player_close(player);
}

static void command_is_clamped_or_if_not_finite_refused_by_name(void **state) {
  (void)state;
  vs_player_register("given:", "what this test gives", given_open);
  vs_player *player = opened("given:here?a=1");
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  given_radps = -100;
  assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
  assert_near(out[1].right_radps, -VS_WHEEL_LIMIT_RADPS, 0);
  given_radps = NAN;
  vs_error err = {0};
  assert_int_equal(vs_player_step(player, &world, &game, 1.0 / 30, out, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "player given:here?a=1, robot 1, right wheel: nan"));
  given_radps = 1234;
  assert_int_equal(vs_player_step(player, &world, &game, 1.0 / 30, out, &err), VS_FAIL);
  assert_string_equal(err.text, "given:here?a=1: went home");
  vs_player_close(player);
}

// Coordinates on a coarse grid, so that robots, ball and lines of the strategies often coincide exactly.
static double coarse(vs_rng *rng, double half_m) { return half_m * ((int)vs_rng_below(rng, 21) - 10) / 10.0; }

static vs_pose coarse_pose(vs_rng *rng) {
  return (vs_pose){coarse(rng, 0.85), coarse(rng, 0.65), VS_PI * ((int)vs_rng_below(rng, 17) - 8) / 8.0};
}

static void assert_always_finite(const char *uri) {
  vs_player *player = opened(uri);
  vs_rng rng = vs_rng_make(11, 0);
  vs_game game = {0};
  for (int k = 0; k < 20000; k++) {
    vs_world world = {0};
    for (int i = 0; i < VS_TEAM_SIZE; i++) {
      world.robot[VS_OWN][i].pose = coarse_pose(&rng);
      world.robot[VS_ADVERSARY][i] = (vs_robot){.pose = coarse_pose(&rng), .valid = true};
    }
    world.ball = (vs_ball){.x_m = coarse(&rng, 0.85), .y_m = coarse(&rng, 0.65)};
    if (k % 3 == 0) world.ball.vx_mps = coarse(&rng, 1), world.ball.vy_mps = coarse(&rng, 1);
    if (k % 50 == 0)
      game.last_event = (vs_event){(vs_event_kind)vs_rng_below(&rng, VS_EVENT_KINDS), (vs_team)(k / 50 % 2), 0, k};
    vs_wheels out[VS_TEAM_SIZE];
    assert_ok(vs_player_step(player, &world, &game, k % 7 ? 1.0 / 30 : 0.0, out, err));
  }
  vs_player_close(player);
}

static void scripted_players_give_numbers_in_any_world(void **state) {
  (void)state;
  assert_always_finite("emc:");
  assert_always_finite("emc:?pid=1");
  assert_always_finite("inf:");
  assert_always_finite("emc22:");
}

static void scripted_players_refuse_options_they_do_not_know(void **state) {
  (void)state;
  assert_refused("emc:?pdi=1", VS_USAGE, "emc: has no option 'pdi=1'; it knows: pid");
  assert_refused("emc:?pid=maybe", VS_USAGE, "pid = maybe");
  assert_refused("inf:?pid=1", VS_USAGE, "inf: takes no options");
  assert_refused("emc22:?pid=1", VS_USAGE, "emc22: takes no options");
}

// Every player's snapshot carries on as the player does.
static void restored_players_repeat_their_commands(void **state) {
  (void)state;
  static const char *const uris[] = {"emc:?pid=1", "inf:", "emc22:", "random:"};
  for (size_t u = 0; u < sizeof uris / sizeof *uris; u++) {
    vs_player *player = opened(uris[u]), *other = opened(uris[u]);
    vs_rng rng = vs_rng_make(u, 0);
    vs_game game = {0};
    static unsigned char saved[4096];
    assert_true(vs_player_state_size(player) <= sizeof saved);
    for (int k = 0; k < 200; k++) {
      vs_world world = {.ball = {.x_m = coarse(&rng, 0.7), .y_m = coarse(&rng, 0.6)}};
      for (int i = 0; i < VS_TEAM_SIZE; i++) world.robot[VS_OWN][i].pose = coarse_pose(&rng);
      vs_wheels a[VS_TEAM_SIZE], b[VS_TEAM_SIZE];
      if (k == 100) {
        vs_player_save(player, saved);
        assert_ok(vs_player_restore(other, saved, err));
      }
      assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, a, err));
      if (k < 100) continue;
      assert_ok(vs_player_step(other, &world, &game, 1.0 / 30, b, err));
      assert_memory_equal(a, b, sizeof a);
    }
    vs_player_close(player);
    vs_player_close(other);
  }
}

static void every_listed_scheme_has_a_help_line(void **state) {
  (void)state;
  const char *name, *help;
  int n = 0;
  for (; vs_player_scheme(n, &name, &help); n++) assert_true(strchr(name, ':') && *help);
  assert_true(n >= 7);
  assert_false(vs_player_scheme(-1, &name, &help));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_scheme_is_a_usage_error_that_lists_the_known_ones),
      cmocka_unit_test(unknown_options_are_usage_errors),
      cmocka_unit_test(words_after_a_built_in_scheme_are_usage_errors),
      cmocka_unit_test(zero_stands_still),
      cmocka_unit_test(random_is_uniform_within_the_limit_and_repeats_by_seed),
      cmocka_unit_test(restored_random_player_repeats_its_commands),
      cmocka_unit_test(registered_scheme_opens_with_its_rest_and_options),
      cmocka_unit_test(command_is_clamped_or_if_not_finite_refused_by_name),
      cmocka_unit_test(scripted_players_give_numbers_in_any_world),
      cmocka_unit_test(scripted_players_refuse_options_they_do_not_know),
      cmocka_unit_test(restored_players_repeat_their_commands),
      cmocka_unit_test(every_listed_scheme_has_a_help_line),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
