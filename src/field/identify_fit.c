#include "identify_fit.h"

#include <math.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

enum { LEFT, RIGHT, WHEELS, MODES = VS_FIT_MODES, UNKNOWNS = VS_FIT_UNKNOWNS };

#define DELAY_MAX_S     0.30
#define TAU_MIN_S       0.004
#define TAU_MAX_S       0.40
#define GAIN_MAX        4.0
#define LIMIT_MIN_RADPS 1.0
#define ROCK_MAX_S2     1e-3 // 80 mm over the floor, a degree for 1.4 m/s2
#define STEP_S          0.004
#define ROUNDS_MAX      30

static const double lowest[UNKNOWNS] = {0, TAU_MIN_S, TAU_MIN_S, 0, 0, 0, -ROCK_MAX_S2};
static const double highest[UNKNOWNS] = {DELAY_MAX_S, TAU_MAX_S,           TAU_MAX_S,  GAIN_MAX,
                                         GAIN_MAX,    1 / LIMIT_MIN_RADPS, ROCK_MAX_S2};
static const double nudge[UNKNOWNS] = {2e-4, 2e-4, 2e-4, 1e-3, 1e-3, 1e-3, 1e-5}; // for the derivatives

// Two wheels on a body: both motors together move it forward, against each other they turn it. Of each mode, in rad/s of
// the wheels and rad rolled.
typedef struct body {
  double speed[MODES], rolled[MODES];
} body;

// What each motor pulls with: its gap, at most the limit. Returns whether it is that.
static bool pull_of(double gap, double limit, double *pull) {
  bool limited = fabs(gap) > limit;
  *pull = limited ? copysign(limit, gap) : gap;
  return limited;
}

typedef struct pulls {
  double of[WHEELS];
  bool limited[WHEELS];
} pulls;

static pulls pulls_of(const body *b, const double target[WHEELS], const double x[UNKNOWNS]) {
  double limit = x[VS_FIT_TIGHTNESS] > 0 ? 1 / x[VS_FIT_TIGHTNESS] : INFINITY;
  pulls p;
  for (int w = 0; w < WHEELS; w++) {
    double sign = w == LEFT ? -1 : 1;
    p.limited[w] = pull_of(target[w] - b->speed[VS_FIT_STRAIGHT] - sign * b->speed[VS_FIT_TURN], limit, &p.of[w]);
  }
  return p;
}

static void roll_step(body *b, const double target[WHEELS], const double x[UNKNOWNS], double dt_s,
                      const double closed[MODES] /* part of a gap, within dt_s */) {
  pulls p = pulls_of(b, target, x);
  for (int m = 0; m < MODES; m++) {
    double tau = x[VS_FIT_TAU_STRAIGHT + m], gained[WHEELS];
    for (int w = 0; w < WHEELS; w++) gained[w] = p.of[w] * (p.limited[w] ? dt_s / tau : closed[m]);
    double both = 0.5 * (gained[RIGHT] + (m == VS_FIT_STRAIGHT ? gained[LEFT] : -gained[LEFT]));
    // Exact while no motor is at its limit; then nearly.
    b->rolled[m] += b->speed[m] * dt_s + both * (dt_s / closed[m] - tau);
    b->speed[m] += both;
  }
}

static void roll(body *b, const double target[WHEELS], const double x[UNKNOWNS], double span_s) {
  int steps = (int)ceil(span_s / STEP_S);
  if (steps <= 0) return;
  double dt_s = span_s / steps;
  const double closed[MODES] = {-expm1(-dt_s / x[VS_FIT_TAU_STRAIGHT]), -expm1(-dt_s / x[VS_FIT_TAU_TURN])};
  for (int i = 0; i < steps; i++) roll_step(b, target, x, dt_s, closed);
}

void vs_fit_centre(vs_fit *f, bool expected) {
  for (int first = 0, end; first < f->rows; first = end) {
    double sum[MODES] = {0};
    for (end = first; end < f->rows && f->row[end].span == f->row[first].span; end++)
      for (int m = 0; m < MODES; m++) sum[m] += expected ? f->row[end].expected[m] : f->row[end].moved[m];
    for (int i = first; i < end; i++)
      for (int m = 0; m < MODES; m++)
        *(expected ? &f->row[i].expected[m] : &f->row[i].moved[m]) -= sum[m] / (end - first);
  }
}

// Fills what is expected.
static void respond(vs_fit *f, const double x[UNKNOWNS]) {
  static const double metres_or_rad[MODES] = {VS_WHEEL_RADIUS_M, VS_WHEEL_RADIUS_M / VS_HALF_TRACK_M};
  body now = {0};
  double target[WHEELS] = {0}, at_s = 0;
  int next = 0;
  for (int i = 0; i < f->rows; i++) {
    for (;;) {
      bool more = next < f->commands;
      double acts_s = more ? 1e-6 * (double)(f->command[next].time_us - f->zero_us) + x[VS_FIT_DELAY] : 0;
      bool is_command = more && acts_s <= f->row[i].time_s;
      double until_s = is_command ? acts_s : f->row[i].time_s;
      roll(&now, target, x, until_s - at_s);
      at_s = fmax(at_s, until_s);
      if (!is_command) break;
      target[LEFT] = x[VS_FIT_GAIN_LEFT] * f->command[next].wheels.left_radps;
      target[RIGHT] = x[VS_FIT_GAIN_RIGHT] * f->command[next++].wheels.right_radps;
    }
    pulls p = pulls_of(&now, target, x);
    double speeds_up = 0.5 * (p.of[LEFT] + p.of[RIGHT]) / x[VS_FIT_TAU_STRAIGHT];
    for (int m = 0; m < MODES; m++) {
      double rocked = m == VS_FIT_STRAIGHT ? x[VS_FIT_ROCK] * speeds_up : 0;
      f->row[i].expected[m] = (now.rolled[m] + rocked) * metres_or_rad[m];
    }
  }
  vs_fit_centre(f, true);
}

static double cost(vs_fit *f, const double x[UNKNOWNS]) {
  double sum = 0;
  respond(f, x);
  for (int i = 0; i < f->rows; i++)
    for (int m = 0; m < MODES && f->row[i].used; m++) {
      double e = f->row[i].moved[m] - f->row[i].expected[m];
      sum += f->weight[m] * e * e;
    }
  return sum;
}

static void differentiate(vs_fit *f, const double x[UNKNOWNS]) {
  double by[UNKNOWNS];
  for (int k = 0; k < UNKNOWNS; k++) {
    double y[UNKNOWNS];
    memcpy(y, x, sizeof y);
    by[k] = x[k] + nudge[k] <= highest[k] ? nudge[k] : -nudge[k];
    y[k] += by[k];
    respond(f, y);
    for (int i = 0; i < f->rows; i++) memcpy(f->row[i].change[k], f->row[i].expected, sizeof f->row[i].expected);
  }
  respond(f, x);
  for (int i = 0; i < f->rows; i++)
    for (int k = 0; k < UNKNOWNS; k++)
      for (int m = 0; m < MODES; m++) f->row[i].change[k][m] = (f->row[i].change[k][m] - f->row[i].expected[m]) / by[k];
}

void vs_fit_normal_equations(const vs_fit *f, double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS]) {
  memset(a, 0, UNKNOWNS * sizeof a[0]);
  memset(b, 0, UNKNOWNS * sizeof b[0]);
  for (int n = 0; n < f->rows; n++) {
    const vs_fit_row *r = &f->row[n];
    for (int m = 0; m < MODES && r->used; m++)
      for (int i = 0; i < UNKNOWNS; i++) {
        b[i] += f->weight[m] * r->change[i][m] * (r->moved[m] - r->expected[m]);
        for (int j = 0; j < UNKNOWNS; j++) a[i][j] += f->weight[m] * r->change[i][m] * r->change[j][m];
      }
  }
}

// Solves a x = b, x in b's place; a is symmetric and, with what damps it, positive.
static void eliminate(double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS]) {
  for (int k = 0; k < UNKNOWNS; k++)
    for (int i = k + 1; i < UNKNOWNS; i++) {
      double share = a[i][k] / a[k][k];
      for (int j = k; j < UNKNOWNS; j++) a[i][j] -= share * a[k][j];
      b[i] -= share * b[k];
    }
  for (int k = UNKNOWNS - 1; k >= 0; k--) {
    for (int j = k + 1; j < UNKNOWNS; j++) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
}

static void hold(const vs_fit *f, double a[UNKNOWNS][UNKNOWNS], double b[UNKNOWNS]) {
  for (int k = 0; k < UNKNOWNS; k++) {
    if (!f->held[k]) continue;
    for (int i = 0; i < UNKNOWNS; i++) a[k][i] = a[i][k] = i == k;
    b[k] = 0;
  }
}

// Levenberg and Marquardt's way down.
static double go_down(vs_fit *f, double x[UNKNOWNS]) {
  double best = cost(f, x), damping = 1e-3;
  for (int round = 0; round < ROUNDS_MAX; round++) {
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS], before = best;
    differentiate(f, x);
    vs_fit_normal_equations(f, a, b);
    hold(f, a, b);
    for (; damping < 1e6; damping *= 10) {
      double damped[UNKNOWNS][UNKNOWNS], step[UNKNOWNS], y[UNKNOWNS];
      memcpy(damped, a, sizeof damped);
      memcpy(step, b, sizeof step);
      for (int i = 0; i < UNKNOWNS; i++) damped[i][i] += damping * a[i][i] + 1e-12;
      eliminate(damped, step);
      for (int i = 0; i < UNKNOWNS; i++) y[i] = vs_clamp(x[i] + step[i], lowest[i], highest[i]);
      double c = cost(f, y);
      if (!(c < best)) continue;
      best = c;
      memcpy(x, y, sizeof y);
      damping /= 10;
      break;
    }
    if (!(before - best > 1e-6 * before)) break;
  }
  return best;
}

void vs_fit_descend(vs_fit *f, double x[UNKNOWNS]) {
  go_down(f, x);
  differentiate(f, x);
}

// From the best of a grid, then from several limits: beyond one that is never reached there is no slope towards it.
void vs_fit_search(vs_fit *f, double x[UNKNOWNS]) {
  static const double tightness[] = {0, 1 / 16.0, 1 / 8.0};
  double best = INFINITY, start[UNKNOWNS] = {0};
  for (double delay_s = 0; delay_s <= DELAY_MAX_S; delay_s += 0.02)
    for (double tau_s = 0.01; tau_s <= TAU_MAX_S; tau_s *= 1.8) {
      const double y[UNKNOWNS] = {delay_s, tau_s, tau_s, 1, 1, 0, 0};
      double c = cost(f, y);
      if (c >= best) continue;
      best = c;
      memcpy(start, y, sizeof start);
    }
  best = INFINITY;
  for (int i = 0; i < 3; i++) {
    double y[UNKNOWNS];
    memcpy(y, start, sizeof y);
    y[VS_FIT_TIGHTNESS] = tightness[i];
    double c = go_down(f, y);
    if (c >= best) continue;
    best = c;
    memcpy(x, y, sizeof y);
  }
  differentiate(f, x);
}
