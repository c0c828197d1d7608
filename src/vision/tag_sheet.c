// Tags on an A4 sheet at true size: a list of rectangles and captions in millimetres, and a writer per file format.
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "vsss/image.h"
#include "vsss/tag.h"

enum { PAGE_W = 210, PAGE_H = 297, MARGIN = 12, GAP = 10, MOST_TAGS = 64 };

// Where tag i's paper begins, from the page's top left.
typedef struct sheet {
  const char *family;
  int count, columns, rows;
  double paper_mm;
  int id[MOST_TAGS];
  vs_tag_pattern tag[MOST_TAGS];
} sheet;

static void place(const sheet *s, int i, double *x_mm, double *y_mm) {
  *x_mm = MARGIN + (i % s->columns) * (s->paper_mm + GAP);
  *y_mm = MARGIN + (i / s->columns) * (s->paper_mm + GAP);
}

// Calls paint for every run of black cells in a row: fewer and seamless rectangles.
static void for_each_black(const sheet *s, void (*paint)(void *to, double x, double y, double w, double h), void *to) {
  for (int i = 0; i < s->count; i++) {
    const vs_tag_pattern *t = &s->tag[i];
    double x, y, cell = s->paper_mm / t->cells;
    place(s, i, &x, &y);
    for (int row = 0; row < t->cells; row++)
      for (int from = 0; from < t->cells;) {
        int end = from;
        while (end < t->cells && !t->cell[row][end]) end++;
        if (end > from) paint(to, x + from * cell, y + row * cell, (end - from) * cell, cell);
        from = end + 1;
      }
  }
}

static void caption(const sheet *s, int i, char *out, size_t size) {
  snprintf(out, size, "%s %d, %g mm, this edge to the rear", s->family, s->id[i], s->paper_mm);
}

// PDF counts in points from the bottom left.
static double pt(double mm) { return mm * 72 / 25.4; }

static void pdf_black(void *to, double x, double y, double w, double h) {
  fprintf(to, "%.4f %.4f %.4f %.4f re f\n", pt(x), pt(PAGE_H - y - h), pt(w), pt(h));
}

static void pdf_text(FILE *f, double x_mm, double y_mm, const char *text) {
  fprintf(f, "BT /F 7 Tf %.3f %.3f Td (%s) Tj ET\n", pt(x_mm), pt(PAGE_H - y_mm), text);
}

static void pdf_page(FILE *f, const sheet *s) {
  for_each_black(s, pdf_black, f);
  for (int i = 0; i < s->count; i++) {
    double x, y;
    char text[128];
    place(s, i, &x, &y);
    caption(s, i, text, sizeof text);
    fprintf(f, "0.6 G 0.3 w %.4f %.4f %.4f %.4f re S\n", pt(x), pt(PAGE_H - y - s->paper_mm), pt(s->paper_mm),
            pt(s->paper_mm));
    pdf_text(f, x, y + s->paper_mm + 4, text);
  }
  pdf_black(f, MARGIN, PAGE_H - 9, 100, 1);
  pdf_text(f, MARGIN + 102, PAGE_H - 8, "100 mm: measure it after printing");
}

static bool write_pdf(FILE *f, const sheet *s) {
  char *page = NULL;
  size_t length = 0;
  FILE *memory = open_memstream(&page, &length);
  if (!memory) return false;
  pdf_page(memory, s);
  fclose(memory);
  long at[6];
  fprintf(f, "%%PDF-1.4\n");
  at[1] = ftell(f);
  fprintf(f, "1 0 obj << /Type /Catalog /Pages 2 0 R >> endobj\n");
  at[2] = ftell(f);
  fprintf(f, "2 0 obj << /Type /Pages /Kids [3 0 R] /Count 1 >> endobj\n");
  at[3] = ftell(f);
  fprintf(f,
          "3 0 obj << /Type /Page /Parent 2 0 R /MediaBox [0 0 %.3f %.3f] /Contents 4 0 R "
          "/Resources << /Font << /F 5 0 R >> >> >> endobj\n",
          pt(PAGE_W), pt(PAGE_H));
  at[4] = ftell(f);
  fprintf(f, "4 0 obj << /Length %zu >> stream\n%sendstream endobj\n", length, page);
  at[5] = ftell(f);
  fprintf(f, "5 0 obj << /Type /Font /Subtype /Type1 /BaseFont /Helvetica >> endobj\n");
  long xref = ftell(f);
  fprintf(f, "xref\n0 6\n0000000000 65535 f \n");
  for (int i = 1; i < 6; i++) fprintf(f, "%010ld 00000 n \n", at[i]);
  fprintf(f, "trailer << /Size 6 /Root 1 0 R >>\nstartxref\n%ld\n%%%%EOF\n", xref);
  free(page);
  return true;
}

enum { DOTS_W = 2480, DOTS_H = 3508 }; // A4 at 300 dots per inch
static void png_black(void *to, double x, double y, double w, double h) {
  const double dots = DOTS_W / (double)PAGE_W;
  for (long row = lround(y * dots); row < lround((y + h) * dots) && row < DOTS_H; row++)
    memset((uint8_t *)to + 3 * (row * DOTS_W + lround(x * dots)), 0,
           3 * (size_t)(lround((x + w) * dots) - lround(x * dots)));
}

static vs_status write_png(const char *path, const sheet *s, vs_error *err) {
  uint8_t *bgr = malloc(3 * (size_t)DOTS_W * DOTS_H);
  if (!bgr) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  memset(bgr, 255, 3 * (size_t)DOTS_W * DOTS_H);
  for_each_black(s, png_black, bgr);
  png_black(bgr, MARGIN, PAGE_H - 9, 100, 1);
  vs_status status = vs_image_save(path, bgr, 3 * DOTS_W, DOTS_W, DOTS_H, err);
  free(bgr);
  return status;
}

static vs_status save_pdf(const char *path, const sheet *s, vs_error *err) {
  FILE *f = fopen(path, "w");
  if (!f) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  bool whole = write_pdf(f, s) && !ferror(f);
  if (fclose(f) || !whole) return vs_fail(err, VS_FAIL, "%s: %s", path, strerror(errno));
  return VS_OK;
}

static vs_status lay_out(sheet *s, const char *family, const int *ids, int count, double paper_m, vs_error *err) {
  s->family = family;
  s->paper_mm = 1000 * paper_m;
  if (!(s->paper_mm >= 10 && s->paper_mm <= PAGE_W - 2 * MARGIN))
    return vs_fail(err, VS_USAGE, "tags of %g mm: allowed are 10 to %d", s->paper_mm, PAGE_W - 2 * MARGIN);
  s->columns = (int)((PAGE_W - 2 * MARGIN + GAP) / (s->paper_mm + GAP));
  s->rows = (int)((PAGE_H - 2 * MARGIN - 4) / (s->paper_mm + GAP));
  int most = s->columns * s->rows < MOST_TAGS ? s->columns * s->rows : MOST_TAGS;
  if (count < 1 || count > most)
    return vs_fail(err, VS_USAGE, "%d tags of %g mm: a sheet holds 1 to %d", count, s->paper_mm, most);
  s->count = count;
  vs_status status = VS_OK;
  for (int i = 0; i < count && status == VS_OK; i++) {
    s->id[i] = ids[i];
    status = vs_tag_pattern_of(family, ids[i], &s->tag[i], err);
  }
  return status;
}

vs_status vs_tag_sheet(const char *path, const char *family, const int *ids, int count, double paper_m, vs_error *err) {
  const char *ending = strrchr(path, '.');
  bool pdf = ending && !strcasecmp(ending, ".pdf");
  if (!pdf && !(ending && !strcasecmp(ending, ".png")))
    return vs_fail(err, VS_USAGE, "%s: a sheet of tags ends in .pdf or .png", path);
  sheet *s = calloc(1, sizeof *s);
  if (!s) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  vs_status status = lay_out(s, family, ids, count, paper_m, err);
  if (status == VS_OK) status = pdf ? save_pdf(path, s, err) : write_png(path, s, err);
  free(s);
  return status;
}
