// Tests src/cli/cmd_replay.c, replay_scan.c, replay_video.c, message_text.c, message_json.c and src/comms/bus_log.c
// through the real binary, on logs that LCM itself wrote.
#include "assert_near.h"
#include "run_vsss.h"
#include "vsss/bus.h"
#include "vsss/bus_log.h"

static char path[64];
static long log_size;
enum { WORLDS = 31 };

static void add_event(vs_bus *bus, vs_event_kind kind, vs_team team, double time_s, int blue, int yellow) {
  vs_message m = {.channel = VS_CH_REFEREE};
  m.as.referee = (vs_msg_referee){{kind, team, kind == VS_EVENT_FREE_BALL ? 2 : 0, time_s}, 120.0, {blue, yellow}};
  assert_ok(vs_bus_publish(bus, &m, err));
}

static void add_world(vs_bus *bus, int i) {
  vs_message m = {.channel = VS_CH_TRUTH, .seq = i};
  vs_world *w = &m.as.world.world;
  w->time_us = i * 33333;
  w->seq = (uint32_t)i;
  w->ball = (vs_ball){.x_m = 0.01 * i, .z_m = 0.021, .valid = true};
  for (int t = 0; t < VS_TEAMS; t++)
    for (int r = 0; r < VS_TEAM_SIZE; r++)
      w->robot[t][r] = (vs_robot){.pose = {(t ? 0.3 : -0.3), -0.3 + 0.3 * r, 0.1 * i}, .valid = true};
  m.as.world.game = (vs_game){.time_s = i / 30.0, .duration_s = 120.0, .score = {2, 1}};
  m.as.world.asks_team = -1;
  assert_ok(vs_bus_publish(bus, &m, err));
}

// A log of 31 worlds (one second), 4 events, 2 commands, and one message of somebody else.
static int write_log(void **state) {
  (void)state;
  snprintf(path, sizeof path, "/tmp/vsss_test_replay_%ld.log", (long)getpid());
  unlink(path);
  char url[128];
  snprintf(url, sizeof url, "file://%s?mode=w", path);
  vs_bus *bus;
  vs_error why = {0};
  if (vs_bus_open(url, &bus, &why) != VS_OK) {
    printf("note: %s\n", why.text);
    exit(0);
  }
  add_event(bus, VS_EVENT_KICK_OFF, VS_BLUE, 0.0, 0, 0);
  for (int i = 0; i < WORLDS; i++) add_world(bus, i);
  add_event(bus, VS_EVENT_GOAL, VS_YELLOW, 12.5, 0, 1);
  add_event(bus, VS_EVENT_FREE_BALL, VS_BLUE, 63.04, 2, 1);
  vs_message m = {.channel = VS_CH_CMD};
  m.as.cmd = (vs_msg_cmd){VS_BLUE, {{1, 2}, {3, 4}, {5, -6.5}}, false, 7, "emc:", VS_3V3};
  assert_ok(vs_bus_publish(bus, &m, err));
  m.as.cmd = (vs_msg_cmd){VS_YELLOW, {{0, 0}}, true, -1, "onnx:\"odd\".onnx", VS_3V3};
  assert_ok(vs_bus_publish(bus, &m, err));
  assert_ok(vs_bus_publish_raw(bus, "CAMERA_OF_OTHERS", (const uint8_t *)"abc", 3, err));
  add_event(bus, VS_EVENT_END, VS_BLUE, 120.0, 2, 1);
  vs_bus_close(bus);
  FILE *f = fopen(path, "rb");
  fseek(f, 0, SEEK_END);
  log_size = ftell(f);
  fclose(f);
  return 0;
}

static int remove_log(void **state) {
  (void)state;
  return unlink(path);
}

static const char *call(const char *flags) {
  static char text[256];
  snprintf(text, sizeof text, "replay %s %s", path, flags);
  return text;
}

static vsss_run run;

static void events_score_and_channels_are_shown(void **state) {
  (void)state;
  vsss(&run, call(""));
  assert_int_equal(run.status, 0);
  assert_string_equal(run.err, "");
  assert_non_null(strstr(run.out, "  0:00.0   0 : 0   kick-off for blue\n"));
  assert_non_null(strstr(run.out, "  0:12.5   0 : 1   goal by yellow\n"));
  assert_non_null(strstr(run.out, "  1:03.0   2 : 1   free ball in quadrant 2\n"));
  assert_non_null(strstr(run.out, "blue emc: 2 : 1 onnx:\"odd\".onnx yellow after 120.0 s\n"));
  assert_non_null(strstr(run.out, ": 38 messages"));
  assert_non_null(strstr(run.out, "VSSS_TRUTH                   31 "));
  assert_non_null(strstr(run.out, "CAMERA_OF_OTHERS              1 "));
}

static void one_channel_shows_every_message_of_it(void **state) {
  (void)state;
  vsss(&run, call("--channel cmd"));
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "VSSS_CMD         blue emc:  +1.0 +2.0  +3.0 +4.0  +5.0 -6.5 rad/s\n"));
  assert_non_null(strstr(run.out, "onnx:\"odd\".onnx  STOP"));
  assert_null(strstr(run.out, "goal by"));
  vsss(&run, call("--channel CAMERA_OF_OTHERS"));
  assert_non_null(strstr(run.out, "CAMERA_OF_OTHERS  3 bytes\n"));
}

static void json_is_one_object_per_line(void **state) {
  (void)state;
  vsss(&run, call("--json --channel VSSS_CMD --channel truth"));
  assert_int_equal(run.status, 0);
  int lines = 0;
  char summary[256];
  snprintf(summary, sizeof summary, "{\"summary\": {\"log\": \"%s\", \"messages\": 38, ", path);
  assert_non_null(strstr(run.out, summary));
  for (char *line = strtok(run.out, "\n"); line; line = strtok(NULL, "\n")) {
    assert_int_equal(line[0], '{');
    assert_int_equal(line[strlen(line) - 1], '}');
    if (strstr(line, "\"seq\": 30, ")) {
      assert_non_null(strstr(line, "\"channel\": \"VSSS_TRUTH\""));
      assert_non_null(strstr(line, "\"time_us\": 999990, \"ball\": {\"valid\": true, \"x_m\": 0.3, "));
    }
    if (strstr(line, "odd")) assert_non_null(strstr(line, "\"source\": \"onnx:\\\"odd\\\".onnx\", \"stop\": true"));
    lines++;
  }
  assert_int_equal(lines, WORLDS + 2 + 1);
}

static void a_cut_log_is_shown_up_to_the_cut_and_named(void **state) {
  (void)state;
  char cut[128], text[256];
  snprintf(cut, sizeof cut, "%s.cut", path);
  snprintf(text, sizeof text, "head -c %ld %s > %s", log_size - 10, path, cut);
  assert_int_equal(system(text), 0);
  snprintf(text, sizeof text, "replay %s", cut);
  vsss(&run, text);
  assert_int_equal(run.status, 1);
  assert_non_null(strstr(run.out, "goal by yellow"));
  assert_non_null(strstr(run.out, ": 37 messages"));
  assert_non_null(strstr(run.err, "cut off in event 37"));
  assert_non_null(strstr(run.err, cut));
  unlink(cut);
}

static void damaged_bytes_are_an_error_with_their_place(void **state) {
  (void)state;
  char bad[128], text[512];
  snprintf(bad, sizeof bad, "%s.bad", path);
  // The second event starts behind the first: a head of 28 bytes, "VSSS_REFEREE", and its data. Its magic is hit.
  vs_bus_log *log;
  vs_log_event event;
  bool end;
  assert_ok(vs_bus_log_open(path, &log, err));
  assert_ok(vs_bus_log_next(log, &event, &end, err));
  size_t second = 28 + strlen(event.channel) + event.size;
  vs_bus_log_close(log);
  snprintf(text, sizeof text, "cp %s %s && printf X | dd of=%s bs=1 seek=%zu conv=notrunc 2>/dev/null", path, bad, bad,
           second);
  assert_int_equal(system(text), 0);
  snprintf(text, sizeof text, "replay %s", bad);
  vsss(&run, text);
  assert_int_equal(run.status, 1);
  char place[64];
  snprintf(place, sizeof place, "damaged at byte %zu", second);
  assert_non_null(strstr(run.err, place));
  unlink(bad);
}

static void every_cut_ends_in_an_error_and_never_in_a_crash(void **state) {
  (void)state;
  static char whole[1 << 20];
  FILE *f = fopen(path, "rb");
  size_t size = fread(whole, 1, sizeof whole, f);
  fclose(f);
  assert_int_equal(size, log_size);
  char cut[128];
  snprintf(cut, sizeof cut, "%s.cut", path);
  for (size_t n = 1; n < size; n += n < 2000 ? 1 : 997) {
    f = fopen(cut, "wb");
    fwrite(whole, 1, n, f);
    fclose(f);
    vs_bus_log *log;
    if (vs_bus_log_open(cut, &log, NULL) != VS_OK) continue;
    bool end = false;
    vs_status s = VS_OK;
    int events = 0;
    for (vs_log_event event; s == VS_OK && !end; events++) s = vs_bus_log_next(log, &event, &end, NULL);
    assert_true(events <= 38);
    vs_bus_log_close(log);
  }
  unlink(cut);
}

static void files_that_are_no_logs_are_refused(void **state) {
  (void)state;
  assert_refused("replay /no/such.log", 1, "/no/such.log: No such file");
  assert_refused("replay /dev/null", 1, "/dev/null: not a file");
  char other[128], text[256];
  snprintf(other, sizeof other, "%s.txt", path);
  FILE *f = fopen(other, "w");
  snprintf(text, sizeof text, "replay %s", other);
  assert_refused(text, 1, "empty");
  fputs("no log at all\n", f);
  fclose(f);
  assert_refused(text, 1, "not a log of LCM");
  unlink(other);
}

static void wrong_calls_are_usage_errors(void **state) {
  (void)state;
  assert_refused("replay", 2, "expected one log file");
  assert_refused(call("--speed 0"), 2, "--speed 0: allowed are 0.01 to 1000");
  assert_refused(call("--video x.mp4 --publish"), 2, "choose one");
  assert_refused(call("--publish --lcm tcp://x"), 2, "tcp://x");
  assert_refused(call("--channel VSSS_IMAGE"), 1, "no messages of channel VSSS_IMAGE");
}

static void sending_again_gives_the_same_messages(void **state) {
  (void)state;
  char copy[128], text[256];
  snprintf(copy, sizeof copy, "%s.copy", path);
  snprintf(text, sizeof text, "--publish --speed 1000 --channel cmd --channel referee --lcm 'file://%s?mode=w'", copy);
  vsss(&run, call(text));
  assert_int_equal(run.status, 0);
  assert_non_null(strstr(run.out, "6 messages sent"));
  vs_bus_log *a, *b;
  assert_ok(vs_bus_log_open(path, &a, err));
  assert_ok(vs_bus_log_open(copy, &b, err));
  vs_log_event x, y;
  bool end = false;
  int same = 0;
  for (;;) {
    assert_ok(vs_bus_log_next(b, &y, &end, err));
    if (end) break;
    do assert_ok(vs_bus_log_next(a, &x, &end, err));
    while (strcmp(x.channel, "VSSS_CMD") != 0 && strcmp(x.channel, "VSSS_REFEREE") != 0);
    assert_string_equal(x.channel, y.channel);
    assert_int_equal(x.size, y.size);
    assert_memory_equal(x.data, y.data, x.size);
    same++;
  }
  assert_int_equal(same, 6);
  vs_bus_log_close(a);
  vs_bus_log_close(b);
  unlink(copy);
}

static void a_second_of_worlds_becomes_a_second_of_video(void **state) {
  (void)state;
  char video[128], text[256];
  snprintf(video, sizeof video, "%s.mp4", path);
  snprintf(text, sizeof text, "--video %s --fps 4", video);
  vsss(&run, call(text));
  if (run.status == 1 && strstr(run.err, "install")) {
    printf("note: %s", run.err);
    skip();
  }
  if (run.status != 0) fail_msg("status %d: %s", run.status, run.err);
  // The worlds span 0 to 999990 us: pictures at 0, 0.25, 0.5 and 0.75 s.
  assert_non_null(strstr(run.out, ": 4 pictures, 1.0 s"));
  FILE *f = fopen(video, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  assert_true(ftell(f) > 1000);
  fclose(f);
  unlink(video);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(events_score_and_channels_are_shown),
      cmocka_unit_test(one_channel_shows_every_message_of_it),
      cmocka_unit_test(json_is_one_object_per_line),
      cmocka_unit_test(a_cut_log_is_shown_up_to_the_cut_and_named),
      cmocka_unit_test(damaged_bytes_are_an_error_with_their_place),
      cmocka_unit_test(every_cut_ends_in_an_error_and_never_in_a_crash),
      cmocka_unit_test(files_that_are_no_logs_are_refused),
      cmocka_unit_test(wrong_calls_are_usage_errors),
      cmocka_unit_test(sending_again_gives_the_same_messages),
      cmocka_unit_test(a_second_of_worlds_becomes_a_second_of_video),
  };
  return cmocka_run_group_tests_name("cli/replay", tests, write_log, remove_log);
}
