// src/base/paths.c
#include "assert_near.h"
#include "vsss/paths.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void a_file_of_the_checkout_is_found_from_a_test_deep_below_it(void **state) {
  (void)state;
  char path[4096];
  assert_ok(vs_path_find("models/vsss_contact.xml", path, sizeof path, err));
  assert_int_equal(access(path, R_OK), 0);
}

static void vsss_home_is_looked_at_first(void **state) {
  (void)state;
  char home[] = "paths_home_XXXXXX", file[64], path[4096];
  assert_non_null(mkdtemp(home));
  snprintf(file, sizeof file, "%s/Makefile", home);
  FILE *f = fopen(file, "w");
  assert_non_null(f);
  fclose(f);
  setenv("VSSS_HOME", home, 1);
  assert_ok(vs_path_find("Makefile", path, sizeof path, err));
  assert_string_equal(path, file);
  unsetenv("VSSS_HOME");
  unlink(file);
  rmdir(home);
}

static void a_file_that_is_nowhere_is_named_with_the_places_tried(void **state) {
  (void)state;
  char path[4096];
  vs_error err = {0};
  assert_int_equal(vs_path_find("models/nothing.xml", path, sizeof path, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "models/nothing.xml: not found (tried "));
  assert_non_null(strstr(err.text, "set VSSS_HOME"));
}

static void a_path_longer_than_the_buffer_is_refused(void **state) {
  (void)state;
  char path[8];
  vs_error err = {0};
  assert_int_equal(vs_path_find("models/vsss_contact.xml", path, sizeof path, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "path too long"));
}

static void a_folder_of_ones_own_is_made_private_and_others_are_refused(void **state) {
  (void)state;
  char home[] = "paths_own_XXXXXX", made[64], slash[80], link[64];
  int fd = -1;
  vs_error err = {0};
  assert_non_null(mkdtemp(home));
  snprintf(made, sizeof made, "%s/made", home);
  snprintf(slash, sizeof slash, "%s/link/", home);
  snprintf(link, sizeof link, "%s/link", home);
  assert_int_equal(vs_path_own_folder(made, false, &fd, &err), VS_FAIL);
  assert_ok(vs_path_own_folder(made, true, &fd, err));
  close(fd);
  struct stat info;
  assert_int_equal(stat(made, &info), 0);
  assert_int_equal(info.st_mode & 0777, 0700);
  assert_ok(vs_path_own_folder(made, true, &fd, err)); // once more: it is there
  close(fd);
  assert_int_equal(symlink("made", link), 0);
  assert_int_equal(vs_path_own_folder(slash, true, &fd, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "is a link"));
  assert_int_equal(chmod(made, 0720), 0);
  assert_int_equal(vs_path_own_folder(made, true, &fd, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "others may write into it"));
  assert_int_equal(vs_path_own_folder("", true, &fd, &err), VS_USAGE);
  unlink(link);
  rmdir(made);
  rmdir(home);
}

static void a_module_that_was_not_built_names_the_package(void **state) {
  (void)state;
  void *handle = NULL;
  vs_error err = {0};
  assert_int_equal(vs_module_load("no_such", "libnosuch-dev", &handle, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "install libnosuch-dev and run make again"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_of_the_checkout_is_found_from_a_test_deep_below_it),
      cmocka_unit_test(vsss_home_is_looked_at_first),
      cmocka_unit_test(a_file_that_is_nowhere_is_named_with_the_places_tried),
      cmocka_unit_test(a_path_longer_than_the_buffer_is_refused),
      cmocka_unit_test(a_folder_of_ones_own_is_made_private_and_others_are_refused),
      cmocka_unit_test(a_module_that_was_not_built_names_the_package),
  };
  return cmocka_run_group_tests_name("base/paths", tests, NULL, NULL);
}
