// Colours into a copy of the field's configuration: line by line, so that its other words and comments stay.
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/colours.h"
#include "vsss/file.h"

enum { MOST_KEYS = 32 };
typedef struct key {
  char name[32];
  double value;
  bool written;
} key;

static int range_keys(key *out, const char *name, const vs_colour *c) {
  static const char *const ends[] = {"hue_min_deg", "hue_max_deg", "saturation_min", "value_min"};
  const double value[] = {c->hue_min_deg, c->hue_max_deg, c->saturation_min, c->value_min};
  for (int i = 0; i < 4; i++) {
    out[i] = (key){.value = value[i]};
    snprintf(out[i].name, sizeof out[i].name, "%s_%s", name, ends[i]);
  }
  return 4;
}

static int all_keys(const vs_detector_def *def, key *out) {
  int n = range_keys(out, "ball", &def->ball);
  n += range_keys(out + n, "blue", &def->team[VS_BLUE]);
  n += range_keys(out + n, "yellow", &def->team[VS_YELLOW]);
  for (int i = 0; i < VS_PLATE_COLOURS; i++) {
    const char *name = vs_plate_colour_name((vs_plate_colour)i);
    out[n].value = def->square[i].hue_deg, out[n].written = false;
    snprintf(out[n++].name, sizeof out->name, "%s_hue_deg", name);
    out[n].value = def->square[i].saturation, out[n].written = false;
    snprintf(out[n++].name, sizeof out->name, "%s_saturation", name);
  }
  return n;
}

static void put(FILE *out, const key *k, const char *comment) {
  char value[32];
  snprintf(value, sizeof value, "%.3g", k->value);
  fprintf(out, "%s = %s%s%s\n", k->name, value, *comment ? " " : "", comment);
}

// What of the keys has not been written yet: at the end of the section.
static void put_rest(FILE *out, key *keys, int count) {
  for (int i = 0; i < count; i++)
    if (!keys[i].written) put(out, &keys[i], ""), keys[i].written = true;
}

static void copy_line(FILE *out, const char *line, key *keys, int count) {
  size_t length = strcspn(line, " \t=;#\n");
  for (int i = 0; i < count; i++) {
    if (strlen(keys[i].name) != length || strncmp(line, keys[i].name, length)) continue;
    char comment[256] = "";
    size_t at = strcspn(line, ";#");
    snprintf(comment, sizeof comment, "%.*s", (int)strcspn(line + at, "\r\n"), line + at);
    if (!keys[i].written) put(out, &keys[i], comment);
    keys[i].written = true;
    return;
  }
  fputs(line, out);
}

static void copy(FILE *in, FILE *out, key *keys, int count) {
  char line[1024];
  bool inside = false, ever = false, ended = true;
  while (fgets(line, sizeof line, in)) {
    ended = strchr(line, '\n') != NULL;
    if (line[0] == '[') {
      if (inside) put_rest(out, keys, count);
      inside = !strncmp(line, "[vision]", 8);
      ever = ever || inside;
    }
    if (inside)
      copy_line(out, line, keys, count);
    else
      fputs(line, out);
  }
  if (!ended) fputc('\n', out);
  if (!ever) fputs("\n[vision]\n", out);
  put_rest(out, keys, count);
}

vs_status vs_colours_save(const char *path, const char *from, const vs_detector_def *def, vs_error *err) {
  key keys[MOST_KEYS];
  int count = all_keys(def, keys);
  FILE *in = fopen(from, "r");
  if (!in) return vs_fail(err, VS_FAIL, "%s: %s", from, strerror(errno));
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (out) copy(in, out, keys, count);
  fclose(in);
  if (!out || fclose(out)) {
    free(text);
    return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  }
  vs_status s = vs_file_replace(path, text, size, err);
  free(text);
  return s;
}
