// Other programs, started by an argument vector: no shell sees a file's name.
#ifndef VSSS_CLI_CHILD_H
#define VSSS_CLI_CHILD_H

#include <stdbool.h>
#include <sys/types.h>

typedef struct vs_child_def {
  char *const *argv;  // the program is looked for in PATH; ended by NULL
  const char *folder; // where it starts; NULL: here
  int in, out, err;   // its standard streams; 0: ours, /dev/null and ours
  bool own_group;     // Ctrl-C in the terminal does not reach it
} vs_child_def;

// Signals are to it what they are to any program, whatever this one blocks or ignores. 0, or an errno.
int vs_child_start(const vs_child_def *def, pid_t *child);
// Waits for its end: its exit status, or 128 + the signal that ended it.
int vs_child_wait(pid_t child);

#endif
