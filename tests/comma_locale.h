// A locale with a decimal comma, as a program of the league's countries may have set it before it calls the library.
#ifndef VSSS_TESTS_COMMA_LOCALE_H
#define VSSS_TESTS_COMMA_LOCALE_H

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

#include "assert_near.h"

// Sets it for the whole program, made in a folder of its own where the system has none; skips where it cannot be made.
static inline void set_comma_locale(void) {
  if (!setlocale(LC_ALL, "pt_BR.UTF-8")) {
    char folder[] = "/tmp/vsss_locale_XXXXXX", command[128];
    assert_non_null(mkdtemp(folder));
    snprintf(command, sizeof command, "localedef -i pt_BR -f UTF-8 %s/pt_BR.UTF-8 2>/dev/null", folder);
    int made = system(command);
    setenv("LOCPATH", folder, 1);
    const char *set = made == 0 ? setlocale(LC_ALL, "pt_BR.UTF-8") : NULL;
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
    if (!set) {
      print_message("note: no locale with a decimal comma: apt install locales\n");
      skip();
    }
  }
  assert_string_equal(localeconv()->decimal_point, ",");
}

#endif
