// Tests src/cli/cmd_spy.c, spy_print.c and spy_window.c through the real binary.
#define _GNU_SOURCE
#include <glob.h>
#include <sched.h>
#include <signal.h>

#include "assert_near.h"
#include "cli_bus.h"
#include "run_vsss.h"
#include "vsss/clock.h"

static vsss_run run;

// Publishes commands at about 100 Hz until it is killed.
static pid_t start_publisher(void) {
  pid_t child = fork();
  if (child) return child;
  vs_bus *bus;
  if (vs_bus_open(test_bus_url(), &bus, NULL) != VS_OK) _exit(1);
  for (;;) {
    vs_message m = {.channel = VS_CH_CMD};
    m.as.cmd = (vs_msg_cmd){.team = VS_YELLOW, .wheels = {{1, 2}, {3, 4}, {5, 6}}, .source = "zero:"};
    vs_bus_publish(bus, &m, NULL);
    vs_bus_publish_raw(bus, "VSSS_STATE", (const uint8_t *)"\1\2\3\4\5\6\7\10", 8, NULL);
    vs_bus_publish_raw(bus, "ELSE", (const uint8_t *)"xyz", 3, NULL);
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 10000);
  }
}

static void table_shows_rates_and_last_values(void **state) {
  (void)state;
  test_bus_url(); // fixes the port for the child
  vs_bus *bus = test_bus_open();
  if (!bus) skip();
  vs_bus_close(bus);
  char text[128];
  snprintf(text, sizeof text, "spy --print --seconds 2 --lcm '%s'", test_bus_url());
  pid_t publisher = start_publisher();
  vsss(&run, text);
  kill(publisher, SIGKILL);
  waitpid(publisher, NULL, 0);
  assert_int_equal(run.status, 0);
  assert_string_equal(run.err, "");
  assert_non_null(strstr(run.out, "yellow zero:  +1.0 +2.0  +3.0 +4.0  +5.0 +6.0 rad/s\n"));
  assert_non_null(strstr(run.out, "another version of the types"));
  assert_non_null(strstr(run.out, "3 bytes, not of vsss\n"));
  // ELSE, 0-9 messages a second upwards: the row is the first of three, with a count that is not 0.
  int messages = 0;
  char *row = strstr(run.out, "\nELSE ");
  assert_non_null(row);
  assert_int_equal(sscanf(row, " ELSE %d", &messages), 1);
  assert_true(messages > 0);
}

static void silence_is_said(void **state) {
  (void)state;
  vsss(&run, "spy --print --seconds 0.1 --lcm memq://");
  if (run.status == 1 && strstr(run.err, "install")) {
    printf("note: %s", run.err);
    skip();
  }
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "nothing heard yet"));
}

static void without_a_display_the_window_points_to_print(void **state) {
  (void)state;
  unsetenv("DISPLAY");
  assert_refused("spy", 1, "'vsss spy --print' needs none");
}

// The jar is made, then Java fails, as the display is none.
static void the_jar_of_our_types_is_made_once(void **state) {
  (void)state;
  char cache[64], pattern[128];
  snprintf(cache, sizeof cache, "/tmp/vsss_test_spy_%ld", (long)getpid());
  setenv("XDG_CACHE_HOME", cache, 1);
  setenv("DISPLAY", ":4711", 1);
  vsss(&run, "spy --lcm memq://");
  unsetenv("DISPLAY");
  assert_int_not_equal(run.status, 0);
  if (strstr(run.err, "install")) {
    printf("note: %s", run.err);
    skip();
  }
  glob_t found = {0};
  snprintf(pattern, sizeof pattern, "%s/vsss/*", cache);
  assert_int_equal(glob(pattern, 0, NULL, &found), 0);
  assert_int_equal(found.gl_pathc, 1); // the jar, and nothing left of the work
  char list[256], line[256];
  snprintf(list, sizeof list, "unzip -l '%s' 2>/dev/null || jar tf '%s'", found.gl_pathv[0], found.gl_pathv[0]);
  FILE *names = popen(list, "r");
  int classes = 0;
  while (fgets(line, sizeof line, names)) classes += strstr(line, "vsss/") && strstr(line, "_t.class");
  pclose(names);
  glob_t types = {0};
  assert_int_equal(glob("lcm_types/*.lcm", 0, NULL, &types), 0);
  assert_int_equal(classes, types.gl_pathc);
  globfree(&types);
  globfree(&found);
  snprintf(list, sizeof list, "rm -r '%s'", cache);
  assert_int_equal(system(list), 0);
}

// Java would run a jar that somebody else put there.
static void a_cache_that_others_may_write_into_is_refused(void **state) {
  (void)state;
  char cache[64], line[256];
  snprintf(cache, sizeof cache, "/tmp/vsss_test_spy_%ld", (long)getpid());
  setenv("XDG_CACHE_HOME", cache, 1);
  setenv("DISPLAY", ":4711", 1);
  static const char *const made[][2] = {{"mkdir -p '%1$s/vsss' && chmod 777 '%1$s/vsss'", "others may write into it"},
                                        {"mkdir -p '%1$s/else' && ln -s else '%1$s/vsss'", "is a link"}};
  static vsss_run refused[2];
  for (int i = 0; i < 2; i++) {
    snprintf(line, sizeof line, made[i][0], cache);
    assert_int_equal(system(line), 0);
    vsss(&refused[i], "spy --lcm memq://");
    snprintf(line, sizeof line, "rm -r '%s'", cache);
    assert_int_equal(system(line), 0);
  }
  unsetenv("DISPLAY");
  for (int i = 0; i < 2; i++) {
    assert_int_equal(refused[i].status, 1);
    if (strstr(refused[i].err, "install")) {
      print_message("note: %s", refused[i].err);
      skip();
    }
    if (!strstr(refused[i].err, made[i][1])) fail_msg("%s", refused[i].err);
  }
}

static void wrong_urls_and_missing_routes_are_named(void **state) {
  (void)state;
  assert_refused("spy --print --lcm tcp://here", 2, "tcp://here");
  // A network of our own without any route.
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(77);
    vsss(&run, "spy --print --seconds 1 --lcm 'udpm://239.255.76.67:7667?ttl=0'");
    bool told = strstr(run.err, "ip link set lo up multicast on") && strstr(run.err, "ip route add 224.0.0.0/4 dev lo");
    _exit(run.status == 1 && (told || strstr(run.err, "install")) ? 0 : 1);
  }
  int status;
  waitpid(child, &status, 0);
  if (WEXITSTATUS(status) == 77) {
    print_message("note: this machine lets nobody make a network of his own\n");
    skip();
  }
  assert_int_equal(status, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(table_shows_rates_and_last_values),
      cmocka_unit_test(silence_is_said),
      cmocka_unit_test(without_a_display_the_window_points_to_print),
      cmocka_unit_test(the_jar_of_our_types_is_made_once),
      cmocka_unit_test(a_cache_that_others_may_write_into_is_refused),
      cmocka_unit_test(wrong_urls_and_missing_routes_are_named),
  };
  return cmocka_run_group_tests_name("cli/spy", tests, NULL, NULL);
}
