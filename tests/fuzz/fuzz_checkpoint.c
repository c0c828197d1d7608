// Fuzzes src/learn/archive.c and src/learn/league_file.c: the file as it is, and with a hash that fits, so that what is in
// it counts.
#include "fuzz.h"
#include "learn/league_file.h"
#include "vsss/world.h"

enum { SLOTS = 6, SIZE = 4 };

static vs_league *new_league(void) {
  static vs_league league;
  static const float actor[SIZE] = {1, 2, 3, 4};
  vs_league_def def = {.replace_score = 0.6, .pool_size = 4, .pool_every = 2};
  vs_error err = {0};
  if (vs_league_parse("self,pool,frozen", &def, &err) || vs_league_init(&league, &def, SLOTS, SIZE, actor, 1, &err))
    abort();
  return &league;
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
  (void)argc, (void)argv;
  vs_bytes bytes = {0};
  vs_league *league = new_league();
  vs_archive_begin(&bytes);
  vs_league_save(league, &bytes);
  fuzz_seed("league", bytes.data, bytes.size);
  vs_bytes_free(&bytes);
  vs_league_free(league);
  return 0;
}

static void go_on(const vs_bytes *archive, bool new_slots) {
  vs_error err = {0};
  vs_league *league = new_league();
  static const float actor[SIZE] = {4, 3, 2, 1};
  if (vs_league_load(league, archive, "fuzz", new_slots, &err) == VS_OK)
    for (int update = 1; update <= 20; update++) {
      for (int slot = 0; slot < SLOTS; slot++) vs_league_episode_over(league, slot, update % 3, 1);
      vs_league_window window = vs_league_results(league);
      if (vs_league_after_update(league, update, actor, &window, NULL, &err) != VS_OK) abort();
    }
  vs_league_free(league);
}

static void go_on_both(const vs_bytes *archive) {
  go_on(archive, false);
  go_on(archive, true);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vs_error err = {0};
  vs_bytes archive = {0}, whole = {0};
  if (vs_archive_read(fuzz_file(data, size), &archive, &err) == VS_OK) go_on_both(&archive);
  vs_bytes_free(&archive);
  uint64_t hash = vs_hash_bytes(VS_HASH_START, data, size);
  vs_bytes_append(&whole, data, size);
  vs_bytes_append(&whole, &hash, sizeof hash);
  if (vs_archive_read(fuzz_file(whole.data, whole.size), &archive, &err) == VS_OK) go_on_both(&archive);
  vs_bytes_free(&archive);
  vs_bytes_free(&whole);
  return 0;
}
