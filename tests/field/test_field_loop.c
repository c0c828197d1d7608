// src/field/field_loop.c, src/field/field_open.c, src/field/orders.c, src/field/field_stats.c and src/field/tap.c
#include <string.h>

#include "assert_near.h"
#include "field/tagged_picture.h"
#include "vsss/image.h"
#include "vsss/bus.h"
#include "vsss/clock.h"
#include "vsss/field_loop.h"
#include "vsss/rng.h"
#include "vsss/tick.h"

enum { W = PICTURE_W, H = PICTURE_H };

// A camera that gives what the test wants next: the same picture, numbered, this old.
static struct {
  uint32_t seq;
  int64_t age_us;
  int64_t not_before_us; // a picture is there from then on
  bool end;
} fake;
static uint8_t picture[3 * W * H], grey[W * H];

static vs_status open_fake(const char *rest, const vs_camera_def *def, void **handle, vs_camera_info *info,
                           vs_error *err) {
  (void)rest, (void)def, (void)err;
  *handle = &fake;
  *info = (vs_camera_info){.width = W, .height = H, .fps = 30};
  return VS_OK;
}

static vs_status read_fake(void *handle, int timeout_ms, vs_frame *out, vs_camera_got *got, vs_error *err) {
  (void)handle, (void)timeout_ms, (void)err;
  *got = fake.end ? VS_CAMERA_END : VS_CAMERA_FRAME;
  vs_clock_sleep_until_us(fake.not_before_us);
  *out = (vs_frame){.grey = grey,
                    .bgr = picture,
                    .width = W,
                    .height = H,
                    .grey_stride = W,
                    .bgr_stride = 3 * W,
                    .capture_us = vs_clock_monotonic_us() - fake.age_us,
                    .seq = fake.seq};
  return VS_OK;
}

static void close_fake(void *handle) { (void)handle; }

static int register_fake(void **state) {
  (void)state;
  static const vs_camera_api api = {"fake", "fake: for tests", open_fake, read_fake, close_fake};
  vs_camera_register(&api);
  paint_tagged_picture(picture);
  for (int i = 0; i < W * H; i++) { // to blue, green, red
    uint8_t red = picture[3 * i];
    picture[3 * i] = picture[3 * i + 2];
    picture[3 * i + 2] = red;
  }
  vs_image_grey(picture, 3 * W, W, H, grey, W);
  return 0;
}

static vs_field *a_field(const char *policy, const char *lcm) {
  memset(&fake, 0, sizeof fake);
  vs_field_def def = vs_field_def_default();
  def.camera = "fake:";
  def.policy = policy;
  def.go = true;
  def.lcm = lcm != NULL;
  def.lcm_url = lcm;
  vs_field *field;
  char note[400];
  assert_ok(vs_field_new(&def, &field, note, sizeof note, err));
  assert_non_null(strstr(note, "assuming a camera 2.20 m above"));
  return field;
}

static vs_field_tick_result tick(vs_field *field, uint32_t seq, int64_t age_us) {
  vs_field_tick_result r;
  fake.seq = seq;
  fake.age_us = age_us;
  fake.not_before_us = vs_clock_monotonic_us() + 33333;
  assert_ok(vs_field_tick(field, &r, err));
  return r;
}

static void the_robots_drive_only_while_one_of_them_is_seen(void **state) {
  (void)state;
  vs_field *field = a_field("random:", NULL);
  for (uint32_t i = 0; i < 4; i++) {
    vs_field_tick_result r = tick(field, i, 500);
    assert_false(r.stop);
    assert_true(r.world.robot[VS_BLUE][2].valid);
    // Tag 2: its middle at 100 + 300 + 13.5 - 0.5 = 413 px from the left; (413 - 319.5) / (776.5 / 2.12) = 0.255 m.
    assert_near(r.world.robot[VS_BLUE][2].pose.x_m, 0.255, 0.002);
    assert_near(r.world.robot[VS_BLUE][2].pose.theta_rad, 1.5708, 0.02); // top up: heading +y
  }
  memset(grey, 0, sizeof grey);
  bool stopped = false;
  for (uint32_t i = 4; i < 30 && !stopped; i++) stopped = tick(field, i, 500).stop;
  assert_true(stopped);
  vs_image_grey(picture, 3 * W, W, H, grey, W);
  vs_field_free(field);
}

static void frames_that_never_came_are_counted(void **state) {
  (void)state;
  vs_field *field = a_field("zero:", NULL);
  static vs_field_stats stats;
  tick(field, 10, 1000);
  tick(field, 11, 1000);
  tick(field, 15, 1000); // 12, 13, 14 are missing
  tick(field, 16, 1000);
  vs_field_get_stats(field, &stats);
  assert_int_equal(stats.frames, 4);
  assert_int_equal(stats.dropped, 3);
  assert_int_equal(stats.stage[VS_STAGE_DETECT].count, 4);
  vs_field_free(field);
}

static void nothing_is_decided_on_an_old_frame(void **state) {
  (void)state;
  vs_field *field = a_field("random:", NULL);
  static vs_field_stats stats;
  for (uint32_t i = 0; i < 6; i++) {
    vs_field_tick_result r = tick(field, i, VS_FIELD_MAX_AGE_US + 1);
    assert_int_equal(r.got, VS_CAMERA_FRAME);
    assert_false(r.decided);
  }
  vs_field_get_stats(field, &stats);
  assert_int_equal(stats.too_old, 6);
  assert_int_equal(stats.decisions, 0);
  assert_int_equal(stats.stage[VS_STAGE_AGE].count, 0);
  vs_field_free(field);
}

static void decisions_keep_the_policys_rate_and_missed_ones_are_counted(void **state) {
  (void)state;
  // random: decides at 10 Hz, so on every third frame of 30 Hz; a pause of half a second misses four.
  vs_field *field = a_field("random:", NULL);
  static vs_field_stats stats;
  int decided = 0;
  for (uint32_t i = 0; i < 9; i++) decided += tick(field, i, 500).decided;
  vs_field_get_stats(field, &stats);
  if (stats.too_old == 0 && stats.stage[VS_STAGE_TOTAL].max_us < 30000) assert_in_range(decided, 3, 4);
  assert_int_equal(stats.decisions, decided);
  int64_t missed = stats.missed_ticks;
  vs_clock_sleep_until_us(vs_clock_monotonic_us() + 500000);
  for (uint32_t i = 9; i < 12; i++) tick(field, i, 500);
  vs_field_get_stats(field, &stats);
  assert_true(stats.missed_ticks - missed >= 4);
  vs_field_free(field);
}

// A run as it would be computed again from a record, so that no machine is too slow for it: turns every 33 ms, with frames that
// show one robot and the ball, or without.
enum { FRAME_US = 33333 };
typedef struct run {
  vs_field *field;
  int64_t now_us, last_frame_us;
  int turns, stops;
} run;

static run open_run(void) {
  static vs_field_rerun start;
  start = (vs_field_rerun){.width_px = W, .height_px = H, .start_us = 1000000};
  vs_field_def def = vs_field_def_default();
  def.camera = "fake:";
  def.policy = "random:";
  def.go = true;
  def.lcm = false;
  def.rerun = &start;
  run r = {.now_us = start.start_us};
  char note[400];
  assert_ok(vs_field_new(&def, &r.field, note, sizeof note, err));
  return r;
}

static bool turn(run *r, bool frame) {
  r->now_us += FRAME_US;
  vs_tick t = {.seq = r->turns,
               .frame = frame,
               .frame_seq = (uint32_t)r->turns,
               .capture_us = r->now_us - 5000,
               .fps = 30},
          again;
  t.camera = t.armed = true;
  for (t.n_clock = 0; t.n_clock < VS_TICK_CLOCKS; t.n_clock++) t.clock_us[t.n_clock] = r->now_us;
  if (frame) {
    t.n_tags = t.n_balls = 1;
    t.tag[0] = (vs_tick_tag){0, 0, 0, 100, {320, 240}, {{308, 252}, {332, 252}, {332, 228}, {308, 228}}};
    t.tag[0].kind = VS_MARK_APRIL;
    t.ball[0] = (vs_tick_blob){200, 200, 180, 1, 1, 0};
    r->last_frame_us = t.capture_us;
  }
  r->turns++;
  vs_field_again(r->field, &t, &again, NULL); // how often it looked at the clock is none of this test
  r->stops += again.stop;
  return again.stop;
}

// How long after the last frame's exposure the robots are stopped.
static double frozen_ms(run *r) {
  for (int i = 0; i < 60; i++)
    if (turn(r, false)) return 1e-3 * (double)(r->now_us - r->last_frame_us);
  fail_msg("frozen for 2 s, and still no stop");
  return 0;
}

// 100 ms predicted and 150 ms more, and up to a turn.
static void a_camera_that_was_whole_and_falls_silent_is_frozen(void **state) {
  (void)state;
  run r = open_run();
  for (int i = 0; i < 60; i++) turn(&r, true);
  assert_true(r.stops < 5); // until the first decision
  assert_near(frozen_ms(&r), 270, 25);
  vs_field_free(r.field);
}

// Ten minutes of half the pictures at random: gaps of ten frames are among them.
static void a_camera_that_loses_half_of_its_pictures_stops_nobody(void **state) {
  (void)state;
  run r = open_run();
  vs_rng rng = vs_rng_make(3, 0);
  for (int i = 0; i < 90; i++) turn(&r, i < 30 || i % 2);
  r.turns = r.stops = 0;
  int gap = 0, longest = 0;
  while (r.turns < 18000) {
    bool frame = vs_rng_below(&rng, 2) != 0;
    gap = frame ? 0 : gap + 1;
    longest = gap > longest ? gap : longest;
    turn(&r, frame);
  }
  print_message("longest gap %d frames, %d of %d turns stopped\n", longest, r.stops, r.turns);
  assert_true(longest >= 10);
  assert_true(r.stops < r.turns / 1000); // what is beyond 400 ms: every 2 ^ 12 frames
  for (int i = 0; i < 30; i++) turn(&r, i % 2);
  assert_near(frozen_ms(&r), 420, 25); // and it too is frozen in the end
  vs_field_free(r.field);
}

static void the_end_of_a_recording_is_told(void **state) {
  (void)state;
  vs_field *field = a_field("zero:", NULL);
  vs_field_tick_result r;
  fake.end = true;
  assert_ok(vs_field_tick(field, &r, err));
  assert_int_equal(r.got, VS_CAMERA_END);
  vs_field_free(field);
}

static int heard[VS_CHANNELS];
static void count_message(const vs_message *message, void *user) {
  (void)user;
  heard[message->channel]++;
  if (message->channel == VS_CH_DETECTIONS) assert_int_equal(message->as.detections.width_px, W);
  if (message->channel == VS_CH_IMAGE) assert_int_equal(message->as.image.width_px, W);
  if (message->channel == VS_CH_STATS) assert_int_equal(message->as.stats.n_stages, VS_STAGES);
}

static void every_frame_is_told_and_a_referee_halts_play(void **state) {
  (void)state;
  vs_error err = {0};
  if (vs_bus_supported(NULL) != VS_OK) skip(); // built without LCM
  vs_bus *outside;
  const char *url = "udpm://239.255.76.67:7717?ttl=0";
  if (vs_bus_open(url, &outside, &err) != VS_OK) {
    print_message("note: no multicast route\n");
    skip();
  }
  memset(heard, 0, sizeof heard);
  assert_ok(vs_bus_subscribe(outside, VS_CHANNELS, false, count_message, NULL, err));
  vs_field *field = a_field("zero:", url);
  for (uint32_t i = 0; i < 4; i++) assert_false(tick(field, i, 500).stop);
  vs_message halt = {.channel = VS_CH_REFEREE};
  halt.as.referee = (vs_msg_referee){.event = {.kind = VS_EVENT_HALT, .time_s = 3}, .duration_s = 60};
  assert_ok(vs_bus_publish(outside, &halt, err));
  int stopped_after = -1;
  for (int i = 0; i < 30 && stopped_after < 0; i++)
    if (tick(field, 4 + (uint32_t)i, 500).stop) stopped_after = i;
  assert_true(stopped_after >= 0);
  static vs_field_stats stats;
  vs_field_get_stats(field, &stats);
  assert_int_equal(stats.events, 1);
  for (int i = 0; i < 100; i++) vs_bus_handle(outside, 5, NULL, NULL);
  uint8_t jpeg[2048];
  size_t size;
  if (vs_image_jpeg(&(vs_image){picture, 8, 8, 3 * W}, &(vs_jpeg_def){80, 1}, jpeg, sizeof jpeg, &size, &err) ==
      VS_OK) { // OpenCV is there
    for (int i = 0; i < 300 && !heard[VS_CH_IMAGE]; i++) vs_bus_handle(outside, 20, NULL, NULL);
    assert_true(heard[VS_CH_IMAGE] >= 1);
  }
  // Before the halt alone: four frames, at least one decision.
  assert_true(heard[VS_CH_STATE] >= 4);
  assert_true(heard[VS_CH_DETECTIONS] >= 4);
  assert_true(heard[VS_CH_CMD] >= 1);
  assert_true(heard[VS_CH_POLICY] >= 1);
  assert_true(heard[VS_CH_RADIO] >= 1);
  vs_field_free(field);
  vs_bus_close(outside);
}

static void what_cannot_be_opened_is_named(void **state) {
  (void)state;
  vs_field_def def = vs_field_def_default();
  vs_field *field;
  vs_error err = {0};
  def.camera = "telescope:1";
  def.lcm = false;
  assert_int_equal(vs_field_new(&def, &field, NULL, 0, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "telescope"));
  def.camera = "fake:";
  def.policy = "clever:";
  assert_int_equal(vs_field_new(&def, &field, NULL, 0, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "clever"));
  def.policy = "zero:";
  def.calib = "/nonexistent/calib.ini";
  assert_int_equal(vs_field_new(&def, &field, NULL, 0, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nonexistent/calib.ini"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_robots_drive_only_while_one_of_them_is_seen),
      cmocka_unit_test(frames_that_never_came_are_counted),
      cmocka_unit_test(nothing_is_decided_on_an_old_frame),
      cmocka_unit_test(decisions_keep_the_policys_rate_and_missed_ones_are_counted),
      cmocka_unit_test(a_camera_that_was_whole_and_falls_silent_is_frozen),
      cmocka_unit_test(a_camera_that_loses_half_of_its_pictures_stops_nobody),
      cmocka_unit_test(the_end_of_a_recording_is_told),
      cmocka_unit_test(every_frame_is_told_and_a_referee_halts_play),
      cmocka_unit_test(what_cannot_be_opened_is_named),
  };
  return cmocka_run_group_tests_name("field/field_loop", tests, register_fake, NULL);
}
