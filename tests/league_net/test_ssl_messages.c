// Tests src/league_net/ssl_messages.c and src/league_net/ssl_world.c: a shared vision's datagrams, and velocities out of them.
#include <math.h>

#include "assert_near.h"
#include "league_net/ssl_bytes.h"
#include "vsss/geom.h"
#include "vsss/league_messages.h"
#include "vsss/ssl_vision.h"

static void a_datagram_is_read_in_metres(void **state) {
  (void)state;
  ssl_bytes d = {.size = 0};
  put_head(&d, 7, 12.5);
  put_ball(&d, 0.2F, 0.5, 0.5); // less sure than the next
  put_ball(&d, 0.8F, -0.123, 0.45);
  put_robot(&d, 7, 0, -0.7, 0.01, 1.5);
  put_robot(&d, 7, 2, 0.25, -0.6, -3);
  put_robot(&d, 6, 1, 0.7, 0, 3.5); // an angle beyond pi
  for (int geometry = 0; geometry < 2; geometry++) {
    ssl_bytes b = wrap(&d, geometry);
    vs_ssl_frame f;
    assert_ok(vs_ssl_decode(b.data, b.size, &f, err));
    assert_true(f.detection);
    assert_near(f.capture_s, 12.5, 0);
    assert_true(f.ball_seen);
    assert_near(f.ball_x_m, -0.123, 1e-6);
    assert_near(f.ball_y_m, 0.45, 1e-6);
    assert_true(f.seen[VS_BLUE][0] && !f.seen[VS_BLUE][1] && f.seen[VS_BLUE][2] && f.seen[VS_YELLOW][1]);
    assert_near(f.robot[VS_BLUE][2].x_m, 0.25, 1e-6);
    assert_near(f.robot[VS_BLUE][2].theta_rad, -3, 1e-6);
    assert_near(f.robot[VS_YELLOW][1].theta_rad, 3.5 - 2 * VS_PI, 1e-6);
  }
}

static void what_cannot_be_is_left_out(void **state) {
  (void)state;
  ssl_bytes d = {.size = 0};
  put_head(&d, 7, NAN);
  put_ball(&d, 1, NAN, 0);
  put_ball(&d, 1, 3, 0);
  put_robot(&d, 7, 3, 0, 0, 0); // three robots: 0 to 2
  put_robot(&d, 7, 0, 0, 5, 0);
  put_robot(&d, 6, 0, 0, 0, INFINITY);
  ssl_bytes b = wrap(&d, 0);
  vs_ssl_frame f;
  assert_ok(vs_ssl_decode(b.data, b.size, &f, err));
  assert_false(f.ball_seen);
  assert_near(f.capture_s, 0, 0);
  for (int t = 0; t < VS_TEAMS; t++)
    for (int i = 0; i < VS_TEAM_SIZE; i++) assert_false(f.seen[t][i]);
  ssl_bytes geometry = wrap(NULL, 1);
  assert_ok(vs_ssl_decode(geometry.data, geometry.size, &f, err));
  assert_false(f.detection);
  vs_error err = {0};
  for (size_t cut = 1; cut < b.size; cut++) vs_ssl_decode(b.data, b.size - cut, &f, &err); // none crashes
  assert_int_equal(vs_ssl_decode((const uint8_t *)"\xff\xff\xff", 3, &f, &err), VS_FAIL);
}

// A robot that drives 0.6 m/s and turns 2 rad/s through pi, a ball of 1 m/s; the sender's clock or ours tells the time.
static void velocities_come_of_positions(void **state) {
  (void)state;
  for (int clock = 0; clock < 2; clock++) {
    vs_ssl_world ssl = {0};
    vs_world w = {0};
    int64_t now_us = 5000000;
    double t = 0, theta = 3;
    for (int k = 0; k < 60; k++) {
      vs_ssl_frame f = {.detection = true, .capture_s = clock ? 1000 + t : 0, .ball_seen = true};
      f.seen[VS_YELLOW][1] = true;
      f.robot[VS_YELLOW][1] = (vs_pose){-0.3 + 0.6 * t, 0.1, vs_wrap_rad(theta)};
      f.ball_x_m = 0.5 - t, f.ball_y_m = 0;
      vs_ssl_world_see(&ssl, &f, now_us, &w);
      t += 1 / 60.0;
      theta += 2 / 60.0;
      // With its clock told, late arrivals do not matter.
      now_us = 5000000 + (int64_t)(1e6 * t) + (clock && k % 2 ? 5000 : 0) + (clock ? 10000 : 0);
    }
    const vs_robot *r = &w.robot[VS_YELLOW][1];
    assert_true(r->valid && w.ball.valid && !w.robot[VS_BLUE][0].valid);
    assert_near(r->vx_mps, 0.6, 0.02);
    assert_near(r->vy_mps, 0, 0.02);
    assert_near(r->omega_radps, 2, 0.1);
    assert_near(w.ball.vx_mps, -1, 0.03);
    assert_near(r->pose.x_m, -0.3 + 0.6 * (t - 1 / 60.0), 0.002);
  }
}

static void what_is_not_seen_for_long_is_not_valid_and_begins_anew(void **state) {
  (void)state;
  vs_ssl_world ssl = {0};
  vs_world w = {0};
  vs_ssl_frame with = {.detection = true}, without = {.detection = true};
  with.seen[VS_BLUE][0] = true;
  with.robot[VS_BLUE][0] = (vs_pose){0.1, 0.2, 0.3};
  vs_ssl_world_see(&ssl, &with, 1000000, &w);
  vs_ssl_world_see(&ssl, &without, 1000000 + VS_SSL_HOLD_US, &w); // another camera, perhaps
  assert_true(w.robot[VS_BLUE][0].valid);
  vs_ssl_world_see(&ssl, &without, 1000001 + VS_SSL_HOLD_US, &w);
  assert_false(w.robot[VS_BLUE][0].valid);
  with.robot[VS_BLUE][0].x_m = -0.6; // put elsewhere by hand: it did not drive there
  vs_ssl_world_see(&ssl, &with, 1100000 + VS_SSL_HOLD_US, &w);
  assert_true(w.robot[VS_BLUE][0].valid);
  assert_near(w.robot[VS_BLUE][0].pose.x_m, -0.6, 1e-9);
  assert_near(w.robot[VS_BLUE][0].vx_mps, 0, 1e-9);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_datagram_is_read_in_metres),
      cmocka_unit_test(what_cannot_be_is_left_out),
      cmocka_unit_test(velocities_come_of_positions),
      cmocka_unit_test(what_is_not_seen_for_long_is_not_valid_and_begins_anew),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, NULL, NULL);
}
