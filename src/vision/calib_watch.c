#include "vsss/calib_watch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/field.h"

enum { MOST_POINTS = 800, BLOCK = 4, TURNS = 9, MODELS = 2 };
#define SPACING_M     0.02
#define TURN_STEP_RAD 0.0175 // 1 degree, to 4 each side
// The found place's mean contrast over that of all places: real lines reach 3 to 6, a picture of nothing 1.4 at most.
#define STANDS_OUT     2.0
#define EDGE           15  // grey levels that a line or wall differs from the floor by
#define SHARE          0.6 // of the points that must show it
#define SHARE_OF_WALLS 0.8 // straight edges along a field are many
// Another place is believed if it fits that much better than where the calibration has it.
#define BETTER 1.25

typedef struct model {
  int points;
  double x_m[MOST_POINTS], y_m[MOST_POINTS];
} model;

typedef struct place {
  double score;
  int dx, dy, turn; // px, px, index
} place;

struct vs_calib_watch {
  vs_calib calib;
  double px_per_m;
  model model[MODELS]; // lines, walls
  int width, height, columns, rows;
  uint8_t *contrast; // [height][width]: of a pixel's surroundings
  uint8_t *coarse;   // [rows][columns]: largest of a block and its neighbours
  // Where the points lie in the picture, for each turn; only those that do.
  int count[MODELS][TURNS];
  short x[MODELS][TURNS][MOST_POINTS], y[MODELS][TURNS][MOST_POINTS];
};

static void add(model *m, double x, double y) {
  if (m->points < MOST_POINTS) m->x_m[m->points] = x, m->y_m[m->points++] = y;
}

static void add_line(model *m, double x0, double y0, double x1, double y1) {
  int steps = (int)(hypot(x1 - x0, y1 - y0) / SPACING_M);
  for (int i = 0; i <= steps; i++) add(m, x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps);
}

static void make_models(vs_calib_watch *w) {
  const double l = VS_FIELD_HALF_LENGTH_M, h = VS_FIELD_HALF_WIDTH_M, g = VS_GOAL_HALF_WIDTH_M,
               a = VS_AREA_HALF_WIDTH_M, d = l - VS_AREA_DEPTH_M, c = VS_CORNER_M;
  model *lines = &w->model[0], *walls = &w->model[1];
  add_line(lines, 0, -h, 0, h);
  for (double t = 0; t < 2 * M_PI; t += SPACING_M / VS_CIRCLE_RADIUS_M)
    add(lines, VS_CIRCLE_RADIUS_M * cos(t), VS_CIRCLE_RADIUS_M * sin(t));
  for (int side = -1; side <= 1; side += 2) {
    add_line(lines, side * d, -a, side * d, a);
    add_line(lines, side * d, a, side * l, a);
    add_line(lines, side * d, -a, side * l, -a);
    add_line(lines, side * l, -g, side * l, g);
    add_line(walls, side * l, g, side * l, h - c);
    add_line(walls, side * l, -g, side * l, c - h);
    add_line(walls, c - l, side * h, l - c, side * h);
  }
}

static void project(vs_calib_watch *w, int model_index, int turn) {
  const model *m = &w->model[model_index];
  double angle = (turn - TURNS / 2) * TURN_STEP_RAD, c = cos(angle), s = sin(angle);
  int *n = &w->count[model_index][turn];
  for (int i = 0; i < m->points; i++) {
    double x, y;
    if (!vs_calib_to_pixel(&w->calib, c * m->x_m[i] - s * m->y_m[i], s * m->x_m[i] + c * m->y_m[i], 0, &x, &y))
      continue;
    if (!(x >= 0 && y >= 0 && x < w->width && y < w->height)) continue;
    w->x[model_index][turn][*n] = (short)x;
    w->y[model_index][turn][(*n)++] = (short)y;
  }
}

vs_status vs_calib_watch_new(const vs_calib *calib, vs_calib_watch **out, vs_error *err) {
  *out = NULL;
  vs_calib_watch *w = calloc(1, sizeof *w);
  if (!w) return vs_fail(err, VS_FAIL, "out of memory");
  w->calib = *calib;
  w->width = calib->width, w->height = calib->height;
  w->columns = w->width / BLOCK, w->rows = w->height / BLOCK;
  w->px_per_m = vs_calib_px_per_m(calib, 0);
  w->contrast = calloc((size_t)w->width, (size_t)w->height);
  w->coarse = calloc((size_t)w->columns + 1, (size_t)w->rows + 1);
  make_models(w);
  for (int m = 0; m < MODELS; m++)
    for (int turn = 0; turn < TURNS; turn++) project(w, m, turn);
  vs_status s =
      !w->contrast || !w->coarse ? vs_fail(err, VS_FAIL, "out of memory")
      : !w->count[0][TURNS / 2] || !(w->px_per_m > 20)
          ? vs_fail(err, VS_FAIL, "this calibration shows no field in a picture of %d x %d", w->width, w->height)
          : VS_OK;
  if (s != VS_OK) {
    vs_calib_watch_free(w);
    return s;
  }
  *out = w;
  return VS_OK;
}

void vs_calib_watch_free(vs_calib_watch *w) {
  if (!w) return;
  free(w->contrast);
  free(w->coarse);
  free(w);
}

// Largest less smallest of the four pixels two to each side: lines and steps alike, noise little.
static void measure_contrast(vs_calib_watch *w, const vs_frame *f) {
  const int s = f->grey_stride;
  for (int y = 2; y < w->height - 2; y++) {
    const uint8_t *p = f->grey + (size_t)y * s;
    uint8_t *out = w->contrast + (size_t)y * w->width;
    for (int x = 2; x < w->width - 2; x++) {
      int v[5] = {p[x], p[x - 2], p[x + 2], p[x - 2 * s], p[x + 2 * s]}, low = v[0], high = v[0];
      for (int i = 1; i < 5; i++) {
        low = v[i] < low ? v[i] : low;
        high = v[i] > high ? v[i] : high;
      }
      int c = high - low;
      out[x] = (uint8_t)(c > 80 ? 80 : c); // a robot's mark must not outweigh a line
    }
  }
}

static void pool(vs_calib_watch *w) {
  for (int row = 0; row < w->rows; row++)
    for (int column = 0; column < w->columns; column++) {
      uint8_t most = 0;
      int x0 = column * BLOCK - BLOCK, y0 = row * BLOCK - BLOCK;
      for (int y = y0 < 0 ? 0 : y0; y < y0 + 3 * BLOCK && y < w->height; y += 2)
        for (int x = x0 < 0 ? 0 : x0; x < x0 + 3 * BLOCK && x < w->width; x += 2) {
          uint8_t c = w->contrast[(size_t)y * w->width + x];
          most = c > most ? c : most;
        }
      w->coarse[(size_t)row * w->columns + column] = most;
    }
}

static double score_at(const vs_calib_watch *w, int m, int turn, int dx, int dy, bool coarse) {
  const short *px = w->x[m][turn], *py = w->y[m][turn];
  int n = w->count[m][turn], sum = 0, inside = 0;
  for (int i = 0; i < n; i++) {
    int x = px[i] + dx, y = py[i] + dy;
    if ((unsigned)x >= (unsigned)(w->columns * BLOCK) || (unsigned)y >= (unsigned)(w->rows * BLOCK)) continue;
    inside++;
    sum += coarse ? w->coarse[(size_t)(y / BLOCK) * w->columns + x / BLOCK] : w->contrast[(size_t)y * w->width + x];
  }
  return inside > n / 2 ? (double)sum / inside : 0.0;
}

// Share of the points with an edge at hand: robots hide some of a line, not most of it.
static double share_seen(const vs_calib_watch *w, int m, const place *p) {
  int hits = 0, n = w->count[m][p->turn];
  for (int i = 0; i < n; i++) {
    int x = w->x[m][p->turn][i] + p->dx, y = w->y[m][p->turn][i] + p->dy;
    hits += (unsigned)x < (unsigned)w->width && (unsigned)y < (unsigned)w->height &&
            w->contrast[(size_t)y * w->width + x] >= EDGE;
  }
  return n ? (double)hits / n : 0;
}

static place search(const vs_calib_watch *w, int m, place from, int reach, int step, int turn_reach, bool coarse,
                    double *mean) {
  place best = {.score = -1};
  double sum = 0;
  int tried = 0;
  for (int turn = from.turn - turn_reach; turn <= from.turn + turn_reach; turn++) {
    if (turn < 0 || turn >= TURNS) continue;
    for (int dy = from.dy - reach; dy <= from.dy + reach; dy += step)
      for (int dx = from.dx - reach; dx <= from.dx + reach; dx += step) {
        place p = {score_at(w, m, turn, dx, dy, coarse), dx, dy, turn};
        sum += p.score, tried++;
        // Of equals the one nearer to where the calibration has it.
        if (p.score > best.score || (p.score == best.score && abs(dx) + abs(dy) < abs(best.dx) + abs(best.dy)))
          best = p;
      }
  }
  *mean = tried ? sum / tried : 0;
  return best;
}

// A shift of the picture, and a turn about the field's centre, in metres of the calibration's frame.
static void to_metres(const vs_calib_watch *w, const place *p, vs_calib_watch_result *r) {
  double cx, cy, x0, y0, x1, y1;
  r->turn_rad = (p->turn - TURNS / 2) * TURN_STEP_RAD;
  if (!vs_calib_to_pixel(&w->calib, 0, 0, 0, &cx, &cy) || !vs_calib_to_field(&w->calib, cx, cy, 0, &x0, &y0) ||
      !vs_calib_to_field(&w->calib, cx + p->dx, cy + p->dy, 0, &x1, &y1))
    return;
  r->x_m = x1 - x0, r->y_m = y1 - y0;
  double c = cos(r->turn_rad) - 1, s = sin(r->turn_rad);
  for (int corner = 0; corner < 4; corner++) {
    double x = corner & 1 ? VS_FIELD_HALF_LENGTH_M : -VS_FIELD_HALF_LENGTH_M;
    double y = corner & 2 ? VS_FIELD_HALF_WIDTH_M : -VS_FIELD_HALF_WIDTH_M;
    r->error_mm = fmax(r->error_mm, 1000 * hypot(r->x_m + c * x - s * y, r->y_m + s * x + c * y));
  }
}

static bool look(const vs_calib_watch *w, int m, vs_calib_watch_result *r) {
  double mean, unused;
  place home = {.turn = TURNS / 2};
  int reach = (int)(VS_CALIB_WATCH_REACH_M * w->px_per_m) / (2 * BLOCK) * 2 * BLOCK;
  place best = search(w, m, home, reach, 2 * BLOCK, TURNS / 2, true, &mean);
  best = search(w, m, best, 3 * BLOCK, 2, 1, false, &unused);
  best = search(w, m, best, 2, 1, 0, false, &unused);
  home = search(w, m, home, 2, 1, 0, false, &unused);
  double all;
  search(w, m, (place){.turn = TURNS / 2}, reach, 4 * BLOCK, 0, false, &all);
  if (best.score < STANDS_OUT * all || share_seen(w, m, &best) < (m == 0 ? SHARE : SHARE_OF_WALLS)) return false;
  if (best.score < BETTER * home.score) best = home;
  *r = (vs_calib_watch_result){.sure = true, .lines = m == 0};
  to_metres(w, &best, r);
  return true;
}

vs_calib_watch_result vs_calib_watch_check(vs_calib_watch *w, const vs_frame *frame) {
  vs_calib_watch_result r = {0};
  if (frame->width != w->width || frame->height != w->height) return r;
  measure_contrast(w, frame);
  pool(w);
  if (!look(w, 0, &r)) look(w, 1, &r);
  return r;
}
