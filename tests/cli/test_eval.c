// src/cli/cmd_eval.c, through the real binary
#include "assert_near.h"
#include "interrupt_vsss.h"
#include "test_folder.h"

static vsss_run run;

static void play(const char *arguments) {
  vsss(&run, arguments);
  if (run.status != 0) fail_msg("vsss %s: status %d: %s", arguments, run.status, run.err);
}

static void read_file(const char *path, char *out, size_t size) {
  FILE *f = fopen(path, "r");
  if (!f) fail_msg("%s was not written", path);
  vsss_read_all(f, out, size);
  fclose(f);
}

static void the_table_and_its_files_are_the_same_for_1_and_3_threads(void **state) {
  (void)state;
  static char arguments[512], json[2][65536], csv[2][4096], path[128];
  for (int k = 0; k < 2; k++) {
    snprintf(arguments, sizeof arguments,
             "eval --blue emc: --against random:,zero: --matches 3 --seconds 3 --drive planar --threads %d "
             "--json %s/%d.json --csv %s/%d.csv",
             1 + 2 * k, folder, k, folder, k);
    play(arguments);
    assert_non_null(strstr(run.out, "emc: as blue, 3 matches against each"));
    assert_non_null(strstr(run.out, "colours are not swapped"));
    assert_non_null(strstr(run.out, "\nrandom: "));
    assert_non_null(strstr(run.out, "\nzero: "));
    snprintf(path, sizeof path, "%s/%d.json", folder, k);
    read_file(path, json[k], sizeof json[k]);
    snprintf(path, sizeof path, "%s/%d.csv", folder, k);
    read_file(path, csv[k], sizeof csv[k]);
  }
  assert_string_equal(json[0], json[1]);
  assert_string_equal(csv[0], csv[1]);
  assert_non_null(strstr(json[0], "\"complete\": true"));
  assert_memory_equal(csv[0], "blue,yellow,matches,win,win_low,win_high,", 41);
  assert_non_null(strstr(csv[0], "\nemc:,random:,3,"));
  assert_non_null(strstr(csv[0], "\nemc:,zero:,3,"));
}

static void a_round_robin_prints_cross_table_and_elo(void **state) {
  (void)state;
  play("eval --round-robin emc:,zero:,random: --matches 2 --seconds 2 --drive planar");
  assert_non_null(strstr(run.out, "round robin of 3 players, 2 matches as blue and as yellow"));
  assert_non_null(strstr(run.out, "Elo"));
  // zero: against random: in 2 s: nobody scores, a cell of draws.
  assert_non_null(strstr(run.out, "0/100/0 +0.00"));
}

// Columns are counted in characters, not bytes, and what tells long names apart, their ends, stays.
static void long_and_accented_names_keep_the_columns(void **state) {
  (void)state;
  play("eval --round-robin emc:,zero:,random: --matches 1 --seconds 1 --drive planar --name Sele\u00e7\u00e3o "
       "--name runs/first/kept/0010.onnx --name runs/first/kept/0020.onnx");
  assert_non_null(
      strstr(run.out, "\n                  Sele\u00e7\u00e3o             ..t/kept/0010.onnx  ..t/kept/0020.onnx "));
  assert_non_null(strstr(run.out, "\n..kept/0010.onnx  "));
  assert_non_null(strstr(run.out, "\nSele\u00e7\u00e3o                              "));
  play("sim --blue zero: --yellow zero: --seconds 1 --drive planar --name 'Campe\u00f5es do Sul' --name \u00c1gua");
  assert_non_null(strstr(run.out, "\nplayer       ..s do Sul       \u00c1gua\n"));
  play(
      "eval --blue zero: --against emc: --matches 1 --seconds 1 --drive planar --name A --name 'Campe\u00f5es do Sul'");
  assert_non_null(strstr(run.out, "\n..\u00f5es do Sul      1  "));
}

// Matches of 2 s in which nobody scores: each goes to extra time and a shoot-out, and has a winner.
static void knockout_matches_have_a_winner(void **state) {
  (void)state;
  static char arguments[512], path[128], text[65536];
  snprintf(path, sizeof path, "%s/knockout.json", folder);
  snprintf(arguments, sizeof arguments,
           "eval --blue emc22: --against zero: --matches 3 --seconds 2 --drive planar --knockout --json %s", path);
  play(arguments);
  assert_non_null(strstr(run.out, "paper rules, knockout"));
  assert_non_null(strstr(run.out, "emc22: against zero:: 3 of 3 matches went to extra time, 3 to a shoot-out\n"));
  read_file(path, text, sizeof text);
  assert_non_null(strstr(text, "\"knockout\": true"));
  assert_non_null(strstr(text, "\"draw\": {\"mean\": 0,"));
  int ended = 0;
  for (const char *at = text; (at = strstr(at, "\"ended_in\": \"shoot-out\"")) != NULL; at++) ended++;
  assert_int_equal(ended, 3);
  assert_null(strstr(text, "\"winner\": null"));
}

// EMC beats a team that stands still from either side; 4 matches of 2 in each colour, and no line is longer than 100.
static void both_colours_count_together_under_the_names_given(void **state) {
  (void)state;
  play("eval --blue zero: --against emc: --swap --matches 2 --seconds 20 --drive planar --name Us --name Them");
  char *row = strstr(run.out, "\nThem ");
  assert_non_null(row);
  assert_int_equal(atoi(row + 6), 4);
  assert_non_null(strstr(row, "0 [0, 49]")); // no match of 4 won: Wilson
  assert_non_null(strstr(run.out, "Us as blue, 2 matches against each, and as yellow"));
  play("eval --matches 2 --seconds 1 --drive planar --against random:,inf:,emc22:");
  for (char *line = run.out; *line; line += strcspn(line, "\n") + 1)
    if (strcspn(line, "\n") > 100) fail_msg("too wide: %.*s", (int)strcspn(line, "\n"), line);
  assert_refused("eval --round-robin emc:,inf: --swap", 2, "plays both colours");
  assert_refused("eval --against emc: --name a --name b --name c", 2, "given 3 times for 2 players");
}

// The third match of a series has the hash that it has alone.
static void one_match_of_a_series_is_played_again(void **state) {
  (void)state;
  char hash[32] = "";
  play("sim --blue random: --yellow emc: --seconds 2 --drive planar --matches 3 --seed 18446744073709551615 --json");
  char *third = run.out;
  for (int i = 0; i < 3; i++) third = strstr(third + 1, "\"hash\": \"");
  snprintf(hash, sizeof hash, "%.16s", third + 9);
  play("sim --blue random: --yellow emc: --seconds 2 --drive planar --match 3 --seed 0xffffffffffffffff --name A");
  if (!strstr(run.out, hash)) fail_msg("no %s in %s", hash, run.out);
  assert_non_null(strstr(run.out, "match 3"));
  assert_non_null(strstr(run.out, "A (blue) against emc:"));
}

static void an_interrupted_evaluation_prints_what_is_done(void **state) {
  (void)state;
  vsss_interrupt(&run, "eval --blue emc: --matches 100000 --against random:", "kicks off first");
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "stopped: "));
  assert_non_null(strstr(run.out, "win % [95 %]"));
}

static void bad_requests_are_refused_before_any_match(void **state) {
  (void)state;
  assert_refused("eval --against random:,nobody:", 2, "nobody:");
  assert_refused("eval --against random:,,zero:", 2, "empty name");
  assert_refused("eval --round-robin emc:", 2, "at least 2");
  assert_refused("eval --round-robin emc:,inf: --against zero:", 2, "exclude");
  assert_refused("eval --matches 0", 2, "--matches");
  assert_refused("eval --json /nowhere/at/all.json", 1, "/nowhere/at/all.json");
  assert_refused("eval --csv /nowhere/at/all.csv", 1, "/nowhere/at/all.csv");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_table_and_its_files_are_the_same_for_1_and_3_threads),
      cmocka_unit_test(a_round_robin_prints_cross_table_and_elo),
      cmocka_unit_test(long_and_accented_names_keep_the_columns),
      cmocka_unit_test(knockout_matches_have_a_winner),
      cmocka_unit_test(both_colours_count_together_under_the_names_given),
      cmocka_unit_test(one_match_of_a_series_is_played_again),
      cmocka_unit_test(an_interrupted_evaluation_prints_what_is_done),
      cmocka_unit_test(bad_requests_are_refused_before_any_match),
  };
  return cmocka_run_group_tests_name("cli/eval", tests, make_folder, remove_folder);
}
