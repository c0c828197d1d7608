// src/base/word.c
#include "base/word.h"

#include <stdio.h>

#include "assert_near.h"

static void a_word_is_its_place_in_the_list(void **state) {
  (void)state;
  static const char *const words[] = {"sun", "moon", "star", NULL};
  for (int i = 0; words[i]; i++) {
    int place = -1;
    assert_ok(vs_word_parse("sky", words[i], words, &place, err));
    assert_int_equal(place, i);
  }
}

static void any_other_text_is_refused_with_the_list(void **state) {
  (void)state;
  static const char *const three[] = {"sun", "moon", "star", NULL}, *const one[] = {"sun", NULL};
  static const char *const wrong[] = {"", "Sun", "sun ", "su", "suns"};
  vs_error err;
  int place = 7;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    char expected[80];
    snprintf(expected, sizeof expected, "sky '%s': expected sun, moon or star", wrong[i]);
    assert_int_equal(vs_word_parse("sky", wrong[i], three, &place, &err), VS_USAGE);
    assert_string_equal(err.text, expected);
  }
  assert_int_equal(vs_word_parse("sky", "moon", one, &place, &err), VS_USAGE);
  assert_string_equal(err.text, "sky 'moon': expected sun");
  assert_int_equal(place, 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_word_is_its_place_in_the_list),
      cmocka_unit_test(any_other_text_is_refused_with_the_list),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
