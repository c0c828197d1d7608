// src/cli/message_text.c and src/cli/replay_scan.c: what came from elsewhere is shown, never obeyed.
#include <endian.h>

#include "assert_near.h"
#include "cli/message_text.h"
#include "run_vsss.h"
#include "test_folder.h"

static void control_characters_are_replaced_and_others_stay(void **state) {
  (void)state;
  static const char *const rows[][2] = {
      {"plain", "plain"},
      {"\033[2J\007\b", "?[2J??"},
      {"a\tb\nc\x7f", "a?b?c?"},
      {"Jo\xc3\xa3o \xe2\x9c\x93 \xc3\x9f",
       "Jo\xc3\xa3o \xe2\x9c\x93 \xc3\x9f"}, // UTF-8, with bytes of 0x80 to 0x9f in it
      {"\x9b"
       "2J",
       "?2J"},
      {"x\xc2\x9b"
       "2J",
       "x??2J"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char text[64];
    snprintf(text, sizeof text, "%s", rows[i][0]);
    vs_text_clean(text);
    assert_string_equal(text, rows[i][1]);
  }
}

static void put_event(FILE *f, int64_t number, int64_t utime_us, const char *channel) {
  uint32_t sync = htobe32(0xEDA1DA01), channel_size = htobe32((uint32_t)strlen(channel)), size = htobe32(4);
  int64_t at[2] = {(int64_t)htobe64((uint64_t)number), (int64_t)htobe64((uint64_t)utime_us)};
  fwrite(&sync, 4, 1, f), fwrite(at, 8, 2, f), fwrite(&channel_size, 4, 1, f), fwrite(&size, 4, 1, f);
  fwrite(channel, 1, strlen(channel), f), fwrite("data", 1, 4, f);
}

// The undefined-behaviour sanitizer sees a difference that overflows.
static void a_log_with_odd_time_stamps_and_names_is_shown(void **state) {
  (void)state;
  static vsss_run run;
  char path[128], arguments[256];
  snprintf(path, sizeof path, "%s/log", folder);
  FILE *f = fopen(path, "wb");
  put_event(f, 0, INT64_MIN, "\033[31mEVIL");
  put_event(f, 1, INT64_MAX, "\033[31mEVIL");
  put_event(f, 2, 0, "OTHER\xc2\x9b");
  fclose(f);
  static const char *const forms[] = {"replay %s", "replay %s --channel OTHER --channel EVIL", "replay %s --json"};
  for (int i = 0; i < 3; i++) {
    snprintf(arguments, sizeof arguments, forms[i], path);
    vsss(&run, arguments);
    if (strchr(run.out, '\033') || strstr(run.out, "\xc2\x9b") || strchr(run.err, '\033'))
      fail_msg("%s: an escape sequence came through", arguments);
  }
  assert_non_null(strstr(run.out, "EVIL"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(control_characters_are_replaced_and_others_stay),
      cmocka_unit_test(a_log_with_odd_time_stamps_and_names_is_shown),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
