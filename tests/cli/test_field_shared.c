// Tests src/cli/field_guest.c with a shared vision (ssl:, vss-vision:) through the real binary: a sender of the test's is
// seen (through --publish) and answered with commands to the simulator's port.
#include <math.h>
#include <time.h>

#include "assert_near.h"
#include "league_net/ssl_bytes.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/clock.h"
#include "vsss/league_messages.h"
#include "vsss/ssl_vision.h"
#include "vsss/udp.h"

static int offset;

// Robot 0 of blue drives along y = 0.3 at 0.4 m/s, to and fro; the others stand; the ball lies at 0.2, -0.1.
static double place_of(double t) { return 0.4 * fabs(fmod(t, 2.0) - 1.0) - 0.2; }

static void send_frame(const vs_udp *to, uint32_t number, double t, int vss_vision) {
  ssl_bytes d = {.size = 0};
  put_head(&d, vss_vision ? 0 : number, vss_vision ? 0 : t);
  put_ball(&d, 1, 0.2, -0.1);
  for (uint32_t i = 0; i < 3; i++) {
    put_robot(&d, 7, i, i ? -0.4 - 0.1 * i : place_of(t), 0.3 * (1 - (int)i), 0);
    put_robot(&d, 6, i, 0.5, 0.3 * (1 - (int)i), 3.1);
  }
  ssl_bytes b = wrap(&d, vss_vision);
  assert_true(vs_udp_send(to, b.data, b.size));
}

static void plays_by(int vss_vision) {
  int vision = 24000 + offset + 3 * vss_vision, shift = offset + 10 * vss_vision;
  vs_udp to, seen, commands;
  char text[512], output[128];
  if (vss_vision)
    assert_ok(vs_udp_sender("127.0.0.1", vision, NULL, &to, err));
  else
    assert_ok(vs_udp_sender("224.5.23.2", vision, NULL, &to, err));
  assert_ok(vs_udp_join("224.0.0.1", 10002 + shift, NULL, &seen, err));
  assert_ok(vs_udp_listen(20011 + shift, NULL, &commands, err));
  snprintf(text, sizeof text, "field --go --camera %s%d --radio firasim:+%d --publish firasim:+%d --policy emc:",
           vss_vision ? "vss-vision:" : "ssl:+", vss_vision ? vision : vision - VS_SSL_PORT, shift, shift);
  snprintf(output, sizeof output, "%s/field", folder);
  pid_t field = vsss_start(output, text);
  vs_fira_environment e = {0};
  int worlds = 0, packets = 0;
  double fastest = 0, speed = 0, begin_s = 1e-6 * (double)vs_clock_monotonic_us(), t = 0;
  for (uint32_t k = 0; (worlds < 200 || packets < 200) && t < 60; k++) {
    uint8_t bytes[2048];
    size_t size;
    vs_fira_packet p;
    t = 1e-6 * (double)vs_clock_monotonic_us() - begin_s;
    send_frame(&to, k, t, vss_vision);
    while (vs_udp_receive(&seen, bytes, sizeof bytes, &size)) {
      assert_ok(vs_fira_environment_decode(bytes, size, &e, err));
      speed = fmax(speed, fabs(e.world.robot[VS_BLUE][0].vx_mps));
      worlds++;
    }
    while (vs_udp_receive(&commands, bytes, sizeof bytes, &size)) {
      assert_ok(vs_fira_packet_decode(bytes, size, true, &p, err));
      for (int i = 0; i < p.commands; i++) {
        assert_int_equal(p.command[i].team, VS_BLUE);
        fastest = fmax(fastest, fabs(p.command[i].wheels.left_radps));
      }
      packets++;
    }
    vs_clock_sleep_until_us((int64_t)(1e6 * (begin_s + t)) + 16667);
  }
  int status = vsss_finish(field, SIGINT);
  if (worlds < 200 || packets < 200) fail_msg("%d worlds, %d packets: %s", worlds, packets, folder_file("field"));
  assert_int_equal(status, 0);
  assert_true(fastest > 1); // it plays
  assert_true(speed > 0.3 && speed < 0.7);
  for (int team = 0; team < VS_TEAMS; team++)
    for (int i = 0; i < 3; i++) assert_true(e.world.robot[team][i].valid);
  assert_near(e.world.robot[VS_BLUE][2].pose.x_m, -0.6, 0.002);
  assert_near(e.world.robot[VS_BLUE][2].pose.y_m, -0.3, 0.002);
  assert_near(e.world.robot[VS_YELLOW][1].pose.theta_rad, 3.1, 0.01);
  assert_near(e.world.ball.x_m, 0.2, 0.002);
  vs_udp_close(&to);
  vs_udp_close(&seen);
  vs_udp_close(&commands);
}

static void ssl_vision_is_played_by(void **state) {
  (void)state;
  plays_by(0);
}

static void vss_vision_without_times_is_played_by(void **state) {
  (void)state;
  plays_by(1);
}

static void what_does_not_fit_is_refused(void **state) {
  (void)state;
  assert_refused("field --camera ssl:7", 2, "ssl:PORT");
  assert_refused("field --camera ssl:+60000", 2, "ssl:+N");
  assert_refused("field --camera ssl:+-1", 2, "ssl:+N");
  assert_refused("field --camera vss-vision:+10", 2, "vss-vision:PORT");
  assert_refused("field --camera vss-vision:", 2, "vss-vision:PORT");
  assert_refused("field --camera ssl: --radio firasim:x=1", 2, "x=1");
  assert_refused("field --camera ssl:24999 --radio /nowhere/tty", 1, "/nowhere/tty");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 40;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ssl_vision_is_played_by),
      cmocka_unit_test(vss_vision_without_times_is_played_by),
      cmocka_unit_test(what_does_not_fit_is_refused),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
