#include "vsss/latency_meter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "predict.h"
#include "vsss/field.h"
#include "vsss/geom.h"

enum { GUESSES = 25 };
#define STEP_S (VS_LATENCY_METER_MAX_S / (GUESSES - 1))

// What is left between a robot foretold and seen counts by these; more than WILD_MISS of them is a push or a mistake.
#define PLACE_M     0.0015
#define HEADING_RAD 0.02
#define WILD_MISS   10.0

// What is held back by a wall or another robot answers its commands otherwise, and for some frames after.
#define FREE_WALL_M  0.07
#define FREE_ROBOT_M 0.12
#define FREE_FRAMES  4

#define TELLING_MISS 1.0   // guesses that differ by less in a frame say nothing
#define REMEMBERED   600.0 // telling frames: 20 s
#define FIRST_AFTER  60    // telling frames until the first answer
#define ANSWER_EVERY 30
#define SURE_S       0.025 // guesses so far from the best ...
#define SURE_FRAMES  8.0   // ... must miss by so many frames' misses more

struct vs_latency_meter {
  vs_team team;
  vs_predictor predictor[GUESSES];
  double missed[GUESSES];     // sums, of old less and less
  double frames;              // in these sums
  int telling;                // frames so far
  int free_for[VS_TEAM_SIZE]; // frames for which each own robot has touched nothing
};

vs_status vs_latency_meter_new(vs_team team, vs_latency_meter **out, vs_error *err) {
  *out = calloc(1, sizeof **out);
  if (!*out) return vs_fail(err, VS_FAIL, "out of memory");
  (*out)->team = team;
  return VS_OK;
}

void vs_latency_meter_free(vs_latency_meter *meter) { free(meter); }

void vs_latency_meter_sent(vs_latency_meter *m, int64_t time_us, const vs_wheels wheels[VS_TEAM_SIZE]) {
  vs_wheels all[VS_TEAM_MOST] = {{0}};
  memcpy(all, wheels, VS_TEAM_SIZE * sizeof *all);
  for (int i = 0; i < GUESSES; i++) vs_predictor_command(&m->predictor[i], time_us, all);
}

static bool is_free(const vs_world *w, vs_team team, int index) {
  const vs_pose *p = &w->robot[team][index].pose;
  if (fabs(p->x_m) > VS_FIELD_HALF_LENGTH_M - FREE_WALL_M || fabs(p->y_m) > VS_FIELD_HALF_WIDTH_M - FREE_WALL_M)
    return false;
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    int t = i / VS_TEAM_SIZE, k = i % VS_TEAM_SIZE;
    const vs_pose *q = &w->robot[t][k].pose;
    if ((t != (int)team || k != index) && vs_distance_m(p->x_m, p->y_m, q->x_m, q->y_m) < FREE_ROBOT_M) return false;
  }
  return true;
}

// The predictor takes a share of each difference; what it leaves is in proportion to the difference.
static double miss(const vs_latency_meter *m, const vs_world *foretold, const vs_world *seen) {
  double sum = 0;
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    const vs_robot *a = &foretold->robot[m->team][i], *b = &seen->robot[m->team][i];
    if (!a->valid || !b->valid || m->free_for[i] < FREE_FRAMES) continue;
    double place = vs_distance_m(a->pose.x_m, a->pose.y_m, b->pose.x_m, b->pose.y_m) / PLACE_M;
    double heading = vs_wrap_rad(a->pose.theta_rad - b->pose.theta_rad) / HEADING_RAD;
    sum += fmin(place * place + heading * heading, WILD_MISS * WILD_MISS);
  }
  return sum;
}

static int best_of(const double missed[GUESSES]) {
  int best = 0;
  for (int i = 1; i < GUESSES; i++)
    if (missed[i] < missed[best]) best = i;
  return best;
}

static bool is_sure(const double missed[GUESSES], double frames, int best) {
  int apart = (int)lround(SURE_S / STEP_S);
  for (int side = -1; side <= 1; side += 2) {
    int other = best + side * apart;
    if (other >= 0 && other < GUESSES && missed[other] < missed[best] * (1 + SURE_FRAMES / frames)) return false;
  }
  return true;
}

// Between the guesses: the lowest point of the parabola through the best one and its neighbours.
static double lowest_s(const double missed[GUESSES], int best) {
  if (best == 0 || best == GUESSES - 1) return best * STEP_S;
  double a = missed[best - 1], b = missed[best], c = missed[best + 1], bend = a - 2 * b + c;
  return (best + (bend > 0 ? 0.5 * (a - c) / bend : 0.0)) * STEP_S;
}

bool vs_latency_meter_see(vs_latency_meter *m, const vs_world *measured, double *latency_s) {
  vs_world own = {.time_us = measured->time_us, .seq = measured->seq};
  for (int i = 0; i < VS_TEAM_SIZE; i++) {
    own.robot[m->team][i] = measured->robot[m->team][i];
    m->free_for[i] = is_free(measured, m->team, i) ? m->free_for[i] + 1 : 0;
  }
  double now[GUESSES];
  bool first = !m->predictor[0].started;
  for (int i = 0; i < GUESSES; i++) {
    vs_predictor_see(&m->predictor[i], m->team, i * STEP_S, &own);
    now[i] = miss(m, &m->predictor[i].now, &own);
  }
  int best = best_of(now);
  double most = 0;
  for (int i = 0; i < GUESSES; i++) most = fmax(most, now[i] - now[best]);
  if (first || most < TELLING_MISS) return false;
  for (int i = 0; i < GUESSES; i++) m->missed[i] = m->missed[i] * (1 - 1 / REMEMBERED) + now[i];
  m->frames = m->frames * (1 - 1 / REMEMBERED) + 1;
  if (++m->telling < FIRST_AFTER || m->telling % ANSWER_EVERY) return false;
  best = best_of(m->missed);
  if (!is_sure(m->missed, m->frames, best)) return false;
  *latency_s = lowest_s(m->missed, best);
  return true;
}
