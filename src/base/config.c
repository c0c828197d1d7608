#include "vsss/config.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/number.h"

static int edit_distance(const char *a, const char *b) {
  size_t n = strlen(a), m = strlen(b);
  int row[128];
  if (m >= sizeof row / sizeof *row) return 1000;
  for (size_t j = 0; j <= m; j++) row[j] = (int)j;
  for (size_t i = 1; i <= n; i++) {
    int diagonal = row[0];
    row[0] = (int)i;
    for (size_t j = 1; j <= m; j++) {
      int up = row[j];
      int best = diagonal + (a[i - 1] != b[j - 1]);
      if (up + 1 < best) best = up + 1;
      if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
      row[j] = best;
      diagonal = up;
    }
  }
  return row[m];
}

static const vs_config_key *nearest(const char *name, const vs_config_key *schema) {
  const vs_config_key *best = NULL;
  int best_distance = 1 << 20;
  for (const vs_config_key *k = schema; k->name; k++) {
    if (k->type == VS_CONFIG_ALIAS) continue;
    int d = edit_distance(name, k->name);
    if (d < best_distance) best_distance = d, best = k;
  }
  return best;
}

static char *trim(char *text) {
  while (isspace((unsigned char)*text)) text++;
  size_t n = strlen(text);
  while (n && isspace((unsigned char)text[n - 1])) text[--n] = '\0';
  return text;
}

static bool limited(const vs_config_key *k) { return k->min != 0.0 || k->max != 0.0; }

static vs_status store_number(const char *where, const vs_config_key *k, const char *value, vs_error *err) {
  double number = 0.0;
  int whole = 0;
  bool is_whole = k->type == VS_CONFIG_INT;
  if (!(is_whole ? vs_parse_whole(value, &whole) : vs_parse_real(value, &number)))
    return vs_fail(err, VS_USAGE, "%s: %s = %s: expected a %s", where, k->name, value,
                   is_whole ? "whole number" : "number");
  if (is_whole) number = whole;
  if (limited(k) && (number < k->min || number > k->max))
    return vs_fail(err, VS_USAGE, "%s: %s = %s: allowed are %.10g to %.10g", where, k->name, value, k->min, k->max);
  if (is_whole)
    *(int *)k->target = whole;
  else
    *(double *)k->target = number;
  return VS_OK;
}

static const vs_config_key *find(const char *name, const vs_config_key *schema) {
  const vs_config_key *k = schema;
  while (k->name && strcmp(k->name, name) != 0) k++;
  return k->name && k->type == VS_CONFIG_ALIAS ? find(k->help, schema) : k;
}

static vs_status store(const char *where, const char *name, const char *value, const vs_config_key *schema,
                       vs_error *err) {
  const vs_config_key *k = find(name, schema);
  if (!k->name) {
    const vs_config_key *near = nearest(name, schema);
    return vs_fail(err, VS_USAGE, "%s: unknown key '%s' (did you mean '%s'?)", where, name, near ? near->name : "?");
  }
  switch (k->type) {
  case VS_CONFIG_INT:
  case VS_CONFIG_REAL: return store_number(where, k, value, err);
  case VS_CONFIG_SEED:
    if (vs_parse_seed(value, k->target)) return VS_OK;
    return vs_fail(err, VS_USAGE, "%s: %s = %s: expected a whole number from 0 to 2^64-1", where, name, value);
  case VS_CONFIG_BOOL:
    if (!strcmp(value, "true") || !strcmp(value, "yes") || !strcmp(value, "on") || !strcmp(value, "1"))
      *(bool *)k->target = true;
    else if (!strcmp(value, "false") || !strcmp(value, "no") || !strcmp(value, "off") || !strcmp(value, "0"))
      *(bool *)k->target = false;
    else
      return vs_fail(err, VS_USAGE, "%s: %s = %s: expected true or false", where, name, value);
    return VS_OK;
  case VS_CONFIG_TEXT:
    if (strlen(value) >= k->text_size)
      return vs_fail(err, VS_USAGE, "%s: %s: longer than %zu characters", where, name, k->text_size - 1);
    memcpy(k->target, value, strlen(value) + 1);
    return VS_OK;
  case VS_CONFIG_ALIAS: break;
  }
  return vs_fail(err, VS_FAIL, "%s: %s: unknown type in the schema", where, name);
}

// Reads a quoted value in place, from its first quote on; false where the closing one is missing or more than a comment
// follows it.
static bool unquote(char *text) {
  char *to = text, *from = text + 1;
  while (*from && *from != '"') {
    if (*from == '\\' && from[1]) {
      from++;
      *to++ = *from == 'n' ? '\n' : *from == 'r' ? '\r' : *from;
    } else {
      *to++ = *from;
    }
    from++;
  }
  if (*from != '"') return false;
  char *rest = trim(from + 1);
  bool ends = *rest == '\0' || *rest == '#' || *rest == ';';
  *to = '\0';
  return ends;
}

void vs_config_quote(const char *value, char *out, size_t size) {
  size_t n = strlen(value), used = 0;
  bool plain = strcspn(value, "#;\"\\\n\r") == n &&
               (n == 0 || (!isspace((unsigned char)value[0]) && !isspace((unsigned char)value[n - 1])));
  if (size == 0) return;
  if (!plain && used + 1 < size) out[used++] = '"';
  for (; *value && used + 1 < size; value++) {
    bool escaped = !plain && strchr("\"\\\n\r", *value);
    if (escaped) out[used++] = '\\';
    if (used + 1 < size) out[used++] = !escaped ? *value : *value == '\n' ? 'n' : *value == '\r' ? 'r' : *value;
  }
  if (!plain && used + 1 < size) out[used++] = '"';
  out[used] = '\0';
}

static vs_status parse_line(const char *file, int number, char *line, char *section, size_t section_size,
                            const vs_config_key *schema, vs_error *err) {
  char where[300];
  snprintf(where, sizeof where, "%.256s:%d", file, number);
  char *equals = strchr(line, '=');
  bool assigns = equals && strcspn(line, "#;[") > (size_t)(equals - line);
  char *value = NULL;
  if (assigns) {
    *equals = '\0';
    value = equals + 1;
    while (isspace((unsigned char)*value)) value++;
  }
  if (value && *value == '"') {
    if (!unquote(value))
      return vs_fail(err, VS_USAGE, "%s: %s: expected a closing \" and nothing after it", where, trim(line));
  } else {
    char *comment = strpbrk(value ? value : line, "#;");
    if (comment) *comment = '\0';
    if (value) value = trim(value);
  }
  char *text = trim(line);
  if (!assigns && !*text) return VS_OK;
  if (!assigns && *text == '[') {
    char *close = strchr(text, ']');
    if (!close || close[1]) return vs_fail(err, VS_USAGE, "%s: '%s': expected [section]", where, text);
    *close = '\0';
    snprintf(section, section_size, "%s", trim(text + 1));
    return VS_OK;
  }
  if (!assigns) return vs_fail(err, VS_USAGE, "%s: '%s': expected key = value", where, text);
  char name[200];
  snprintf(name, sizeof name, "%.90s%s%.90s", section, *section ? "." : "", text);
  return store(where, name, value, schema, err);
}

vs_status vs_config_parse(const char *name_for_errors, const char *text, const vs_config_key *schema, vs_error *err) {
  char section[96] = "";
  int number = 0;
  while (*text) {
    size_t n = strcspn(text, "\n");
    char line[1024];
    number++;
    if (n >= sizeof line)
      return vs_fail(err, VS_USAGE, "%s:%d: line longer than %zu characters", name_for_errors, number, sizeof line - 1);
    memcpy(line, text, n);
    line[n] = '\0';
    vs_status s = parse_line(name_for_errors, number, line, section, sizeof section, schema, err);
    if (s != VS_OK) return s;
    text += n + (text[n] == '\n');
  }
  return VS_OK;
}

vs_status vs_config_load(const char *path, const vs_config_key *schema, vs_error *err) {
  FILE *f = fopen(path, "rb");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  char *text = malloc(VS_CONFIG_FILE_MAX + 1);
  if (!text) {
    fclose(f);
    return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  }
  size_t used = fread(text, 1, VS_CONFIG_FILE_MAX + 1, f);
  int failed = ferror(f) ? errno : 0;
  fclose(f);
  vs_status s = VS_OK;
  if (failed)
    s = vs_fail(err, VS_FAIL, "%s: %s", path, strerror(failed));
  else if (used > VS_CONFIG_FILE_MAX)
    s = vs_fail(err, VS_USAGE, "%s: more than %d bytes: not a file of settings", path, VS_CONFIG_FILE_MAX);
  else if (memchr(text, 0, used))
    s = vs_fail(err, VS_USAGE, "%s: holds a zero byte: not a text file", path);
  if (s == VS_OK) {
    text[used] = '\0';
    s = vs_config_parse(path, text, schema, err);
  }
  free(text);
  return s;
}

vs_status vs_config_set(const char *assignment, const vs_config_key *schema, vs_error *err) {
  char copy[1024];
  if (strlen(assignment) >= sizeof copy)
    return vs_fail(err, VS_USAGE, "'%.60s...': longer than %zu characters", assignment, sizeof copy - 1);
  snprintf(copy, sizeof copy, "%s", assignment);
  char *equals = strchr(copy, '=');
  if (!equals) return vs_fail(err, VS_USAGE, "'%s': expected key=value", assignment);
  *equals = '\0';
  return store("command line", trim(copy), trim(equals + 1), schema, err);
}
