#define _GNU_SOURCE // dladdr
#include "vsss/paths.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifndef VSSS_PREFIX
#define VSSS_PREFIX "/usr/local"
#endif
#ifndef VSSS_LIBDIR // below the prefix
#define VSSS_LIBDIR "lib"
#endif

// Where the running executable and the library this code is in lie; "" where the system does not tell.
static void folder_of(const char *path, char *out, size_t size) {
  char copy[PATH_MAX];
  snprintf(copy, sizeof copy, "%s", path);
  snprintf(out, size, "%s", dirname(copy));
}

static void executable_folder(char *out, size_t size) {
  char path[PATH_MAX];
  ssize_t n = readlink("/proc/self/exe", path, sizeof path - 1);
  path[n > 0 ? n : 0] = '\0';
  out[0] = '\0';
  if (n > 0) folder_of(path, out, size);
}

static void library_folder(char *out, size_t size) {
  Dl_info info;
  union {
    vs_status (*function)(const char *, char *, size_t, vs_error *);
    void *address;
  } self = {vs_path_find};
  out[0] = '\0';
  if (dladdr(self.address, &info) && info.dli_fname && strchr(info.dli_fname, '/'))
    folder_of(info.dli_fname, out, size);
}

typedef struct place {
  const char *folder, *below;
} place;

// Looks for a file in places, in order.
static vs_status find_in(const place *places, size_t count, const char *relative, char *out, size_t out_size,
                         vs_error *err) {
  char tried[384] = "";
  for (size_t i = 0; i < count; i++) {
    char candidate[PATH_MAX + 512];
    if (!places[i].folder[0]) continue;
    snprintf(candidate, sizeof candidate, "%s%s/%s", places[i].folder, places[i].below, relative);
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

vs_status vs_path_find(const char *relative, char *out, size_t out_size, vs_error *err) {
  char program[PATH_MAX], library[PATH_MAX];
  executable_folder(program, sizeof program);
  library_folder(library, sizeof library);
  const char *home = getenv("VSSS_HOME");
  // In a checkout the program lies beside models/, its tests up to five folders below; installed, in PREFIX/bin beside
  // PREFIX/share/vsss, the library in PREFIX/lib or a folder of that.
  const place places[] = {
      {home ? home : "", ""},
      {program, ""},
      {program, "/.."},
      {program, "/../.."},
      {program, "/../../.."},
      {program, "/../../../.."},
      {program, "/../../../../.."},
      {program, "/../share/vsss"},
      {library, "/../share/vsss"},
      {library, "/../../share/vsss"},
      {VSSS_PREFIX, "/share/vsss"},
  };
  return find_in(places, sizeof places / sizeof *places, relative, out, out_size, err);
}

vs_status vs_path_library(const char *built, char *out, size_t out_size, vs_error *err) {
  if (vs_path_find(built, out, out_size, err) == VS_OK) return VS_OK;
  char program[PATH_MAX], library[PATH_MAX];
  executable_folder(program, sizeof program);
  library_folder(library, sizeof library);
  const char *name = strrchr(built, '/');
  const place places[] = {
      {program, "/../" VSSS_LIBDIR "/vsss"},
      {program, "/../lib/vsss"},
      {library, "/vsss"},
      {VSSS_PREFIX, "/" VSSS_LIBDIR "/vsss"},
  };
  return find_in(places, sizeof places / sizeof *places, name ? name + 1 : built, out, out_size, err);
}

vs_status vs_path_make_folder(const char *path, unsigned mode, vs_error *err) {
  char part[PATH_MAX];
  size_t length = strlen(path);
  if (length >= sizeof part) return vs_fail(err, VS_FAIL, "%.100s...: path too long", path);
  for (size_t i = 1; i <= length; i++) {
    if (path[i] != '/' && path[i] != '\0') continue;
    memcpy(part, path, i);
    part[i] = '\0';
    if (mkdir(part, mode) != 0 && errno != EEXIST) return vs_fail(err, VS_FAIL, "%s: %s", part, strerror(errno));
  }
  struct stat info;
  if (stat(path, &info) != 0) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  return S_ISDIR(info.st_mode) ? VS_OK : vs_fail(err, VS_FAIL, "%s: is a file, not a folder", path);
}

vs_status vs_path_own_folder(const char *path, bool make, int *folder, vs_error *err) {
  char name[PATH_MAX];
  size_t length = strlen(path);
  while (length > 1 && path[length - 1] == '/') length--; // a slash at the end would follow a link
  if (length == 0 || length >= sizeof name) return vs_fail(err, VS_USAGE, "'%.100s': not the path of a folder", path);
  memcpy(name, path, length);
  name[length] = '\0';
  if (make && mkdir(name, 0700) != 0 && errno != EEXIST)
    return vs_fail(err, VS_FAIL, "%s: cannot make this folder: %s", name, strerror(errno));
  struct stat info;
  if (lstat(name, &info) == 0 && S_ISLNK(info.st_mode))
    return vs_fail(err, VS_FAIL, "%s: is a link, which somebody else may have planted; give the folder itself", name);
  int fd = open(name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0 || fstat(fd, &info) != 0) {
    int number = errno;
    if (fd >= 0) close(fd);
    return vs_fail(err, VS_FAIL, "%s: %s", name, strerror(number));
  }
  vs_status s = VS_OK;
  if (info.st_uid != geteuid())
    s = vs_fail(err, VS_FAIL, "%s: belongs to user %u, not to you; give another folder", name, (unsigned)info.st_uid);
  else if (info.st_mode & 022)
    s = vs_fail(err, VS_FAIL, "%s: others may write into it; 'chmod go-w' it or give another folder", name);
  if (s != VS_OK)
    close(fd);
  else
    *folder = fd;
  return s;
}

vs_status vs_module_load(const char *name, const char *debian_package, void **handle, vs_error *err) {
  char relative[128], path[PATH_MAX];
  snprintf(relative, sizeof relative, "build/lib/vsss_%s.so", name);
  if (vs_path_library(relative, path, sizeof path, NULL) != VS_OK)
    return vs_fail(err, VS_FAIL, "this build has no %s support: install %s and run make again", name, debian_package);
  *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!*handle) return vs_fail(err, VS_FAIL, "%s: %s", path, dlerror());
  return VS_OK;
}
