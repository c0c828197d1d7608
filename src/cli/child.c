#define _GNU_SOURCE // posix_spawn_file_actions_addchdir_np

#include "child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static void set_streams(const vs_child_def *def, posix_spawn_file_actions_t *actions) {
  if (def->in > 0) posix_spawn_file_actions_adddup2(actions, def->in, STDIN_FILENO);
  if (def->out > 0)
    posix_spawn_file_actions_adddup2(actions, def->out, STDOUT_FILENO);
  else
    posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (def->err > 0) posix_spawn_file_actions_adddup2(actions, def->err, STDERR_FILENO);
  if (def->folder) posix_spawn_file_actions_addchdir_np(actions, def->folder);
}

int vs_child_start(const vs_child_def *def, pid_t *child) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  sigset_t none, standard;
  sigemptyset(&none);
  sigemptyset(&standard);
  sigaddset(&standard, SIGPIPE);
  sigaddset(&standard, SIGINT);
  sigaddset(&standard, SIGTERM);
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  set_streams(def, &actions);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &standard);
  posix_spawnattr_setpgroup(&attributes, 0);
  int flags = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | (def->own_group ? POSIX_SPAWN_SETPGROUP : 0);
  posix_spawnattr_setflags(&attributes, (short)flags);
  int failed = posix_spawnp(child, def->argv[0], &actions, &attributes, def->argv, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

int vs_child_wait(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
