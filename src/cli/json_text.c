#include "json_text.h"

#include <stdbool.h>
#include <string.h>

// Bytes of the UTF-8 character that text begins with; 0: it is none.
static size_t utf8_length(const unsigned char *text) {
  size_t length = text[0] < 0x80                      ? 1
                  : text[0] >= 0xC2 && text[0] < 0xE0 ? 2
                  : text[0] >= 0xE0 && text[0] < 0xF0 ? 3
                  : text[0] >= 0xF0 && text[0] < 0xF5 ? 4
                                                      : 0;
  for (size_t i = 1; i < length; i++)
    if (text[i] < 0x80 || text[i] >= 0xC0) return 0;
  bool overlong = (text[0] == 0xE0 && text[1] < 0xA0) || (text[0] == 0xF0 && text[1] < 0x90);
  bool beyond = (text[0] == 0xED && text[1] >= 0xA0) || (text[0] == 0xF4 && text[1] >= 0x90); // surrogates, > U+10FFFF
  return overlong || beyond ? 0 : length;
}

void vs_json_next(const char **text, char piece[8]) {
  const unsigned char *c = (const unsigned char *)*text;
  size_t length = *c ? utf8_length(c) : 0;
  piece[0] = '\0';
  if (!*c) return;
  if (length == 0)
    snprintf(piece, 8, "\\ufffd");
  else if (*c == '"' || *c == '\\')
    snprintf(piece, 8, "\\%c", *c);
  else if (*c < 0x20 || *c == 0x7F)
    snprintf(piece, 8, "\\u%04x", *c);
  else if (*c == 0xC2 && c[1] < 0xA0) // U+0080 to U+009F, which a terminal would obey
    snprintf(piece, 8, "\\u%04x", c[1]);
  else
    snprintf(piece, 8, "%.*s", (int)length, (const char *)c);
  *text += length ? length : 1;
}

void vs_json_quote(const char *text, char *out, size_t size) {
  if (size < 3) {
    if (size) out[0] = '\0';
    return;
  }
  size_t used = 1;
  out[0] = '"';
  char piece[8];
  for (vs_json_next(&text, piece); piece[0]; vs_json_next(&text, piece)) {
    size_t n = strlen(piece);
    if (used + n + 2 > size) break; // the closing quote fits in any case
    memcpy(out + used, piece, n);
    used += n;
  }
  memcpy(out + used, "\"", 2);
}

void vs_json_put(FILE *out, const char *text) {
  fputc('"', out);
  char piece[8];
  for (vs_json_next(&text, piece); piece[0]; vs_json_next(&text, piece)) fputs(piece, out);
  fputc('"', out);
}
