// Runs the real binary, waits until it has said something, and interrupts it as Ctrl-C does.
#ifndef VSSS_TESTS_INTERRUPT_VSSS_H
#define VSSS_TESTS_INTERRUPT_VSSS_H

#include <signal.h>

#include "run_vsss.h"

// arguments: as for vsss(). Fills run->out with all of standard output.
static inline void vsss_interrupt(vsss_run *run, const char *arguments, const char *wait_for) {
  char binary[4096], command[8192];
  vsss_binary(binary, sizeof binary);
  snprintf(command, sizeof command, "exec '%s' %s", binary, arguments);
  int ends[2];
  memset(run, 0, sizeof *run);
  if (pipe(ends) != 0) return;
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    execl("/bin/sh", "sh", "-c", command, (char *)NULL);
    _exit(127);
  }
  close(ends[1]);
  size_t length = 0;
  int sent = 0;
  for (ssize_t n; (n = read(ends[0], run->out + length, sizeof run->out - 1 - length)) > 0;) {
    length += (size_t)n;
    if (!sent && strstr(run->out, wait_for)) {
      kill(child, SIGINT);
      sent = 1;
    }
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  run->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

#endif
