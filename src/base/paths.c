#include "vsss/paths.h"

#include <dlfcn.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef VSSS_PREFIX
#define VSSS_PREFIX "/usr/local"
#endif

// The folder of the running executable, or "" where /proc does not tell.
static void executable_folder(char *out, size_t size) {
  char path[PATH_MAX];
  ssize_t n = readlink("/proc/self/exe", path, sizeof path - 1);
  if (n <= 0) {
    out[0] = '\0';
    return;
  }
  path[n] = '\0';
  snprintf(out, size, "%s", dirname(path));
}

vs_status vs_path_find(const char *relative, char *out, size_t out_size, vs_error *err) {
  char folder[PATH_MAX];
  executable_folder(folder, sizeof folder);
  const char *home = getenv("VSSS_HOME");
  // Tests live in build/<flavour>/tests/, so up to three levels above the executable.
  const char *const ups[] = {"", "/..", "/../..", "/../../..", "/../../../.."};
  char tried[384] = "";
  for (size_t i = 0; i < 2 + sizeof ups / sizeof *ups; i++) {
    char candidate[PATH_MAX + 64];
    if (i == 0) {
      if (!home) continue;
      snprintf(candidate, sizeof candidate, "%s/%s", home, relative);
    } else if (i <= sizeof ups / sizeof *ups) {
      if (!folder[0]) continue;
      snprintf(candidate, sizeof candidate, "%s%s/%s", folder, ups[i - 1], relative);
    } else {
      snprintf(candidate, sizeof candidate, VSSS_PREFIX "/share/vsss/%s", relative);
    }
    if (access(candidate, R_OK) == 0) {
      if (strlen(candidate) >= out_size) return vs_fail(err, VS_FAIL, "%s: path too long", candidate);
      memcpy(out, candidate, strlen(candidate) + 1);
      return VS_OK;
    }
    size_t used = strlen(tried);
    snprintf(tried + used, sizeof tried - used, "%s%.120s", used ? ", " : "", candidate);
  }
  return vs_fail(err, VS_FAIL, "%s: not found (tried %s); set VSSS_HOME to the folder that holds it", relative, tried);
}

vs_status vs_module_load(const char *name, const char *debian_package, void **handle, vs_error *err) {
  char relative[128], path[PATH_MAX];
  // Built modules lie in build/lib of a checkout, in PREFIX/share/vsss/build/lib when installed.
  snprintf(relative, sizeof relative, "build/lib/vsss_%s.so", name);
  if (vs_path_find(relative, path, sizeof path, NULL) != VS_OK)
    return vs_fail(err, VS_FAIL, "this build has no %s support: install %s and run make again", name, debian_package);
  *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!*handle) return vs_fail(err, VS_FAIL, "%s: %s", path, dlerror());
  return VS_OK;
}
