// Tests src/cli/cmd_bridge.c through the real binary: commands on LCM in, a robot's firmware behind a pseudo terminal.
#include <fcntl.h>
#include <signal.h>

#include "assert_near.h"
#include "cli_bus.h"
#include "run_vsss.h"
#include "vsss/clock.h"
#include "vsss/firmware.h"
#include "vsss/radio_serial.h"

enum { PATIENCE_MS = 30000 }; // for a machine that is busy with other things

typedef struct venue {
  vs_bus *bus;
  vs_pty *pty;
  pid_t bridge;
  char out[64];          // the bridge's output
  vs_firmware robot;     // number 7 on the air
  vs_firmware_drive now; // what it does
  int stops;             // STOP frames since the last reset
  vs_radio_decoder tap;
  int reports;
  vs_msg_radio report; // the last
} venue;

static void on_radio(const vs_message *m, void *user) {
  venue *v = user;
  v->reports++;
  v->report = m->as.radio;
}

static uint32_t now_ms(void) { return (uint32_t)(vs_clock_monotonic_us() / 1000); }

// One millisecond or so of the venue.
static void live(venue *v) {
  uint8_t bytes[256];
  size_t n = vs_pty_read(v->pty, bytes, sizeof bytes);
  vs_firmware_receive(&v->robot, bytes, n, now_ms());
  vs_radio_frame frame;
  for (size_t i = 0; i < n; i++) {
    if (!vs_radio_decode(&v->tap, bytes[i], &frame) || frame.type != VS_RADIO_COMMAND) continue;
    v->stops += frame.as.command.flags & VS_RADIO_FLAG_STOP;
    size_t size = vs_firmware_telemetry(&v->robot, now_ms(), 123, -123, 7400, -55, bytes + 128);
    vs_pty_write(v->pty, bytes + 128, size);
  }
  v->now = vs_firmware_tick(&v->robot, now_ms());
  vs_bus_handle(v->bus, 1, NULL, NULL);
}

static void command(venue *v, double left_radps) {
  vs_message m = {.channel = VS_CH_CMD};
  m.as.cmd = (vs_msg_cmd){.team = VS_BLUE, .wheels = {{0, 0}, {left_radps, -1.0}, {0, 0}}, .source = "test"};
  assert_ok(vs_bus_publish(v->bus, &m, err));
  m.as.cmd.team = VS_YELLOW; // not this bridge's
  m.as.cmd.wheels[1].left_radps = -9.0;
  assert_ok(vs_bus_publish(v->bus, &m, err));
}

static bool start(venue *v) {
  memset(v, 0, sizeof *v);
  v->bus = test_bus_open();
  if (!v->bus) skip();
  assert_ok(vs_pty_new(&v->pty, err));
  assert_ok(vs_bus_subscribe(v->bus, VS_CH_RADIO, true, on_radio, v, err));
  vs_firmware_init(&v->robot, 7, now_ms());
  snprintf(v->out, sizeof v->out, "/tmp/vsss_test_bridge_%ld", (long)getpid());
  char binary[4096];
  vsss_binary(binary, sizeof binary);
  fflush(NULL);
  v->bridge = fork();
  if (v->bridge == 0) {
    int fd = open(v->out, O_CREAT | O_TRUNC | O_WRONLY, 0666);
    dup2(fd, STDOUT_FILENO);
    dup2(fd, STDERR_FILENO);
    execl(binary, "vsss", "bridge", "--go", "--radio", vs_pty_path(v->pty), "--lcm", test_bus_url(), "--ids", "3,7,9",
          (char *)NULL);
    _exit(127);
  }
  return true;
}

static void commands_drive_silence_stops_and_the_end_stops(void **state) {
  (void)state;
  static venue v;
  if (!start(&v)) return;
  int64_t end_us = vs_clock_monotonic_us() + PATIENCE_MS * 1000LL;

  // Commanded, robot 7 (the second of the team) turns its left wheel at 12.34 rad/s.
  while (!(v.now.left == 1234 && !v.now.brake) && vs_clock_monotonic_us() < end_us) {
    command(&v, 12.34);
    for (int i = 0; i < 10; i++) live(&v);
  }
  assert_int_equal(v.now.left, 1234);
  assert_int_equal(v.now.right, -100);

  // Its telemetry is on the bus.
  while (!(v.reports && v.report.robot[1].age_us >= 0) && vs_clock_monotonic_us() < end_us) live(&v);
  assert_true(v.report.up);
  assert_int_equal(v.report.robot[1].id, 7);
  assert_near(v.report.robot[1].battery_v, 7.4, 1e-9);
  assert_near(v.report.robot[1].measured.left_radps, 1.23, 1e-9);
  assert_int_equal(v.report.robot[0].age_us, -1);

  // Without commands, STOP frames come.
  v.stops = 0;
  while (v.stops < 3 && vs_clock_monotonic_us() < end_us) live(&v);
  assert_true(v.stops >= 3);
  assert_true(v.now.brake);

  // Commanded again it drives; ended, the bridge sends ten STOP frames and exits with 0.
  while (v.now.brake && vs_clock_monotonic_us() < end_us) {
    command(&v, 5.0);
    for (int i = 0; i < 10; i++) live(&v);
  }
  assert_false(v.now.brake);
  v.stops = 0;
  kill(v.bridge, SIGINT);
  int status = -1;
  while (waitpid(v.bridge, &status, WNOHANG) == 0 && vs_clock_monotonic_us() < end_us) live(&v);
  for (int i = 0; i < 20; i++) live(&v);
  assert_int_equal(status, 0);
  assert_true(v.stops >= 10);
  assert_true(v.robot.stopped);
  vs_bus_close(v.bus);
  vs_pty_free(v.pty);
  unlink(v.out);
}

static void an_unplugged_radio_does_not_end_the_bridge(void **state) {
  (void)state;
  static venue v;
  if (!start(&v)) return;
  int64_t end_us = vs_clock_monotonic_us() + PATIENCE_MS * 1000LL;
  while (!v.reports && vs_clock_monotonic_us() < end_us) live(&v);
  assert_true(v.reports > 0);
  vs_pty_free(v.pty);
  while (v.report.up && vs_clock_monotonic_us() < end_us) vs_bus_handle(v.bus, 10, NULL, NULL);
  assert_false(v.report.up);
  kill(v.bridge, SIGTERM);
  int status = -1;
  waitpid(v.bridge, &status, 0);
  assert_int_equal(status, 0);
  vs_bus_close(v.bus);
  unlink(v.out);
}

// A log with commands, to be sent from another machine.
static void write_commands(const char *path) {
  char url[160];
  vs_bus *log;
  snprintf(url, sizeof url, "file://%s?mode=w", path);
  assert_ok(vs_bus_open(url, &log, err));
  for (int i = 0; i < 20; i++) {
    vs_message m = {.channel = VS_CH_CMD, .seq = i};
    m.as.cmd = (vs_msg_cmd){.team = VS_BLUE, .wheels = {{1, 1}, {1, 1}, {1, 1}}, .source = "far"};
    assert_ok(vs_bus_publish(log, &m, err));
    vs_clock_sleep_until_us(vs_clock_monotonic_us() + 2000);
  }
  vs_bus_close(log);
}

// Commands that a bridge on one machine took from another one; -1: this machine cannot be two.
static int taken_from_afar(const char *flags, const char *log, const char *out, vs_pty *pty) {
  char binary[4096], command[10000];
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command,
           "sh tests/cli/two_machines.sh '%s bridge --go --radio %s --lcm udpm://239.255.76.67:7667?ttl=1 %s' "
           "'%s replay %s --publish --lcm udpm://239.255.76.67:7667?ttl=1' >%s 2>&1",
           binary, vs_pty_path(pty), flags, binary, log, out);
  int status = system(command);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) return -1;
  static char text[8192];
  FILE *f = fopen(out, "r");
  text[f ? fread(text, 1, sizeof text - 1, f) : 0] = '\0';
  if (f) fclose(f);
  const char *line = strstr(text, " commands, ");
  if (!line) fail_msg("the bridge did not report: %s", text);
  while (line > text && line[-1] >= '0' && line[-1] <= '9') line--;
  bool told = strstr(text, "messages of other machines were not obeyed") != NULL;
  assert_int_equal(told, !*flags);
  return atoi(line);
}

static void another_machine_is_obeyed_only_when_told_so(void **state) {
  (void)state;
  char log[64], out[64];
  vs_pty *pty;
  snprintf(log, sizeof log, "/tmp/vsss_far_%ld.lcm", (long)getpid());
  snprintf(out, sizeof out, "/tmp/vsss_far_%ld.out", (long)getpid());
  if (vs_bus_supported(NULL) != VS_OK) skip();
  write_commands(log);
  assert_ok(vs_pty_new(&pty, err));
  int told = taken_from_afar("--lcm-remote", log, out, pty),
      untold = told < 0 ? -1 : taken_from_afar("", log, out, pty);
  vs_pty_free(pty);
  unlink(log);
  unlink(out);
  if (told < 0) {
    print_message("note: this machine does not allow network namespaces\n");
    skip();
  }
  assert_true(told > 0);
  assert_int_equal(untold, 0);
}

static void wrong_calls_are_named(void **state) {
  (void)state;
  assert_refused("bridge", 2, "--radio is needed");
  assert_refused("bridge --radio /dev/none --lcm memq://", 1, "/dev/none: No such file");
  assert_refused("bridge --radio /dev/null --lcm memq://", 1, "not a serial device");
  assert_refused("bridge --radio /dev/null --team green", 2, "--team green");
  assert_refused("bridge --radio /dev/null --ids 1,2", 2, "--ids 1,2");
  assert_refused("bridge --radio /dev/null --ids 1,2,256", 2, "0 to 255");
  assert_refused("bridge --radio /dev/null --ids 1,2,1", 2, "same radio id 1");
  assert_refused("bridge --radio /dev/null --baud 7", 2, "baud 7");
  assert_refused("bridge --radio /dev/null --wire morse", 2, "--wire: wire 'morse': expected one of vsss, pequi-xbee");
  assert_refused("bridge --radio /dev/null --wire unball --ids 1,2,3", 2, "robot 2 has radio id 3, unball has 0 to 2");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(commands_drive_silence_stops_and_the_end_stops),
      cmocka_unit_test(an_unplugged_radio_does_not_end_the_bridge),
      cmocka_unit_test(another_machine_is_obeyed_only_when_told_so),
      cmocka_unit_test(wrong_calls_are_named),
  };
  return cmocka_run_group_tests_name("cli/bridge", tests, NULL, NULL);
}
