// src/base/file.c
#define _GNU_SOURCE // syscall
#include "vsss/file.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "assert_near.h"
#include "test_folder.h"

// Stand before the C library's, and note what they are asked for.
static int synced;           // since the last rename
static int renamed_unsynced; // files put in place before they were on the disk
int fsync(int file) {
  synced++;
  return (int)syscall(SYS_fsync, file);
}
int rename(const char *from, const char *to) {
  renamed_unsynced += synced == 0;
  synced = 0;
  return (int)syscall(SYS_renameat2, -100 /* AT_FDCWD */, from, -100, to, 0);
}

static char *text_of(const char *path, char *out, size_t size) {
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  out[fread(out, 1, size - 1, file)] = '\0';
  fclose(file);
  return out;
}

static void a_file_is_replaced_whole_and_nothing_is_left_beside_it(void **state) {
  (void)state;
  char path[128], beside[160], text[64] = "";
  vs_error err = {0};
  struct stat about;
  snprintf(path, sizeof path, "%s/a file", folder);
  snprintf(beside, sizeof beside, "%s.tmp", path);
  assert_int_equal(vs_file_replace(path, "a long first text", 17, &err), VS_OK);
  assert_int_equal(vs_file_replace(path, "second", 6, &err), VS_OK);
  assert_string_equal(text_of(path, text, sizeof text), "second");
  assert_int_not_equal(stat(beside, &about), 0);
}

static void a_write_that_fails_keeps_the_old_file_and_names_it(void **state) {
  (void)state;
  static char large[20000];
  char path[128], beside[160], text[64] = "";
  vs_error err = {0};
  struct stat about;
  struct rlimit old, small;
  snprintf(path, sizeof path, "%s/kept", folder);
  snprintf(beside, sizeof beside, "%s.tmp", path);
  assert_int_equal(vs_file_replace(path, "old", 3, &err), VS_OK);
  // A file size limit stands for the full disk: write(2) fails in the same way once the signal is ignored.
  void (*was)(int) = signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 8192;
  setrlimit(RLIMIT_FSIZE, &small);
  vs_status s = vs_file_replace(path, large, sizeof large, &err);
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, was);
  assert_int_equal(s, VS_FAIL);
  assert_non_null(strstr(err.text, path));
  assert_string_equal(text_of(path, text, sizeof text), "old");
  assert_int_not_equal(stat(beside, &about), 0);
}

static void a_file_is_on_the_disk_before_it_takes_the_others_place(void **state) {
  (void)state;
  char path[128];
  vs_error err = {0};
  snprintf(path, sizeof path, "%s/synced", folder);
  renamed_unsynced = 0;
  for (int i = 0; i < 3; i++) assert_int_equal(vs_file_replace(path, "text", 4, &err), VS_OK);
  assert_int_equal(renamed_unsynced, 0);
}

static void a_folder_that_is_not_there_is_an_error(void **state) {
  (void)state;
  char path[128];
  vs_error err = {0};
  snprintf(path, sizeof path, "%s/none/file", folder);
  assert_int_equal(vs_file_replace(path, "x", 1, &err), VS_FAIL);
  assert_non_null(strstr(err.text, path));
}

// Somebody left a link at the temporary name: what it points to is not written into, nor anything through it.
static void a_link_beside_is_not_followed(void **state) {
  (void)state;
  char path[128], beside[160], victim[160], text[64] = "";
  vs_error err = {0};
  struct stat about;
  snprintf(path, sizeof path, "%s/plain", folder);
  snprintf(beside, sizeof beside, "%s.tmp", path);
  snprintf(victim, sizeof victim, "%s/victim", folder);
  assert_int_equal(vs_file_replace(victim, "precious", 8, &err), VS_OK);
  assert_int_equal(symlink(victim, beside), 0);
  assert_int_equal(vs_file_replace(path, "new", 3, &err), VS_OK);
  assert_string_equal(text_of(path, text, sizeof text), "new");
  assert_string_equal(text_of(victim, text, sizeof text), "precious");
  assert_int_equal(lstat(path, &about), 0);
  assert_true(S_ISREG(about.st_mode));
}

static void what_a_dead_writer_left_is_no_hindrance(void **state) {
  (void)state;
  char path[128], beside[160], text[64] = "";
  vs_error err = {0};
  snprintf(path, sizeof path, "%s/after a crash", folder);
  snprintf(beside, sizeof beside, "%s.tmp", path);
  FILE *half = fopen(beside, "w");
  assert_non_null(half);
  fputs("half of something longer", half);
  fclose(half);
  assert_int_equal(vs_file_replace(path, "whole", 5, &err), VS_OK);
  assert_string_equal(text_of(path, text, sizeof text), "whole");
}

static void a_file_keeps_its_mode(void **state) {
  (void)state;
  char path[128];
  vs_error err = {0};
  struct stat about;
  snprintf(path, sizeof path, "%s/mode", folder);
  mode_t before = umask(022);
  assert_int_equal(vs_file_replace(path, "a", 1, &err), VS_OK);
  assert_int_equal(stat(path, &about), 0);
  assert_int_equal(about.st_mode & 0777, 0644);
  assert_int_equal(chmod(path, 0600), 0); // a radio's key in it
  assert_int_equal(vs_file_replace(path, "b", 1, &err), VS_OK);
  umask(before);
  assert_int_equal(stat(path, &about), 0);
  assert_int_equal(about.st_mode & 0777, 0600);
}

static void a_file_is_created_only_where_there_is_none(void **state) {
  (void)state;
  char path[128], link[128], text[64] = "";
  vs_error err = {0};
  struct stat about;
  snprintf(path, sizeof path, "%s/created", folder);
  snprintf(link, sizeof link, "%s/dangling", folder);
  assert_int_equal(vs_file_create(path, "first", 5, &err), VS_OK);
  assert_int_equal(stat(path, &about), 0);
  assert_int_equal(about.st_mode & 0777, 0600);
  assert_int_equal(vs_file_create(path, "second", 6, &err), VS_FAIL);
  assert_non_null(strstr(err.text, path));
  assert_string_equal(text_of(path, text, sizeof text), "first");
  assert_int_equal(symlink("nowhere", link), 0);
  assert_int_equal(vs_file_create(link, "x", 1, &err), VS_FAIL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_file_is_replaced_whole_and_nothing_is_left_beside_it),
      cmocka_unit_test(a_write_that_fails_keeps_the_old_file_and_names_it),
      cmocka_unit_test(a_file_is_on_the_disk_before_it_takes_the_others_place),
      cmocka_unit_test(a_link_beside_is_not_followed),
      cmocka_unit_test(what_a_dead_writer_left_is_no_hindrance),
      cmocka_unit_test(a_file_keeps_its_mode),
      cmocka_unit_test(a_file_is_created_only_where_there_is_none),
      cmocka_unit_test(a_folder_that_is_not_there_is_an_error),
  };
  return cmocka_run_group_tests_name("base/file", tests, make_folder, remove_folder);
}
