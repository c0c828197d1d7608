// lcm-spy with our types. Debian's own launcher does not start (it passes a flag that Java dropped) and would not see
// our types, so Java is started here; their jar is made once for each version of lcm_types.
#define _XOPEN_SOURCE 700 // nftw
#define _DEFAULT_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "child.h"
#include "spy.h"
#include "vsss/bus.h"
#include "vsss/paths.h"

#define LCM_JAR   "/usr/share/java/lcm.jar"
#define CHART_JAR "/usr/share/java/jchart2d.jar"

enum { PATH = 512, ARGUMENTS_MAX = 64 };

// Runs a program, its standard output on our standard error; VS_FAIL: missing (names the package) or failed.
static vs_status run(char *const argv[], const char *debian_package, vs_error *err) {
  const vs_child_def def = {.argv = argv, .out = STDERR_FILENO};
  pid_t child;
  int failed = vs_child_start(&def, &child);
  if (failed == ENOENT) return vs_fail(err, VS_FAIL, "%s is missing: install %s", argv[0], debian_package);
  if (failed) return vs_fail(err, VS_FAIL, "%s: %s", argv[0], strerror(failed));
  if (vs_child_wait(child) != 0) return vs_fail(err, VS_FAIL, "%s failed; what it said is above", argv[0]);
  return VS_OK;
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *walk) {
  (void)info, (void)kind, (void)walk;
  return remove(path);
}

// Appends what pattern finds to argv; the names live in found.
static vs_status append(const char *pattern, glob_t *found, char *argv[], int *n, vs_error *err) {
  if (glob(pattern, 0, NULL, found) != 0) return vs_fail(err, VS_FAIL, "%s: nothing there", pattern);
  for (size_t i = 0; i < found->gl_pathc && *n < ARGUMENTS_MAX - 1; i++) argv[(*n)++] = found->gl_pathv[i];
  argv[*n] = NULL;
  return VS_OK;
}

// lcm_types/*.lcm -> Java sources -> classes -> jar, all within folder.
static vs_status make_jar(const char *types, const char *folder, vs_error *err) {
  char pattern[PATH + 16], classes[PATH + 16], jar[PATH + 16];
  char *argv[ARGUMENTS_MAX] = {"lcm-gen", "-j", "--jpath", (char *)folder, NULL};
  int n = 4;
  glob_t found = {0};
  snprintf(pattern, sizeof pattern, "%s/*.lcm", types);
  vs_status s = append(pattern, &found, argv, &n, err);
  if (s == VS_OK) s = run(argv, "liblcm-bin", err);
  globfree(&found);
  if (s != VS_OK) return s;

  snprintf(classes, sizeof classes, "%s/classes", folder);
  snprintf(pattern, sizeof pattern, "%s/vsss/*.java", folder);
  s = vs_path_make_folder(classes, 0777, err);
  if (s != VS_OK) return s;
  char *compile[ARGUMENTS_MAX] = {"javac", "-nowarn", "-cp", LCM_JAR, "-d", classes, NULL};
  n = 6;
  memset(&found, 0, sizeof found);
  s = append(pattern, &found, compile, &n, err);
  if (s == VS_OK) s = run(compile, "default-jdk-headless", err);
  globfree(&found);
  if (s != VS_OK) return s;

  snprintf(jar, sizeof jar, "%s/types.jar", folder);
  char *pack[] = {"jar", "cf", jar, "-C", classes, ".", NULL};
  return run(pack, "default-jdk-headless", err);
}

// Hash of all type files, so that a changed type makes another jar.
static vs_status hash_types(const char *types, uint64_t *hash, vs_error *err) {
  char pattern[PATH + 16];
  snprintf(pattern, sizeof pattern, "%s/*.lcm", types);
  glob_t found = {0};
  if (glob(pattern, 0, NULL, &found) != 0) return vs_fail(err, VS_FAIL, "%s: nothing there", pattern);
  *hash = VS_HASH_START;
  for (size_t i = 0; i < found.gl_pathc; i++) {
    FILE *f = fopen(found.gl_pathv[i], "rb");
    char bytes[4096];
    for (size_t n; f && (n = fread(bytes, 1, sizeof bytes, f)) > 0;) *hash = vs_hash_bytes(*hash, bytes, n);
    if (f) fclose(f);
  }
  globfree(&found);
  return VS_OK;
}

// Java runs what lies there: nobody but the user may have put it there.
static vs_status cache_folder(char *cache, size_t size, vs_error *err) {
  const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  if (base && *base)
    snprintf(cache, size, "%s/vsss", base);
  else if (home && *home)
    snprintf(cache, size, "%s/.cache/vsss", home);
  else
    snprintf(cache, size, "/tmp/vsss-cache-%u", (unsigned)geteuid());
  vs_status s = vs_path_make_folder(cache, 0700, err);
  int folder = -1;
  if (s == VS_OK) s = vs_path_own_folder(cache, false, &folder, err);
  if (folder >= 0) close(folder);
  return s;
}

static vs_status find_jar(char *jar, size_t size, vs_error *err) {
  char types[PATH], cache[PATH], work[PATH], made[PATH + 16];
  vs_status s = vs_path_find("lcm_types/world_t.lcm", types, sizeof types, err);
  if (s != VS_OK) return s;
  *strrchr(types, '/') = '\0';
  uint64_t hash = 0;
  s = hash_types(types, &hash, err);
  if (s == VS_OK) s = cache_folder(cache, sizeof cache, err);
  if (s != VS_OK) return s;
  snprintf(jar, size, "%.400s/types-%016llx.jar", cache, (unsigned long long)hash);
  if (access(jar, R_OK) == 0) return VS_OK;

  snprintf(work, sizeof work, "%.400s/types-XXXXXX", cache);
  if (!mkdtemp(work)) return vs_fail(err, VS_FAIL, "%s: %s", work, strerror(errno));
  s = make_jar(types, work, err);
  snprintf(made, sizeof made, "%s/types.jar", work);
  if (s == VS_OK && rename(made, jar) != 0) s = vs_fail(err, VS_FAIL, "%s: %s", jar, strerror(errno));
  nftw(work, remove_one, 8, FTW_DEPTH | FTW_PHYS);
  return s;
}

static bool any(const char *pattern) {
  glob_t found = {0};
  bool there = glob(pattern, 0, NULL, &found) == 0;
  globfree(&found);
  return there;
}

vs_status spy_window(const char *url, vs_error *err) {
  const char *display = getenv("DISPLAY");
  if (!display || !*display)
    return vs_fail(err, VS_FAIL, "no display for a window (DISPLAY is not set): 'vsss spy --print' needs none");
  if (access(LCM_JAR, R_OK) != 0 || access(CHART_JAR, R_OK) != 0)
    return vs_fail(err, VS_FAIL, "lcm-spy is missing: install liblcm-java libjchart2d-java default-jre");
  if (any("/usr/lib/jvm") && !any("/usr/lib/jvm/*/lib/libawt_xawt.so"))
    return vs_fail(err, VS_FAIL, "this Java has no windows: install default-jre, or use 'vsss spy --print'");
  char jar[PATH], path[PATH + 128];
  vs_status s = find_jar(jar, sizeof jar, err);
  if (s != VS_OK) return s;
  setenv("LCM_DEFAULT_URL", url, 1);
  snprintf(path, sizeof path, "%s:%s:%s", LCM_JAR, CHART_JAR, jar);
  char *argv[] = {"java", "-Djava.net.preferIPv4Stack=true", "-cp", path, "lcm.spy.Spy", NULL};
  execvp(argv[0], argv);
  return vs_fail(err, VS_FAIL, "java: %s: install default-jre", strerror(errno));
}
