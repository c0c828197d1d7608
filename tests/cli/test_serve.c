// Tests src/cli/cmd_serve.c as a user, and src/serve/serve.c as a team's program sees it (tests/serve/conformance.py).
#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/league_messages.h"
#include "vsss/udp.h"

static int offset; // of this process's ports

// Starts the server; what it says goes to folder/NAME.
static pid_t serve(const char *name, const char *flags) {
  char arguments[1024], output[128];
  snprintf(arguments, sizeof arguments, "serve %s", flags);
  snprintf(output, sizeof output, "%s/%s", folder, name);
  return vsss_start(output, arguments);
}

static void wait_for(const char *name, const char *text) {
  for (int k = 0; k < 600 && !strstr(folder_file(name), text); k++) usleep(50000);
  if (!strstr(folder_file(name), text)) fail_msg("the server never said '%s': %s", text, folder_file(name));
}

// The client finds nothing to complain about. It may start first: it waits for the server.
static void conforms(const char *which, int shift, const char *flags) {
  char text[512], name[64];
  snprintf(text, sizeof text, "--ports +%d --json %s", shift, flags);
  snprintf(name, sizeof name, "%s.json", which);
  pid_t server = serve(name, text);
  char self[4096], command[8192];
  vsss_sources(self, sizeof self);
  snprintf(command, sizeof command, "python3 '%s/tests/serve/conformance.py' %s %d 2>&1", self, which, shift);
  FILE *client = popen(command, "r");
  char said[2048];
  said[fread(said, 1, sizeof said - 1, client)] = '\0';
  int result = pclose(client);
  int status = vsss_finish(server, SIGINT);
  if (result != 0 || status != 0) fail_msg("%s, server %d: %s", said, status, folder_file(name));
}

static void a_full_match_conforms(void **state) {
  (void)state;
  conforms("match", offset, "--sync --seconds 60 --pause 1 --drive planar --answer 30");
  const char *json = folder_file("match.json");
  if (!strstr(json, "\"complete\": true") || !strstr(json, "\"garbage\": 0") || !strstr(json, "\"silences\": 0"))
    fail_msg("%s", json);
}

static void a_match_of_five_against_five_conforms(void **state) {
  (void)state;
  conforms("five", offset + 50, "--sync --division 5v5 --seconds 30 --pause 0.5 --drive planar --answer 30");
  const char *json = folder_file("five.json");
  if (!strstr(json, "\"division\": \"5v5\"") || !strstr(json, "\"complete\": true") ||
      !strstr(json, "\"garbage\": 0") || !strstr(json, "\"dropped_rows\": 0"))
    fail_msg("%s", json);
}

static void a_learned_policy_is_refused_in_5v5_with_the_reason(void **state) {
  (void)state;
  char flags[256];
  snprintf(flags, sizeof flags, "serve --division 5v5 --blue onnx: --ports +%d", offset + 60);
  assert_refused(flags, 2, "three robots, not 5v5: use --division 3v3");
}

static void a_knockout_match_conforms(void **state) {
  (void)state;
  conforms("knockout", offset + 90, "--sync --knockout --seconds 10 --pause 0.2 --drive planar --answer 30");
  const char *json = folder_file("knockout.json");
  const char *end =
      "{\"winner\": \"blue\", \"extra_time\": true, \"kicks\": [2, 2], \"kicks_scored\": [2, 0], \"lot\": false}";
  if (!strstr(json, end) || !strstr(json, "\"complete\": true") || !strstr(json, "\"score\": [0, 0]"))
    fail_msg("%s", json);
}

static void a_key_gives_a_team_its_time_outs(void **state) {
  (void)state;
  char self[4096], binary[4096], command[8448], said[4096];
  vsss_sources(self, sizeof self);
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "python3 '%s/tests/serve/conformance.py' time_out %d '%s' 2>&1", self, offset + 40,
           binary);
  FILE *client = popen(command, "r");
  said[fread(said, 1, sizeof said - 1, client)] = '\0';
  if (pclose(client) != 0) fail_msg("%s", said);
}

static void free_play_conforms_in_both_dialects(void **state) {
  (void)state;
  conforms("firasim", offset + 10, "--sync --no-referee --answer 30");
  conforms("travesim", offset + 20, "--sync --no-referee --answer 30 --dialect travesim");
}

static void a_second_server_is_refused_with_the_first_one_named(void **state) {
  (void)state;
  char flags[256], holder[64];
  snprintf(flags, sizeof flags, "--ports +%d", offset + 30);
  pid_t first = serve("first", flags);
  wait_for("first", "commands");
  snprintf(flags, sizeof flags, "serve --ports +%d", offset + 30);
  snprintf(holder, sizeof holder, "process %d (", (int)first);
  assert_refused(flags, 1, holder);
  // Other command ports, the same vision: two worlds on one group would mix.
  snprintf(flags, sizeof flags, "serve --ports vision=%d,command=%d", 10002 + offset + 30, 20011 + offset + 40);
  assert_refused(flags, 1, holder);
  assert_int_equal(vsss_finish(first, SIGINT), 0);
}

static void two_servers_run_side_by_side(void **state) {
  (void)state;
  vsss_run run;
  char flags[256];
  snprintf(flags, sizeof flags, "--ports +%d --json", offset + 50);
  pid_t other = serve("other", flags);
  usleep(300000);
  snprintf(flags, sizeof flags, "serve --ports +%d --blue emc: --yellow inf: --sync --pause 0 --seconds 20 --json",
           offset + 60);
  vsss(&run, flags);
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "\"complete\": true"));
  assert_int_equal(vsss_finish(other, SIGINT), 0);
  if (!strstr(folder_file("other"), "\"unsent\": 0")) fail_msg("%s", folder_file("other"));
}

// A local match over the server twice, once under fire: garbage, oversized and truncated datagrams change nothing.
static void garbage_changes_nothing(void **state) {
  (void)state;
  char flags[256], hash[2][64];
  for (int fire = 0; fire < 2; fire++) {
    snprintf(flags, sizeof flags, "--ports +%d --blue emc: --yellow inf: --pause 0 --seconds 3 --json --drive planar",
             offset + 70);
    pid_t server = serve("fire", flags);
    vs_udp to;
    assert_ok(vs_udp_sender("127.0.0.1", 20011 + offset + 70, NULL, &to, err));
    static uint8_t bytes[60000];
    vs_fira_packet p = {.commands = 3};
    size_t whole = vs_fira_packet_encode(&p, true, bytes, 512);
    int status = 0;
    for (int k = 0; waitpid(server, &status, WNOHANG) == 0; k++) {
      if (fire) {
        memset(bytes, 0xff, sizeof bytes);
        vs_udp_send(&to, bytes, sizeof bytes - (size_t)(k % 9000)); // oversized
        vs_udp_send(&to, bytes, (size_t)(k % 500) + 1);             // garbage
        vs_fira_packet_encode(&p, true, bytes, 512);
        vs_udp_send(&to, bytes, whole - 1 - (size_t)k % (whole - 1)); // truncated
      }
      if (k % 20 == 0) usleep(1000);
    }
    vs_udp_close(&to);
    assert_int_equal(status, 0);
    const char *at = strstr(folder_file("fire"), "\"hash\"");
    assert_non_null(at);
    snprintf(hash[fire], sizeof hash[fire], "%.28s", at);
  }
  assert_string_equal(hash[0], hash[1]);
  const char *garbage = strstr(folder_file("fire"), "\"garbage\": ");
  assert_non_null(garbage);
  if (atol(garbage + 11) < 1000) fail_msg("%s", folder_file("fire"));
}

static void a_record_is_replayed(void **state) {
  (void)state;
  vsss_run run;
  char text[512];
  snprintf(text, sizeof text,
           "serve --ports +%d --blue emc: --yellow inf: --sync --pause 0 --seconds 20 --json --record '%s/log'",
           offset + 80, folder);
  vsss(&run, text);
  assert_int_equal(run.status, 0);
  snprintf(text, sizeof text, "replay '%s/log'", folder);
  vsss(&run, text);
  if (run.status != 0 || !strstr(run.out, "VSSS_TRUTH") || !strstr(run.out, "VSSS_CMD"))
    fail_msg("%d: %.500s%s", run.status, run.out, run.err);
}

// A second of a match with its kick-off's three calls of ten datagrams, at half time once more and at the end a HALT; sent again, the worlds
// come in their order with what was called.
static void a_league_log_is_sent_again(void **state) {
  (void)state;
  vsss_run run;
  char text[512];
  snprintf(text, sizeof text,
           "serve --ports +%d --blue emc: --yellow inf: --sync --pause 0 --seconds 1 --drive planar --json "
           "--league-log '%s/l'",
           offset + 85, folder);
  vsss(&run, text);
  assert_int_equal(run.status, 0);
  vs_udp vision, referee;
  assert_ok(vs_udp_join("224.0.0.1", 10002 + offset + 85, NULL, &vision, err));
  assert_ok(vs_udp_join("224.5.23.2", 10003 + offset + 85, NULL, &referee, err));
  snprintf(text, sizeof text, "serve --ports +%d --replay '%s/l'", offset + 85, folder);
  vsss(&run, text);
  assert_int_equal(run.status, 0);
  int worlds = 0, calls = 0, halts = 0;
  size_t size;
  uint8_t bytes[1024];
  for (int64_t before = -1; vs_udp_receive(&vision, bytes, sizeof bytes, &size); worlds++) {
    vs_fira_environment e;
    assert_ok(vs_fira_environment_decode(bytes, size, &e, err));
    assert_true((int64_t)e.step > before);
    before = e.step;
  }
  for (; vs_udp_receive(&referee, bytes, sizeof bytes, &size); calls++) {
    vs_ref_command c;
    assert_ok(vs_ref_command_decode(bytes, size, &c, err));
    halts += c.foul == VS_FOUL_HALT;
  }
  vs_udp_close(&vision);
  vs_udp_close(&referee);
  assert_true(worlds >= 60);
  assert_int_equal(halts, 10);
  assert_true(calls >= 40);
  char said[128];
  snprintf(said, sizeof said, "%d worlds and %d calls", worlds, calls);
  if (!strstr(run.out, said)) fail_msg("'%s' lacks '%s'", run.out, said);
  snprintf(text, sizeof text, "serve --ports +%d --replay '%s/log'", offset + 85, folder);
  assert_refused(text, 1, "no entry"); // another format
}

static void wrong_flags_are_refused(void **state) {
  (void)state;
  assert_refused("serve --dialect vss", 2, "'vss'");
  assert_refused("serve --robot tractor", 2, "'tractor'");
  assert_refused("serve --ports 7", 2, "--ports 7");
  assert_refused("serve --interface hall0", 2, "'hall0'");
  assert_refused("serve --sync --realtime", 2, "exclude");
  assert_refused("serve --referee maybe", 2, "maybe");
  assert_refused("serve --knockout --no-referee", 2, "--knockout");
  assert_refused("serve --blue nobody:", 2, "nobody:");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_full_match_conforms),
      cmocka_unit_test(a_match_of_five_against_five_conforms),
      cmocka_unit_test(a_learned_policy_is_refused_in_5v5_with_the_reason),
      cmocka_unit_test(a_knockout_match_conforms),
      cmocka_unit_test(a_key_gives_a_team_its_time_outs),
      cmocka_unit_test(free_play_conforms_in_both_dialects),
      cmocka_unit_test(a_second_server_is_refused_with_the_first_one_named),
      cmocka_unit_test(two_servers_run_side_by_side),
      cmocka_unit_test(garbage_changes_nothing),
      cmocka_unit_test(a_record_is_replayed),
      cmocka_unit_test(a_league_log_is_sent_again),
      cmocka_unit_test(wrong_flags_are_refused),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
