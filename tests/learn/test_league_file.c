// src/learn/league_file.c and src/learn/checkpoint.c: checkpoints whose hash is right and whose numbers are not.
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assert_near.h"
#include "learn/archive.h"
#include "learn/train_internal.h"
#include "test_folder.h"

static char file[128];
static vs_train_def def;
static vs_bytes whole; // a real run against every kind of opponent, after three updates

static vs_train *open_run(void) {
  vs_train *train = NULL;
  assert_ok(vs_train_new(&def, NULL, &train, err));
  return train;
}

static int make_run(void **state) {
  if (make_folder(state) != 0) return -1;
  snprintf(file, sizeof file, "%s/checkpoint", folder);
  def = vs_train_def_default();
  snprintf(def.hidden, sizeof def.hidden, "8,8");
  snprintf(def.opponent, sizeof def.opponent, "self,pool,frozen,emc:,inf:,emc22:,random:");
  def.envs = 14, def.steps = 8, def.minibatch = 100, def.pool_every = 1, def.threads = 1;
  vs_train *train = open_run();
  vs_train_report report;
  for (int i = 0; i < 3; i++) assert_ok(vs_train_update(train, &report, err));
  assert_ok(vs_train_save(train, file, err));
  vs_train_free(train);
  assert_ok(vs_archive_read(file, &whole, err));
  return 0;
}

static int drop_run(void **state) {
  vs_bytes_free(&whole);
  return remove_folder(state);
}

// The section's place in `whole`.
static size_t find(const char *name, size_t *size) {
  vs_found found;
  assert_true(vs_archive_has(&whole, name, &found));
  *size = found.size;
  return (size_t)((const uint8_t *)found.data - whole.data);
}

// Writes the checkpoint with these bytes changed and a hash that fits, loads it and goes on; the first failure.
static vs_status go_on_with(size_t at, const void *bytes, size_t count, vs_error *err) {
  vs_bytes changed = {0};
  vs_bytes_append(&changed, whole.data, whole.size - sizeof(uint64_t));
  memcpy(changed.data + at, bytes, count);
  assert_ok(vs_archive_write(&changed, file, err));
  vs_train *train = open_run();
  vs_train_report report;
  vs_status s = vs_train_load(train, file, NULL, err);
  for (int i = 0; s == VS_OK && i < 2; i++) s = vs_train_update(train, &report, err);
  vs_train_free(train);
  return s;
}

static void assert_refused(const char *section, size_t offset, int32_t word) {
  size_t size, at = find(section, &size);
  vs_error err = {0};
  assert_true(offset + sizeof word <= size);
  if (go_on_with(at + offset, &word, sizeof word, &err) != VS_FAIL || !strstr(err.text, file))
    fail_msg("%s + %zu = %d: %s", section, offset, word, err.text);
}

static void numbers_out_of_range_are_refused_with_the_file(void **state) {
  (void)state;
  static const int32_t wrong[] = {-1, -2, 14, 1000000, 0x7fffffff, 2146959360, (int32_t)0x80000000};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    int32_t word = wrong[i];
    if (word != 14) assert_refused("league", 0, word); // how many selves
    assert_refused("league", 4, word);                 // the frozen one
    assert_refused("slots", 0, word);                  // kind of the first slot
    assert_refused("slots", 4, word);                  // its side
    if (word != -1) assert_refused("slots", 8, word);  // whom it meets (it is one of two equals: nobody)
    assert_refused("slots", 8 + 16, word);             // the second meets one of the pool
    assert_refused("selves", 4, word);                 // whether it is in the pool
    assert_refused("selves", 8, word);                 // how many meet it
  }
  assert_refused("league", 8, -1);                // the next number
  assert_refused("league", 16, 100);              // place in the window
  assert_refused("league", 20, 101);              // how much of it is filled
  assert_refused("counters", 4, -1);              // updates
  assert_refused("parameters", 400, 0x7fc00000);  // not a number
  assert_refused("observation", 400, 0x7f800000); // infinite
}

// Whatever a word of any section becomes: the run is refused, or goes on, or ends with an error; the sanitizers see that
// nothing is read out of bounds.
static void any_word_may_be_wrong(void **state) {
  (void)state;
  static const uint32_t words[] = {0xffffffff, 0x7fffffff, 0x80000000, 0x7ff7f7f8, 1000000, 2, 0x7ff00000};
  static const char *const sections[] = {"matches", "matches", "matches",  "matches", "slots",
                                         "league",  "selves",  "counters", "settings"};
  vs_rng rng = vs_rng_make(5, 0);
  int refused = 0;
  for (int trial = 0; trial < 400; trial++) {
    size_t size, at = find(sections[trial % 9], &size);
    size_t words_in = size / 4;
    if (strcmp(sections[trial % 9], "selves") == 0) words_in = 6;
    uint32_t word = words[vs_rng_below(&rng, sizeof words / sizeof *words)];
    vs_error err = {0};
    vs_status s = go_on_with(at + 4 * vs_rng_below(&rng, (uint32_t)words_in), &word, sizeof word, &err);
    if (s != VS_OK) refused++;
    if (s != VS_OK && err.text[0] == '\0') fail_msg("trial %d failed without a word", trial);
  }
  print_message("%d of 400 refused\n", refused);
  assert_true(refused > 40);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_out_of_range_are_refused_with_the_file),
      cmocka_unit_test(any_word_may_be_wrong),
  };
  return cmocka_run_group_tests(tests, make_run, drop_run);
}
