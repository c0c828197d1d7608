// src/cli/cmd_train.c and src/cli/terminal.c through the real binary: signals while it computes.
#include <signal.h>
#include <time.h>

#include "assert_near.h"
#include "run_vsss.h"
#include "test_folder.h"
#include "vsss/rng.h"

// The paper's layers, so that the products are the ones that a signal used to damage; an update takes about a second.
#define RUN "--threads 2 --set envs=32 --set steps=16 --set minibatch=512 --set epochs=2 "

static vsss_run run;
static char text[65536];

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static pid_t start(const char *arguments) {
  char binary[4096], command[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "exec '%s' %s >%s/log 2>&1", binary, arguments, folder);
  char log[128];
  snprintf(log, sizeof log, "%s/log", folder);
  unlink(log); // what the one before said must not be taken for this one's
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
  }
  return child;
}

static const char *said(void) {
  char path[128];
  snprintf(path, sizeof path, "%s/log", folder);
  FILE *f = fopen(path, "r");
  text[0] = '\0';
  if (f) vsss_read_all(f, text, sizeof text);
  if (f) fclose(f);
  return text;
}

// Waits until it has said this; fails where it ended before or a minute passed.
static void wait_for(pid_t child, const char *words) {
  for (double end = now_s() + 60.0; !strstr(said(), words); usleep(5000))
    if (waitpid(child, NULL, WNOHANG) != 0 || now_s() > end) fail_msg("waited for '%s': %s", words, text);
}

static int end_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The run of this name can be continued, and its checkpoint is the whole one.
static void assert_resumes(const char *name) {
  char arguments[256];
  snprintf(arguments, sizeof arguments, "train --resume %s/%s --transitions 0.0000001", folder, name);
  vsss(&run, arguments);
  if (run.status != 0 || strstr(run.out, "damaged")) fail_msg("%s: %d: %s%s", name, run.status, run.out, run.err);
}

static void interrupts_at_any_moment_leave_runs_that_go_on(void **state) {
  (void)state;
  uint64_t seed = (uint64_t)time(NULL);
  print_message("seed %llu\n", (unsigned long long)seed);
  vs_rng rng = vs_rng_make(seed, 0);
  double end_s = now_s() + 12.0;
  int rounds = 0;
  for (; rounds < 300 && now_s() < end_s; rounds++) {
    char arguments[512], name[16];
    snprintf(name, sizeof name, "r%d", rounds);
    snprintf(arguments, sizeof arguments, "train --run %s/%s " RUN, folder, name);
    pid_t child = start(arguments);
    wait_for(child, "training in");
    usleep((unsigned)vs_rng_range(&rng, 0.0, 1e6));
    kill(child, rounds % 3 ? SIGINT : SIGHUP);
    int status = end_of(child);
    if (status != 0) fail_msg("round %d: status %d: %s", rounds, status, said());
    assert_non_null(strstr(said(), "stopping after this update"));
    assert_non_null(strstr(said(), "stopped at"));
    assert_resumes(name);
  }
  print_message("%d interrupts\n", rounds);
}

// The update here takes some seconds.
static void a_second_interrupt_saves_what_was_before_the_update(void **state) {
  (void)state;
  for (int round = 0; round < 2; round++) {
    char arguments[512];
    snprintf(arguments, sizeof arguments, "train --%s %s/two --threads 1 %s --set steps=1024", round ? "resume" : "run",
             folder, round ? "--set epochs=1" : "--set envs=32");
    pid_t child = start(arguments);
    wait_for(child, "training in");
    usleep(200000);
    kill(child, SIGINT);
    wait_for(child, "stopping after this update");
    kill(child, SIGINT);
    double sent_s = now_s();
    assert_int_equal(end_of(child), 128 + SIGINT);
    assert_true(now_s() - sent_s < 30.0);
    if (!strstr(said(), "saved as it was after update 0")) fail_msg("%s", text);
  }
  assert_resumes("two");
}

// nohup: SIGHUP is ignored by who started it.
static void a_run_that_is_to_outlive_its_terminal_does(void **state) {
  (void)state;
  char arguments[512];
  snprintf(arguments, sizeof arguments, "train --run %s/nohup " RUN, folder);
  signal(SIGHUP, SIG_IGN);
  pid_t child = start(arguments);
  signal(SIGHUP, SIG_DFL);
  wait_for(child, "training in");
  kill(child, SIGHUP);
  usleep(300000);
  assert_int_equal(waitpid(child, NULL, WNOHANG), 0);
  assert_null(strstr(said(), "stopping"));
  kill(child, SIGTERM);
  assert_int_equal(end_of(child), 0);
  assert_non_null(strstr(said(), "stopped at"));
}

static void two_trainings_in_one_folder_are_refused(void **state) {
  (void)state;
  char arguments[512];
  snprintf(arguments, sizeof arguments, "train --run %s/lock " RUN, folder);
  pid_t child = start(arguments);
  wait_for(child, "training in");
  snprintf(arguments, sizeof arguments, "%s/lock/checkpoint", folder);
  for (double end = now_s() + 60.0; access(arguments, F_OK) != 0 && now_s() < end;) usleep(5000);
  snprintf(arguments, sizeof arguments, "train --resume %s/lock", folder);
  assert_refused(arguments, 2, "trains in it: wait for its end");
  snprintf(arguments, sizeof arguments, "train --run %s/lock", folder);
  assert_refused(arguments, 2, "trains in it: wait for its end");
  kill(child, SIGKILL);
  end_of(child);
  assert_resumes("lock"); // the lock died with its owner; the first checkpoint was there from the start
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(interrupts_at_any_moment_leave_runs_that_go_on),
      cmocka_unit_test(a_second_interrupt_saves_what_was_before_the_update),
      cmocka_unit_test(a_run_that_is_to_outlive_its_terminal_does),
      cmocka_unit_test(two_trainings_in_one_folder_are_refused),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
