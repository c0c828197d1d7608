// src/cli/main.c, src/cli/args.c and src/cli/version.c, through the real binary
#include <ctype.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "vsss/sim.h"
#include "vsss/version.h"

static void unknown_command_is_named_with_status_2(void **state) {
  (void)state;
  assert_refused("smi", 2, "unknown command 'smi'; did you mean 'sim'?");
}

static void no_command_lists_the_commands_with_status_2(void **state) {
  (void)state;
  static vsss_run run;
  vsss(&run, "");
  assert_int_equal(run.status, 2);
  assert_non_null(strstr(run.err, "usage: vsss COMMAND"));
}

static void every_command_has_help(void **state) {
  (void)state;
  static vsss_run list, one;
  vsss(&list, "--help");
  assert_int_equal(list.status, 0);
  int commands = 0;
  for (char *line = strtok(list.out, "\n"); line; line = strtok(NULL, "\n")) {
    char name[32], arguments[64], usage[64];
    if (strncmp(line, "  ", 2) != 0 || sscanf(line, "%31s", name) != 1) continue;
    snprintf(arguments, sizeof arguments, "%s --help", name);
    snprintf(usage, sizeof usage, "usage: vsss %s", name);
    vsss(&one, arguments);
    if (one.status != 0 || strncmp(one.out, usage, strlen(usage)) != 0)
      fail_msg("vsss %s: status %d: %s%s", arguments, one.status, one.out, one.err);
    snprintf(arguments, sizeof arguments, "%s --no-such-flag", name);
    assert_refused(arguments, 2, "unknown flag '--no-such-flag'");
    commands++;
  }
  assert_true(commands >= 1);
}

static void help_of_a_command_is_its_own_help(void **state) {
  (void)state;
  static vsss_run by_word, by_flag;
  vsss(&by_word, "help sim");
  vsss(&by_flag, "sim --help");
  assert_int_equal(by_word.status, 0);
  assert_string_equal(by_word.out, by_flag.out);
  assert_refused("help smi", 2, "did you mean 'sim'?");
}

static void a_slip_of_one_letter_is_told_what_was_meant(void **state) {
  (void)state;
  assert_refused("trian", 2, "did you mean 'train'?");
  assert_refused("eva", 2, "did you mean 'eval'?");
  assert_refused("fieldd", 2, "did you mean 'field'?");
  assert_refused("plat", 2, "did you mean 'plot'?");
  assert_refused("xyz", 2, "'vsss --help' lists them");
}

static void version_names_release_commit_and_libraries(void **state) {
  (void)state;
  static vsss_run run;
  char release[32], mujoco[64];
  vsss(&run, "--version");
  assert_int_equal(run.status, 0);
  snprintf(release, sizeof release, "vsss %d.%d.%d (commit ", VSSS_VERSION_MAJOR, VSSS_VERSION_MINOR,
           VSSS_VERSION_PATCH);
  assert_int_equal(strncmp(run.out, release, strlen(release)), 0);
  snprintf(mujoco, sizeof mujoco, "MuJoCo %s, ONNX Runtime ", vs_mujoco_version());
  assert_non_null(strstr(run.out, mujoco));
  assert_non_null(strstr(run.out, "built with: "));
}

// Every feature that deploy/probe.sh looks for is told, on the line where it belongs.
static void version_names_every_feature(void **state) {
  (void)state;
  static vsss_run run;
  char line[256], name[32], found[16], with[512] = "", without[512] = "";
  vsss(&run, "--version");
  const char *at = strstr(run.out, "built with: ");
  assert_non_null(at);
  sscanf(at, "built with: %511[^\n]", with);
  if ((at = strstr(run.out, "built without: "))) sscanf(at, "built without: %511[^\n]", without);
  FILE *features = fopen("build/features.txt", "r");
  assert_non_null(features);
  int count = 0;
  while (fgets(line, sizeof line, features) && sscanf(line, "%31s %15s", name, found) == 2) {
    if (!strcmp(name, "MUJOCO") || !strcmp(name, "CMOCKA")) continue;
    for (char *c = name; *c; c++) *c = (char)tolower((unsigned char)*c);
    if (!strstr(strcmp(found, "found") ? without : with, name)) fail_msg("no %s in: %s", name, run.out);
    count++;
  }
  fclose(features);
  assert_true(count > 8);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_command_is_named_with_status_2),
      cmocka_unit_test(no_command_lists_the_commands_with_status_2),
      cmocka_unit_test(every_command_has_help),
      cmocka_unit_test(help_of_a_command_is_its_own_help),
      cmocka_unit_test(a_slip_of_one_letter_is_told_what_was_meant),
      cmocka_unit_test(version_names_release_commit_and_libraries),
      cmocka_unit_test(version_names_every_feature),
  };
  return cmocka_run_group_tests_name("cli/main", tests, NULL, NULL);
}
