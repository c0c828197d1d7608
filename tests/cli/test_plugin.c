// src/policy/plugin.c and deploy/examples/plugin/team.c, through the real binary
#include "policy/plugins/compile.h"
#include "run_vsss.h"

static vsss_run run;

static const char *arguments(const char *format, const char *name) {
  static char text[512];
  char file[128];
  snprintf(file, sizeof file, "%s/%s", folder, name);
  snprintf(text, sizeof text, format, file);
  return text;
}

static void the_example_team_scores_against_a_team_that_stands(void **state) {
  (void)state;
  compile_example();
  vsss(&run, arguments("sim --blue plugin:%s --yellow zero: --seconds 60 --drive planar --json", "team.so"));
  if (run.status != 0) fail_msg("status %d: %s", run.status, run.err);
  assert_non_null(strstr(run.out, "team.so"));
  const char *goals = strstr(run.out, "\"score\": [");
  if (!goals) fail_msg("no score in %s", run.out);
  assert_true(atoi(goals + strlen("\"score\": [")) >= 1);
}

static void a_crash_in_a_match_is_reported_by_name_with_status_1(void **state) {
  (void)state;
  const char *const how[] = {"segv", "fpe", "ill", "bus", "abort", "overflow"};
  for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
    char format[160];
    snprintf(format, sizeof format, "sim --yellow 'plugin:%%s?step=%s' --seconds 2 --drive planar", how[i]);
    assert_refused(arguments(format, "bad.so"), 1, "bad.so (\"bad\"): crashed in step (SIG");
  }
}

static void a_crash_on_one_of_several_threads_ends_the_run(void **state) {
  (void)state;
  vsss(&run, arguments("eval --blue 'plugin:%s?step=segv' --against zero: --matches 4 --seconds 2 --threads 2 "
                       "--drive planar",
                       "bad.so"));
  assert_int_equal(run.status, 1);
  assert_non_null(strstr(run.err, "bad.so (\"bad\"): crashed in step (SIGSEGV"));
}

static void a_crash_at_the_start_is_reported_by_name_with_status_1(void **state) {
  (void)state;
  assert_refused(arguments("sim --blue 'plugin:%s?init=segv'", "bad.so"), 1, "bad.so (\"bad\"): crashed in init (SIG");
}

static void a_command_that_is_no_number_is_named_with_status_1(void **state) {
  (void)state;
  assert_refused(arguments("sim --blue 'plugin:%s?step=nan' --drive planar", "bad.so"), 1,
                 "robot 2, left wheel: nan rad/s");
}

static void plugins_that_do_not_fit_are_refused(void **state) {
  (void)state;
  compile_bad("version", "-DBAD_VERSION=7");
  compile_bad("entry", "-DBAD_ENTRY");
  assert_refused(arguments("sim --blue plugin:%s", "version.so"), 1, "interface 7, this program speaks 2");
  assert_refused(arguments("sim --blue plugin:%s", "entry.so"), 1, "no symbol vsss_player");
  assert_refused(arguments("sim --blue plugin:%s", "nothing.so"), 1, "nothing.so: cannot be loaded");
  assert_refused("sim --blue plugin:", 2, "plugin: needs a file");
}

static void unknown_players_and_options_are_usage_errors(void **state) {
  (void)state;
  assert_refused("sim --blue ecm:", 2,
                 "'ecm:' is no player; known: onnx: emc: inf: emc22: random: zero: shake: plugin:");
  assert_refused("sim --blue 'emc:?pdi=1'", 2, "emc: has no option 'pdi=1'; it knows: pid");
  assert_refused("sim --yellow inf:x", 2, "inf:x: nothing but ?options may follow 'inf:'");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_example_team_scores_against_a_team_that_stands),
      cmocka_unit_test(a_crash_in_a_match_is_reported_by_name_with_status_1),
      cmocka_unit_test(a_crash_on_one_of_several_threads_ends_the_run),
      cmocka_unit_test(a_crash_at_the_start_is_reported_by_name_with_status_1),
      cmocka_unit_test(a_command_that_is_no_number_is_named_with_status_1),
      cmocka_unit_test(plugins_that_do_not_fit_are_refused),
      cmocka_unit_test(unknown_players_and_options_are_usage_errors),
  };
  return cmocka_run_group_tests_name("cli/plugin", tests, make_folder, remove_folder);
}
