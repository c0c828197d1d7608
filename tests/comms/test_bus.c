// Tests src/comms/bus.c, bus_url.c, bus_encode.c and bus_decode.c.
#define _GNU_SOURCE // memmem
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/bus.h"
#include "vsss/paths.h"
#include "vsss/rng.h"

static uint8_t picture[5000];

// One message per channel with no two equal fields where the type allows it.
static void fill(vs_channel channel, vs_message *m) {
  memset(m, 0, sizeof *m);
  m->channel = channel;
  m->utime_us = 1700000000123456;
  m->utime_capture_us = 1700000000100000;
  m->seq = 4711;
  switch (channel) {
  case VS_CH_TRUTH:
  case VS_CH_STATE: {
    vs_world *w = &m->as.world.world;
    w->time_us = 33333;
    w->seq = 4711;
    double value = 0.01;
    for (int t = 0; t < VS_TEAMS; t++)
      for (int i = 0; i < VS_TEAM_SIZE; i++) {
        double *p[] = {&w->robot[t][i].pose.x_m,   &w->robot[t][i].pose.y_m,   &w->robot[t][i].pose.theta_rad,
                       &w->robot[t][i].vx_mps,     &w->robot[t][i].vy_mps,     &w->robot[t][i].omega_radps,
                       &w->robot[t][i].left_radps, &w->robot[t][i].right_radps};
        for (int k = 0; k < 8; k++) *p[k] = value += 0.01;
        w->robot[t][i].valid = (t + i) % 2;
      }
    w->ball = (vs_ball){-0.1, -0.2, 0.021, 1.1, 1.2, 1.3, true};
    m->as.world.game = (vs_game){12.5, 120.0, {3, 4}, {VS_EVENT_FREE_BALL, VS_YELLOW, 3, 11.25}};
    m->as.world.asks_team = channel == VS_CH_STATE ? VS_YELLOW : -1;
    break;
  }
  case VS_CH_CMD:
    m->as.cmd = (vs_msg_cmd){VS_YELLOW, {{1, 2}, {-3, 4}, {5, -6}}, true, 99, "emc:?pid=1", VS_3V3};
    break;
  case VS_CH_REFEREE: m->as.referee = (vs_msg_referee){{VS_EVENT_GOAL, VS_YELLOW, 0, 7.5}, 120.0, {1, 2}}; break;
  case VS_CH_POLICY:
    m->as.policy.team = VS_YELLOW;
    m->as.policy.contract_hash = 0xfedcba9876543210;
    for (int r = 0; r < VS_TEAM_SIZE; r++)
      for (int i = 0; i < VS_OBS_SIZE; i++) m->as.policy.observation[r][i] = (float)(r * 1000 + i) / 4096.0f;
    m->as.policy.action[2][1] = -0.75f;
    strcpy(m->as.policy.player, "onnx:models/policy/vsss.onnx");
    break;
  case VS_CH_DETECTIONS:
    m->as.detections.width_px = 640;
    m->as.detections.height_px = 480;
    m->as.detections.n_tags = 2;
    m->as.detections.tag[1] = (vs_msg_tag){5, 1, 120.5, {320, 240}, {{1, 2}, {3, 4}, {5, 6}, {7, 8}}, {0.1, 0.2, 0.3}};
    m->as.detections.n_blobs = 1;
    m->as.detections.blob[0] = (vs_msg_blob){VS_BLOB_OPPONENT, {11, 12}, 150, 0.5, -0.3, 0.4};
    break;
  case VS_CH_RADIO:
    m->as.radio = (vs_msg_radio){.device = "/dev/ttyUSB0",
                                 .up = true,
                                 .stopping = true,
                                 .sent_frames = 1,
                                 .dropped_frames = 2,
                                 .reopened = 3,
                                 .received_frames = 4,
                                 .bad_frames = 5,
                                 .command_age_us = 6};
    m->as.radio.robot[2] = (vs_msg_radio_robot){2, 10, 20, {1.5, -2.5}, 7.4, 100.25, -60, 65535, 3};
    break;
  case VS_CH_STATS:
    m->as.stats =
        (vs_msg_stats){.frames = 600, .dropped_frames = 1, .decisions = 100, .missed_ticks = 2, .n_stages = 2};
    m->as.stats.stage[1] =
        (vs_msg_stage){.name = "detect", .count = 60, .p50_us = 2500, .p99_us = 3400, .max_us = 9000};
    m->as.stats.stage[1].bucket[20] = 7;
    break;
  case VS_CH_IMAGE:
    for (size_t i = 0; i < sizeof picture; i++) picture[i] = (uint8_t)(i * 7);
    m->as.image = (vs_msg_image){640, 480, "jpeg", sizeof picture, picture};
    break;
  case VS_CHANNELS: break;
  }
}

static uint8_t image_buffer[VS_BUS_IMAGE_MAX];

static bool no_lcm(void) {
  vs_error err = {0};
  if (vs_bus_supported(&err) == VS_OK) return false;
  print_message("note: %s\n", err.text);
  skip();
  return true;
}

static void every_message_survives_the_wire(void **state) {
  (void)state;
  if (no_lcm()) return;
  for (int c = 0; c < VS_CHANNELS; c++) {
    vs_message in, out;
    uint8_t bytes[VS_MESSAGE_MAX_BYTES];
    fill((vs_channel)c, &in);
    size_t size = vs_message_encode(&in, bytes, sizeof bytes);
    assert_true(size > 0);
    memset(&out, 0, sizeof out);
    assert_ok(vs_message_decode((vs_channel)c, bytes, size, &out, image_buffer, err));
    uint8_t again[VS_MESSAGE_MAX_BYTES];
    assert_int_equal(vs_message_encode(&out, again, sizeof again), size);
    assert_memory_equal(again, bytes, size);
    assert_int_equal(out.seq, 4711);
    assert_true(out.utime_us == 1700000000123456 && out.utime_capture_us == 1700000000100000);
  }
}

static void fields_keep_their_meaning(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_message in, out;
  uint8_t bytes[VS_MESSAGE_MAX_BYTES];
  fill(VS_CH_STATE, &in);
  size_t size = vs_message_encode(&in, bytes, sizeof bytes);
  assert_ok(vs_message_decode(VS_CH_STATE, bytes, size, &out, NULL, err));
  // fill counts in steps of 0.01 through eight numbers a robot: yellow 1 is the fifth, its numbers start at 0.34.
  const vs_robot *r = &out.as.world.world.robot[VS_YELLOW][1];
  assert_near(r->pose.x_m, 0.34, 1e-12);
  assert_near(r->pose.theta_rad, 0.36, 1e-12);
  assert_near(r->omega_radps, 0.39, 1e-12);
  assert_near(r->right_radps, 0.41, 1e-12);
  assert_false(r->valid);
  assert_near(out.as.world.world.ball.vz_mps, 1.3, 0);
  assert_int_equal(out.as.world.world.seq, 4711);
  assert_int_equal(out.as.world.game.score[VS_YELLOW], 4);
  assert_int_equal(out.as.world.game.last_event.kind, VS_EVENT_FREE_BALL);
  assert_int_equal(out.as.world.asks_team, VS_YELLOW);

  fill(VS_CH_CMD, &in);
  size = vs_message_encode(&in, bytes, sizeof bytes);
  assert_ok(vs_message_decode(VS_CH_CMD, bytes, size, &out, NULL, err));
  assert_near(out.as.cmd.wheels[2].right_radps, -6.0, 0);
  assert_true(out.as.cmd.stop && out.as.cmd.team == VS_YELLOW && out.as.cmd.state_seq == 99);
}

// Worlds and commands of five robots a team: types of their own on the same channels, every number in its place.
static void five_robots_a_team_have_types_of_their_own(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_message in, out;
  uint8_t bytes[VS_MESSAGE_MAX_BYTES], of_three[VS_MESSAGE_MAX_BYTES];
  fill(VS_CH_TRUTH, &in);
  size_t three = vs_message_encode(&in, of_three, sizeof of_three);
  vs_world *w = &in.as.world.world;
  w->division = VS_5V5;
  for (int i = 0; i < 10; i++)
    w->robot[i / 5][i % 5] = (vs_robot){{i, 10 + i, 0.1 * i}, 20 + i, 30 + i, 40 + i, 50 + i, 60 + i, i % 2};
  size_t size = vs_message_encode(&in, bytes, sizeof bytes);
  assert_int_equal(size, three + 4 * (8 * 8 + 1)); // four robots more of eight doubles and a flag
  assert_memory_not_equal(bytes, of_three, 8);     // another fingerprint
  memset(&out, 0xff, sizeof out);
  assert_ok(vs_message_decode(VS_CH_TRUTH, bytes, size, &out, NULL, err));
  assert_true(vs_world_hash(VS_HASH_START, &out.as.world.world) == vs_world_hash(VS_HASH_START, w));
  assert_int_equal(vs_message_decode(VS_CH_TRUTH, bytes, size - 1, &out, NULL, NULL), VS_FAIL);
  assert_int_equal(vs_message_decode(VS_CH_CMD, bytes, size, &out, NULL, NULL), VS_FAIL);
  memset(&out, 0xff, sizeof out);
  assert_ok(vs_message_decode(VS_CH_TRUTH, of_three, three, &out, NULL, err));
  assert_int_equal(out.as.world.world.division, VS_3V3);
  assert_true(out.as.world.world.robot[VS_BLUE][4].pose.x_m == 0 && !out.as.world.world.robot[VS_BLUE][4].valid);

  fill(VS_CH_CMD, &in);
  in.as.cmd.division = VS_5V5;
  in.as.cmd.wheels[4] = (vs_wheels){7, -8};
  size = vs_message_encode(&in, bytes, sizeof bytes);
  memset(&out, 0xff, sizeof out);
  assert_ok(vs_message_decode(VS_CH_CMD, bytes, size, &out, NULL, err));
  assert_true(out.as.cmd.division == VS_5V5 && out.as.cmd.wheels[4].right_radps == -8);
  assert_string_equal(out.as.cmd.source, "emc:?pid=1");
}

// Decodes the golden message of channel and encodes it again, to the same bytes.
static void golden(vs_channel channel, vs_message *out) {
  static char line[8192];
  char path[512], name[32];
  assert_ok(vs_path_find("tests/golden/bus_v1.txt", path, sizeof path, err));
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  int start = 0;
  do assert_non_null(fgets(line, sizeof line, file));
  while (sscanf(line, "%31s %n", name, &start) != 1 || strcmp(name, vs_channel_name(channel)) != 0);
  fclose(file);
  uint8_t bytes[4096], again[4096];
  size_t size = 0;
  for (unsigned value; sscanf(line + start + 2 * size, "%2x", &value) == 1; size++) bytes[size] = (uint8_t)value;
  assert_ok(vs_message_decode(channel, bytes, size, out, NULL, err));
  assert_int_equal(vs_message_encode(out, again, sizeof again), size);
  assert_memory_equal(again, bytes, size);
}

static void golden_messages_of_another_implementation_are_read_and_written(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_message m;
  golden(VS_CH_CMD, &m);
  assert_int_equal(m.as.cmd.team, VS_YELLOW);
  assert_near(m.as.cmd.wheels[1].left_radps, -3.0, 0);
  assert_near(m.as.cmd.wheels[2].right_radps, -6.0, 0);
  assert_string_equal(m.as.cmd.source, "emc:?pid=1");
  golden(VS_CH_REFEREE, &m);
  assert_int_equal(m.as.referee.event.kind, VS_EVENT_GOAL);
  assert_int_equal(m.as.referee.score[VS_YELLOW], 2);
  golden(VS_CH_STATE, &m);
  // Field n of robot i of team t is n + 100 t + 10 i + 0.5, in the order of vs_robot's fields.
  const vs_robot *r = &m.as.world.world.robot[VS_YELLOW][2];
  assert_near(r->pose.x_m, 120.5, 0);
  assert_near(r->pose.theta_rad, 122.5, 0);
  assert_near(r->omega_radps, 125.5, 0);
  assert_near(r->right_radps, 127.5, 0);
  assert_true(m.as.world.world.robot[VS_BLUE][2].valid && !r->valid);
  assert_near(m.as.world.world.ball.vz_mps, 3.5, 0);
  assert_int_equal(m.as.world.game.last_event.quadrant, 3);
  assert_near(m.as.world.game.last_event.time_s, 11.25, 0);
}

static void cut_or_lengthened_messages_are_refused(void **state) {
  (void)state;
  if (no_lcm()) return;
  for (int c = 0; c < VS_CHANNELS; c++) {
    vs_message in, out;
    uint8_t bytes[VS_MESSAGE_MAX_BYTES];
    fill((vs_channel)c, &in);
    size_t size = vs_message_encode(&in, bytes, sizeof bytes);
    for (size_t cut = 0; cut < size; cut++) {
      uint8_t *exact = malloc(cut + 1); // so that the address sanitizer sees a read beyond the cut
      memcpy(exact, bytes, cut);
      assert_int_equal(vs_message_decode((vs_channel)c, exact, cut, &out, image_buffer, NULL), VS_FAIL);
      free(exact);
    }
    bytes[size] = 0;
    assert_int_equal(vs_message_decode((vs_channel)c, bytes, size + 1, &out, image_buffer, NULL), VS_FAIL);
  }
}

// The generated decoders hand out texts as they stand in the message: one without its final zero would be read beyond it.
static void a_text_without_its_end_is_refused(void **state) {
  (void)state;
  if (no_lcm()) return;
  static const vs_channel last_is_text[] = {VS_CH_CMD, VS_CH_REFEREE, VS_CH_POLICY, VS_CH_RADIO, VS_CH_STATS};
  vs_message in, out;
  uint8_t bytes[VS_MESSAGE_MAX_BYTES];
  for (size_t i = 0; i < sizeof last_is_text / sizeof *last_is_text; i++) {
    fill(last_is_text[i], &in);
    size_t size = vs_message_encode(&in, bytes, sizeof bytes);
    assert_int_equal(bytes[size - 1], 0);
    bytes[size - 1] = 'x';
    vs_error err = {0};
    assert_int_equal(vs_message_decode(last_is_text[i], bytes, size, &out, NULL, &err), VS_FAIL);
    assert_non_null(strstr(err.text, "a damaged message of"));
  }
  // In the middle of a message: an image's bytes come after its format.
  fill(VS_CH_IMAGE, &in);
  size_t size = vs_message_encode(&in, bytes, sizeof bytes), length = strlen(in.as.image.format);
  uint8_t *format = memmem(bytes, size, in.as.image.format, length + 1);
  assert_non_null(format);
  format[length] = 'x';
  assert_int_equal(vs_message_decode(VS_CH_IMAGE, bytes, size, &out, image_buffer, NULL), VS_FAIL);
}

static void damaged_bytes_never_crash_the_decoder(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_rng rng = vs_rng_make(7, 0);
  int refused = 0;
  for (int round = 0; round < 20000; round++) {
    vs_channel c = (vs_channel)(round % VS_CHANNELS);
    vs_message in, out;
    uint8_t bytes[VS_MESSAGE_MAX_BYTES];
    fill(c, &in);
    size_t size = vs_message_encode(&in, bytes, sizeof bytes);
    for (int k = 0; k < 4; k++) bytes[8 + vs_rng_below(&rng, (uint32_t)size - 8)] = (uint8_t)vs_rng_u64(&rng);
    refused += vs_message_decode(c, bytes, size, &out, image_buffer, NULL) != VS_OK;
  }
  assert_true(refused > 0);
}

static void another_version_of_a_type_is_refused_by_name(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_message in, out;
  vs_error err = {0};
  uint8_t bytes[VS_MESSAGE_MAX_BYTES];
  fill(VS_CH_CMD, &in);
  size_t size = vs_message_encode(&in, bytes, sizeof bytes);
  bytes[3] ^= 1;
  assert_int_equal(vs_message_decode(VS_CH_CMD, bytes, size, &out, NULL, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "VSSS_CMD"));
  assert_non_null(strstr(err.text, "another version"));
}

typedef struct heard {
  int count, raw;
  vs_message last;
} heard;

static void hear(const vs_message *m, void *user) {
  heard *h = user;
  h->count++;
  h->last = *m;
}

static void hear_raw(const char *channel, const uint8_t *data, size_t size, int64_t utime_us, void *user) {
  (void)data, (void)size, (void)utime_us;
  heard *h = user;
  if (!strncmp(channel, "VSSS_", 5) || !strcmp(channel, "OTHER")) h->raw++;
}

static void published_messages_reach_their_channel_only(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_bus *bus;
  heard cmd = {0}, all = {0}, raw = {0};
  assert_ok(vs_bus_open("memq://", &bus, err));
  assert_ok(vs_bus_subscribe(bus, VS_CH_CMD, false, hear, &cmd, err));
  assert_ok(vs_bus_subscribe(bus, VS_CHANNELS, false, hear, &all, err));
  assert_ok(vs_bus_subscribe_raw(bus, NULL, hear_raw, &raw, err));
  vs_message m;
  for (int c = 0; c < VS_CHANNELS; c++) {
    fill((vs_channel)c, &m);
    assert_ok(vs_bus_publish(bus, &m, err));
  }
  assert_ok(vs_bus_publish_raw(bus, "OTHER", (const uint8_t *)"x", 1, err));
  assert_ok(vs_bus_publish_raw(bus, "VSSS_CMD", (const uint8_t *)"no command", 10, err));
  for (int left = 50; left; left--) assert_ok(vs_bus_handle(bus, 10, NULL, err));
  assert_int_equal(cmd.count, 1);
  assert_int_equal(all.count, VS_CHANNELS);
  assert_int_equal(raw.raw, VS_CHANNELS + 2);
  assert_int_equal(vs_bus_refused(bus), 2); // one damaged message, heard by two subscriptions
  assert_string_equal(cmd.last.as.cmd.source, "emc:?pid=1");
  vs_bus_close(bus);
}

static void publishing_stamps_the_wall_clock(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_bus *bus;
  assert_ok(vs_bus_open("memq://", &bus, err));
  vs_message m;
  fill(VS_CH_CMD, &m);
  m.utime_us = 0;
  assert_ok(vs_bus_publish(bus, &m, err));
  assert_true(m.utime_us > 1600000000000000); // 2020
  vs_bus_close(bus);
}

static void oversized_image_is_not_published(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_bus *bus;
  assert_ok(vs_bus_open("memq://", &bus, err));
  vs_message m;
  fill(VS_CH_IMAGE, &m);
  m.as.image.size = VS_BUS_IMAGE_MAX + 1;
  assert_int_equal(vs_bus_publish(bus, &m, NULL), VS_FAIL);
  vs_bus_close(bus);
}

static void wrong_urls_are_usage_errors_that_show_a_right_one(void **state) {
  (void)state;
  const char *const wrong[] = {"",
                               "tcpq://x",
                               "udpm://",
                               "udpm://10.0.0.1:7667",
                               "udpm://239.255.76.67",
                               "udpm://239.255.76.67:0",
                               "udpm://239.255.76.67:70000",
                               "udpm://239.255.76.67:7667x",
                               "udpm://239.255.76.67:7667?tl=0",
                               "udpm://239.255.76.67:7667?ttl",
                               "file://",
                               "file://x?mood=w"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vs_bus *bus;
    vs_error err = {0};
    if (vs_bus_open(wrong[i], &bus, &err) != VS_USAGE) fail_msg("'%s' was not refused as usage", wrong[i]);
    assert_non_null(strstr(err.text, wrong[i]));
    assert_null(bus);
  }
}

static void missing_log_folder_is_named(void **state) {
  (void)state;
  if (no_lcm()) return;
  vs_bus *bus;
  vs_error err = {0};
  assert_int_equal(vs_bus_open("file:///nowhere/at/all.log?mode=w", &bus, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/at/all.log"));
}

static void channel_names_are_read_in_any_spelling(void **state) {
  (void)state;
  vs_channel c;
  assert_true(vs_channel_parse("VSSS_STATE", &c) && c == VS_CH_STATE);
  assert_true(vs_channel_parse("referee", &c) && c == VS_CH_REFEREE);
  assert_false(vs_channel_parse("VSSS_", &c));
  assert_false(vs_channel_parse("STATES", &c));
}

static void default_url_comes_from_the_environment(void **state) {
  (void)state;
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  assert_string_equal(vs_bus_default_url(), "memq://");
  unsetenv("LCM_DEFAULT_URL");
  assert_string_equal(vs_bus_default_url(), VS_BUS_DEFAULT_URL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_message_survives_the_wire),
      cmocka_unit_test(fields_keep_their_meaning),
      cmocka_unit_test(five_robots_a_team_have_types_of_their_own),
      cmocka_unit_test(golden_messages_of_another_implementation_are_read_and_written),
      cmocka_unit_test(cut_or_lengthened_messages_are_refused),
      cmocka_unit_test(a_text_without_its_end_is_refused),
      cmocka_unit_test(damaged_bytes_never_crash_the_decoder),
      cmocka_unit_test(another_version_of_a_type_is_refused_by_name),
      cmocka_unit_test(published_messages_reach_their_channel_only),
      cmocka_unit_test(publishing_stamps_the_wall_clock),
      cmocka_unit_test(oversized_image_is_not_published),
      cmocka_unit_test(wrong_urls_are_usage_errors_that_show_a_right_one),
      cmocka_unit_test(missing_log_folder_is_named),
      cmocka_unit_test(channel_names_are_read_in_any_spelling),
      cmocka_unit_test(default_url_comes_from_the_environment),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
