// src/base/config.c
#include "assert_near.h"
#include "test_folder.h"
#include "vsss/config.h"

#include <stdio.h>
#include <string.h>

typedef struct settings {
  int envs;
  double rate;
  bool noise;
  char name[8];
} settings;

static settings value;
static const vs_config_key schema[] = {
    {"train.envs", VS_CONFIG_INT, &value.envs, 0, 1, 1000, "matches at once"},
    {"train.rate", VS_CONFIG_REAL, &value.rate, 0, 0, 0, "learning rate"},
    {"noise", VS_CONFIG_BOOL, &value.noise, 0, 0, 0, "sensor noise"},
    {"name", VS_CONFIG_TEXT, value.name, sizeof value.name, 0, 0, "of the run"},
    {"train.matches", VS_CONFIG_ALIAS, NULL, 0, 0, 0, "train.envs"},
    {NULL, VS_CONFIG_INT, NULL, 0, 0, 0, NULL},
};

static void sections_comments_and_all_types_are_read(void **state) {
  (void)state;
  memset(&value, 0, sizeof value);
  assert_ok(vs_config_parse("a.ini", "# first\nnoise = yes ; on\nname= abc \n\n[train]\nenvs = 20\nrate = 4e-4\n",
                            schema, err));
  assert_int_equal(value.envs, 20);
  assert_near(value.rate, 4e-4, 0);
  assert_true(value.noise);
  assert_string_equal(value.name, "abc");
}

static void refused(const char *text, const char *message) {
  vs_error err = {0};
  assert_int_equal(vs_config_parse("a.ini", text, schema, &err), VS_USAGE);
  if (!strstr(err.text, message)) fail_msg("expected '%s' in: %s", message, err.text);
}

static void unknown_key_names_file_line_key_and_the_nearest(void **state) {
  (void)state;
  refused("[train]\n\nenv = 3\n", "a.ini:3: unknown key 'train.env' (did you mean 'train.envs'?)");
}

static void an_older_name_sets_the_key_as_it_is_called_now(void **state) {
  (void)state;
  assert_ok(vs_config_parse("a.ini", "[train]\nmatches = 30\n", schema, err));
  assert_int_equal(value.envs, 30);
  refused("[train]\nmatches = 0\n", "a.ini:2: train.envs = 0: allowed are 1 to 1000");
  refused("[train]\nmatche = 3\n",
          "unknown key 'train.matche' (did you mean 'train.rate'?)"); // old names are not proposed
}

static void bad_values_name_the_value_and_what_is_allowed(void **state) {
  (void)state;
  refused("[train]\nenvs = 0\n", "a.ini:2: train.envs = 0: allowed are 1 to 1000");
  refused("[train]\nenvs = 2.5\n", "a.ini:2: train.envs = 2.5: expected a whole number");
  refused("[train]\nrate = nan\n", "train.rate = nan: expected a number");
  refused("noise = maybe\n", "noise = maybe: expected true or false");
  refused("name = 12345678\n", "name: longer than 7 characters");
  refused("noise\n", "a.ini:1: 'noise': expected key = value");
  refused("[train\n", "a.ini:1: '[train': expected [section]");
}

static void a_quoted_value_holds_any_character(void **state) {
  (void)state;
  assert_ok(vs_config_parse("a.ini", "name = \"#a;b \" ; comment\n", schema, err));
  assert_string_equal(value.name, "#a;b ");
  assert_ok(vs_config_parse("a.ini", "name=\"\\\"\\\\\\n\\r\"# comment\n", schema, err));
  assert_string_equal(value.name, "\"\\\n\r");
  assert_ok(vs_config_parse("a.ini", "name = \"\"\n", schema, err));
  assert_string_equal(value.name, "");
  refused("name = \"abc\n", "a.ini:1: name: expected a closing \"");
  refused("name = \"a\" b\n", "expected a closing \" and nothing after it");
  for (int c = 1; c < 256; c++) { // alone, first, in the middle, last
    char text[8] = {0}, quoted[32], line[64];
    for (int place = 0; place < 4; place++) {
      snprintf(text, sizeof text, "%s%c%s", place > 1 ? "a" : "", c, place % 2 ? "b" : "");
      vs_config_quote(text, quoted, sizeof quoted);
      snprintf(line, sizeof line, "name = %s\n", quoted);
      assert_ok(vs_config_parse("a.ini", line, schema, err));
      if (strcmp(value.name, text)) fail_msg("character %d: %s", c, line);
    }
  }
}

static void a_key_sign_in_a_comment_is_no_key(void **state) {
  (void)state;
  assert_ok(vs_config_parse("a.ini", "# name = x\n; a = b\n[train] # a = 3\nenvs = 5 # = 6\n", schema, err));
  assert_int_equal(value.envs, 5);
}

static void assignment_sets_a_key(void **state) {
  (void)state;
  assert_ok(vs_config_set("train.envs=7", schema, err));
  assert_int_equal(value.envs, 7);
  vs_error err = {0};
  assert_int_equal(vs_config_set("train.envs", schema, &err), VS_USAGE);
}

static void missing_file_is_named(void **state) {
  (void)state;
  vs_error err = {0};
  assert_int_equal(vs_config_load("no/such.ini", schema, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "no/such.ini: No such file"));
}

static void what_is_no_text_file_is_refused(void **state) {
  (void)state;
  vs_error err = {0};
  assert_int_equal(vs_config_load("/dev/zero", schema, &err), VS_USAGE); // it would be read until memory is full
  assert_non_null(strstr(err.text, "/dev/zero: more than 1048576 bytes"));
  char path[96];
  snprintf(path, sizeof path, "%s/zero.ini", folder);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  static const char text[] = "name = a\n\0name = b\n"; // what follows the zero would not be read
  assert_int_equal(fwrite(text, 1, sizeof text - 1, file), sizeof text - 1);
  assert_int_equal(fclose(file), 0);
  assert_int_equal(vs_config_load(path, schema, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "holds a zero byte"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_comments_and_all_types_are_read),
      cmocka_unit_test(unknown_key_names_file_line_key_and_the_nearest),
      cmocka_unit_test(an_older_name_sets_the_key_as_it_is_called_now),
      cmocka_unit_test(bad_values_name_the_value_and_what_is_allowed),
      cmocka_unit_test(a_quoted_value_holds_any_character),
      cmocka_unit_test(a_key_sign_in_a_comment_is_no_key),
      cmocka_unit_test(assignment_sets_a_key),
      cmocka_unit_test(missing_file_is_named),
      cmocka_unit_test(what_is_no_text_file_is_refused),
  };
  return cmocka_run_group_tests_name("base/config", tests, make_folder, remove_folder);
}
