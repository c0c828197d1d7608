// src/policy/plugin.c and src/policy/plugin_guard.c, and the example deploy/examples/plugin/team.c
#include "plugins/compile.h"
#include "vsss/field.h"
#include "vsss/geom.h"
#include "vsss/policy.h"

static void bad_uri(char *uri, size_t size, const char *name, const char *options) {
  snprintf(uri, size, "plugin:%s/%s.so%s%s", folder, name, *options ? "?" : "", options);
}

static void assert_open_fails(const char *name, const char *options, const char *word) {
  char uri[256];
  bad_uri(uri, sizeof uri, name, options);
  vs_player *player;
  vs_error err = {0};
  assert_int_equal(vs_player_open(uri, &player, &err), VS_FAIL);
  assert_null(player);
  if (!strstr(err.text, word) || !strstr(err.text, folder))
    fail_msg("'%s' does not name the file and '%s'", err.text, word);
}

static void missing_file_is_refused(void **state) {
  (void)state;
  assert_open_fails("nothing", "", "No such file");
}

static void file_that_is_no_library_is_refused(void **state) {
  (void)state;
  char path[128];
  snprintf(path, sizeof path, "%s/text.so", folder);
  FILE *f = fopen(path, "w");
  fputs("not a library\n", f);
  fclose(f);
  assert_open_fails("text", "", "cannot be loaded");
}

static void plugin_without_the_entry_is_refused(void **state) {
  (void)state;
  compile_bad("entry", "-DBAD_ENTRY");
  assert_open_fails("entry", "", "no symbol vsss_player");
}

static void plugin_with_an_unresolved_symbol_is_refused_with_its_name(void **state) {
  (void)state;
  compile_bad("symbol", "-DBAD_SYMBOL");
  assert_open_fails("symbol", "", "nobody_has_this");
}

static void plugin_of_another_version_is_refused(void **state) {
  (void)state;
  compile_bad("version", "-DBAD_VERSION=7");
  assert_open_fails("version", "", "interface 7, this program speaks 2");
}

// Built with the header of interface 1: it finds the ball behind three robots a team, and steers with it.
static void plugin_of_the_first_interface_plays_on_in_3v3_alone(void **state) {
  (void)state;
  char command[4 * PATH_MAX], uri[256];
  snprintf(command, sizeof command,
           "cd '%s' && ${CC:-cc} -O1 -fPIC -shared -o '%s/first.so' tests/policy/plugins/first_interface.c", root,
           folder);
  if (system(command) != 0) fail_msg("failed: %s", command);
  bad_uri(uri, sizeof uri, "first", "");
  vs_player *player;
  vs_error why = {0};
  assert_ok(vs_player_open(uri, &player, err));
  vs_world view = {.ball = {.x_m = 0.25}};
  view.robot[VS_ADVERSARY][2].pose.y_m = -0.5;
  vs_game game = {0};
  vs_wheels out[VS_TEAM_MOST] = {{0}};
  assert_ok(vs_player_step(player, &view, &game, 0.1, out, err));
  assert_near(out[0].left_radps, 25, 1e-12);
  assert_near(out[2].right_radps, -5, 1e-12);
  assert_ok(vs_player_plays(player, VS_3V3, err));
  assert_int_equal(vs_player_plays(player, VS_5V5, &why), VS_USAGE);
  assert_non_null(strstr(why.text, "does not play 5v5"));
  vs_player_close(player);
}

static void plugin_without_step_is_refused(void **state) {
  (void)state;
  compile_bad("step", "-DBAD_STEP");
  assert_open_fails("step", "", "has no step");
}

static void plugin_whose_rate_does_not_divide_the_cameras_is_refused(void **state) {
  (void)state;
  compile_bad("rate", "-DBAD_RATE=20");
  assert_open_fails("rate", "", "rate_hz 20");
}

static void plugin_that_crashes_while_loading_is_named(void **state) {
  (void)state;
  compile_bad("load", "-DBAD_LOAD");
  assert_open_fails("load", "", "crashed in loading (SIGSEGV");
}

static void failed_init_is_reported_with_its_reason(void **state) {
  (void)state;
  assert_open_fails("bad", "init=fail", "(\"bad\"): init: its file is missing");
}

static void crash_in_init_is_named(void **state) {
  (void)state;
  assert_open_fails("bad", "init=segv", "(\"bad\"): crashed in init (SIGSEGV");
  assert_open_fails("bad", "init=abort", "crashed in init (SIGABRT");
}

// Two good steps, then the third fails and says so; after a crash the plugin is not called again.
static void assert_third_step_fails(const char *how, const char *word, bool crash) {
  char uri[256], options[32];
  snprintf(options, sizeof options, "step=%s", how);
  bad_uri(uri, sizeof uri, "bad", options);
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  for (int k = 1; k <= 2; k++) {
    assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
    assert_near(out[0].left_radps, k, 0);
    assert_near(out[1].right_radps, 0, 0); // not written by the plugin: stands still
  }
  vs_error err = {0};
  assert_int_equal(vs_player_step(player, &world, &game, 1.0 / 30, out, &err), VS_FAIL);
  if (!strstr(err.text, word) || !strstr(err.text, "bad.so")) fail_msg("'%s' does not name '%s'", err.text, word);
  if (crash) {
    assert_int_equal(vs_player_step(player, &world, &game, 1.0 / 30, out, &err), VS_FAIL);
    assert_non_null(strstr(err.text, "has crashed before"));
  }
  vs_player_close(player);
}

static void crash_in_step_is_named(void **state) {
  (void)state;
  assert_third_step_fails("segv", "(\"bad\"): crashed in step (SIGSEGV", true);
  assert_third_step_fails("fpe", "crashed in step (SIGFPE", true);
  assert_third_step_fails("ill", "crashed in step (SIGILL", true);
  assert_third_step_fails("bus", "crashed in step (SIGBUS", true);
  assert_third_step_fails("abort", "crashed in step (SIGABRT", true);
}

static void endless_recursion_is_named(void **state) {
  (void)state;
  assert_third_step_fails("overflow", "crashed in step (SIGSEGV", true);
}

static void command_that_is_no_number_is_named(void **state) {
  (void)state;
  assert_third_step_fails("nan", "robot 2, left wheel: nan", false);
}

static void plugin_calls_its_own_function_where_the_program_has_one_of_that_name(void **state) {
  (void)state;
#ifdef __SANITIZE_ADDRESS__
  skip(); // the sanitizer cannot load plugins that way
#endif
  char uri[256];
  bad_uri(uri, sizeof uri, "bad", "step=wrap");
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  vs_world world = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  for (int k = 0; k < 3; k++) assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
  assert_near(out[2].left_radps, 18, 0);
  assert_near(vs_wrap_rad(1.0), 1, 0);
  vs_player_close(player);
}

static void crash_at_the_end_of_a_match_does_not_end_the_program(void **state) {
  (void)state;
  char uri[256];
  bad_uri(uri, sizeof uri, "bad", "free=segv");
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  vs_player_close(player);
}

// The example, built by its own Makefile.
static vs_player *example(const char *options) {
  compile_example();
  char uri[256];
  snprintf(uri, sizeof uri, "plugin:%s/team.so%s", folder, options);
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  return player;
}

// Robots that follow their wheels exactly; the ball lies still.
static void follow(vs_world *world, const vs_wheels wheels[VS_TEAM_SIZE], double dt_s) {
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    vs_pose *p = &world->robot[VS_OWN][i].pose;
    double left = wheels[i].left_radps * VS_WHEEL_RADIUS_M, right = wheels[i].right_radps * VS_WHEEL_RADIUS_M;
    p->theta_rad += (right - left) / (2 * VS_HALF_TRACK_M) * dt_s;
    p->x_m += (left + right) / 2 * cos(p->theta_rad) * dt_s;
    p->y_m += (left + right) / 2 * sin(p->theta_rad) * dt_s;
  }
}

static void example_team_goes_behind_the_ball_and_through_it(void **state) {
  (void)state;
  vs_player *player = example("");
  assert_string_equal(vs_player_name(player), "example team");
  vs_world world = {.ball = {.x_m = 0.1, .y_m = 0.1}};
  world.robot[VS_OWN][0].pose = (vs_pose){-0.5, 0.3, 0};
  world.robot[VS_OWN][1].pose = (vs_pose){0.5, -0.2, 1};
  world.robot[VS_OWN][2].pose = (vs_pose){-0.4, -0.4, 2};
  vs_game game = {0};
  double nearest_m = 1;
  const vs_pose *r = &world.robot[VS_OWN][1].pose;
  for (int k = 0; k < 150 && nearest_m > 0.061; k++) { // 5 s; touching: half a robot and the ball's radius
    vs_wheels out[VS_TEAM_SIZE];
    assert_ok(vs_player_step(player, &world, &game, 1.0 / 30, out, err));
    follow(&world, out, 1.0 / 30);
    nearest_m = fmin(nearest_m, hypot(r->x_m - 0.1, r->y_m - 0.1));
  }
  assert_true(nearest_m <= 0.061);
  // It comes from behind, heading for the goal at (0.75, 0), give or take 20 degrees, with either end.
  double to_goal = atan2(-0.1, 0.65), off = fabs(remainder(r->theta_rad - to_goal, M_PI));
  assert_true(off < 20 * M_PI / 180);
  // The keeper stands on its line, level with the ball.
  assert_near(world.robot[VS_OWN][0].pose.x_m, -0.69, 0.03);
  assert_near(world.robot[VS_OWN][0].pose.y_m, 0.1, 0.03);
  vs_player_close(player);
}

static void example_team_refuses_an_option_it_does_not_know(void **state) {
  (void)state;
  vs_player_close(example("?speed=0.5"));
  char uri[256];
  static const char *const wrong[] = {"sped=0.5", "speed=9"};
  for (int i = 0; i < 2; i++) {
    bad_uri(uri, sizeof uri, "team", wrong[i]);
    vs_player *player;
    vs_error err = {0};
    assert_int_equal(vs_player_open(uri, &player, &err), VS_USAGE);
    assert_non_null(strstr(err.text, "the only option is speed="));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(missing_file_is_refused),
      cmocka_unit_test(file_that_is_no_library_is_refused),
      cmocka_unit_test(plugin_without_the_entry_is_refused),
      cmocka_unit_test(plugin_with_an_unresolved_symbol_is_refused_with_its_name),
      cmocka_unit_test(plugin_of_another_version_is_refused),
      cmocka_unit_test(plugin_of_the_first_interface_plays_on_in_3v3_alone),
      cmocka_unit_test(plugin_without_step_is_refused),
      cmocka_unit_test(plugin_whose_rate_does_not_divide_the_cameras_is_refused),
      cmocka_unit_test(plugin_that_crashes_while_loading_is_named),
      cmocka_unit_test(failed_init_is_reported_with_its_reason),
      cmocka_unit_test(crash_in_init_is_named),
      cmocka_unit_test(crash_in_step_is_named),
      cmocka_unit_test(endless_recursion_is_named),
      cmocka_unit_test(command_that_is_no_number_is_named),
      cmocka_unit_test(plugin_calls_its_own_function_where_the_program_has_one_of_that_name),
      cmocka_unit_test(crash_at_the_end_of_a_match_does_not_end_the_program),
      cmocka_unit_test(example_team_goes_behind_the_ball_and_through_it),
      cmocka_unit_test(example_team_refuses_an_option_it_does_not_know),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
