// Tests src/cli/cmd_league.c and src/cli/league_match.c as a user: programs, a crash, silence, a resumed league, its files.
#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/league_messages.h"

static int offset;
static vsss_run run;

static void write_file(const char *name, const char *text) {
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fputs(text, f);
  fclose(f);
}

static void must_say(const char *text, const char *expected) {
  if (!strstr(text, expected)) fail_msg("'%s' is missing in: %s", expected, text);
}

static void league(const char *name) {
  char command[256];
  snprintf(command, sizeof command, "league '%s/%s'", folder, name);
  vsss(&run, command);
}

// The file of a league as it is written with these values, played to its end.
__attribute__((format(printf, 2, 3))) static void league_of(const char *name, const char *format, ...) {
  char ini[8192];
  va_list values;
  va_start(values, format);
  vsnprintf(ini, sizeof ini, format, values);
  va_end(values);
  write_file(name, ini);
  league(name);
  if (run.status != 0) fail_msg("%s: status %d: %s", name, run.status, run.err);
}

// Five robots a team, in the log as in the match; policies of three are refused by name.
static void the_division_is_what_is_played(void **state) {
  (void)state;
  char command[256];
  league_of("five.ini",
            "[league]\ndivision = 5v5\nseconds = 2\npause = 0\ndrive = planar\nfolder = %s/five\nports = +%d\n"
            "[club1]\nname = A\nplayer = emc22:\n[club2]\nname = B\nplayer = inf:\n",
            folder, offset + 15);
  snprintf(command, sizeof command, "replay '%s/five/1-A-B.log' --channel VSSS_TRUTH --json", folder);
  vsss(&run, command);
  run.out[strcspn(run.out, "\n")] = '\0';
  int robots = 0;
  for (const char *at = run.out; (at = strstr(at, "\"omega_radps\"")) != NULL; at++) robots++;
  assert_int_equal(robots, 2 * 5);
  write_file("learned.ini",
             "[league]\ndivision = 5v5\n[club1]\nname = A\nplayer = onnx:\n[club2]\nname = B\nplayer = inf:\n");
  snprintf(command, sizeof command, "league '%s/learned.ini'", folder);
  assert_refused(command, 2, "onnx:");
}

// Two players and a program that plays, one that ends at once, one that says nothing.
static void clubs_meet_from_both_sides_and_who_fails_is_named(void **state) {
  (void)state;
  char self[4096];
  vsss_sources(self, sizeof self);
  league_of("all.ini",
            "[league]\nseconds = 15\npause = 0\nwait = 4\ndrive = planar\nfolder = %s/out\nports = +%d\n"
            "[club1]\nname = Zero\nplayer = zero:\n"
            "[club2]\nname = Program\ncommand = \"exec python3 '%s/tests/serve/league_team.py'\"\n"
            "[club3]\nname = Crash\ncommand = exit 3\n"
            "[club4]\nname = Silent\ncommand = exec sleep 1000\n",
            folder, offset, self);
  must_say(run.out, "12 of 12");
  must_say(run.out, "Zero 10 : 0 Crash  Crash ended by itself (status 3)");
  must_say(run.out, "Silent 0 : 10 Zero  Silent was never heard");
  must_say(run.out, "out/index.html");
  const char *json = folder_file("out/results.json");
  must_say(json, "\"matches\": 12, \"of\": 12");
  must_say(json, "\"why\": \"Crash ended by itself (status 3)\"");
  const char *page = folder_file("out/index.html");
  must_say(page, "<a href=\"1-Zero-Program.log\">");
  must_say(page, "Crash ended by itself");
  assert_null(strstr(page, "<script"));
  char command[256];
  snprintf(command, sizeof command, "replay '%s/out/1-Zero-Program.log'", folder);
  vsss(&run, command);
  must_say(run.out, "VSSS_TRUTH");
  // Again: everything is there, nothing is played.
  league("all.ini");
  assert_int_equal(run.status, 0);
  must_say(run.out, "12 of 12 matches are in");
  assert_null(strstr(run.out, "1 of 12 "));
}

static void a_league_goes_on_where_it_was_stopped(void **state) {
  (void)state;
  league_of("again.ini",
            "[league]\nseconds = 10\npause = 0\ndrive = planar\nrecord = no\nfolder = %s/again\nports = +%d\n"
            "[club1]\nname = A\nplayer = emc:\n[club2]\nname = B\nplayer = zero:\n",
            folder, offset + 10);
  static char whole[32768];
  snprintf(whole, sizeof whole, "%s", folder_file("again/results.csv"));
  // Keep the first match only: the second is played anew, to the same result.
  char part[32768];
  snprintf(part, sizeof part, "%s", whole);
  char *second = strchr(strchr(part, '\n') + 1, '\n');
  assert_non_null(second);
  second[1] = '\0';
  write_file("again/results.csv", part);
  league("again.ini");
  must_say(run.out, "1 of 2 matches are in");
  must_say(run.out, "2 of 2  B");
  assert_string_equal(folder_file("again/results.csv"), whole);
  // Another league's results are not taken for ours.
  write_file("again/results.csv", "round,blue,yellow\n1,A,Nobody,1,0,0,\"\"\n");
  league("again.ini");
  assert_int_equal(run.status, 1);
  must_say(run.err, "line 2");
}

// Five clubs: the last two play for a place among four, the first three wait. Teams that stand still: shoot-outs and lots.
static void a_knockout_has_byes_and_a_winner_and_goes_on_where_it_was_stopped(void **state) {
  (void)state;
  league_of(
      "cup.ini",
      "[league]\nformat = knockout\nseconds = 2\npause = 0\ndrive = planar\nrecord = no\nfolder = %s/cup\nports = +%d\n"
      "[club1]\nname = A\nplayer = zero:\n[club2]\nname = B\nplayer = zero:\n[club3]\nname = C\nplayer = zero:\n"
      "[club4]\nname = D\nplayer = emc22:\n[club5]\nname = E\nplayer = zero:\n",
      folder, offset + 20);
  must_say(run.out, "quarter-final  D - E  0 : 0, ");
  must_say(run.out, "semi-final     A - D  0 : 0, ");
  must_say(run.out, "semi-final     B - C  0 : 0, by lot");
  must_say(run.out, "D has won\n"); // the only one that kicks: it wins every shoot-out
  const char *json = folder_file("cup/results.json");
  must_say(json, "\"matches\": 4, \"of\": 4, \"champion\": \"D\"");
  must_say(json, "\"knockout\": \"final\"");
  must_say(json, "\"winner\": \"D\"");
  must_say(folder_file("cup/index.html"), "<b>D</b> has won.");
  static char whole[32768];
  snprintf(whole, sizeof whole, "%s", folder_file("cup/results.csv"));
  char part[32768];
  snprintf(part, sizeof part, "%s", whole);
  char *end = part;
  for (int line = 0; line < 3; line++) end = strchr(end, '\n') + 1;
  *end = '\0';
  write_file("cup/results.csv", part);
  league("cup.ini");
  must_say(run.out, "2 of 4 matches are in");
  assert_string_equal(folder_file("cup/results.csv"), whole);
}

// Two groups of two, A and C, B and D; the winners play the final.
static void groups_are_followed_by_a_knockout(void **state) {
  (void)state;
  league_of(
      "groups.ini",
      "[league]\nformat = groups\ngroups = 2\nadvance = 1\nseconds = 30\npause = 0\ndrive = planar\nrecord = no\n"
      "folder = %s/groups\nports = +%d\n"
      "[club1]\nname = A\nplayer = zero:\n[club2]\nname = B\nplayer = emc22:\n[club3]\nname = C\nplayer = emc22:\n"
      "[club4]\nname = D\nplayer = zero:\n",
      folder, offset + 20);
  must_say(run.out, "5 of 5  C");
  must_say(run.out, "group A\nclub");
  must_say(run.out, "group B\nclub");
  must_say(run.out, "final          C - B  ");
  must_say(run.out, " has won\n");
  assert_null(strstr(run.out, "A - B"));
  must_say(folder_file("groups/results.json"), "\"club\": \"C\", \"group\": \"A\"");
  const char *page = folder_file("groups/index.html");
  must_say(page, "<h2>Group B</h2>");
  must_say(page, "<h2>Knockout</h2>");
}

// Its command prints what it sees of the network; in one of its own there is loopback alone.
static void programs_play_in_a_network_of_their_own_where_allowed(void **state) {
  (void)state;
  for (int own = 0; own < 2; own++) {
    league_of(
        "net.ini",
        "[league]\nseconds = 2\npause = 0\nwait = 1\ndrive = planar\nrecord = no\nfolder = %s/net%d\nports = +%d\n"
        "own_network = %s\n[club1]\nname = Looks\ncommand = \"readlink /proc/self/ns/net; cat /proc/net/dev\"\n"
        "[club2]\nname = B\nplayer = zero:\n",
        folder, own, offset + 30, own ? "yes" : "no");
    char outside[64] = "", path[64];
    snprintf(path, sizeof path, "net%d/1-Looks-B.log.blue.txt", own);
    assert_true(readlink("/proc/self/ns/net", outside, sizeof outside - 1) > 0);
    const char *seen = folder_file(path);
    must_say(seen, "net:[");
    if (own && strstr(run.err, "share this machine's network")) {
      print_message("note: no network namespaces on this system\n");
      must_say(seen, outside);
      return;
    }
    assert_int_equal(strstr(seen, outside) == NULL, own);
    must_say(seen, "lo:");
    if (own) assert_null(strstr(seen, "eth"));
  }
}

static void what_is_wrong_with_a_file_is_named(void **state) {
  (void)state;
  const struct {
    const char *text, *why;
  } row[] = {{"[club1]\nname = A\nplayer = zero:\n", "at least 2"},
             {"[club1]\nname = A\n[club2]\nname = B\nplayer = zero:\n", "[club1] A: give either"},
             {"[club1]\nname = A\nplayer = zero:\n[club2]\nname = A\nplayer = emc:\n", "another club has it"},
             {"[club1]\nname = A,B\nplayer = zero:\n[club2]\nname = C\nplayer = emc:\n", "make a name"},
             {"[club1]\nname = A\nplayer = nobody:\n[club2]\nname = C\nplayer = emc:\n", "A: "},
             {"[league]\nformat = cup\n[club1]\nname = A\nplayer = zero:\n[club2]\nname = B\nplayer = zero:\n",
              "[league]: format 'cup': expected round-robin, knockout or groups"},
             {"[league]\nformat = groups\n[club1]\nname = A\nplayer = zero:\n[club2]\nname = B\nplayer = zero:\n",
              "groups = 2: 2 clubs are too few"},
             {"[league]\ndivision = 4v4\n[club1]\nname = A\nplayer = zero:\n[club2]\nname = B\nplayer = zero:\n",
              "bad.ini: [league]: division '4v4'"},
             {"[league]\nmatches = 3\n", "matches"}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    char command[256];
    write_file("bad.ini", row[k].text);
    snprintf(command, sizeof command, "league '%s/bad.ini'", folder);
    assert_refused(command, 2, row[k].why);
  }
  assert_refused("league", 2, "FILE.ini");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 70;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(clubs_meet_from_both_sides_and_who_fails_is_named),
      cmocka_unit_test(the_division_is_what_is_played),
      cmocka_unit_test(a_league_goes_on_where_it_was_stopped),
      cmocka_unit_test(a_knockout_has_byes_and_a_winner_and_goes_on_where_it_was_stopped),
      cmocka_unit_test(groups_are_followed_by_a_knockout),
      cmocka_unit_test(programs_play_in_a_network_of_their_own_where_allowed),
      cmocka_unit_test(what_is_wrong_with_a_file_is_named),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
