#include "vsss/journal.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tensorboard.h"
#include "vsss/clock.h"
#include "vsss/file.h"

struct vs_journal {
  FILE *progress, *eval, *events;
  char folder[PATH_MAX - 64];
};

// Keeps the header and the lines whose first number is at most `update`. A file that is not there stays so.
static vs_status drop_later_lines(const char *path, double update, vs_error *err) {
  FILE *f = fopen(path, "rb");
  if (!f) return VS_OK;
  vs_bytes kept = {0};
  char line[4096];
  for (bool header = true; fgets(line, sizeof line, f); header = false) {
    bool whole = strchr(line, '\n') != NULL; // a crash may have cut off the last
    if (whole && (header || strtod(line, NULL) <= update)) vs_bytes_append(&kept, line, strlen(line));
  }
  fclose(f);
  vs_status s =
      kept.failed ? vs_fail(err, VS_FAIL, "%s: out of memory", path) : vs_file_replace(path, kept.data, kept.size, err);
  vs_bytes_free(&kept);
  return s;
}

// Opens folder/name for appending; tells whether it was empty.
static vs_status open_csv(vs_journal *j, const char *name, double update, FILE **out, bool *empty, vs_error *err) {
  char path[PATH_MAX];
  snprintf(path, sizeof path, "%s/%s", j->folder, name);
  vs_status s = update > 0.0 ? drop_later_lines(path, update, err) : VS_OK;
  if (s != VS_OK) return s;
  *out = fopen(path, update > 0.0 ? "ab" : "wb");
  if (!*out) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  fseek(*out, 0, SEEK_END);
  *empty = ftell(*out) == 0;
  return VS_OK;
}

static vs_status flush(vs_journal *j, FILE *f, vs_error *err) {
  if (fflush(f) == 0 && !ferror(f)) return VS_OK;
  return vs_fail(err, VS_FAIL, "%s: %s", j->folder, strerror(errno));
}

static vs_status write_bytes(vs_journal *j, vs_bytes *bytes, vs_error *err) {
  vs_status s = bytes->failed ? vs_fail(err, VS_FAIL, "%s: out of memory", j->folder) : VS_OK;
  if (s == VS_OK) fwrite(bytes->data, 1, bytes->size, j->events);
  vs_bytes_free(bytes);
  return s == VS_OK ? flush(j, j->events, err) : s;
}

static double now_s(void) { return 1e-6 * (double)vs_clock_wall_us(); }

// Rows under the header of another version would stand in the wrong columns: its table is put aside, under .old.
static vs_status put_aside_other_columns(const vs_journal *j, vs_error *err) {
  char path[PATH_MAX], old[PATH_MAX + 8], line[4096], header[4096] = "";
  int count;
  size_t used = 0;
  const vs_train_column *column = vs_train_columns(&count);
  for (int i = 0; i < count && used < sizeof header; i++)
    used += (size_t)snprintf(header + used, sizeof header - used, "%s%c", column[i].name, i + 1 < count ? ',' : '\n');
  snprintf(path, sizeof path, "%s/progress.csv", j->folder);
  snprintf(old, sizeof old, "%s.old", path);
  FILE *f = fopen(path, "r");
  if (!f) return VS_OK;
  bool other = fgets(line, sizeof line, f) && strcmp(line, header) != 0;
  fclose(f);
  if (other && rename(path, old) != 0) return vs_fail(err, VS_FAIL, "%s: %s", old, strerror(errno));
  return VS_OK;
}

static vs_status begin_files(vs_journal *j, double update, vs_error *err) {
  bool empty;
  vs_status s = update > 0.0 ? put_aside_other_columns(j, err) : VS_OK;
  if (s == VS_OK) s = open_csv(j, "progress.csv", update, &j->progress, &empty, err);
  if (s != VS_OK) return s;
  int count;
  const vs_train_column *column = vs_train_columns(&count);
  for (int i = 0; empty && i < count; i++) fprintf(j->progress, "%s%c", column[i].name, i + 1 < count ? ',' : '\n');
  s = open_csv(j, "eval.csv", update, &j->eval, &empty, err);
  if (s != VS_OK) return s;
  if (empty)
    fprintf(j->eval, "update,transitions,wall_s,opponent,matches,win,draw,loss,goals_for,goals_against,score,score_low,"
                     "score_high\n");
  s = flush(j, j->progress, err);
  if (s == VS_OK) s = flush(j, j->eval, err);
  if (s != VS_OK) return s;
  // A new file for every start, as TensorBoard wants it.
  char path[PATH_MAX];
  snprintf(path, sizeof path, "%s/events.out.tfevents.%lld.vsss", j->folder, (long long)now_s());
  j->events = fopen(path, "wb");
  if (!j->events) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  vs_bytes bytes = {0};
  vs_tensorboard_begin(&bytes, now_s());
  return write_bytes(j, &bytes, err);
}

vs_status vs_journal_open(const char *folder, double update, vs_journal **out, vs_error *err) {
  *out = NULL;
  vs_journal *j = calloc(1, sizeof *j);
  if (!j) return vs_fail(err, VS_FAIL, "out of memory");
  vs_status s = VS_OK;
  if ((size_t)snprintf(j->folder, sizeof j->folder, "%s", folder) >= sizeof j->folder)
    s = vs_fail(err, VS_FAIL, "%.300s: path too long", folder);
  if (s == VS_OK) s = begin_files(j, update, err);
  if (s != VS_OK) {
    vs_journal_close(j);
    return s;
  }
  *out = j;
  return VS_OK;
}

void vs_journal_close(vs_journal *journal) {
  if (!journal) return;
  if (journal->progress) fclose(journal->progress);
  if (journal->eval) fclose(journal->eval);
  if (journal->events) fclose(journal->events);
  free(journal);
}

vs_status vs_journal_add(vs_journal *journal, const vs_train_report *report, vs_error *err) {
  int count;
  const vs_train_column *column = vs_train_columns(&count);
  vs_bytes summary = {0}, bytes = {0};
  for (int i = 0; i < count; i++) {
    double value = vs_train_value(report, &column[i]);
    if (isfinite(value)) fprintf(journal->progress, "%.9g", value); // what was not measured is an empty cell
    fputc(i + 1 < count ? ',' : '\n', journal->progress);
    if (isfinite(value)) vs_tensorboard_scalar(&summary, column[i].tag, value);
  }
  vs_tensorboard_event(&bytes, now_s(), (int64_t)report->transitions, &summary);
  vs_status s = flush(journal, journal->progress, err);
  return s == VS_OK ? write_bytes(journal, &bytes, err) : (vs_bytes_free(&bytes), s);
}

vs_status vs_journal_add_eval(vs_journal *journal, const vs_train_report *report, const vs_train_score *score,
                              vs_error *err) {
  fprintf(journal->eval, "%.0f,%.0f,%.1f,%s,%.0f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", report->update,
          report->transitions, report->wall_s, score->opponent, score->matches, score->win, score->draw, score->loss,
          score->goals_for, score->goals_against, score->score, score->score_low, score->score_high);
  vs_bytes summary = {0}, bytes = {0};
  const struct {
    const char *name;
    double value;
  } scalars[] = {{"win", score->win}, {"draw", score->draw}, {"loss", score->loss}, {"score", score->score}};
  for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
    char tag[160];
    snprintf(tag, sizeof tag, "eval/%.100s %s", score->opponent, scalars[i].name);
    vs_tensorboard_scalar(&summary, tag, scalars[i].value);
  }
  vs_tensorboard_event(&bytes, now_s(), (int64_t)report->transitions, &summary);
  vs_status s = flush(journal, journal->eval, err);
  return s == VS_OK ? write_bytes(journal, &bytes, err) : (vs_bytes_free(&bytes), s);
}
