// Tests src/learn/checkpoint.c and src/learn/archive.c
#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "assert_near.h"
#include "learn/archive.h"
#include "learn/train_internal.h"
#include "tiny_matches.h"

static char folder[64], file[96], previous[112];

// As of any name at its first version.
static void add_section(vs_bytes *archive, const char *name, const void *data, size_t size) {
  const vs_section section = {name, 1, 1};
  vs_archive_section(archive, &section, data, size);
}

static vs_train_def tiny_def(void) {
  vs_train_def def = vs_train_def_default();
  snprintf(def.precision, sizeof def.precision, "fp32"); // auto may choose another one each time
  snprintf(def.hidden, sizeof def.hidden, "8,8");
  snprintf(def.opponent, sizeof def.opponent, "self=0.4,pool=0.3,frozen=0.3");
  def.envs = 10;
  def.steps = 8;
  def.minibatch = 100;
  def.pool_every = 2;
  def.pool_size = 2;
  def.threads = 1;
  def.replace_score = -1.0; // replaced whenever its window is full
  def.score_window_zero_filled = true;
  return def;
}

static vs_train *open_tiny(const vs_train_def *def) {
  vs_matches matches = tiny_matches(def->envs, 7, 3);
  vs_train *train = NULL;
  assert_ok(vs_train_new_over(def, &matches, NULL, &train, err));
  return train;
}

static void updates(vs_train *train, int count) {
  vs_train_report report;
  for (int i = 0; i < count; i++) assert_ok(vs_train_update(train, &report, err));
}

static void assert_same(const vs_train *a, const vs_train *b) {
  size_t bytes = a->learner.net.size * sizeof(float);
  assert_memory_equal(a->learner.parameters, b->learner.parameters, bytes);
  assert_memory_equal(a->learner.m, b->learner.m, bytes);
  assert_memory_equal(a->learner.v, b->learner.v, bytes);
  assert_memory_equal(a->actor_mean, b->actor_mean, a->league.size * sizeof(float));
  assert_int_equal(a->transitions, b->transitions);
  assert_int_equal(a->league.next_id, b->league.next_id);
  assert_memory_equal(a->league.slot, b->league.slot, (size_t)a->league.slots * sizeof *a->league.slot);
}

static void a_resumed_run_continues_bit_for_bit(void **state) {
  (void)state;
  vs_train_def def = tiny_def(), read;
  vs_train *straight = open_tiny(&def), *first = open_tiny(&def);
  updates(straight, 9);
  updates(first, 4);
  assert_ok(vs_train_save(first, file, err));
  vs_train_free(first);
  assert_ok(vs_train_read_def(file, &read, err));
  assert_memory_equal(&read, &def, sizeof def);
  vs_train *second = open_tiny(&read);
  char note[256];
  assert_ok(vs_train_load(second, file, note, err));
  assert_string_equal(note, "");
  updates(second, 5);
  assert_same(straight, second);
  vs_train_free(straight);
  vs_train_free(second);
}

// Checkpoints of one run at two ages: the mean of both, number for number, also for the policy that plays; the run then
// goes on from it. A file that does not fit changes nothing.
static void a_run_goes_on_from_the_mean_of_checkpoints(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  char older[112];
  snprintf(older, sizeof older, "%s/older", folder);
  vs_train *run = open_tiny(&def), *mean = open_tiny(&def);
  updates(run, 2);
  assert_ok(vs_train_save_slim(run, older, err));
  size_t size = run->learner.net.size;
  float *before = malloc(size * sizeof *before);
  memcpy(before, run->learner.parameters, size * sizeof *before);
  updates(run, 3);
  assert_ok(vs_train_save_slim(run, file, err));
  assert_ok(vs_train_load(mean, file, NULL, err));
  const char *const one[] = {older}, *const bad[] = {older, "/nowhere/at/all"};
  vs_error err = {0};
  assert_int_equal(vs_train_average(mean, bad, 2, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/nowhere/at/all"));
  assert_memory_equal(mean->learner.parameters, run->learner.parameters, size * sizeof *before);
  assert_ok(vs_train_average(mean, one, 1, err));
  for (size_t i = 0; i < size; i++)
    assert_near(mean->learner.parameters[i], 0.5 * ((double)before[i] + (double)run->learner.parameters[i]), 1e-6);
  assert_memory_equal(mean->league.self[0].parameters, mean->actor, mean->league.size * sizeof(float));
  updates(mean, 1);
  unlink(older);
  free(before);
  vs_train_free(run);
  vs_train_free(mean);
}

static void read_bytes(const char *path, char **data, size_t *size) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  *data = malloc(1 << 22);
  *size = fread(*data, 1, 1 << 22, f);
  fclose(f);
}

static void write_bytes(const char *path, const char *data, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
}

static void a_damaged_checkpoint_falls_back_to_the_one_before_and_says_so(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  updates(train, 2);
  assert_ok(vs_train_save(train, file, err));
  updates(train, 1);
  assert_ok(vs_train_save(train, file, err)); // the first is now file.previous
  char *data, note[256];
  size_t size;
  read_bytes(file, &data, &size);
  for (int part = 0; part <= 10; part++) { // cut off anywhere, or one bit flipped
    if (part == 10) data[size / 3] ^= 1;
    write_bytes(file, data, part == 10 ? size : size * (size_t)part / 10);
    vs_train *again = open_tiny(&def);
    assert_ok(vs_train_load(again, file, note, err));
    assert_int_equal(again->updates, 2);
    assert_non_null(strstr(note, file));
    assert_non_null(strstr(note, ".previous"));
    vs_train_free(again);
  }
  write_bytes(previous, data, 10);
  vs_error err = {0};
  assert_int_equal(vs_train_load(train, file, note, &err), VS_FAIL);
  assert_non_null(strstr(err.text, file));
  free(data);
  vs_train_free(train);
}

static void a_checkpoint_of_other_settings_is_refused(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  updates(train, 1);
  assert_ok(vs_train_save(train, file, err));
  vs_train_free(train);
  snprintf(def.hidden, sizeof def.hidden, "8,9");
  train = open_tiny(&def);
  vs_error err = {0};
  assert_int_equal(vs_train_load(train, file, NULL, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "'parameters' has"));
  vs_train_free(train);
}

static void a_run_older_than_the_precision_goes_on_in_fp32(void **state) {
  (void)state;
  static const char settings[] = "gamma = 0.9\n";
  vs_bytes archive = {0};
  vs_train_def def;
  vs_archive_begin(&archive);
  add_section(&archive, "contract", vs_contract_hash_hex(), 16);
  add_section(&archive, "settings", settings, sizeof settings - 1);
  assert_ok(vs_archive_write(&archive, file, err));
  assert_ok(vs_train_read_def(file, &def, err));
  assert_near(def.gamma, 0.9, 0.0);
  assert_string_equal(def.precision, "fp32");
}

static void settings_of_a_newer_program_are_refused_with_the_one_that_is(void **state) {
  (void)state;
  static const char settings[] = "gamma = 0.9\nwarp = 9\n";
  static const struct {
    vs_section section;
    const char *says;
  } row[] = {{{"settings", 1, 2}, ":2: unknown key 'warp'"}, {{"settings", 1, 3}, "'settings' is too new (version 3"}};
  for (size_t i = 0; i < 2; i++) {
    vs_bytes archive = {0};
    vs_train_def def;
    vs_error err = {0};
    unlink(previous);
    vs_archive_begin(&archive);
    add_section(&archive, "contract", vs_contract_hash_hex(), 16);
    vs_archive_section(&archive, &row[i].section, settings, sizeof settings - 1);
    assert_int_equal(vs_archive_write(&archive, file, &err), VS_OK);
    assert_int_not_equal(vs_train_read_def(file, &def, &err), VS_OK);
    assert_non_null(strstr(err.text, row[i].says));
    assert_non_null(strstr(err.text, file));
    if (i == 0) assert_non_null(strstr(err.text, "a setting of a newer vsss: "));
  }
}

static void a_section_of_another_version_is_refused_by_name(void **state) {
  (void)state;
  static const vs_section written = {"thing", 3, 4};
  vs_bytes archive = {0};
  vs_found found;
  vs_archive_begin(&archive);
  vs_archive_section(&archive, &written, "abc", 3);
  assert_ok(vs_archive_write(&archive, file, err));
  assert_ok(vs_archive_read(file, &archive, err));
  static const struct {
    vs_section reader;
    const char *says; // NULL: it reads it
  } row[] = {{{"thing", 3, 4}, NULL},
             {{"thing", 1, 7}, NULL},
             {{"thing", 1, 3}, "'thing' is too new (version 4, this vsss reads up to 3)"},
             {{"thing", 5, 5}, "'thing' is too old (version 4, this vsss reads from 5 on)"},
             {{"thin", 1, 4}, "no 'thin' in it"}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    vs_error err = {0};
    vs_status s = vs_archive_find(&archive, file, &row[i].reader, 3, &found, &err);
    assert_int_equal(s, row[i].says ? VS_FAIL : VS_OK);
    if (row[i].says) assert_non_null(strstr(err.text, row[i].says));
    if (row[i].says) assert_non_null(strstr(err.text, file));
    if (!row[i].says) assert_int_equal(found.version, 4);
  }
  vs_bytes_free(&archive);
}

// Where the version of the section that begins at data is: after the name, before the size.
static void *version_of(vs_bytes *archive, const char *name) {
  vs_found found;
  assert_true(vs_archive_has(archive, name, &found));
  return archive->data + ((const uint8_t *)found.data - archive->data) - 12;
}

static void write_again(vs_bytes *archive) {
  archive->size -= sizeof(uint64_t); // the hash
  assert_ok(vs_archive_write(archive, file, err));
}

// But for the matches, whose bytes have changed since (VS_VECENV_STATE).
static void a_checkpoint_of_before_versions_continues_bit_for_bit(void **state) {
  (void)state;
  static const char *const names[] = {"contract", "settings", "counters", "parameters", "mean",
                                      "square",   "league",   "slots",    "selves",     "observation"};
  vs_train_def def = tiny_def(), read;
  vs_train *straight = open_tiny(&def), *again;
  updates(straight, 3);
  assert_ok(vs_train_save(straight, file, err));
  vs_bytes archive;
  assert_ok(vs_archive_read(file, &archive, err));
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) memset(version_of(&archive, names[i]), 0, 4);
  write_again(&archive);
  assert_ok(vs_train_read_def(file, &read, err));
  again = open_tiny(&read);
  assert_ok(vs_train_load(again, file, NULL, err));
  updates(straight, 2);
  updates(again, 2);
  assert_same(straight, again);
  vs_train_free(straight);
  vs_train_free(again);
}

static void a_newer_checkpoint_is_refused_by_the_section_that_is(void **state) {
  (void)state;
  static const char *const names[] = {"parameters", "square", "league", "matches"};
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  updates(train, 1);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    unlink(previous);
    assert_ok(vs_train_save(train, file, err));
    vs_bytes archive;
    assert_ok(vs_archive_read(file, &archive, err));
    static const uint32_t newer = 1000;
    memcpy(version_of(&archive, names[i]), &newer, sizeof newer);
    write_again(&archive);
    vs_train *again = open_tiny(&def);
    vs_error err = {0};
    char expected[64];
    snprintf(expected, sizeof expected, "'%s' is too new (version 1000", names[i]);
    assert_int_equal(vs_train_load(again, file, NULL, &err), VS_FAIL);
    assert_non_null(strstr(err.text, expected));
    vs_train_free(again);
  }
  vs_train_free(train);
}

// The one in the tree: written by the release that ships it.
static void the_last_releases_checkpoint_loads_and_trains_on(void **state) {
  (void)state;
  static const char released[] = "models/policy/vsss.checkpoint";
  vs_train_def def;
  assert_ok(vs_train_read_def(released, &def, err));
  assert_string_equal(def.hidden, "256,256");
  snprintf(def.precision, sizeof def.precision, "fp32"); // bf16 needs a processor that has it
  def.envs = 8, def.steps = 4, def.minibatch = 64, def.threads = 1;
  vs_train *train = open_tiny(&def);
  assert_ok(vs_train_load(train, released, NULL, err));
  assert_true(train->transitions > 10 * 1000 * 1000);
  assert_true(train->learner.steps > 10000); // of Adam: its m and v are those of a long run
  double largest = 0.0;
  for (size_t i = 0; i < train->learner.net.size; i++) largest = fmax(largest, train->learner.v[i]);
  assert_true(largest > 0.0);
  long long before = train->transitions;
  updates(train, 1);
  assert_true(train->transitions > before);
  vs_train_free(train);
}

static void a_slim_checkpoint_continues_the_networks_with_new_matches(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def), *again = open_tiny(&def);
  updates(train, 3);
  assert_ok(vs_train_save_slim(train, file, err));
  struct stat status;
  assert_int_equal(stat(file, &status), 0);
  assert_true((size_t)status.st_size < 3 * train->learner.net.size * sizeof(float) + 4096);
  assert_ok(vs_train_load(again, file, NULL, err));
  size_t bytes = train->learner.net.size * sizeof(float);
  assert_memory_equal(again->learner.parameters, train->learner.parameters, bytes);
  assert_memory_equal(again->learner.v, train->learner.v, bytes);
  assert_int_equal(again->transitions, train->transitions);
  // Its frozen opponents are the policy as saved, not the untrained one.
  vs_net_extract_actor(&train->learner.net, train->learner.parameters, &train->rollout.actor, train->actor);
  assert_memory_equal(again->league.self[again->league.frozen].parameters, train->actor,
                      train->league.size * sizeof(float));
  updates(again, 1);
  assert_int_equal(again->updates, 4);
  vs_train_free(train);
  vs_train_free(again);
}

// More matches than before, of another length: networks and earlier selves go on, the matches begin anew. Another mix of
// opponents: the networks alone go on.
static void a_run_goes_on_with_other_matches_and_says_so(void **state) {
  (void)state;
  const struct {
    int more_envs;
    double episode_s;
    const char *opponent, *named;
  } row[] = {{0, 20, NULL, "'episode_s'"}, {3, 0, NULL, "'envs'"}, {0, 0, "self=0.5,pool=0.5", "'opponent'"}};
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  updates(train, 7);
  assert_ok(vs_train_save(train, file, err));
  const vs_league *before = &train->league;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    char note[256];
    vs_train_def other = def;
    other.envs += row[k].more_envs;
    if (row[k].episode_s > 0) other.episode_s = row[k].episode_s;
    if (row[k].opponent) snprintf(other.opponent, sizeof other.opponent, "%s", row[k].opponent);
    vs_train *again = open_tiny(&other);
    assert_ok(vs_train_load(again, file, note, err));
    assert_non_null(strstr(note, row[k].named));
    assert_memory_equal(again->learner.parameters, train->learner.parameters, train->learner.net.size * sizeof(float));
    const vs_league *now = &again->league;
    int users = 0, meet = 0;
    for (int i = 0; i < now->selves; i++) users += now->self[i].users;
    for (int i = 0; i < now->slots; i++) meet += now->slot[i].self >= 0;
    assert_int_equal(users, meet);
    assert_int_equal(now->slots, other.envs);
    if (row[k].opponent) {
      vs_net_extract_actor(&train->learner.net, train->learner.parameters, &train->rollout.actor, train->actor);
      for (int i = 0; i < now->selves; i++)
        assert_memory_equal(now->self[i].parameters, train->actor, now->size * sizeof(float));
    } else {
      assert_int_equal(now->next_id, before->next_id);
      for (int i = 0; i < before->selves; i++)
        if (before->self[i].id)
          assert_memory_equal(now->self[i].parameters, before->self[i].parameters, now->size * sizeof(float));
    }
    updates(again, 3);
    assert_int_equal(again->updates, 10);
    vs_train_free(again);
  }
  vs_train_free(train);
}

static void a_full_disk_leaves_the_old_checkpoint_and_names_the_file(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train *train = open_tiny(&def);
  vs_error err = {0};
  assert_int_equal(vs_train_save(train, "/dev/full/checkpoint", &err), VS_FAIL);
  assert_non_null(strstr(err.text, "/dev/full/checkpoint"));
  vs_bytes bytes = {0};
  vs_archive_begin(&bytes);
  add_section(&bytes, "x", "abc", 3);
  assert_ok(vs_archive_write(&bytes, file, err));
  // A limit on the size of files stands for the full disk: the write fails half-way.
  struct rlimit old, small;
  getrlimit(RLIMIT_FSIZE, &old);
  small = old;
  small.rlim_cur = 2000;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  vs_status s = vs_train_save(train, file, &err);
  setrlimit(RLIMIT_FSIZE, &old);
  assert_int_equal(s, VS_FAIL);
  assert_non_null(strstr(err.text, file));
  assert_non_null(strstr(err.text, "File too large"));
  vs_bytes kept;
  assert_ok(vs_archive_read(file, &kept, err));
  vs_bytes_free(&kept);
  vs_train_free(train);
}

// A child trains and saves after every update until it is killed; whatever the moment, a whole checkpoint is there and
// continues exactly as an undisturbed run.
static void a_run_killed_at_any_moment_resumes_exactly(void **state) {
  (void)state;
  vs_train_def def = tiny_def();
  vs_train_report report;
  for (int trial = 0; trial < 6; trial++) {
    unlink(file);
    unlink(previous);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
      vs_train *train = open_tiny(&def);
      for (;;)
        if (vs_train_update(train, &report, NULL) != VS_OK || vs_train_save(train, file, NULL) != VS_OK) _exit(1);
    }
    while (access(previous, F_OK) != 0) usleep(500); // two saves are done
    usleep((useconds_t)(1000 + 2377 * trial));
    kill(child, SIGKILL);
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status));
    vs_train *resumed = open_tiny(&def), *straight = open_tiny(&def);
    char note[256];
    assert_ok(vs_train_load(resumed, file, note, err));
    assert_true(resumed->updates >= 1);
    updates(straight, (int)resumed->updates);
    assert_same(resumed, straight);
    updates(resumed, 1);
    updates(straight, 1);
    assert_same(resumed, straight);
    vs_train_free(resumed);
    vs_train_free(straight);
  }
}

static int set_up(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "build/checkpoint_test_%d", (int)getpid());
  snprintf(file, sizeof file, "%s/checkpoint", folder);
  snprintf(previous, sizeof previous, "%s.previous", file);
  return mkdir(folder, 0755);
}

static int tear_down(void **state) {
  (void)state;
  char left[128];
  static const char *const endings[] = {"", ".previous", ".next", ".next.tmp"};
  for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
    snprintf(left, sizeof left, "%s%s", file, endings[i]);
    unlink(left);
  }
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_resumed_run_continues_bit_for_bit),
      cmocka_unit_test(a_run_goes_on_from_the_mean_of_checkpoints),
      cmocka_unit_test(a_damaged_checkpoint_falls_back_to_the_one_before_and_says_so),
      cmocka_unit_test(a_checkpoint_of_other_settings_is_refused),
      cmocka_unit_test(a_run_older_than_the_precision_goes_on_in_fp32),
      cmocka_unit_test(settings_of_a_newer_program_are_refused_with_the_one_that_is),
      cmocka_unit_test(a_section_of_another_version_is_refused_by_name),
      cmocka_unit_test(a_checkpoint_of_before_versions_continues_bit_for_bit),
      cmocka_unit_test(a_newer_checkpoint_is_refused_by_the_section_that_is),
      cmocka_unit_test(the_last_releases_checkpoint_loads_and_trains_on),
      cmocka_unit_test(a_slim_checkpoint_continues_the_networks_with_new_matches),
      cmocka_unit_test(a_run_goes_on_with_other_matches_and_says_so),
      cmocka_unit_test(a_full_disk_leaves_the_old_checkpoint_and_names_the_file),
      cmocka_unit_test(a_run_killed_at_any_moment_resumes_exactly),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
