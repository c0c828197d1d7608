#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "vsss/number.h"

const char *vs_cli_program = "vsss";

static void print_default(const vs_flag *f) {
  if (f->type == VS_FLAG_INT) printf(" [%d]", *(const int *)f->target);
  if (f->type == VS_FLAG_REAL) printf(" [%g]", *(const double *)f->target);
  if (f->type == VS_FLAG_SEED) printf(" [%" PRIu64 "]", *(const uint64_t *)f->target);
  if (f->type == VS_FLAG_TEXT && *(const char *const *)f->target) printf(" [%s]", *(const char *const *)f->target);
}

static void print_help(const char *synopsis, const char *about, const vs_flag *flags) {
  printf("usage: vsss %s\n\n%s\n", synopsis, about);
  if (flags->name) printf("\n");
  for (const vs_flag *f = flags; f->name; f++) {
    char left[64];
    snprintf(left, sizeof left, "--%s%s%s", f->name, f->value_name ? " " : "", f->value_name ? f->value_name : "");
    printf("  %-24s %s", left, f->help);
    print_default(f);
    printf("\n");
  }
  printf("  %-24s %s\n", "--help", "this text");
}

static const vs_flag *find(const vs_flag *flags, const char *name, size_t length) {
  for (const vs_flag *f = flags; f->name; f++)
    if (strlen(f->name) == length && strncmp(f->name, name, length) == 0) return f;
  return NULL;
}

static vs_status store_number(const vs_flag *f, const char *value, vs_error *err) {
  double number = 0.0;
  int whole = 0;
  bool is_whole = f->type == VS_FLAG_INT;
  if (!(is_whole ? vs_parse_whole(value, &whole) : vs_parse_real(value, &number)))
    return vs_fail(err, VS_USAGE, "--%s %s: expected a %s", f->name, value, is_whole ? "whole number" : "number");
  if (is_whole) number = whole;
  if ((f->min != 0.0 || f->max != 0.0) && (number < f->min || number > f->max))
    return vs_fail(err, VS_USAGE, "--%s %s: allowed are %.10g to %.10g", f->name, value, f->min, f->max);
  if (is_whole)
    *(int *)f->target = whole;
  else
    *(double *)f->target = number;
  return VS_OK;
}

static vs_status store(const vs_flag *f, const char *value, vs_error *err) {
  switch (f->type) {
  case VS_FLAG_INT:
  case VS_FLAG_REAL: return store_number(f, value, err);
  case VS_FLAG_TEXT: *(const char **)f->target = value; return VS_OK;
  case VS_FLAG_SEED:
    if (vs_parse_seed(value, f->target)) return VS_OK;
    return vs_fail(err, VS_USAGE, "--%s %s: expected a whole number from 0 to 2^64-1", f->name, value);
  case VS_FLAG_LIST: {
    vs_flag_list *list = f->target;
    if (list->count == VS_FLAG_LIST_MAX)
      return vs_fail(err, VS_USAGE, "--%s: given more than %d times", f->name, VS_FLAG_LIST_MAX);
    list->value[list->count++] = value;
    return VS_OK;
  }
  case VS_FLAG_SWITCH: break;
  }
  *(bool *)f->target = true;
  return VS_OK;
}

vs_status vs_args_parse(int argc, char **argv, const char *synopsis, const char *about, const vs_flag *flags,
                        vs_flag_list *positional, bool *help, vs_error *err) {
  *help = false;
  for (int i = 1; i < argc; i++) {
    const char *word = argv[i];
    if (!strcmp(word, "--help") || !strcmp(word, "-h")) {
      print_help(synopsis, about, flags);
      *help = true;
      return VS_OK;
    }
    if (word[0] != '-' || word[1] != '-') {
      if (!positional || word[0] == '-') return vs_fail(err, VS_USAGE, "'%s' is not expected here; see --help", word);
      if (positional->count == VS_FLAG_LIST_MAX) return vs_fail(err, VS_USAGE, "more than %d words", VS_FLAG_LIST_MAX);
      positional->value[positional->count++] = word;
      continue;
    }
    const char *name = word + 2;
    size_t length = strcspn(name, "=");
    const vs_flag *f = find(flags, name, length);
    if (!f) return vs_fail(err, VS_USAGE, "unknown flag '%s'; see --help", word);
    const char *value = name[length] ? name + length + 1 : NULL;
    if (f->type == VS_FLAG_SWITCH && value) return vs_fail(err, VS_USAGE, "--%s takes no value", f->name);
    if (f->type != VS_FLAG_SWITCH && !value) {
      if (i + 1 == argc) return vs_fail(err, VS_USAGE, "--%s needs a value (%s)", f->name, f->value_name);
      value = argv[++i];
    }
    vs_status s = store(f, value, err);
    if (s != VS_OK) return s;
  }
  return VS_OK;
}

vs_status vs_cli_team(const char *flag, const char *name, vs_team *out, vs_error *err) {
  for (int t = 0; t < VS_TEAMS; t++)
    if (!strcmp(name, vs_team_name((vs_team)t))) {
      *out = (vs_team)t;
      return VS_OK;
    }
  return vs_fail(err, VS_USAGE, "%s %s: expected blue or yellow", flag, name);
}

static void add(char *out, size_t size, char c) {
  size_t used = strlen(out);
  if (used + 1 < size) out[used] = c, out[used + 1] = '\0';
}

static void add_word(char *out, size_t size, const char *word) {
  static const char *const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  bool quoted = !*word || word[strspn(word, plain)];
  if (*out) add(out, size, ' ');
  if (quoted) add(out, size, '\'');
  for (; *word; word++) {
    if (*word == '\'') // ends the quotation, adds a quote, begins anew
      add(out, size, '\''), add(out, size, '\\'), add(out, size, '\'');
    add(out, size, *word);
  }
  if (quoted) add(out, size, '\'');
}

void vs_cli_command(const char *program, int argc, const char *const *argv, char *out, size_t size) {
  out[0] = '\0';
  add_word(out, size, program);
  for (int i = 0; i < argc; i++) add_word(out, size, argv[i]);
}
