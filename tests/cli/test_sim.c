// src/cli/cmd_sim.c, through the real binary
#include <stdbool.h>

#include "assert_near.h"
#include "cli_bus.h"
#include "interrupt_vsss.h"
#include "vsss/bus.h"

static vsss_run run, other;

// Runs and expects success.
static void play(vsss_run *r, const char *arguments) {
  vsss(r, arguments);
  if (r->status != 0) fail_msg("vsss %s: status %d: %s", arguments, r->status, r->err);
}

static bool has_lcm(void) {
  vs_bus *bus = NULL;
  bool opened = vs_bus_open("memq://", &bus, NULL) == VS_OK;
  vs_bus_close(bus);
  return opened;
}

// From the first '{' to the last '}', with nothing before or after but a newline, brackets in pairs.
static void assert_one_json_object(const char *text) {
  int depth = 0;
  bool quoted = false;
  const char *c = text;
  assert_int_equal(*c, '{');
  do {
    if (*c == '"' && (c == text || c[-1] != '\\')) quoted = !quoted;
    if (!quoted && (*c == '{' || *c == '[')) depth++;
    if (!quoted && (*c == '}' || *c == ']')) depth--;
    c++;
  } while (*c && depth > 0);
  assert_int_equal(depth, 0);
  assert_string_equal(c, "\n");
}

static const char *value_of(const char *json, const char *key) {
  char quoted[64];
  snprintf(quoted, sizeof quoted, "\"%s\": ", key);
  const char *at = strstr(json, quoted);
  if (!at) fail_msg("no %s in %s", key, json);
  return at + strlen(quoted);
}

static void a_match_shows_its_events_and_a_table(void **state) {
  (void)state;
  play(&run, "sim --seconds 3");
  // Our policy, or, where this build cannot play it, EMC and a word about it.
  bool told = strstr(run.err, "emc: plays blue: ") != NULL;
  assert_non_null(
      strstr(run.out, told ? "emc: (blue) against emc22: (yellow)" : "onnx: (blue) against emc22: (yellow)"));
  assert_true(!told || strstr(run.err, "no ONNX Runtime"));
  assert_non_null(strstr(run.out, "0.00 s  kick-off"));
  assert_non_null(strstr(run.out, "3.00 s  end"));
  assert_non_null(strstr(run.out, "goals"));
  assert_non_null(strstr(run.out, "penalties"));
  assert_non_null(strstr(run.out, "free balls"));
  assert_non_null(strstr(run.out, "times real time"));
}

static int goals_of_blue(const char *against) {
  char arguments[128];
  snprintf(arguments, sizeof arguments, "sim --yellow %s --drive planar --json --seed 3", against);
  play(&run, arguments);
  const char *score = strstr(run.out, "\"score\": ["); // blue's comes first
  assert_non_null(score);
  return atoi(strchr(score, '[') + 1);
}

static void our_policy_scores(void **state) {
  (void)state;
  play(&run, "sim --seconds 1 --json");
  if (strstr(run.err, "no ONNX Runtime")) {
    print_message("note: this build has no ONNX Runtime\n");
    skip();
  }
  assert_true(goals_of_blue("random:") >= 1); // 5.9 in a match at the time of writing
}

static void json_is_one_object_and_nothing_else(void **state) {
  (void)state;
  play(&run, "sim --seconds 2 --yellow random: --json --seed 5");
  assert_one_json_object(run.out);
  assert_memory_equal(value_of(run.out, "yellow"), "\"random:\"", 9);
  assert_memory_equal(value_of(run.out, "seed"), "5,", 2);
  assert_memory_equal(value_of(run.out, "complete"), "true", 4);
  assert_memory_equal(value_of(run.out, "time_s"), "2,", 2);
}

static void several_matches_are_the_same_for_1_and_3_threads_and_with_watchers(void **state) {
  (void)state;
  play(&run, "sim --matches 3 --seconds 2 --json --threads 1 --drive planar");
  assert_one_json_object(run.out);
  play(&other, "sim --matches 3 --seconds 2 --json --threads 3 --drive planar");
  assert_string_equal(value_of(run.out, "summary"), value_of(other.out, "summary"));
  play(&other, has_lcm() ? "sim --matches 3 --seconds 2 --json --drive planar --lcm 'memq://'"
                         : "sim --matches 3 --seconds 2 --json --drive planar --realtime");
  assert_string_equal(value_of(run.out, "summary"), value_of(other.out, "summary"));
  play(&other, "sim --matches 3 --seconds 2 --json --threads 1 --drive planar --seed 2");
  assert_string_not_equal(value_of(run.out, "summary"), value_of(other.out, "summary"));
}

static void several_matches_end_in_rates_with_intervals(void **state) {
  (void)state;
  play(&run, "sim --matches 4 --seconds 2 --blue zero: --yellow zero: --drive planar");
  assert_non_null(strstr(run.out, "win % [95 %]"));
  assert_non_null(strstr(run.out, "100 [51, 100]")); // draws: nobody moves; Wilson: 4 of 4 is at least 4/(4 + 1.96^2)
  assert_non_null(strstr(run.out, "free balls"));
}

// Three seconds of the wall clock for three of the match.
static void realtime_keeps_the_pace_of_the_clock(void **state) {
  (void)state;
  play(&run, "sim --seconds 3 --realtime --json --drive planar --blue zero: --yellow random:");
  double wall_s = atof(value_of(run.out, "wall_s"));
  assert_true(wall_s >= 2.99);
}

static void an_interrupted_match_prints_what_is_done(void **state) {
  (void)state;
  vsss_interrupt(&run, "sim --seconds 7000", "kick-off");
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "stopped: "));
  assert_non_null(strstr(run.out, "goals"));
}

// Two seconds: the start and 60 frames of truth and state, 60 commands of each team, the referee's kick-off and end.
static void what_is_published_can_be_replayed(void **state) {
  (void)state;
  if (!has_lcm()) {
    print_message("note: built without LCM\n");
    skip();
  }
  char folder[] = "/tmp/vsss_sim_XXXXXX", arguments[512], remove[64];
  assert_non_null(mkdtemp(folder));
  snprintf(arguments, sizeof arguments,
           "sim --seconds 2 --drive planar --blue zero: --yellow random: --lcm 'file://%s/log?mode=w'", folder);
  play(&run, arguments);
  snprintf(arguments, sizeof arguments, "replay %s/log --json", folder);
  play(&run, arguments);
  assert_non_null(strstr(run.out, "VSSS_TRUTH\", \"messages\": 61"));
  assert_non_null(strstr(run.out, "VSSS_STATE\", \"messages\": 61"));
  assert_non_null(strstr(run.out, "VSSS_CMD\", \"messages\": 120"));
  assert_non_null(strstr(run.out, "VSSS_REFEREE\", \"messages\": 2"));
  snprintf(remove, sizeof remove, "rm -r '%s'", folder);
  assert_int_equal(system(remove), 0);
}

// 4 simulated seconds at 10 times real time are 0.4 s, where they would be 0.02 s.
static void messages_over_udp_go_out_at_a_pace_that_listeners_keep(void **state) {
  (void)state;
  vs_bus *bus = test_bus_open();
  if (!bus) skip();
  vs_bus_close(bus);
  char arguments[256];
  snprintf(arguments, sizeof arguments, "sim --seconds 4 --drive planar --blue zero: --yellow zero: --json --lcm '%s'",
           test_bus_url());
  play(&run, arguments);
  assert_true(strtod(value_of(run.out, "wall_s"), NULL) > 0.39);
  assert_non_null(strstr(run.err, "10 times real time"));
  assert_null(strstr(run.err, "could not be sent"));
}

static void help_names_every_flag(void **state) {
  (void)state;
  play(&run, "sim --help");
  static const char *const flags[] = {"--blue",     "--yellow", "--matches", "--seconds",   "--seed",
                                      "--threads",  "--drive",  "--rules",   "--placement", "--realism",
                                      "--realtime", "--lcm",    "--video",   "--json"};
  for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) assert_non_null(strstr(run.out, flags[i]));
}

static void bad_requests_are_refused_in_one_line(void **state) {
  (void)state;
  assert_refused("sim --blue nobody:", 2, "nobody:");
  assert_refused("sim --blue onnx:/nowhere.onnx", 1, "/nowhere.onnx");
  assert_refused("sim --seconds -1", 2, "--seconds -1: allowed are 0 to 7200");
  assert_refused("sim --seconds nan", 2, "--seconds");
  assert_refused("sim --matches 0", 2, "--matches");
  assert_refused("sim --threads -1", 2, "--threads");
  assert_refused("sim --drive hover", 2, "hover");
  assert_refused("sim --rules street", 2, "street");
  assert_refused("sim --placement anywhere", 2, "anywhere");
  assert_refused("sim --realism /nowhere.ini", 1, "/nowhere.ini");
  assert_refused("sim --fast", 2, "--fast");
  assert_refused("sim emc:", 2, "emc:");
  assert_refused("sim --seconds", 2, "--seconds");
}

static void an_lcm_url_that_fails_is_an_error(void **state) {
  (void)state;
  vsss(&run, "sim --seconds 1 --json --lcm carrier-pigeon://field");
  assert_int_equal(run.status, 2);
  assert_non_null(strstr(run.err, "carrier-pigeon"));
  assert_string_equal(run.out, "");
}

// Two teams that stand still: nobody scores in 2 s, 1.2 s more and 40 kicks, and the lot decides; the same one every time.
static void a_knockout_match_goes_on_until_there_is_a_winner(void **state) {
  (void)state;
  static vsss_run again;
  vsss(&run, "sim --blue zero: --yellow zero: --seconds 2 --drive planar --knockout");
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "2.00 s  extra time, kick-off for blue\n"));
  assert_non_null(strstr(run.out, "shoot-out, kick of yellow  (0 : 0 of 1, 0 kicks)\n"));
  const char *end = strstr(run.out, "end  0 : 0  (0 : 0 of 20, 20 kicks)\n"),
             *winner = strstr(run.out, " wins by lot\n");
  assert_non_null(end);
  assert_non_null(winner);
  vsss(&again, "sim --blue zero: --yellow zero: --seconds 2 --drive planar --knockout");
  const char *same = strstr(again.out, " wins by lot\n");
  assert_non_null(same);
  assert_memory_equal(winner - 4, same - 4, 4);
  vsss(&again, "sim --blue zero: --yellow zero: --seconds 2 --drive planar");
  assert_null(strstr(again.out, "shoot-out"));
}

// Five robots a team: the same hash twice, and our policy refused with the reason; then a log that replay reads with ten robots.
static void five_against_five_is_played(void **state) {
  (void)state;
  play(&run, "sim --division 5v5 --yellow inf: --seconds 10 --drive planar --rules league --json");
  play(&other, "sim --division 5v5 --blue emc: --yellow inf: --seconds 10 --drive planar --rules league --json");
  assert_int_equal(strncmp(value_of(run.out, "division"), "\"5v5\"", 5), 0);
  assert_int_equal(strncmp(value_of(run.out, "blue"), "\"emc:\"", 6), 0); // not our policy
  assert_int_equal(strncmp(value_of(run.out, "hash"), value_of(other.out, "hash"), 18), 0);
  assert_refused("sim --division 5v5 --blue onnx: --seconds 1", 2, "three robots, not 5v5: use --division 3v3");
  assert_refused("eval --division 5v5 --against emc: --matches 1 --seconds 1", 2, "not 5v5");
  assert_refused("sim --division 4v4", 2, "division '4v4': expected 3v3 or 5v5");
}

static void five_against_five_is_recorded_and_read_again(void **state) {
  (void)state;
  if (!has_lcm()) {
    print_message("note: built without LCM\n");
    skip();
  }
  char log[64] = "/tmp/vsss_five_XXXXXX", command[256];
  int fd = mkstemp(log);
  assert_true(fd >= 0);
  close(fd);
  snprintf(command, sizeof command,
           "sim --division 5v5 --blue emc: --yellow inf: --seconds 2 --drive planar --lcm 'file://%s?mode=w'", log);
  play(&run, command);
  snprintf(command, sizeof command, "replay %s --channel VSSS_TRUTH", log);
  play(&run, command);
  assert_non_null(strstr(run.out, "  y4 "));
  snprintf(command, sizeof command, "replay %s --channel VSSS_CMD --json", log);
  play(&run, command);
  unlink(log);
  const char *wheels = strstr(run.out, "\"wheels_radps\"");
  assert_non_null(wheels);
  int pairs = 0;
  for (const char *c = wheels; *c != '}'; c++) pairs += *c == ',' && c[1] == ' ' && c[2] == '[';
  assert_int_equal(pairs, 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_match_shows_its_events_and_a_table),
      cmocka_unit_test(five_against_five_is_played),
      cmocka_unit_test(five_against_five_is_recorded_and_read_again),
      cmocka_unit_test(our_policy_scores),
      cmocka_unit_test(json_is_one_object_and_nothing_else),
      cmocka_unit_test(several_matches_are_the_same_for_1_and_3_threads_and_with_watchers),
      cmocka_unit_test(several_matches_end_in_rates_with_intervals),
      cmocka_unit_test(realtime_keeps_the_pace_of_the_clock),
      cmocka_unit_test(an_interrupted_match_prints_what_is_done),
      cmocka_unit_test(what_is_published_can_be_replayed),
      cmocka_unit_test(messages_over_udp_go_out_at_a_pace_that_listeners_keep),
      cmocka_unit_test(help_names_every_flag),
      cmocka_unit_test(bad_requests_are_refused_in_one_line),
      cmocka_unit_test(a_knockout_match_goes_on_until_there_is_a_winner),
      cmocka_unit_test(an_lcm_url_that_fails_is_an_error),
  };
  return cmocka_run_group_tests_name("cli/sim", tests, NULL, NULL);
}
