// Tests that what src/cli/cmd_sim.c plays, lcm-logger records and src/cli/cmd_replay.c shows.
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>

#include "assert_near.h"
#include "cli_bus.h"
#include "run_vsss.h"
#include "vsss/clock.h"

// Starts lcm-logger and waits until it hears: until a message sent to it is in the file. false, after a note: not here.
static bool start_logger(const char *log, pid_t *logger) {
  vs_bus *bus = test_bus_open();
  if (!bus) skip();
  char url[128];
  snprintf(url, sizeof url, "--lcm-url=%s", test_bus_url());
  fflush(NULL);
  *logger = fork();
  if (*logger == 0) {
    int quiet = open("/dev/null", O_WRONLY);
    dup2(quiet, STDOUT_FILENO);
    dup2(quiet, STDERR_FILENO);
    execlp("lcm-logger", "lcm-logger", url, log, (char *)NULL);
    _exit(127);
  }
  struct stat info = {0};
  int64_t end_us = vs_clock_monotonic_us() + 20000000;
  pid_t gone = 0;
  while (!gone && info.st_size == 0 && vs_clock_monotonic_us() < end_us) {
    vs_bus_publish_raw(bus, "TEST", (const uint8_t *)"x", 1, NULL);
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 20000);
    gone = waitpid(*logger, NULL, WNOHANG);
    if (stat(log, &info) != 0) info.st_size = 0;
  }
  vs_bus_close(bus);
  if (gone) {
    print_message("note: no lcm-logger (install liblcm-bin)\n");
    skip();
  }
  assert_true(info.st_size > 0);
  return !gone;
}

static void a_recorded_match_is_shown(void **state) {
  (void)state;
  char log[64], text[256];
  pid_t logger;
  snprintf(log, sizeof log, "/tmp/vsss_test_record_%ld.log", (long)getpid());
  unlink(log);
  if (!start_logger(log, &logger)) return;
  static vsss_run run;
  snprintf(text, sizeof text, "sim --blue random: --yellow zero: --seconds 2 --realtime --lcm '%s'", test_bus_url());
  vsss(&run, text);
  if (run.status != 0) fail_msg("sim: status %d: %s", run.status, run.err);
  vs_clock_sleep_until_us(vs_clock_monotonic_us() + 500000);
  kill(logger, SIGINT);
  int status;
  waitpid(logger, &status, 0);

  snprintf(text, sizeof text, "replay %s", log);
  vsss(&run, text);
  if (run.status != 0) fail_msg("replay: status %d: %s", run.status, run.err);
  assert_non_null(strstr(run.out, "0:00.0   0 : 0   kick-off for blue\n"));
  assert_non_null(strstr(run.out, "0:02.0   0 : 0   end\n"));
  assert_non_null(strstr(run.out, "blue random: 0 : 0 zero: yellow after 2.0 s\n"));
  // Two seconds at 30 Hz; a busy machine may lose some on the way to the logger.
  int truth = 0, states = 0, commands = 0;
  assert_int_equal(sscanf(strstr(run.out, "VSSS_TRUTH"), "VSSS_TRUTH %d", &truth), 1);
  assert_int_equal(sscanf(strstr(run.out, "VSSS_STATE"), "VSSS_STATE %d", &states), 1);
  assert_int_equal(sscanf(strstr(run.out, "VSSS_CMD"), "VSSS_CMD %d", &commands), 1);
  assert_true(truth > 20 && truth <= 61);
  assert_true(states > 20 && states <= 61);
  assert_true(commands > 40 && commands <= 122);
  assert_null(strstr(run.out, "not readable"));
  unlink(log);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_recorded_match_is_shown)};
  return cmocka_run_group_tests_name("cli/record", tests, NULL, NULL);
}
