// Tags on an A4 sheet at true size: a list of rectangles and captions in millimetres, and a writer per file format.
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "vsss/field.h"
#include "vsss/image.h"
#include "vsss/mark.h"
#include "vsss/tag.h"

enum { PAGE_W = 210, PAGE_H = 297, MARGIN = 12, GAP = 10, MOST_TAGS = 64 };

typedef void paint_fn(void *to, double x_mm, double y_mm, double w_mm, double h_mm, const uint8_t rgb[3]);

static const uint8_t black[3] = {0, 0, 0}, white[3] = {255, 255, 255};
static const char bar_text[] = "100 mm: measure it after printing, at 100 %, cut along the grey lines";

typedef struct sheet {
  const char *family;
  int count, columns, rows;
  double paper_mm;  // of the pattern
  double margin_mm; // light paper around it that belongs to the mark; cut along its outer edge
  int id[MOST_TAGS];
  vs_tag_pattern tag[MOST_TAGS];
} sheet;

// Where tag i's pattern begins, from the page's top left.
static void place(const sheet *s, int i, double *x_mm, double *y_mm) {
  *x_mm = MARGIN + s->margin_mm + (i % s->columns) * (s->paper_mm + 2 * s->margin_mm + GAP);
  *y_mm = MARGIN + s->margin_mm + (i / s->columns) * (s->paper_mm + 2 * s->margin_mm + GAP);
}

static bool is_plate(const sheet *s) { return !strcmp(s->family, vs_mark_name(VS_MARK_COLOUR)); }

// The team whose mark it is by the league's rules, or -1.
static int team_of(const sheet *s, int id) {
  if (is_plate(s)) return id / 100;
  for (int k = 0; k < VS_TEAMS * VS_TEAM_SIZE && !strcmp(s->family, VS_TAG_ARUCO); k++)
    if (vs_aruco_league_id[k / VS_TEAM_SIZE][k % VS_TEAM_SIZE] == id) return k / VS_TEAM_SIZE;
  return -1;
}

// Runs of cells of one kind in a row: fewer rectangles, and no seams between them.
static void paint_cells(const sheet *s, int i, bool light, const uint8_t rgb[3], paint_fn *paint, void *to) {
  const vs_tag_pattern *t = &s->tag[i];
  double x, y, cell = s->paper_mm / t->cells;
  place(s, i, &x, &y);
  for (int row = 0; row < t->cells; row++)
    for (int from = 0; from < t->cells;) {
      int end = from;
      while (end < t->cells && (t->cell[row][end] != 0) == light) end++;
      if (end > from) paint(to, x + from * cell, y + row * cell, (end - from) * cell, cell, rgb);
      from = end + 1;
    }
}

// A colour plate on black, scaled from its 65 mm.
static void paint_plate(const sheet *s, int i, paint_fn *paint, void *to) {
  double x, y, square = s->paper_mm * VS_PLATE_SQUARE_M / VS_PLATE_SIDE_M, far = s->paper_mm - square;
  place(s, i, &x, &y);
  paint(to, x - s->margin_mm, y - s->margin_mm, s->paper_mm + 2 * s->margin_mm, s->paper_mm + 2 * s->margin_mm, black);
  paint(to, x, y + far, s->paper_mm, square, vs_team_rgb[s->id[i] / 100]);
  paint(to, x, y, square, square, vs_plate_rgb[s->id[i] / 10 % 10]);
  paint(to, x + far, y, square, square, vs_plate_rgb[s->id[i] % 10]);
}

// Paper is white. The league's blue marks are white on blue, its yellow ones yellow on black.
static void paint_tag(const sheet *s, int i, paint_fn *paint, void *to) {
  int team = team_of(s, s->id[i]);
  if (is_plate(s)) {
    paint_plate(s, i, paint, to);
    return;
  }
  if (team < 0) {
    paint_cells(s, i, false, black, paint, to);
    return;
  }
  double x, y; // the dark ground whole, the light cells upon it: no seams
  place(s, i, &x, &y);
  paint(to, x, y, s->paper_mm, s->paper_mm, team == VS_BLUE ? vs_team_rgb[VS_BLUE] : black);
  paint_cells(s, i, true, team == VS_BLUE ? white : vs_team_rgb[VS_YELLOW], paint, to);
}

static void caption(const sheet *s, int i, char *out, size_t size) {
  int team = team_of(s, s->id[i]);
  char plate[32] = "";
  if (is_plate(s))
    snprintf(plate, sizeof plate, " %s %s", vs_plate_colour_name((vs_plate_colour)(s->id[i] / 10 % 10)),
             vs_plate_colour_name((vs_plate_colour)(s->id[i] % 10)));
  snprintf(out, size, "%s %d%s%s%s, %g mm, this edge to the rear", s->family, s->id[i], team >= 0 ? " " : "",
           team >= 0 ? vs_team_name((vs_team)team) : "", plate, s->paper_mm);
}

// PDF counts in points from the bottom left.
static double pt(double mm) { return mm * 72 / 25.4; }

static void pdf_rectangle(void *to, double x, double y, double w, double h, const uint8_t rgb[3]) {
  fprintf(to, "%.3f %.3f %.3f rg %.4f %.4f %.4f %.4f re f\n", rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0, pt(x),
          pt(PAGE_H - y - h), pt(w), pt(h));
}

static void pdf_text(FILE *f, double x_mm, double y_mm, const char *text) {
  fprintf(f, "0 g BT /F 7 Tf %.3f %.3f Td (%s) Tj ET\n", pt(x_mm), pt(PAGE_H - y_mm), text);
}

// The line to cut along, and outside of it an arrow head at the edge that goes to the robot's front.
static void pdf_outline(FILE *f, const sheet *s, double x, double y) {
  double side = s->paper_mm + 2 * s->margin_mm, left = x - s->margin_mm, top = y - s->margin_mm;
  fprintf(f, "0.6 G 0.3 w %.4f %.4f %.4f %.4f re S\n", pt(left), pt(PAGE_H - top - side), pt(side), pt(side));
  double middle = left + 0.5 * side;
  fprintf(f, "0.4 g %.4f %.4f m %.4f %.4f l %.4f %.4f l f\n", pt(middle - 2), pt(PAGE_H - top + 1), pt(middle + 2),
          pt(PAGE_H - top + 1), pt(middle), pt(PAGE_H - top + 4));
  pdf_text(f, middle + 3, top - 1, "front");
}

static void pdf_page(FILE *f, const sheet *s) {
  for (int i = 0; i < s->count; i++) {
    double x, y;
    char text[128];
    place(s, i, &x, &y);
    paint_tag(s, i, pdf_rectangle, f);
    pdf_outline(f, s, x, y);
    caption(s, i, text, sizeof text);
    pdf_text(f, x - s->margin_mm, y + s->paper_mm + s->margin_mm + 4, text);
  }
  pdf_rectangle(f, MARGIN, PAGE_H - 9, 100, 1, black);
  pdf_text(f, MARGIN + 102, PAGE_H - 8, bar_text);
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
static void png_rectangle(void *to, double x, double y, double w, double h, const uint8_t rgb[3]) {
  const double dots = DOTS_W / (double)PAGE_W;
  for (long row = lround(y * dots); row < lround((y + h) * dots) && row < DOTS_H; row++) {
    uint8_t *bgr = (uint8_t *)to + 3 * (row * DOTS_W + lround(x * dots));
    for (long n = lround((x + w) * dots) - lround(x * dots); n > 0; n--, bgr += 3)
      bgr[0] = rgb[2], bgr[1] = rgb[1], bgr[2] = rgb[0];
  }
}

// Its upper left corner at a place of the page, as large as its width allows, at most 1.8 mm high.
static void png_text(uint8_t *bgr, double x_mm, double y_mm, double width_mm, const char *text) {
  const double dots = DOTS_W / (double)PAGE_W;
  vs_image page = {bgr, DOTS_W, DOTS_H, 3 * DOTS_W};
  int dot_px = (int)(width_mm * dots / (6.0 * (double)strlen(text)));
  vs_image_text(&page, (int)lround(x_mm * dots), (int)lround(y_mm * dots),
                dot_px < 1   ? 1
                : dot_px > 3 ? 3
                             : dot_px,
                text, black);
}

// As in the PDF; the line to cut along lies just outside of the mark, in dashes: a closed one would be a mark's border to `detect`.
static void png_outline(uint8_t *bgr, const sheet *s, int i) {
  static const uint8_t grey[3] = {153, 153, 153};
  const double line = 0.2, dash = 2, side = s->paper_mm + 2 * s->margin_mm;
  double x, y;
  char text[128];
  place(s, i, &x, &y);
  x -= s->margin_mm, y -= s->margin_mm;
  for (double along = 0; along < side; along += 2 * dash) {
    double length = fmin(dash, side - along);
    png_rectangle(bgr, x + along, y - line, length, line, grey);
    png_rectangle(bgr, x + along, y + side, length, line, grey);
    png_rectangle(bgr, x - line, y + along, line, length, grey);
    png_rectangle(bgr, x + side, y + along, line, length, grey);
  }
  for (double up = 1; up < 4; up += line) // an arrow head, 4 mm wide where it begins
    png_rectangle(bgr, x + 0.5 * side - (4 - up) * 2 / 3, y - up - line, (4 - up) * 4 / 3, line, grey);
  png_text(bgr, x + 0.5 * side + 3, y - 3, 20, "front");
  caption(s, i, text, sizeof text);
  png_text(bgr, x, y + side + 1.5, side, text);
}

static vs_status write_png(const char *path, const sheet *s, vs_error *err) {
  uint8_t *bgr = malloc(3 * (size_t)DOTS_W * DOTS_H);
  if (!bgr) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  memset(bgr, 255, 3 * (size_t)DOTS_W * DOTS_H);
  for (int i = 0; i < s->count; i++) {
    paint_tag(s, i, png_rectangle, bgr);
    png_outline(bgr, s, i);
  }
  png_rectangle(bgr, MARGIN, PAGE_H - 9, 100, 1, black);
  png_text(bgr, MARGIN + 102, PAGE_H - 9.5, PAGE_W - 2 * MARGIN - 102, bar_text);
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
  if (!strcmp(family, VS_TAG_ARUCO)) s->margin_mm = s->paper_mm * VS_ARUCO_MARGIN_M / VS_ARUCO_SIDE_M;
  if (is_plate(s)) s->margin_mm = s->paper_mm * 0.5 * (VS_ROBOT_SIZE_M / VS_PLATE_SIDE_M - 1);
  if (s->paper_mm + 2 * s->margin_mm > PAGE_W - 2 * MARGIN)
    return vs_fail(err, VS_USAGE, "marks of %g mm are %.0f mm wide with their margin: a sheet holds %d mm", s->paper_mm,
                   s->paper_mm + 2 * s->margin_mm, PAGE_W - 2 * MARGIN);
  s->columns = (int)((PAGE_W - 2 * MARGIN + GAP) / (s->paper_mm + 2 * s->margin_mm + GAP));
  s->rows = (int)((PAGE_H - MARGIN - 16 + GAP) / (s->paper_mm + 2 * s->margin_mm + GAP)); // 16: a caption, the bar
  if (s->columns == 0) s->columns = 1;
  int most = s->columns * s->rows < MOST_TAGS ? s->columns * s->rows : MOST_TAGS;
  if (count < 1 || count > most)
    return vs_fail(err, VS_USAGE, "%d tags of %g mm: a sheet holds 1 to %d", count, s->paper_mm, most);
  s->count = count;
  vs_status status = VS_OK;
  for (int i = 0; i < count && status == VS_OK; i++) {
    s->id[i] = ids[i];
    vs_mark_picture unused;
    status = is_plate(s) ? vs_mark_paint(VS_MARK_COLOUR, VS_BLUE, ids[i], &unused, err)
                         : vs_tag_pattern_of(family, ids[i], &s->tag[i], err);
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
