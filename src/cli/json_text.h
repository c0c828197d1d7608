// Text as a JSON string, for all that write JSON.
#ifndef VSSS_CLI_JSON_TEXT_H
#define VSSS_CLI_JSON_TEXT_H

#include <stdio.h>

// With its quotes. UTF-8 stays as it is but for control characters; bytes that are none become U+FFFD.
void vs_json_quote(const char *text, char *out, size_t size);
void vs_json_put(FILE *out, const char *text);
// The next piece of text as it stands within the quotes; advances *text, "" at its end.
void vs_json_next(const char **text, char piece[8]);

#endif
