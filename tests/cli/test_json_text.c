// src/cli/json_text.c
#include <string.h>

#include "assert_near.h"
#include "cli/json_text.h"

static void every_text_is_a_json_string(void **state) {
  (void)state;
  static const char *const rows[][2] = {
      {"", "\"\""},
      {"a b", "\"a b\""},
      {"\"\\/", "\"\\\"\\\\/\""},
      {"\n\033\x7f", "\"\\u000a\\u001b\\u007f\""},
      {"Jo\xc3\xa3o", "\"Jo\xc3\xa3o\""},
      {"\xc2\x9b"
       "1",
       "\"\\u009b1\""},
      {"\xff\xc3", "\"\\ufffd\\ufffd\""},            // no UTF-8, cut short
      {"\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\""}, // a surrogate
      {"\xf0\x9f\x98\x80", "\"\xf0\x9f\x98\x80\""},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char out[64];
    vs_json_quote(rows[i][0], out, sizeof out);
    assert_string_equal(out, rows[i][1]);
  }
}

static void what_does_not_fit_is_cut_between_characters_and_closed(void **state) {
  (void)state;
  char out[16];
  for (size_t size = 0; size <= sizeof out; size++) {
    memset(out, 'x', sizeof out);
    vs_json_quote("ab\n\"c", out, size);
    size_t n = size ? strlen(out) : 0;
    assert_true(n <= size);
    if (size >= 3) assert_true(out[0] == '"' && out[n - 1] == '"');
    if (size == 11) assert_string_equal(out, "\"ab\\u000a\"");
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_text_is_a_json_string),
      cmocka_unit_test(what_does_not_fit_is_cut_between_characters_and_closed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
