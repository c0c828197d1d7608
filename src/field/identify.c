#include "vsss/identify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "identify_fit.h"
#include "vsss/geom.h"

#define GAP_S      0.05 // between sights of a span
#define SPAN_S     0.5  // long beside a camera's noise, short beside what slips
#define ROWS_MIN   100
#define OUTLIER    2.5 // times the usual deviation: a span in which it was pushed, or seen wrong
#define CERTAIN    3.0 // deviations of an estimate
#define STRAIGHT_M 1e-3
#define TURN_RAD   1e-2

enum { MODES = VS_FIT_MODES, UNKNOWNS = VS_FIT_UNKNOWNS };

static double left_over(const vs_fit_row *r, int mode) { return r->moved[mode] - r->expected[mode]; }

static double deviation(const vs_fit *f, int mode) {
  double sum = 0;
  int n = 0;
  for (int i = 0; i < f->rows; i++) {
    if (!f->row[i].used) continue;
    sum += left_over(&f->row[i], mode) * left_over(&f->row[i], mode);
    n++;
  }
  return n ? sqrt(sum / n) : 0;
}

static int end_of_span(const vs_fit *f, int first) {
  int end = first;
  while (end < f->rows && f->row[end].span == f->row[first].span) end++;
  return end;
}

static double deviation_in(const vs_fit *f, int first, int end, int mode) {
  double sum = 0;
  for (int i = first; i < end; i++) sum += left_over(&f->row[i], mode) * left_over(&f->row[i], mode);
  return sqrt(sum / (end - first));
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Of the spans' deviations: what pushes do to some of them does not move it. scratch: room for one number a row.
static double usual_deviation(const vs_fit *f, int mode, double *scratch) {
  int n = 0;
  for (int first = 0, end; first < f->rows; first = end) {
    end = end_of_span(f, first);
    scratch[n++] = deviation_in(f, first, end, mode);
  }
  qsort(scratch, (size_t)n, sizeof *scratch, ascending);
  return scratch[n / 2];
}

// Returns how many rows are used.
static int drop_outliers(vs_fit *f, double *scratch) {
  double usual[MODES];
  int used = 0;
  for (int m = 0; m < MODES; m++) usual[m] = usual_deviation(f, m, scratch);
  for (int first = 0, end; first < f->rows; first = end) {
    end = end_of_span(f, first);
    bool fits = true;
    for (int m = 0; m < MODES; m++) fits = fits && deviation_in(f, first, end, m) <= OUTLIER * usual[m];
    for (int i = first; i < end; i++) f->row[i].used = fits;
    used += fits ? end - first : 0;
  }
  return used;
}

// Way and angle from a to b.
static void moved_between(const vs_pose *a, const vs_pose *b, double moved[MODES]) {
  double turned = vs_wrap_rad(b->theta_rad - a->theta_rad), middle = a->theta_rad + 0.5 * turned;
  double chord = cos(middle) * (b->x_m - a->x_m) + sin(middle) * (b->y_m - a->y_m);
  moved[VS_FIT_STRAIGHT] = fabs(turned) > 1e-6 ? chord * 0.5 * turned / sin(0.5 * turned) : chord; // the arc
  moved[VS_FIT_TURN] = turned;
}

static void make_rows(vs_fit *f, const vs_motion_sight *sight, int sights) {
  double span_began_s = 0;
  for (int i = 0; i < sights; i++) {
    vs_fit_row *r = &f->row[f->rows], *before = f->rows ? r - 1 : NULL;
    *r = (vs_fit_row){.time_s = 1e-6 * (double)(sight[i].time_us - f->zero_us), .used = true};
    if (before && !(r->time_s > before->time_s)) continue;
    bool goes_on = before && r->time_s - before->time_s <= GAP_S && r->time_s - span_began_s <= SPAN_S;
    if (!goes_on) span_began_s = r->time_s;
    r->span = !before ? 0 : goes_on ? before->span : before->span + 1;
    if (goes_on) {
      double step[MODES];
      moved_between(&sight[i - 1].pose, &sight[i].pose, step);
      for (int m = 0; m < MODES; m++) r->moved[m] = before->moved[m] + step[m];
    }
    f->rows++;
  }
  vs_fit_centre(f, false);
}

// Both wheels turned, and not always together.
static bool tells_gains(double a[UNKNOWNS][UNKNOWNS]) {
  double left = a[VS_FIT_GAIN_LEFT][VS_FIT_GAIN_LEFT], right = a[VS_FIT_GAIN_RIGHT][VS_FIT_GAIN_RIGHT];
  double both = a[VS_FIT_GAIN_LEFT][VS_FIT_GAIN_RIGHT];
  return left > 0 && right > 0 && left * right - both * both > 1e-9 * left * right;
}

static vs_status identify(vs_fit *f, double *scratch, vs_identified *out, vs_error *err) {
  double x[UNKNOWNS] = {0}, a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS];
  vs_fit_search(f, x);
  for (int pass = 0; pass < 3; pass++) {
    double weight[MODES];
    for (int m = 0; m < MODES; m++) {
      double sigma = usual_deviation(f, m, scratch);
      weight[m] = sigma > 0 ? 1 / (sigma * sigma) : f->weight[m];
    }
    out->samples = drop_outliers(f, scratch);
    // A robot that speeds up tips, and its mark with it, which looks like another delay; one that turns on the spot does not.
    f->weight[VS_FIT_STRAIGHT] = 0;
    f->weight[VS_FIT_TURN] = weight[VS_FIT_TURN];
    vs_fit_descend(f, x);
    f->weight[VS_FIT_STRAIGHT] = weight[VS_FIT_STRAIGHT];
    f->held[VS_FIT_DELAY] = true;
    vs_fit_descend(f, x);
    f->held[VS_FIT_DELAY] = false;
  }
  vs_fit_normal_equations(f, a, b);
  if (!tells_gains(a)) return vs_fail(err, VS_FAIL, "hardly commanded; record it with 'vsss field --policy shake:'");
  out->delay_s = x[VS_FIT_DELAY];
  out->tau_straight_s = x[VS_FIT_TAU_STRAIGHT];
  out->tau_turn_s = x[VS_FIT_TAU_TURN];
  out->gain_left = x[VS_FIT_GAIN_LEFT];
  out->gain_right = x[VS_FIT_GAIN_RIGHT];
  bool reached = x[VS_FIT_TIGHTNESS] * sqrt(a[VS_FIT_TIGHTNESS][VS_FIT_TIGHTNESS]) > CERTAIN;
  out->limit_radps = reached ? 1 / x[VS_FIT_TIGHTNESS] : 0;
  out->error_m = deviation(f, VS_FIT_STRAIGHT);
  out->error_rad = deviation(f, VS_FIT_TURN);
  return VS_OK;
}

vs_status vs_identify(const vs_motion_command *command, int commands, const vs_motion_sight *sight, int sights,
                      vs_identified *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  if (sights < ROWS_MIN || commands < 2)
    return vs_fail(err, VS_FAIL, "seen in %d frames, at least %d are needed", sights, ROWS_MIN);
  vs_fit f = {.command = command, .commands = commands};
  f.weight[VS_FIT_STRAIGHT] = 1 / (STRAIGHT_M * STRAIGHT_M);
  f.weight[VS_FIT_TURN] = 1 / (TURN_RAD * TURN_RAD);
  f.zero_us = command[0].time_us < sight[0].time_us ? command[0].time_us : sight[0].time_us;
  f.row = calloc((size_t)sights, sizeof *f.row);
  double *scratch = calloc((size_t)sights, sizeof *scratch);
  vs_status s = f.row && scratch ? VS_OK : vs_fail(err, VS_FAIL, "out of memory");
  if (s == VS_OK) {
    make_rows(&f, sight, sights);
    s = identify(&f, scratch, out, err);
  }
  free(scratch);
  free(f.row);
  return s;
}
