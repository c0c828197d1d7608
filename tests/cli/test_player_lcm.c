// Tests src/cli/player_lcm.c against the example deploy/examples/lcm/player.c in a process of its own.
#include <math.h>
#include <signal.h>

#include "assert_near.h"
#include "cli/player_lcm.h"
#include "cli_bus.h"
#include "run_vsss.h"
#include "vsss/field.h"
#include "vsss/paths.h"

static char folder[64], uri[256];
static pid_t example;
static bool no_bus;

// Builds the example as its README says, and starts it for yellow.
static int start_example(void **state) {
  (void)state;
  vs_player_register("lcm:", PLAYER_LCM_HELP, player_lcm_open);
  snprintf(uri, sizeof uri, "lcm:yellow?timeout_ms=30000&url=%s", test_bus_url());
  vs_bus *bus = test_bus_open();
  no_bus = !bus;
  vs_bus_close(bus);
  if (no_bus) return 0;
  char makefile[512], command[1200];
  snprintf(folder, sizeof folder, "/tmp/vsss_lcm_XXXXXX");
  if (!mkdtemp(folder) || vs_path_find("deploy/examples/lcm/Makefile", makefile, sizeof makefile, NULL) != VS_OK)
    return -1;
  *strrchr(makefile, '/') = '\0';
  snprintf(command, sizeof command, "make -s -C '%s' OUT='%s/player' >&2", makefile, folder);
  if (system(command) != 0) return -1;
  fflush(NULL);
  example = fork();
  if (example == 0) {
    char binary[128];
    snprintf(binary, sizeof binary, "%s/player", folder);
    execl(binary, "player", "yellow", test_bus_url(), (char *)NULL);
    _exit(127);
  }
  return 0;
}

static int stop_example(void **state) {
  (void)state;
  if (no_bus) return 0;
  kill(example, SIGKILL);
  waitpid(example, NULL, 0);
  char command[128];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static void the_other_process_plays_in_its_own_frame(void **state) {
  (void)state;
  if (no_bus) skip();
  vs_player *player;
  assert_ok(vs_player_open(uri, &player, err));
  assert_int_equal(vs_player_kind(player), VS_SEES_WORLD);
  assert_int_equal(vs_player_state_size(player), 0);
  // As yellow sees it: robot 0 has the ball 0.2 m ahead, robot 1 has it 0.2 m to its left, robot 2 looks away from it.
  // 0.7 m/s / 0.03 m = 23.333 rad/s; 0.035 m * 8 /s * pi/2 / 0.03 m = 14.661 rad/s. Robot 2: error pi or -pi: -23.333
  // from driving, -+29.322 from turning, so 5.988 and -52.655, which is limited to -46.66.
  vs_world view = {0};
  vs_game game = {.duration_s = 120};
  view.ball.x_m = 0.4;
  view.robot[VS_OWN][0].pose = (vs_pose){0.2, 0, 0};
  view.robot[VS_OWN][1].pose = (vs_pose){0.4, -0.2, 0};
  view.robot[VS_OWN][2].pose = (vs_pose){0.6, 0, 0};
  vs_wheels out[VS_TEAM_SIZE];
  for (int i = 0; i < 20; i++) {
    assert_ok(vs_player_step(player, &view, &game, 1.0 / 30, out, err));
    assert_near(out[0].left_radps, 70.0 / 3, 1e-6);
    assert_near(out[0].right_radps, 70.0 / 3, 1e-6);
    assert_near(out[1].left_radps, -14.660766, 1e-5);
    assert_near(out[1].right_radps, 14.660766, 1e-5);
    assert_near(fmin(out[2].left_radps, out[2].right_radps), -46.66, 1e-9);
    assert_near(fmax(out[2].left_radps, out[2].right_radps), 5.988198, 1e-5);
  }
  assert_ok(vs_player_reset(player, 2, err)); // another match
  assert_ok(vs_player_step(player, &view, &game, 1.0 / 30, out, err));
  vs_player_close(player);
}

static void silence_is_an_error_that_names_player_and_time(void **state) {
  (void)state;
  if (no_bus) skip();
  char blue[256];
  snprintf(blue, sizeof blue, "lcm:blue?timeout_ms=120&url=%s", test_bus_url());
  vs_player *player;
  assert_ok(vs_player_open(blue, &player, err));
  vs_world view = {0};
  vs_game game = {0};
  vs_wheels out[VS_TEAM_SIZE];
  vs_error err = {0};
  assert_int_equal(vs_player_step(player, &view, &game, 1.0 / 30, out, &err), VS_FAIL);
  assert_non_null(strstr(err.text, blue));
  assert_non_null(strstr(err.text, "no answer within 120 ms"));
  vs_player_close(player);
}

static void wrong_uris_are_refused(void **state) {
  (void)state;
  const char *const wrong[] = {"lcm:",
                               "lcm:green",
                               "lcm:blue?timeout_ms=0",
                               "lcm:blue?timeout_ms=9x",
                               "lcm:blue?speed=1",
                               "lcm:blue?url=memq://",
                               "lcm:blue?timeout_ms=5&url=tcp://x"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vs_player *player;
    vs_error err = {0};
    if (vs_player_open(wrong[i], &player, &err) != VS_USAGE) fail_msg("'%s' was not refused: %s", wrong[i], err.text);
    assert_non_null(strstr(err.text, "lcm:"));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_other_process_plays_in_its_own_frame),
      cmocka_unit_test(silence_is_an_error_that_names_player_and_time),
      cmocka_unit_test(wrong_uris_are_refused),
  };
  return cmocka_run_group_tests_name("cli/player_lcm", tests, start_example, stop_example);
}
