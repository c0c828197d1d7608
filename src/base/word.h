// One word of a short list, as users write it in flags, settings and files.
#ifndef VSSS_BASE_WORD_H
#define VSSS_BASE_WORD_H

#include "vsss/status.h"

// The place of text among words (ended by NULL) into *out. VS_USAGE "WHAT 'TEXT': expected A, B or C" leaves *out as it
// was.
vs_status vs_word_parse(const char *what, const char *text, const char *const *words, int *out, vs_error *err);

#endif
