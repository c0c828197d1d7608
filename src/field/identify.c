#include "vsss/identify.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/field.h"
#include "vsss/geom.h"

#define GAP_S      0.05 // sights further apart are no pair
#define DELAY_MAX  0.30
#define TAU_MIN    0.004
#define TAU_MAX    0.40
#define PAIRS_MIN  100
#define OUTLIER    4.0 // deviations: pushed, or seen wrong
#define SMALL_STEP 1e-5

enum { LEFT, RIGHT, WHEELS, STRAIGHT = 0, TURN, MODES };

// What a pair of sights shows, and what each wheel with a gain of 1 would have done meanwhile.
typedef struct pair {
  double from_s, to_s;
  double moved[MODES];          // m forward, rad
  double rolled[MODES][WHEELS]; // rad of each wheel, with the mode's time constant
  bool used;
} pair;

typedef struct fit {
  const vs_motion_command *command;
  int commands;
  int64_t zero_us;
  pair *pair;
  int pairs;
  double weight[MODES]; // 1 / variance
  double gain[WHEELS];
} fit;

static double seconds(const fit *f, int64_t time_us) { return 1e-6 * (double)(time_us - f->zero_us); }

// The wheels' response to the commands, with a delay and a time constant, rolled between the sights of each pair.
static void respond(fit *f, int mode, double delay_s, double tau_s) {
  double speed[WHEELS] = {0}, angle[WHEELS] = {0}, target[WHEELS] = {0};
  double at_s = 0;
  int next = 0, open = 0;
  double start[WHEELS] = {0};
  bool begun = false;
  for (open = 0; open < f->pairs;) {
    pair *p = &f->pair[open];
    double event_s = begun ? p->to_s : p->from_s;
    bool is_command = next < f->commands && seconds(f, f->command[next].time_us) + delay_s <= event_s;
    double until_s = is_command ? seconds(f, f->command[next].time_us) + delay_s : event_s;
    double dt_s = fmax(0, until_s - at_s), decay = exp(-dt_s / tau_s);
    for (int w = 0; w < WHEELS; w++) {
      angle[w] += target[w] * dt_s + (speed[w] - target[w]) * tau_s * (1 - decay);
      speed[w] = target[w] + (speed[w] - target[w]) * decay;
    }
    at_s = fmax(at_s, until_s);
    if (is_command) {
      target[LEFT] = f->command[next].wheels.left_radps;
      target[RIGHT] = f->command[next++].wheels.right_radps;
    } else if (!begun) {
      memcpy(start, angle, sizeof start);
      begun = true;
    } else {
      for (int w = 0; w < WHEELS; w++) p->rolled[mode][w] = angle[w] - start[w];
      begun = false;
      open++;
    }
  }
}

// Metres or radians that a wheel's radian makes.
static double effect(int mode, int wheel) {
  if (mode == STRAIGHT) return 0.5 * VS_WHEEL_RADIUS_M;
  return (wheel == LEFT ? -0.5 : 0.5) * VS_WHEEL_RADIUS_M / VS_HALF_TRACK_M;
}

static double left_over(const fit *f, const pair *p, int mode) {
  double e = p->moved[mode];
  for (int w = 0; w < WHEELS; w++) e -= f->gain[w] * effect(mode, w) * p->rolled[mode][w];
  return e;
}

// The gains that leave least, and what is left; INFINITY: the wheels hardly turned.
static double solve(fit *f) {
  double a[WHEELS][WHEELS] = {{0}}, b[WHEELS] = {0};
  for (int i = 0; i < f->pairs; i++) {
    const pair *p = &f->pair[i];
    if (!p->used) continue;
    for (int m = 0; m < MODES; m++)
      for (int w = 0; w < WHEELS; w++) {
        double x = effect(m, w) * p->rolled[m][w];
        b[w] += f->weight[m] * x * p->moved[m];
        for (int v = 0; v < WHEELS; v++) a[w][v] += f->weight[m] * x * effect(m, v) * p->rolled[m][v];
      }
  }
  double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  if (!(det > 1e-9 * a[0][0] * a[1][1]) || !(a[0][0] > 0)) return INFINITY;
  f->gain[LEFT] = (b[0] * a[1][1] - b[1] * a[0][1]) / det;
  f->gain[RIGHT] = (a[0][0] * b[1] - a[1][0] * b[0]) / det;
  double sum = 0;
  for (int i = 0; i < f->pairs; i++)
    for (int m = 0; m < MODES && f->pair[i].used; m++) {
      double e = left_over(f, &f->pair[i], m);
      sum += f->weight[m] * e * e;
    }
  return sum;
}

// x: delay, time constant straight, time constant turning.
static double cost(fit *f, const double x[3]) {
  for (int m = 0; m < MODES; m++) respond(f, m, x[0], x[1 + m]);
  return solve(f);
}

// A walk along the axes with shrinking steps: three smooth unknowns.
static double descend(fit *f, double x[3], double step_s) {
  const double low[3] = {0, TAU_MIN, TAU_MIN}, high[3] = {DELAY_MAX, TAU_MAX, TAU_MAX};
  double best = cost(f, x);
  while (step_s > SMALL_STEP) {
    bool better = false;
    // The delay against the time constants too: they trade off along that line.
    static const int way[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, -1}, {1, 0, -1}, {1, -1, 0}};
    for (int k = 0; k < 12; k++) {
      double y[3];
      for (int i = 0; i < 3; i++) y[i] = vs_clamp(x[i] + (k % 2 ? -step_s : step_s) * way[k / 2][i], low[i], high[i]);
      double c = cost(f, y);
      if (c >= best) continue;
      best = c;
      memcpy(x, y, sizeof y);
      better = true;
    }
    if (!better) step_s /= 2;
  }
  cost(f, x);
  return best;
}

static void search(fit *f, double x[3]) {
  double best = INFINITY;
  for (double delay_s = 0; delay_s <= DELAY_MAX; delay_s += 0.02)
    for (double tau_s = 0.01; tau_s <= TAU_MAX; tau_s *= 1.6) {
      const double y[3] = {delay_s, tau_s, tau_s};
      double c = cost(f, y);
      if (c >= best) continue;
      best = c;
      memcpy(x, y, sizeof y);
    }
  descend(f, x, 0.01);
}

static double deviation(const fit *f, int mode) {
  double sum = 0;
  int n = 0;
  for (int i = 0; i < f->pairs; i++) {
    if (!f->pair[i].used) continue;
    double e = left_over(f, &f->pair[i], mode);
    sum += e * e;
    n++;
  }
  return n ? sqrt(sum / n) : 0;
}

static int drop_outliers(fit *f) {
  int left = 0;
  double sigma[MODES] = {deviation(f, STRAIGHT), deviation(f, TURN)};
  for (int i = 0; i < f->pairs; i++) {
    pair *p = &f->pair[i];
    for (int m = 0; m < MODES; m++)
      if (fabs(left_over(f, p, m)) > OUTLIER * sigma[m]) p->used = false;
    left += p->used;
  }
  return left;
}

static int make_pairs(fit *f, const vs_motion_sight *sight, int sights) {
  for (int i = 1; i < sights; i++) {
    const vs_motion_sight *a = &sight[i - 1], *b = &sight[i];
    double dt_s = 1e-6 * (double)(b->time_us - a->time_us);
    if (!(dt_s > 0) || dt_s > GAP_S) continue;
    double turned = vs_wrap_rad(b->pose.theta_rad - a->pose.theta_rad), middle = a->pose.theta_rad + 0.5 * turned;
    double chord = cos(middle) * (b->pose.x_m - a->pose.x_m) + sin(middle) * (b->pose.y_m - a->pose.y_m);
    // From the chord to the arc.
    double arc = fabs(turned) > 1e-6 ? chord * 0.5 * turned / sin(0.5 * turned) : chord;
    f->pair[f->pairs++] =
        (pair){.from_s = seconds(f, a->time_us), .to_s = seconds(f, b->time_us), .moved = {arc, turned}, .used = true};
  }
  return f->pairs;
}

vs_status vs_identify(const vs_motion_command *command, int commands, const vs_motion_sight *sight, int sights,
                      vs_identified *out, vs_error *err) {
  memset(out, 0, sizeof *out);
  fit f = {.command = command, .commands = commands, .weight = {1 / (1e-3 * 1e-3), 1 / (1e-2 * 1e-2)}};
  f.pair = calloc((size_t)(sights > 0 ? sights : 1), sizeof *f.pair);
  if (!f.pair) return vs_fail(err, VS_FAIL, "out of memory");
  f.zero_us = commands > 0 && sights > 0 && command[0].time_us < sight[0].time_us ? command[0].time_us
              : sights > 0                                                        ? sight[0].time_us
                                                                                  : 0;
  vs_status s = VS_OK;
  double x[3] = {0, 0.05, 0.05};
  if (make_pairs(&f, sight, sights) < PAIRS_MIN || commands < 2) {
    s = vs_fail(err, VS_FAIL, "seen in %d pairs of frames, at least %d are needed", f.pairs, PAIRS_MIN);
  } else {
    search(&f, x);
    double best = cost(&f, x);
    if (!isfinite(best)) {
      s = vs_fail(err, VS_FAIL, "hardly commanded; record it with 'vsss field --policy shake:'");
    } else {
      for (int pass = 0; pass < 2; pass++) {
        for (int m = 0; m < MODES; m++) {
          double sigma = deviation(&f, m);
          f.weight[m] = sigma > 0 ? 1 / (sigma * sigma) : f.weight[m];
        }
        out->samples = drop_outliers(&f);
        descend(&f, x, 0.004);
      }
      out->delay_s = x[0];
      out->tau_straight_s = x[1];
      out->tau_turn_s = x[2];
      out->gain_left = f.gain[LEFT];
      out->gain_right = f.gain[RIGHT];
      out->error_m = deviation(&f, STRAIGHT);
      out->error_rad = deviation(&f, TURN);
    }
  }
  free(f.pair);
  return s;
}
