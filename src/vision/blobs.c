#include "vision/blobs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double hue_deg(double b, double g, double r, double high, double chroma) {
  if (chroma <= 0.0) return 0.0;
  double h = high == r ? (g - b) / chroma : high == g ? 2.0 + (b - r) / chroma : 4.0 + (r - g) / chroma;
  return h < 0.0 ? 60.0 * h + 360.0 : 60.0 * h;
}

static bool in_range(const vs_colour *c, double b, double g, double r) {
  double high = fmax(b, fmax(g, r)), chroma = high - fmin(b, fmin(g, r));
  if (high < c->value_min || chroma < c->saturation_min * high) return false;
  double hue = hue_deg(b, g, r, high, chroma);
  if (c->hue_min_deg <= c->hue_max_deg) return hue >= c->hue_min_deg && hue <= c->hue_max_deg;
  return hue >= c->hue_min_deg || hue <= c->hue_max_deg;
}

void vs_colour_table_add(uint8_t *table, const vs_colour *colour, uint8_t bit) {
  const int levels = 1 << VS_COLOUR_BITS;
  for (int i = 0; i < VS_COLOUR_TABLE; i++) {
    // The middle of the cell, so that rounding favours no side.
    double b = ((i >> (2 * VS_COLOUR_BITS)) + 0.5) / levels, g = ((i >> VS_COLOUR_BITS) % levels + 0.5) / levels;
    double r = (i % levels + 0.5) / levels;
    if (in_range(colour, b, g, r)) table[i] |= bit;
  }
}

static inline uint8_t classes(const uint8_t *table, const uint8_t *bgr) {
  const int drop = 8 - VS_COLOUR_BITS;
  return table[(bgr[0] >> drop) << (2 * VS_COLOUR_BITS) | (bgr[1] >> drop) << VS_COLOUR_BITS | (bgr[2] >> drop)];
}

// Sums over the pixels of a blob, x and y relative to the first.
typedef struct moments {
  double n, x, y, xx, xy, yy;
} moments;

typedef struct point {
  short x, y;
} point;

struct vs_blob_finder {
  int width, height;
  int cells;       // of the grid, capacity of label and stack
  uint16_t *label; // per grid cell: 0 not of the class or not visited, else component
  int *stack;
  point *pixel; // of the component in hand
  int pixels, pixel_capacity;
};

vs_blob_finder *vs_blob_finder_new(void) { return calloc(1, sizeof(vs_blob_finder)); }

void vs_blob_finder_free(vs_blob_finder *finder) {
  if (!finder) return;
  free(finder->label);
  free(finder->stack);
  free(finder->pixel);
  free(finder);
}

static vs_status fit_to_frame(vs_blob_finder *f, const vs_frame *frame, vs_error *err) {
  if (f->width == frame->width && f->height == frame->height) return VS_OK;
  if (frame->width > 32767 || frame->height > 32767)
    return vs_fail(err, VS_FAIL, "a picture of %d x %d: at most 32767 each way", frame->width, frame->height);
  free(f->label);
  free(f->stack);
  free(f->pixel);
  f->width = f->height = 0;
  f->cells = frame->width * frame->height; // a grid step of 1 at worst
  f->pixel_capacity = f->cells;
  f->label = malloc(f->cells * sizeof *f->label);
  f->stack = malloc(f->cells * sizeof *f->stack);
  f->pixel = malloc(f->pixel_capacity * sizeof *f->pixel);
  if (!f->label || !f->stack || !f->pixel) return vs_fail(err, VS_FAIL, "out of memory for a picture");
  f->width = frame->width;
  f->height = frame->height;
  return VS_OK;
}

typedef struct grid {
  int columns, rows, step;
} grid;

// Cells of the class get UNSEEN, others 0.
#define UNSEEN 0xffff
static void classify(vs_blob_finder *f, const vs_frame *frame, const uint8_t *table, uint8_t bit, grid g) {
  for (int row = 0; row < g.rows; row++) {
    const uint8_t *in = frame->bgr + (size_t)(row * g.step + g.step / 2) * frame->bgr_stride + 3 * (g.step / 2);
    uint16_t *out = f->label + (size_t)row * g.columns;
    for (int x = 0; x < g.columns; x++, in += 3 * g.step) out[x] = classes(table, in) & bit ? UNSEEN : 0;
  }
}

typedef struct box {
  int x0, y0, x1, y1; // grid cells, inclusive
} box;

// Labels the component that holds cell start and returns its box and its number of cells.
static int flood(vs_blob_finder *f, grid g, int start, uint16_t label, box *b) {
  int depth = 0, count = 0;
  *b = (box){g.columns, g.rows, -1, -1};
  f->label[start] = label;
  f->stack[depth++] = start;
  while (depth) {
    int cell = f->stack[--depth], x = cell % g.columns, y = cell / g.columns;
    count++;
    if (x < b->x0) b->x0 = x;
    if (x > b->x1) b->x1 = x;
    if (y < b->y0) b->y0 = y;
    if (y > b->y1) b->y1 = y;
    for (int ny = y > 0 ? y - 1 : 0; ny <= y + 1 && ny < g.rows; ny++)
      for (int nx = x > 0 ? x - 1 : 0; nx <= x + 1 && nx < g.columns; nx++) {
        int next = ny * g.columns + nx;
        if (f->label[next] != UNSEEN) continue;
        f->label[next] = label;
        f->stack[depth++] = next;
      }
  }
  return count;
}

// The pixels of a component at full resolution: of the class, and not in a cell of another component.
static void collect(vs_blob_finder *f, const vs_frame *frame, const uint8_t *table, uint8_t bit, grid g, box b,
                    uint16_t label) {
  int x0 = (b.x0 - 1) * g.step, y0 = (b.y0 - 1) * g.step, x1 = (b.x1 + 2) * g.step, y1 = (b.y1 + 2) * g.step;
  if (x0 < 0) x0 = 0;
  if (y0 < 0) y0 = 0;
  if (x1 > f->width) x1 = f->width;
  if (y1 > f->height) y1 = f->height;
  f->pixels = 0;
  for (int y = y0; y < y1; y++) {
    const uint8_t *in = frame->bgr + (size_t)y * frame->bgr_stride + 3 * x0;
    int row = y / g.step < g.rows ? y / g.step : g.rows - 1;
    for (int x = x0; x < x1; x++, in += 3) {
      if (!(classes(table, in) & bit)) continue;
      int column = x / g.step < g.columns ? x / g.step : g.columns - 1;
      uint16_t owner = f->label[(size_t)row * g.columns + column];
      if (owner == label || owner == 0) f->pixel[f->pixels++] = (point){(short)x, (short)y};
    }
  }
}

static void add(moments *m, point p) {
  m->n += 1, m->x += p.x, m->y += p.y;
  m->xx += (double)p.x * p.x, m->xy += (double)p.x * p.y, m->yy += (double)p.y * p.y;
}

typedef struct axes {
  double x, y, long_px, short_px, angle; // centre; deviations along the axes; of the long one
} axes;

static axes axes_of(const moments *m) {
  double x = m->x / m->n, y = m->y / m->n;
  // A pixel has an area: its own second moment of 1/12 keeps a thin line from having none.
  double xx = m->xx / m->n - x * x + 1.0 / 12, yy = m->yy / m->n - y * y + 1.0 / 12, xy = m->xy / m->n - x * y;
  double half = 0.5 * (xx + yy), root = hypot(0.5 * (xx - yy), xy);
  return (axes){x, y, sqrt(half + root), sqrt(fmax(half - root, 1e-9)), 0.5 * atan2(2 * xy, xx - yy)};
}

// Lloyd's algorithm from starting points spread along the long axis.
static void cut(const vs_blob_finder *f, axes whole, int parts, moments *part) {
  double cx[VS_TEAM_SIZE], cy[VS_TEAM_SIZE];
  for (int k = 0; k < parts; k++) {
    double along = whole.long_px * 1.7 * (2.0 * k - parts + 1) / parts; // a bar's ends are 1.73 deviations out
    cx[k] = whole.x + along * cos(whole.angle);
    cy[k] = whole.y + along * sin(whole.angle);
  }
  for (int round = 0; round < 8; round++) {
    memset(part, 0, parts * sizeof *part);
    for (int i = 0; i < f->pixels; i++) {
      int best = 0;
      double best_d = INFINITY;
      for (int k = 0; k < parts; k++) {
        double dx = f->pixel[i].x - cx[k], dy = f->pixel[i].y - cy[k], d = dx * dx + dy * dy;
        if (d < best_d) best_d = d, best = k;
      }
      add(&part[best], f->pixel[i]);
    }
    for (int k = 0; k < parts; k++)
      if (part[k].n > 0) cx[k] = part[k].x / part[k].n, cy[k] = part[k].y / part[k].n;
  }
}

static bool accept(const vs_blob_gate *gate, const moments *m, vs_blob *out) {
  if (m->n < gate->min_px || m->n > gate->max_px) return false;
  axes a = axes_of(m);
  double elongation = a.long_px / a.short_px;
  if (elongation > gate->elongation) return false;
  double size = gate->area_px > 0 ? fmin(m->n, gate->area_px) / fmax(m->n, gate->area_px) : 1.0;
  *out = (vs_blob){a.x + 0.5, a.y + 0.5, m->n, elongation, size / elongation, a.angle};
  return true;
}

static int best_first(const void *a, const void *b) {
  const vs_blob *p = a, *q = b;
  double sp = p->confidence * sqrt(p->area_px), sq = q->confidence * sqrt(q->area_px);
  return (sp < sq) - (sp > sq);
}

static int measure(const vs_blob_finder *f, const vs_blob_gate *gate, vs_blob *out, int room) {
  moments whole = {0};
  for (int i = 0; i < f->pixels; i++) add(&whole, f->pixel[i]);
  int parts = gate->area_px > 0 && whole.n > gate->max_px ? (int)lround(whole.n / gate->area_px) : 1;
  if (parts > gate->most) return 0;
  if (parts <= 1) return whole.n > 0 && room > 0 && accept(gate, &whole, out);
  moments part[VS_TEAM_SIZE];
  cut(f, axes_of(&whole), parts, part);
  int count = 0;
  for (int k = 0; k < parts && count < room; k++) count += part[k].n > 0 && accept(gate, &part[k], &out[count]);
  return count;
}

vs_status vs_blobs_find(vs_blob_finder *f, const vs_frame *frame, const uint8_t *table, const vs_blob_gate *gate,
                        int step, vs_blob *out, int capacity, int *count, vs_error *err) {
  *count = 0;
  vs_status s = fit_to_frame(f, frame, err);
  if (s != VS_OK) return s;
  grid g = {frame->width / step, frame->height / step, step};
  classify(f, frame, table, gate->bit, g);
  // Coarse gate: a quarter of the smallest area, three (cut) times the largest; noise ends here.
  double fewest = gate->min_px / (4.0 * step * step), most = 1.5 * gate->most * gate->max_px / (step * step) + 8;
  uint16_t label = 0;
  for (int cell = 0; cell < g.columns * g.rows && label < UNSEEN - 1; cell++) {
    if (f->label[cell] != UNSEEN) continue;
    box b;
    int cells = flood(f, g, cell, ++label, &b);
    if (cells < fewest || cells > most || *count == capacity) continue;
    collect(f, frame, table, gate->bit, g, b, label);
    *count += measure(f, gate, out + *count, capacity - *count);
  }
  qsort(out, *count, sizeof *out, best_first);
  return VS_OK;
}
