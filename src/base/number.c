#define _GNU_SOURCE // strtod_l
#include "vsss/number.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Kept for good: threads of the host program may be using it when it ends.
static locale_t plain;
static void make_plain(void) { plain = newlocale(LC_ALL_MASK, "C", (locale_t)0); }
static locale_t plain_locale(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, make_plain);
  return plain;
}

bool vs_parse_real(const char *text, double *out) {
  char *end;
  errno = 0;
  double number = strtod_l(text, &end, plain_locale());
  // A number too small for a double is 0 or nearly so, which is what was meant.
  if (end == text || *end || !isfinite(number)) return false;
  *out = number;
  return true;
}

bool vs_parse_whole(const char *text, int *out) {
  double number;
  if (!vs_parse_real(text, &number) || number != floor(number) || number < INT_MIN || number > INT_MAX) return false;
  *out = (int)number;
  return true;
}

bool vs_parse_seed(const char *text, uint64_t *out) {
  bool hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
  const char *digits = hexadecimal ? text + 2 : text;
  for (const char *c = digits; *c; c++) // strtoull would take a sign and spaces
    if (!(hexadecimal ? isxdigit((unsigned char)*c) : isdigit((unsigned char)*c))) return false;
  errno = 0;
  unsigned long long number = strtoull(digits, NULL, hexadecimal ? 16 : 10);
  if (!*digits || errno) return false;
  *out = number;
  return true;
}

vs_number_text vs_real_text(double number) {
  vs_number_text out;
  locale_t theirs = uselocale(plain_locale());
  snprintf(out.text, sizeof out.text, "%g", number);
  uselocale(theirs);
  return out;
}
