// src/cli/cmd_train.c through the real binary, killed at random moments: a run that was continued is the run that was
// never killed, bit for bit, on real matches at one thread.
#include <signal.h>
#include <time.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/rng.h"

#define SETTINGS                                                                                                       \
  "--set precision=fp32 --set envs=6 --set steps=16 --set minibatch=128 --set hidden=32,32 --set pool_every=3 "        \
  "--set opponent=self=0.6,pool=0.4 --threads 1 "
// 6 matches, 4 with both sides learning: 30 rows x 16 steps = 480 transitions an update, so 60 updates.
#define RUN SETTINGS "--transitions 0.0288 --checkpoint-every 0.001 "

enum { UPDATES = 60, KILLS_MOST = 12 };

// Starts vsss with these arguments; dead after delay_us, unless it ended before: then its exit status, else -1.
static int start_and_kill(const char *arguments, unsigned delay_us) {
  char binary[4096], command[8192], log[128];
  vsss_binary(binary, sizeof binary);
  snprintf(log, sizeof log, "%s/log", folder);
  snprintf(command, sizeof command, "exec '%s' %s >'%s' 2>&1", binary, arguments, log);
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
  }
  int status = 0;
  usleep(delay_us);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The columns of progress.csv that no clock goes into: update, transitions, and from the reward on.
static int read_progress(const char *name, char rows[UPDATES + 1][512]) {
  char path[128], line[2048];
  snprintf(path, sizeof path, "%s/%s/progress.csv", folder, name);
  FILE *f = fopen(path, "r");
  if (!f) fail_msg("%s was not written", path);
  int count = 0;
  while (fgets(line, sizeof line, f)) {
    char *after = line, *cell = line;
    for (int column = 0; column < 7; column++) {
      after = strchr(after, ',') + 1;
      if (column == 1) cell = after;
    }
    assert_true(count <= UPDATES);
    snprintf(rows[count++], 512, "%.*s%s", (int)(cell - line), line, after);
  }
  fclose(f);
  return count;
}

static void a_run_killed_at_random_moments_ends_as_one_that_was_not(void **state) {
  (void)state;
  static char whole[UPDATES + 1][512], killed[UPDATES + 1][512];
  static vsss_run run;
  char arguments[1024];
  struct timespec start, end;
  clock_gettime(CLOCK_MONOTONIC, &start);
  snprintf(arguments, sizeof arguments, "train --run %s/whole " RUN, folder);
  vsss(&run, arguments);
  if (run.status != 0) fail_msg("%s", run.err);
  clock_gettime(CLOCK_MONOTONIC, &end);
  double whole_us = 1e6 * (double)(end.tv_sec - start.tv_sec) + 1e-3 * (double)(end.tv_nsec - start.tv_nsec);

  uint64_t seed = (uint64_t)end.tv_nsec;
  print_message("seed %llu\n", (unsigned long long)seed);
  vs_rng rng = vs_rng_make(seed, 0);
  int status = -1;
  char checkpoint[128], forget[128];
  snprintf(checkpoint, sizeof checkpoint, "%s/killed/checkpoint", folder);
  snprintf(forget, sizeof forget, "rm -rf '%s/killed'", folder);
  for (int kills = 0; status != 0 && kills < KILLS_MOST;) {
    if (access(checkpoint, F_OK) == 0)
      snprintf(arguments, sizeof arguments, "train --resume %s/killed --checkpoint-every 0.001", folder);
    else
      snprintf(arguments, sizeof arguments, "train --run %s/killed " RUN, folder);
    status = start_and_kill(arguments, (unsigned)vs_rng_range(&rng, 0.2 * whole_us, 0.6 * whole_us));
    if (status > 0) fail_msg("vsss %s: status %d, see %s/log", arguments, status, folder);
    if (status < 0) {
      kills++;
    } else if (kills == 0) { // the machine has become faster: anew, and kill sooner
      status = system(forget) == 0 ? -1 : 1;
      whole_us /= 2;
    }
  }
  if (status != 0) { // it was never left alone for long enough: now it is
    snprintf(arguments, sizeof arguments, "train --resume %s/killed", folder);
    vsss(&run, arguments);
    if (run.status != 0) fail_msg("%s", run.err);
  }
  int rows = read_progress("whole", whole);
  assert_int_equal(rows, UPDATES + 1);
  assert_int_equal(read_progress("killed", killed), rows);
  for (int i = 0; i < rows; i++) assert_string_equal(killed[i], whole[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_run_killed_at_random_moments_ends_as_one_that_was_not)};
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
