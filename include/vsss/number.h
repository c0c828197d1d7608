// Numbers as a user writes them, the same in flags, settings and files, and with a decimal point whatever locale the
// program around the library has set.
#ifndef VSSS_NUMBER_H
#define VSSS_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// The whole text must be the number; false leaves *out as it was. A real number is finite; a whole one fits an int and
// may be written as 1e3; a seed is any of 64 bits, decimal or 0x and hexadecimal.
bool vs_parse_real(const char *text, double *out);
bool vs_parse_whole(const char *text, int *out);
bool vs_parse_seed(const char *text, uint64_t *out);

// As "%g" writes it.
typedef struct vs_number_text {
  char text[32];
} vs_number_text;
vs_number_text vs_real_text(double number);

#ifdef __cplusplus
}
#endif
#endif
