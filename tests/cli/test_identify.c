// src/cli/cmd_identify.c, src/cli/cmd_latency.c, src/cli/motion_log.c and the player shake: (src/policy/player_simple.c): a
// rig whose robots act late is recorded and measured, and the rig itself says how late they were.
#include "cli/command_log.h"
#include "cli/field_match.h"
#include "test_folder.h"

#include "assert_near.h"
#include "vsss/bus.h"
#include "vsss/sensor_model.h"

#define SERVO_TAU_S 0.055 // of the simulator's wheels, straight (src/sim/drive.h)

// 10 % as promised; a busy machine, whose pictures and commands come unevenly, may take twice that.
static double share(void) {
  const char *strict = getenv("VSSS_STRICT");
  return strict && *strict == '1' ? 0.1 : 0.2;
}

static double number_of(const char *text, const char *name) {
  double value = number_after(text, name);
  if (isnan(value)) fail_msg("no '%s' in %s", name, text);
  return value;
}

// Pictures that were not drawn are pictures in which the robots acted all the same: their delay is another one then.
static void skip_where_the_rig_was_late(const char *said) {
  double late = number_of(said, "replaced by newer ones, "), sent = number_of(said, "pictures: ");
  if (late < 0.02 * sent) return;
  print_message("note: the machine was late with %.0f of %.0f pictures\n", late, sent + late);
  skip();
}

static void a_rig_is_measured_as_it_is(void **state) {
  (void)state;
  if (vs_bus_supported(NULL) != VS_OK || too_slow_for_real_time()) skip();
  char arguments[512], rig_log[96], log[96], out[96];
  static vsss_run run;
  snprintf(rig_log, sizeof rig_log, "%s/rig.log", folder);
  snprintf(log, sizeof log, "%s/shaken.lcm", folder);
  snprintf(out, sizeof out, "%s/realism.ini", folder);
  snprintf(arguments, sizeof arguments, "rig%s --no-lcm --opponent zero: --robot-delay 2 --dir %s/venue",
           SANITIZED ? "" : " --rt 40", folder);
  pid_t rig = vsss_start(rig_log, arguments);
  if (!wait_for_text(rig_log, "waiting for the camera", 60)) {
    vsss_wait(rig, 1);
    if (!strstr(read_text(rig_log), "install ")) fail_msg("rig: %s", read_text(rig_log));
    print_message("note: %s", read_text(rig_log));
    skip();
  }
  snprintf(arguments, sizeof arguments,
           "field%s --go --no-lcm --camera rig:%s/venue/camera --radio %s/venue/radio --policy shake: --seconds 25 "
           "--record %s",
           SANITIZED ? "" : " --rt 50", folder, folder, log);
  vsss(&run, arguments);
  assert_int_equal(run.status, 0);
  double wheel_ms = number_of(run.out, "mid-exposure to wheel: ");
  assert_non_null(strstr(run.out, "ms, as the robots' motion told"));
  kill(rig, SIGINT);
  assert_int_equal(vsss_wait(rig, 20), 0);
  skip_where_the_rig_was_late(read_text(rig_log));
  double true_s = 1e-3 * number_of(read_text(rig_log), "a command acted ");
  assert_true(true_s > 0.066); // two pictures late at least

  snprintf(arguments, sizeof arguments, "identify %s --json --out %s", log, out);
  vsss(&run, arguments);
  if (run.status) fail_msg("identify: %s", run.err);
  double delay_s = 0, tau_s = 0, gain = 0;
  const char *at = run.out;
  for (int i = 0; i < 3; i++) {
    char name[32];
    snprintf(name, sizeof name, "\"robot\": %d", i);
    at = strstr(run.out, name);
    assert_non_null(at);
    delay_s += number_of(at, "\"delay_s\": ") / 3;
    tau_s += number_of(at, "\"tau_straight_s\": ") / 3;
    gain += (number_of(at, "\"gain_left\": ") + number_of(at, "\"gain_right\": ")) / 6;
  }
  print_message("delay %.1f ms, the rig's own %.1f ms; time constant %.1f ms; gain %.3f\n", 1e3 * delay_s, 1e3 * true_s,
                1e3 * tau_s, gain);
  assert_near(delay_s, true_s, share() * true_s);
  assert_near(tau_s, SERVO_TAU_S, share() * SERVO_TAU_S);
  assert_near(gain, 1, share());

  vs_realism realism;
  assert_ok(vs_realism_load(out, &realism, err)); // what sim, eval and train read

  snprintf(arguments, sizeof arguments, "latency %s --json", log);
  vsss(&run, arguments);
  assert_int_equal(run.status, 0);
  const char *to_bytes = strstr(run.out, "mid-exposure to bytes");
  assert_non_null(to_bytes);
  double both_ms = number_of(to_bytes, "\"mean_ms\": ") + 1e3 * true_s;
  print_message("mid-exposure to wheel: field says %.0f ms, it was %.1f ms\n", wheel_ms, both_ms);
  assert_near(wheel_ms, both_ms, share() * both_ms);
  double motion_ms = number_of(strstr(run.out, "bytes to motion, robot 0"), "\"p50_ms\": ");
  assert_near(motion_ms, 1e3 * true_s, share() * 1e3 * true_s);
  assert_true(number_of(run.out, "\"mid-exposure to bytes\": {\"count\": ") > 300);
}

static void what_cannot_be_measured_is_named(void **state) {
  (void)state;
  if (vs_bus_supported(NULL) != VS_OK) skip();
  char path[96], arguments[160];
  snprintf(path, sizeof path, "%s/empty.lcm", folder);
  write_log_of_a_command(path);
  snprintf(arguments, sizeof arguments, "identify %s", path);
  assert_refused(arguments, 1, "holds no sights of blue");
  snprintf(arguments, sizeof arguments, "latency %s", path);
  assert_refused(arguments, 1, "holds no sights of blue");
  assert_refused("identify", 2, "expected one log");
  assert_refused("latency /nonexistent", 1, "/nonexistent: No such file");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_rig_is_measured_as_it_is),
      cmocka_unit_test(what_cannot_be_measured_is_named),
  };
  return cmocka_run_group_tests_name("cli/identify", tests, make_folder, remove_folder);
}
