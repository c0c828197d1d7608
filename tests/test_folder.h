// A folder of its own under /tmp for a test program, as the group set-up and tear-down of cmocka.
#ifndef VSSS_TESTS_TEST_FOLDER_H
#define VSSS_TESTS_TEST_FOLDER_H

#include <stdio.h>
#include <stdlib.h>

static char folder[64];

static inline int make_folder(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/vsss_test_XXXXXX");
  return mkdtemp(folder) ? 0 : -1;
}

// What is in the folder's file, as far as it fits; "" where there is none. Good until the next call.
static inline const char *folder_file(const char *name) {
  static char text[65536];
  char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "r");
  size_t n = f ? fread(text, 1, sizeof text - 1, f) : 0;
  if (f) fclose(f);
  text[n] = '\0';
  return text;
}

static inline int remove_folder(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command) == 0 ? 0 : -1;
}

#endif
