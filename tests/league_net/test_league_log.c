// Tests src/league_net/league_log.c: the bytes of the referee's recorder, there and back.
#include "vsss/league_log.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "test_folder.h"

static const char *path_of(const char *name) {
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

// Big-endian: int64 time in ms, uint32 kind, uint32 size, the bytes.
static const uint8_t two[] = {0, 0, 1, 0x93, 0x6f, 0x0e, 0x12, 0x34, 0, 0, 0, 1, 0, 0, 0, 2, 0xaa, 0xbb, //
                              0, 0, 1, 0x93, 0x6f, 0x0e, 0x12, 0x44, 0, 0, 0, 0, 0, 0, 0, 0};
#define FIRST_MS INT64_C(0x1936f0e1234)

static void what_is_written_is_the_recorders_format(void **state) {
  (void)state;
  vs_league_log *log = NULL;
  assert_ok(vs_league_log_create(path_of("written"), &log, err));
  vs_league_log_put(log, FIRST_MS, VS_LEAGUE_VISION, (const uint8_t *)"\xaa\xbb", 2);
  vs_league_log_put(log, FIRST_MS + 16, VS_LEAGUE_REFEREE, NULL, 0); // all fields zero: a free kick of blue
  assert_ok(vs_league_log_close(log, err));
  uint8_t bytes[64];
  FILE *f = fopen(path_of("written"), "rb");
  assert_int_equal(fread(bytes, 1, sizeof bytes, f), sizeof two);
  fclose(f);
  assert_memory_equal(bytes, two, sizeof two);
}

static vs_league_log *log_of(const uint8_t *bytes, size_t size) {
  vs_league_log *log = NULL;
  FILE *f = fopen(path_of("given"), "wb");
  fwrite(bytes, 1, size, f);
  fclose(f);
  assert_ok(vs_league_log_open(path_of("given"), &log, err));
  return log;
}

static void entries_are_read_until_the_end(void **state) {
  (void)state;
  vs_league_log *log = log_of(two, sizeof two);
  vs_league_entry e;
  bool end = true;
  assert_ok(vs_league_log_next(log, &e, &end, err));
  assert_false(end);
  assert_true(e.time_ms == FIRST_MS);
  assert_int_equal(e.kind, VS_LEAGUE_VISION);
  assert_int_equal(e.size, 2);
  assert_memory_equal(e.data, "\xaa\xbb", 2);
  assert_ok(vs_league_log_next(log, &e, &end, err));
  assert_true(!end && e.kind == VS_LEAGUE_REFEREE && e.size == 0 && e.time_ms == FIRST_MS + 16);
  assert_ok(vs_league_log_next(log, &e, &end, err));
  assert_true(end);
  assert_ok(vs_league_log_close(log, err));
}

static void every_cut_and_foreign_bytes_are_refused_with_their_place(void **state) {
  (void)state;
  for (size_t size = 1; size < sizeof two; size++) {
    vs_league_log *log = log_of(two, size);
    vs_league_entry e;
    bool end = false;
    vs_error err = {0};
    vs_status s = vs_league_log_next(log, &e, &end, &err);
    if (s == VS_OK) s = vs_league_log_next(log, &e, &end, &err);
    if (size == 18) {
      assert_true(s == VS_OK && end);
    } else {
      assert_int_equal(s, VS_FAIL);
      assert_non_null(strstr(err.text, size < 18 ? "cut at byte 0" : "cut at byte 18"));
    }
    vs_league_log_close(log, NULL);
  }
  for (int where = 11; where <= 12; where++) { // another kind; four billion bytes
    uint8_t bytes[sizeof two];
    memcpy(bytes, two, sizeof two);
    bytes[where] = 0xff;
    vs_league_log *log = log_of(bytes, sizeof bytes);
    vs_league_entry e;
    bool end;
    vs_error err = {0};
    assert_int_equal(vs_league_log_next(log, &e, &end, &err), VS_FAIL);
    assert_non_null(strstr(err.text, "byte 0 is no entry"));
    vs_league_log_close(log, NULL);
  }
}

static void a_file_that_cannot_be_is_named(void **state) {
  (void)state;
  vs_league_log *log = NULL;
  vs_error err = {0};
  assert_int_equal(vs_league_log_open(path_of("none"), &log, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "none"));
  assert_ok(vs_league_log_create("/dev/full", &log, err));
  vs_league_log_put(log, 0, VS_LEAGUE_VISION, (const uint8_t *)"a", 1);
  assert_int_equal(vs_league_log_close(log, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/full"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_written_is_the_recorders_format),
      cmocka_unit_test(entries_are_read_until_the_end),
      cmocka_unit_test(every_cut_and_foreign_bytes_are_refused_with_their_place),
      cmocka_unit_test(a_file_that_cannot_be_is_named),
  };
  return cmocka_run_group_tests_name("league_net/league_log", tests, make_folder, remove_folder);
}
