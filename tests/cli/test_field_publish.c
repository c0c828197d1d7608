// Tests src/cli/field_publish.c through the real binary: a listener of the league's group sees what the camera sees.
#include "field_venue.h"
#include "test_folder.h"
#include "vsss/field.h"
#include "vsss/league_messages.h"
#include "vsss/udp.h"

static int offset;

// Plays until the listener has n worlds; the last one is left in e.
static void hear(venue *v, const vs_udp *listener, int n, vs_fira_environment *e) {
  uint8_t bytes[2048];
  size_t size;
  uint32_t before = 0;
  for (int64_t end_us = vs_clock_monotonic_us() + 60000000; n > 0;) {
    if (vs_clock_monotonic_us() > end_us) fail_msg("%d worlds are missing: %s", n, read_text(v->log_path));
    live(v);
    if (!vs_udp_receive(listener, bytes, sizeof bytes, &size)) continue;
    assert_true(size <= VS_LEAGUE_DATAGRAM_MAX);
    assert_ok(vs_fira_environment_decode(bytes, size, e, err));
    assert_true(e->step >= before); // it counts milliseconds of the pictures
    before = e->step;
    n--;
  }
}

// The picture of tagged_picture.h under the camera that `field` assumes: 640 px show 1.813 m (0.68 m above the middle is
// 240 px), so 2.83 mm a pixel on the floor and, 8 cm higher under a lens at 2.2 m, 2.73 mm. Tags' centres are in the rows
// around 213, 26 px above the middle, their middles 13.5 px right of 100, 250 and 400.
static void a_listener_sees_the_robots_where_they_are(void **state) {
  (void)state;
  char flags[160];
  vs_udp listener;
  vs_fira_environment e = {0};
  assert_ok(vs_udp_join("224.0.0.1", 10002 + offset, NULL, &listener, err));
  snprintf(flags, sizeof flags, "--policy zero: --publish firasim:+%d", offset);
  venue *v = open_venue(folder, flags);
  hear(v, &listener, 40, &e);
  const double centre_px[VS_TEAM_SIZE] = {113.5, 263.5, 413.5};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_robot *r = &e.world.robot[VS_BLUE][i];
    assert_true(r->valid);
    assert_near(r->pose.x_m, (centre_px[i] - 320) * 0.00273, 0.02);
    assert_near(r->pose.y_m, (240 - 213) * 0.00273, 0.02);
    assert_near(hypot(r->vx_mps, r->vy_mps), 0, 0.02);
  }
  assert_true(e.world.ball.valid);
  assert_near(e.world.ball.x_m, 0, 0.02);
  assert_near(e.world.ball.y_m, (240 - 350) * 0.00281, 0.02);
  assert_true(e.step > 30 * 25 && e.step < 60000);
  close_venue(v, 0);
  vs_udp_close(&listener);
}

static void two_do_not_publish_on_one_port(void **state) {
  (void)state;
  char text[256], holder[64];
  vs_udp claim;
  assert_ok(vs_udp_claim("224.0.0.1", 10002 + offset + 10, &claim, err));
  snprintf(text, sizeof text, "field --camera rig:%s/camera --publish firasim:+%d", folder, offset + 10);
  snprintf(holder, sizeof holder, "process %d", (int)getpid());
  assert_refused(text, 1, holder);
  vs_udp_close(&claim);
  assert_refused("field --camera rig:/nowhere --publish ssl:", 2, "expected firasim:");
  assert_refused("field --camera rig:/nowhere --publish firasim:x=1", 2, "x=1");
  assert_refused("field --camera rig:/nowhere --publish firasim: --interface hall0", 2, "hall0");
  // As a guest it would see its own world again.
  snprintf(text, sizeof text, "field --camera firasim:+%d --policy zero: --publish firasim:+%d", offset + 20,
           offset + 20);
  assert_refused(text, 2, "take another");
}

int main(void) {
  offset = 100 + (int)(getpid() % 200) * 100 + 30;
  vs_camera_register(vs_frame_stream_camera());
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_listener_sees_the_robots_where_they_are),
      cmocka_unit_test(two_do_not_publish_on_one_port),
  };
  vs_error err = {0};
  if (vs_league_supported(&err) != VS_OK) {
    print_message("note: %s\n", err.text);
    return 0;
  }
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
