// Tests src/learn/tensorboard.c, src/learn/wire.c and src/learn/journal.c
#define _GNU_SOURCE // memmem
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assert_near.h"
#include "learn/tensorboard.h"
#include "vsss/journal.h"

// RFC 3720, B.4: 32 bytes of zeros, 32 bytes of ones; and the check value of "123456789".
static void crc32c_agrees_with_the_published_values(void **state) {
  (void)state;
  uint8_t zeros[32] = {0}, ones[32];
  memset(ones, 0xff, sizeof ones);
  assert_int_equal(vs_crc32c(zeros, 32), 0x8a9136aa);
  assert_int_equal(vs_crc32c(ones, 32), 0x62a8ab43);
  assert_int_equal(vs_crc32c("123456789", 9), 0xe3069283);
}

// 300 = 0b10'0101100 -> ac 02 (protocol buffers' own example); field 1, type 0 -> key 08; field 2, type 2 -> key 12.
static void the_wire_format_agrees_with_hand_values(void **state) {
  (void)state;
  vs_bytes out = {0}, inner = {0};
  vs_wire_int(&out, 1, 300);
  vs_wire_text(&inner, 2, "ab");
  vs_wire_message(&out, 3, &inner);
  vs_wire_float(&out, 4, 1.0f); // key 25, 00 00 80 3f
  vs_wire_double(&out, 5, 1.0); // key 29, 00 .. f0 3f
  vs_wire_int(&out, 16, -1);    // key 80 01, ten bytes of varint
  const uint8_t expected[] = {0x08, 0xac, 0x02, 0x1a, 0x04, 0x12, 0x02, 'a',  'b',  0x25, 0,    0,
                              0x80, 0x3f, 0x29, 0,    0,    0,    0,    0,    0,    0xf0, 0x3f, 0x80,
                              0x01, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01};
  assert_int_equal(out.size, sizeof expected);
  assert_memory_equal(out.data, expected, sizeof expected);
  vs_bytes_free(&out);
}

// Walks the records: length, checksum of it, data, checksum of it. Returns how many.
static int count_records(const uint8_t *data, size_t size) {
  int records = 0;
  for (size_t at = 0; at < size; records++) {
    uint64_t length;
    uint32_t crc[2];
    assert_true(size - at >= 12);
    memcpy(&length, data + at, 8);
    memcpy(&crc[0], data + at + 8, 4);
    assert_true(size - at >= 16 + length);
    memcpy(&crc[1], data + at + 12 + length, 4);
    for (int i = 0; i < 2; i++) {
      uint32_t plain = vs_crc32c(i ? data + at + 12 : data + at, i ? length : 8);
      assert_int_equal(crc[i], (uint32_t)((plain >> 15 | plain << 17) + 0xa282ead8u));
    }
    at += 16 + length;
  }
  return records;
}

static void events_are_whole_records_that_hold_tag_and_value(void **state) {
  (void)state;
  vs_bytes out = {0}, summary = {0};
  vs_tensorboard_begin(&out, 1.5);
  assert_non_null(memmem(out.data, out.size, "brain.Event:2", 13));
  vs_tensorboard_scalar(&summary, "ppo/entropy", -0.5);
  vs_tensorboard_event(&out, 2.5, 128400, &summary);
  assert_int_equal(count_records(out.data, out.size), 2);
  // Value { tag = "ppo/entropy", simple_value = -0.5 }: 0a 0b tag, 15 00 00 00 bf.
  assert_non_null(memmem(out.data, out.size, "\x0a\x0bppo/entropy\x15\x00\x00\x00\xbf", 18));
  vs_bytes_free(&out);
}

static char folder[64];

static int lines_of(const char *name, char *last, size_t size) {
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  int lines = 0;
  while (fgets(last, (int)size, f)) lines++;
  fclose(f);
  return lines;
}

static void a_journal_that_is_continued_drops_what_came_after_the_checkpoint(void **state) {
  (void)state;
  vs_journal *journal;
  char line[4096], path[128];
  const vs_train_score eval = {"random:", 10, 0.9, 0.1, 0.0, 3.0, 0.5, 2.5, 2.0, 3.0};
  assert_ok(vs_journal_open(folder, 0.0, &journal, err));
  for (int i = 1; i <= 5; i++) {
    vs_train_report report = {.update = i, .transitions = 1000.0 * i, .reward = -0.25 * i};
    assert_ok(vs_journal_add(journal, &report, err));
    if (i % 2 == 0) assert_ok(vs_journal_add_eval(journal, &report, &eval, err));
  }
  vs_journal_close(journal);
  assert_int_equal(lines_of("progress.csv", line, sizeof line), 6);
  assert_int_equal(lines_of("eval.csv", line, sizeof line), 3);
  snprintf(path, sizeof path, "%s/progress.csv", folder);
  FILE *f = fopen(path, "a");
  fprintf(f, "3,40"); // cut off by a crash
  fclose(f);
  assert_ok(vs_journal_open(folder, 3.0, &journal, err));
  vs_train_report report = {.update = 4, .transitions = 4000, .reward = 7.5};
  assert_ok(vs_journal_add(journal, &report, err));
  vs_journal_close(journal);
  assert_int_equal(lines_of("progress.csv", line, sizeof line), 5);
  assert_int_equal(strncmp(line, "4,4000,", 7), 0);
  assert_non_null(strstr(line, ",7.5,"));
  assert_int_equal(lines_of("eval.csv", line, sizeof line), 2);
  assert_string_equal(line, "2,2000,0.0,random:,10,0.9000,0.1000,0.0000,3.0000,0.5000,2.5000,2.0000,3.0000\n");
}

static void a_journal_without_its_folder_is_an_error_that_names_it(void **state) {
  (void)state;
  vs_journal *journal;
  vs_error err = {0};
  assert_int_equal(vs_journal_open("build/no/such/folder", 0.0, &journal, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "build/no/such/folder/progress.csv"));
  assert_null(journal);
}

static int set_up(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "build/journal_test_%d", (int)getpid());
  return mkdir(folder, 0755);
}

static int tear_down(void **state) {
  (void)state;
  DIR *d = opendir(folder);
  if (!d) return -1;
  for (struct dirent *e; (e = readdir(d));) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
    unlink(path);
  }
  closedir(d);
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(crc32c_agrees_with_the_published_values),
      cmocka_unit_test(the_wire_format_agrees_with_hand_values),
      cmocka_unit_test(events_are_whole_records_that_hold_tag_and_value),
      cmocka_unit_test(a_journal_that_is_continued_drops_what_came_after_the_checkpoint),
      cmocka_unit_test(a_journal_without_its_folder_is_an_error_that_names_it),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
