#include "vsss/number.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool vs_parse_real(const char *text, double *out) {
  char *end;
  errno = 0;
  double number = strtod(text, &end);
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
