// Builds plugins for the tests, in a folder of their own, with nothing but the compiler and the public headers.
#ifndef VSSS_TESTS_POLICY_PLUGINS_COMPILE_H
#define VSSS_TESTS_POLICY_PLUGINS_COMPILE_H

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "vsss/paths.h"

static char folder[64] = "/tmp/vsss_plugin_XXXXXX";
static char root[PATH_MAX]; // of the checkout

// tests/policy/plugins/bad.c with flags -> folder/name.so.
static inline void compile_bad(const char *name, const char *flags) {
  char command[4 * PATH_MAX];
  snprintf(command, sizeof command,
           "cd '%s' && ${CC:-cc} -O1 -w -fPIC -shared %s -Iinclude -o '%s/%s.so' tests/policy/plugins/bad.c", root,
           flags, folder, name);
  if (system(command) != 0) fail_msg("failed: %s", command);
}

// The example with its own Makefile -> folder/team.so.
static inline void compile_example(void) {
  char command[3 * PATH_MAX];
  snprintf(command, sizeof command, "make -s -C '%s/deploy/examples/plugin' OUT='%s/team.so' >&2", root, folder);
  if (system(command) != 0) fail_msg("failed: %s", command);
}

static int make_folder(void **state) {
  (void)state;
  char path[PATH_MAX];
  if (vs_path_find("tests/policy/plugins/bad.c", path, sizeof path, NULL) != VS_OK || !realpath(path, root)) return -1;
  *strstr(root, "/tests/policy/plugins") = '\0';
  if (!mkdtemp(folder)) return -1;
  compile_bad("bad", "");
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

#endif
