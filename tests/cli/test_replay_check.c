// src/cli/replay_check.c, src/field/record.c, src/comms/tick.c and src/policy/player_rerun.c through the real binary: a run
// with faults in it is recorded and computed again; a record that was changed in one number is found out.
#include <fcntl.h>
#include <sys/stat.h>

#include "cli/command_log.h"
#include "cli/field_venue.h"
#include "cli_bus.h"
#include "policy/plugins/compile.h"
#include "vsss/bus_log.h"
#include "vsss/safety.h"
#include "vsss/tick.h"

static char record[96], changed[96];
static int words = -1;

static void say(const char *word) { assert_int_equal(write(words, word, strlen(word)), (ssize_t)strlen(word)); }

static void assert_same(const char *path) {
  static vsss_run run;
  char arguments[160];
  snprintf(arguments, sizeof arguments, "replay %s --check", path);
  vsss(&run, arguments);
  if (run.status != 0 || !strstr(run.out, "the same commands, bit for bit"))
    fail_msg("%d: %s%s", run.status, run.out, run.err);
  print_message("%s", run.out);
}

static void assert_differs(const char *text) {
  char arguments[160];
  snprintf(arguments, sizeof arguments, "replay %s --check", changed);
  assert_refused(arguments, 1, text);
}

// What the copy shall have different.
typedef struct change {
  int turn;                       // of VSSS_TICK; -1: none
  void (*edit)(vs_tick *tick);    // NULL: the turn is left out
  const char *channel, *was, *is; // in this text; NULL: none
} change;

static void copy_with(const change *c) {
  vs_bus_log *log;
  vs_bus *out;
  char url[160];
  snprintf(url, sizeof url, "file://%s?mode=w", changed);
  assert_ok(vs_bus_log_open(record, &log, err));
  assert_ok(vs_bus_open(url, &out, err));
  for (bool end = false;;) {
    static uint8_t bytes[VS_MESSAGE_MAX_BYTES];
    static vs_tick tick;
    vs_log_event event;
    assert_ok(vs_bus_log_next(log, &event, &end, err));
    if (end) break;
    size_t size = event.size;
    memcpy(bytes, event.data, size);
    if (!strcmp(event.channel, VS_TICK_CHANNEL) && vs_tick_decode(bytes, size, &tick, NULL) == VS_OK &&
        tick.seq == c->turn) {
      if (!c->edit) continue;
      c->edit(&tick);
      size = vs_tick_encode(&tick, 1, 1, bytes, sizeof bytes);
      assert_true(size > 0);
    }
    if (c->channel && !strcmp(event.channel, c->channel)) {
      bytes[size] = '\0';
      char *at = strstr((char *)bytes, c->was);
      if (!at) fail_msg("%s has no '%s': %s", c->channel, c->was, (char *)bytes);
      memcpy(at, c->is, strlen(c->is)); // of the same length
    }
    assert_ok(vs_bus_publish_raw(out, event.channel, bytes, size, err));
  }
  vs_bus_close(out);
  vs_bus_log_close(log);
}

static void a_bit_of_a_command(vs_tick *t) { t->wheels[1].left_radps = nextafter(t->wheels[1].left_radps, 100); }
static void a_nanometre_of_a_tag(vs_tick *t) { t->tag[0].corner_px[2][1] += 1e-7; }
static void another_state(vs_tick *t) { t->safety = VS_SAFETY_HALTED; }
static void a_player_that_failed(vs_tick *t) { t->player_failed = true; }
static void a_minute_later(vs_tick *t) {
  for (int i = 0; i < t->n_clock; i++) t->clock_us[i] += 60000000;
}

static void a_run_with_faults_is_computed_again_and_a_changed_one_found_out(void **state) {
  (void)state;
  if (vs_bus_supported(NULL) != VS_OK || too_slow_for_real_time()) skip();
  char pipe[96], flags[400];
  snprintf(pipe, sizeof pipe, "%s/words", folder);
  snprintf(record, sizeof record, "%s/record.lcm", folder);
  snprintf(changed, sizeof changed, "%s/changed.lcm", folder);
  assert_int_equal(mkfifo(pipe, 0600), 0);
  words = open(pipe, O_RDWR | O_CLOEXEC);
  snprintf(flags, sizeof flags, "--policy 'plugin:%s/bad.so?late=segv' --referee %s --record %s", folder, pipe, record);
  venue *v = open_venue(folder, flags);
  live_for(v, 0.3);
  say("go\n");
  wait_until(v, true);
  v->drop = 0.3; // of the pictures: the prediction stands in
  live_for(v, 0.5);
  say("stop\n");
  wait_until(v, false);
  live_for(v, 0.2);
  say("go\n");
  wait_until(v, true);
  wait_until(v, false); // the player crashes at its thirtieth step
  wait_until(v, true);
  unplug_camera(v);
  wait_until(v, false);
  live_for(v, 0.3);
  plug_camera(v);
  wait_until(v, true);
  close_venue(v, 0);
  assert_same(record);

  copy_with(&(change){.turn = -1});
  assert_same(changed);
  static const struct {
    change change;
    const char *said;
  } cases[] = {
      {{20, a_bit_of_a_command, NULL, NULL, NULL}, "turn 20, "},
      {{5, a_nanometre_of_a_tag, NULL, NULL, NULL}, "the tracked world differs"},
      {{20, another_state, NULL, NULL, NULL}, "safety was 'halted', now "},
      {{20, a_minute_later, NULL, NULL, NULL}, "turn 20, "},
      {{20, NULL, NULL, NULL, NULL}, "turn 20 is missing"},
      {{-1, NULL, VS_CONFIG_CHANNEL, "tag_height_m = 0.08 ", "tag_height_m = 0.09 "}, "the tracked world differs"},
      {{-1, NULL, VS_SETUP_CHANNEL, "version = 1", "version = 2"}, "version"},
      {{-1, NULL, VS_SETUP_CHANNEL, "team = blue", "team = grey"}, "grey"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    copy_with(&cases[i].change);
    assert_differs(cases[i].said);
  }
  copy_with(&(change){40, a_player_that_failed, NULL, NULL, NULL});
  char arguments[160];
  snprintf(arguments, sizeof arguments, "replay %s --check", changed);
  assert_refused(arguments, 1, "turn 4"); // at that turn, or with the next answer of one that was started anew
  // The player's file is another one now.
  char command[256];
  snprintf(command, sizeof command, "cp '%s/bad.so' '%s/kept.so' && printf x >> '%s/bad.so'", folder, folder, folder);
  assert_int_equal(system(command), 0);
  snprintf(arguments, sizeof arguments, "replay %s --check", record);
  assert_refused(arguments, 1, "has changed");
  close(words);
}

static void what_a_referee_says_is_in_the_record_and_the_key_is_not(void **state) {
  (void)state;
  vs_bus *bus = test_bus_open();
  if (!bus) skip();
  char config[96], arguments[600];
  snprintf(record, sizeof record, "%s/heard.lcm", folder);
  snprintf(config, sizeof config, "%s/field.ini", folder);
  FILE *f = fopen(config, "w");
  fprintf(f, "[radio]\nteam_id = 3\nkey = 0123456789abcdef0123456789abcdef\n");
  fclose(f);
  snprintf(arguments, sizeof arguments, "--lcm %s --referee lcm --config %s --policy emc: --record %s", test_bus_url(),
           config, record);
  venue *v = open_venue(folder, arguments);
  for (int i = 0; i < 3000; i++) {
    live(v);
    if (i % 500 != 499) continue;
    vs_message m = {.channel = VS_CH_REFEREE};
    m.as.referee =
        (vs_msg_referee){.event = {i < 2000 ? VS_EVENT_KICK_OFF : VS_EVENT_HALT, VS_BLUE, 0, 1}, .duration_s = 60};
    assert_ok(vs_bus_publish(bus, &m, err));
  }
  close_venue(v, 0);
  vs_bus_close(bus);
  assert_true(number_after(read_text(v->log_path), "referee spoke ") >= 3);
  assert_same(record);
  char command[160];
  snprintf(command, sizeof command, "grep -q 0123456789abcdef '%s'", record);
  assert_int_not_equal(system(command), 0);
}

static void what_is_no_record_is_named(void **state) {
  (void)state;
  if (vs_bus_supported(NULL) != VS_OK) skip();
  char path[96], arguments[160];
  snprintf(path, sizeof path, "%s/other.lcm", folder);
  write_log_of_a_command(path);
  snprintf(arguments, sizeof arguments, "replay %s --check", path);
  assert_refused(arguments, 1, "holds no VSSS_SETUP: not a record of 'vsss field --record'");
  snprintf(arguments, sizeof arguments, "replay %s --check --publish", path);
  assert_refused(arguments, 2, "--video, --mcap, --publish, --check: choose one");
}

int main(void) {
  vs_camera_register(vs_frame_stream_camera());
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_run_with_faults_is_computed_again_and_a_changed_one_found_out),
      cmocka_unit_test(what_a_referee_says_is_in_the_record_and_the_key_is_not),
      cmocka_unit_test(what_is_no_record_is_named),
  };
  return cmocka_run_group_tests_name("cli/replay_check", tests, make_folder, remove_folder);
}
