#include "word.h"

#include <stdio.h>
#include <string.h>

vs_status vs_word_parse(const char *what, const char *text, const char *const *words, int *out, vs_error *err) {
  char list[160] = "";
  for (int i = 0; words[i]; i++) {
    if (!strcmp(text, words[i])) {
      *out = i;
      return VS_OK;
    }
    size_t used = strlen(list);
    const char *between = i == 0 ? "" : words[i + 1] ? ", " : " or ";
    snprintf(list + used, sizeof list - used, "%s%s", between, words[i]);
  }
  return vs_fail(err, VS_USAGE, "%s '%.80s': expected %s", what, text, list);
}
