// Waiting for what the real binary says in the background, and comparing two world tables (src/cli/world_csv.h).
#ifndef VSSS_TESTS_CLI_FIELD_MATCH_H
#define VSSS_TESTS_CLI_FIELD_MATCH_H

#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <time.h>

#include "assert_near.h"
#include "run_vsss.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

// Under it a player may need longer for one answer than `field` waits, and delays are longer than they are.
static inline bool too_slow_for_real_time(void) {
#ifdef __SANITIZE_THREAD__
  print_message("note: the thread sanitizer is too slow for real time\n");
  return true;
#else
  return false;
#endif
}

static inline int wait_for_text(const char *path, const char *text, int seconds) {
  static char content[65536];
  for (int i = 0; i < 20 * seconds; i++) {
    FILE *f = fopen(path, "r");
    if (f) {
      content[fread(content, 1, sizeof content - 1, f)] = '\0';
      fclose(f);
      if (strstr(content, text)) return 1;
    }
    nanosleep(&(struct timespec){0, 50000000}, NULL);
  }
  return 0;
}

static inline const char *read_text(const char *path) {
  static char content[65536];
  FILE *f = fopen(path, "r");
  size_t n = f ? fread(content, 1, sizeof content - 1, f) : 0;
  content[n] = '\0';
  if (f) fclose(f);
  return content;
}

// The number behind the first occurrence of a text in a text; NAN: not there.
static inline double number_after(const char *content, const char *text) {
  const char *at = strstr(content, text);
  return at ? strtod(at + strlen(text), NULL) : NAN;
}

enum { ROWS_MAX = 4000, OBJECTS = 7 }; // blue0 ... yellow2, ball

typedef struct table {
  int rows;
  struct row {
    int64_t time_us;
    int event; // a referee spoke
    int valid[OBJECTS];
    double x_m[OBJECTS], y_m[OBJECTS], theta_rad[OBJECTS];
  } row[ROWS_MAX];
} table;

static inline void read_table(const char *path, table *t) {
  char line[2048];
  t->rows = 0;
  FILE *f = fopen(path, "r");
  if (!f) return;
  if (!fgets(line, sizeof line, f)) line[0] = '\0';
  while (t->rows < ROWS_MAX && fgets(line, sizeof line, f)) {
    struct row *r = &t->row[t->rows];
    char event[32];
    int used = 0;
    if (sscanf(line, "%" SCNd64 ",%*u,%31[^,]%n", &r->time_us, event, &used) < 2) continue;
    r->event = strcmp(event, "none") != 0;
    char *at = line + used;
    for (int k = 0; k < OBJECTS; k++) {
      r->valid[k] = (int)strtol(at + 1, &at, 10);
      r->x_m[k] = strtod(at + 1, &at);
      r->y_m[k] = strtod(at + 1, &at);
      r->theta_rad[k] = k < OBJECTS - 1 ? strtod(at + 1, &at) : 0.0;
    }
    t->rows++;
  }
  fclose(f);
}

static inline const struct row *row_at(const table *t, int64_t time_us) {
  for (int low = 0, high = t->rows - 1; low <= high;) {
    int middle = (low + high) / 2;
    if (t->row[middle].time_us == time_us) return &t->row[middle];
    if (t->row[middle].time_us < time_us)
      low = middle + 1;
    else
      high = middle - 1;
  }
  return NULL;
}

#endif
