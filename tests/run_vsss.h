// Runs the real binary as its user would: arguments in, exit status and both outputs back. The binary is the one of
// this build flavour (./vsss beside the sources in the plain one).
#ifndef VSSS_TESTS_RUN_VSSS_H
#define VSSS_TESTS_RUN_VSSS_H

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct vsss_run {
  int status;      // exit status, or 128 + signal
  char out[65536]; // standard output and standard error, each cut to fit
  char err[16384];
} vsss_run;

// The folder that holds build/ of the running test, build/<flavour>/tests/<module>/test_x.
static inline void vsss_binary(char *path, size_t size) {
  char self[4096];
  ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
  self[n > 0 ? n : 0] = '\0';
  char *tests = strstr(self, "/tests/");
  char *last = NULL;
  for (; tests; tests = strstr(tests + 1, "/tests/")) last = tests;
  if (last) *last = '\0'; // .../build/<flavour>
  size_t length = strlen(self);
  if (length > 12 && !strcmp(self + length - 12, "/build/plain")) {
    self[length - 12] = '\0';
  }
  snprintf(path, size, "%s/vsss", self);
}

static inline void vsss_read_all(FILE *f, char *out, size_t size) {
  rewind(f);
  size_t n = fread(out, 1, size - 1, f);
  out[n] = '\0';
}

// arguments: as typed in a shell after "vsss ", so that quoting works. NULL environment: inherited.
static inline void vsss(vsss_run *run, const char *arguments) {
  char binary[4096], command[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "exec '%s' %s", binary, arguments);
  FILE *out = tmpfile(), *err = tmpfile();
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    dup2(fileno(out), STDOUT_FILENO);
    dup2(fileno(err), STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  run->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  vsss_read_all(out, run->out, sizeof run->out);
  vsss_read_all(err, run->err, sizeof run->err);
  fclose(out);
  fclose(err);
}

// Starts it in the background; both outputs go to the file log. Returns the process.
static inline pid_t vsss_start(const char *log, const char *arguments) {
  char binary[4096], command[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "exec '%s' %s", binary, arguments);
  unlink(log); // nobody shall read what the one before said
  fflush(NULL);
  pid_t child = fork();
  if (child) return child;
  int out = open(log, O_CREAT | O_TRUNC | O_WRONLY, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  execl("/bin/sh", "sh", "-c", command, (char *)NULL);
  _exit(127);
}

// Exit status, 128 + signal, or -1 where it did not end in time (it is then killed).
static inline int vsss_wait(pid_t child, int seconds) {
  int status;
  for (int i = 0; i < 100 * seconds; i++) {
    if (waitpid(child, &status, WNOHANG) == child)
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    nanosleep(&(struct timespec){0, 10000000}, NULL);
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return -1;
}

// The same for one that shall end by itself or by the signal (0: none).
static inline int vsss_finish(pid_t child, int signal_number) {
  if (signal_number) kill(child, signal_number);
  return vsss_wait(child, 300);
}

// The folder of the sources.
static inline void vsss_sources(char *path, size_t size) {
  vsss_binary(path, size);
  char *cut = strstr(path, "/build/");
  if (!cut) cut = strrchr(path, '/');
  *cut = '\0';
}

// The call fails with this status, says exactly one line on standard error, and the line holds the text.
#define assert_refused(arguments, expected_status, text)                                                               \
  do {                                                                                                                 \
    static vsss_run run_;                                                                                              \
    vsss(&run_, arguments);                                                                                            \
    size_t length_ = strlen(run_.err);                                                                                 \
    if (run_.status != (expected_status) || !strstr(run_.err, text) || length_ == 0 ||                                 \
        strchr(run_.err, '\n') != run_.err + length_ - 1)                                                              \
      fail_msg("vsss %s: status %d (expected %d), expected one line with '%s', got: %s", arguments, run_.status,       \
               expected_status, text, run_.err);                                                                       \
  } while (0)

#endif
