// src/cli/main.c and src/cli/args.c, through the real binary
#include "assert_near.h"
#include "run_vsss.h"

static void unknown_command_is_named_with_status_2(void **state) {
  (void)state;
  assert_refused("smi", 2, "unknown command 'smi'");
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_command_is_named_with_status_2),
      cmocka_unit_test(no_command_lists_the_commands_with_status_2),
      cmocka_unit_test(every_command_has_help),
  };
  return cmocka_run_group_tests_name("cli/main", tests, NULL, NULL);
}
