// Who holds a UDP port: /proc/net/udp tells the socket, /proc/PID/fd who has it open.
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "process_name.h"
#include "vsss/udp.h"

void vs_process_name(int pid, char *out, size_t out_size) {
  char path[64], words[96] = "";
  snprintf(path, sizeof path, "/proc/%d/cmdline", pid);
  FILE *f = fopen(path, "r");
  size_t n = f ? fread(words, 1, sizeof words - 1, f) : 0;
  if (f) fclose(f);
  for (size_t i = 0; i + 1 < n; i++)
    if (words[i] < ' ') words[i] = ' ';
  snprintf(out, out_size, n ? "process %d (%s)" : "process %d", pid, words);
}

static unsigned long socket_of_port(const char *table, int port) {
  FILE *f = fopen(table, "r");
  if (!f) return 0;
  char line[512];
  unsigned long inode = 0;
  while (!inode && fgets(line, sizeof line, f)) {
    unsigned at;
    unsigned long found;
    if (sscanf(line, " %*d: %*[0-9A-Fa-f]:%x %*s %*s %*s %*s %*s %*s %*s %lu", &at, &found) == 2 && (int)at == port)
      inode = found;
  }
  fclose(f);
  return inode;
}

static bool has_open(const char *pid, const char *link) {
  char folder[300], path[600], target[64];
  snprintf(folder, sizeof folder, "/proc/%s/fd", pid);
  DIR *d = opendir(folder);
  if (!d) return false;
  bool found = false;
  for (const struct dirent *e; !found && (e = readdir(d)) != NULL;) {
    snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
    ssize_t n = readlink(path, target, sizeof target - 1);
    if (n <= 0) continue;
    target[n] = '\0';
    found = strcmp(target, link) == 0;
  }
  closedir(d);
  return found;
}

void vs_udp_port_holder(int port, char *out, size_t out_size) {
  snprintf(out, out_size, "another process");
  unsigned long inode = socket_of_port("/proc/net/udp", port);
  if (!inode) inode = socket_of_port("/proc/net/udp6", port);
  DIR *proc = inode ? opendir("/proc") : NULL;
  if (!proc) return;
  char link[64];
  snprintf(link, sizeof link, "socket:[%lu]", inode);
  for (const struct dirent *e; (e = readdir(proc)) != NULL;) {
    int pid = atoi(e->d_name);
    if (pid <= 0 || !has_open(e->d_name, link)) continue;
    vs_process_name(pid, out, out_size);
    break;
  }
  closedir(proc);
}
