#include "run_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "cli.h"
#include "vsss/paths.h"

static void host_name(char *out, size_t size) {
  if (gethostname(out, size) != 0) snprintf(out, size, "unknown");
  out[size - 1] = '\0';
}

vs_status vs_run_folder_lock(const char *folder, vs_error *err) {
  char path[PATH_MAX], text[256], host[128];
  vs_status s = vs_path_make_folder(folder, 0755, err);
  if (s != VS_OK) return s;
  snprintf(path, sizeof path, "%s/lock", folder);
  int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0644); // closed by the process's end, and the lock with it
  if (file < 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    int why = errno;
    ssize_t n = why == EWOULDBLOCK ? read(file, text, sizeof text - 1) : -1;
    text[n > 0 ? n : 0] = '\0';
    text[strcspn(text, "\n")] = '\0';
    s = why == EWOULDBLOCK
            ? vs_fail(err, VS_USAGE, "%s: %s trains in it: wait for its end, or choose another --run", folder, text)
            : vs_fail(err, VS_FAIL, "%s: %s", path, strerror(why));
    close(file);
    return s;
  }
  host_name(host, sizeof host);
  int n = snprintf(text, sizeof text, "process %ld on %s\n", (long)getpid(), host);
  if (ftruncate(file, 0) != 0 || write(file, text, (size_t)n) != n)
    return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  return VS_OK;
}

vs_status vs_run_folder_note(const char *folder, const char *command, const char *commit, vs_error *err) {
  char path[PATH_MAX], when[64], host[128];
  time_t now = time(NULL);
  struct tm utc;
  strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S UTC", gmtime_r(&now, &utc));
  host_name(host, sizeof host);
  snprintf(path, sizeof path, "%s/history.txt", folder);
  FILE *f = fopen(path, "a");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  fprintf(f, "%s  host %s, %ld processors, commit %s\n  %s\n", when, host, sysconf(_SC_NPROCESSORS_ONLN), commit,
          command);
  return fclose(f) == 0 ? VS_OK : vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
}

static void print_next(const char *const words[], int count, const char *about) {
  char line[2 * PATH_MAX];
  vs_cli_command(vs_cli_program, count, words, line, sizeof line);
  printf("  %-62s  %s\n", line, about);
}

void vs_run_folder_next(const char *folder, double limit_m) {
  char policy[PATH_MAX + 32], limit[32];
  snprintf(policy, sizeof policy, "onnx:%s/policy.onnx", folder);
  snprintf(limit, sizeof limit, "%.6g", 2.0 * limit_m);
  printf("next:\n");
  print_next((const char *[]){"eval", "--blue", policy}, 3, "how it plays");
  print_next((const char *[]){"plot", folder}, 2, "how it learnt");
  print_next((const char *[]){"train", "--resume", folder, "--transitions", limit}, limit_m > 0.0 ? 5 : 3,
             limit_m > 0.0 ? "learns on, to another limit" : "learns on");
}
