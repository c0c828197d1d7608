// Reads tests/data/drive_traces.txt and plays its traces; shared by the tests and the benchmark of the simulator.
#ifndef VSSS_TESTS_SIM_TRACES_H
#define VSSS_TESTS_SIM_TRACES_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vsss/geom.h"
#include "vsss/paths.h"
#include "vsss/sim.h"

#define TRACE_FRAMES 30
#define TRACE_MOST   128
#define TRACE_KINDS  8
#define TRACE_MELEE  7 // six robots at random: not among the kinds that the agreement is asked of

static const char *const trace_kind_name[TRACE_KINDS] = {"step", "spin", "arc",   "random",
                                                         "ball", "wall", "robot", "melee"};

typedef struct trace {
  int kind;
  vs_world start;
  bool uses_robot[6];
  vs_wheels command[TRACE_FRAMES][VS_TEAMS][VS_TEAM_MOST];
} trace;

// The trace's pieces after each frame.
typedef struct trace_run {
  vs_world world[TRACE_FRAMES];
} trace_run;

static inline void trace_begin(trace *t, const char *kind) {
  memset(t, 0, sizeof *t);
  t->kind = -1;
  for (int k = 0; k < TRACE_KINDS; k++) {
    if (!strcmp(kind, trace_kind_name[k])) t->kind = k;
  }
  for (int r = 0; r < 6; r++) t->start.robot[r / 3][r % 3].pose = (vs_pose){-0.6 + 0.1 * r, 0.6, 0};
}

// Returns the number of traces, or -1 with a message in err.
static inline int traces_load(trace *out, vs_error *err) {
  char path[512], line[160], kind[32];
  if (vs_path_find("tests/data/drive_traces.txt", path, sizeof path, err) != VS_OK) return -1;
  FILE *file = fopen(path, "r");
  int count = 0, number = 0, robot, frame;
  double a, b, c;
  bool good = file != NULL;
  while (good && fgets(line, sizeof line, file)) {
    number++;
    trace *t = count ? &out[count - 1] : NULL;
    if (line[0] == '#') continue;
    if (sscanf(line, "trace %31s", kind) == 1 && count < TRACE_MOST) {
      trace_begin(&out[count++], kind);
      good = out[count - 1].kind >= 0;
    } else if (t && sscanf(line, "robot %d %lf %lf %lf", &robot, &a, &b, &c) == 4 && robot >= 0 && robot < 6) {
      t->start.robot[robot / 3][robot % 3].pose = (vs_pose){a, b, c};
      t->uses_robot[robot] = true;
    } else if (t && sscanf(line, "ball %lf %lf", &a, &b) == 2) {
      t->start.ball = (vs_ball){.x_m = a, .y_m = b, .valid = true};
    } else if (t && sscanf(line, "at %d %d %lf %lf", &frame, &robot, &a, &b) == 4 && robot >= 0 && robot < 6) {
      for (int f = frame; f < TRACE_FRAMES; f++) t->command[f][robot / 3][robot % 3] = (vs_wheels){a, b};
    } else {
      good = false;
    }
  }
  if (file) fclose(file);
  if (good) return count;
  vs_fail(err, VS_FAIL, "%s:%d: not a line of a trace", path, number);
  return -1;
}

static inline vs_status trace_play(vs_sim *sim, const trace *t, trace_run *out, vs_error *err) {
  vs_sim_reset(sim, NULL);
  vs_sim_place(sim, &t->start);
  for (int f = 0; f < TRACE_FRAMES; f++) {
    vs_status status = vs_sim_frame(sim, t->command[f], err);
    if (status != VS_OK) return status;
    vs_sim_world(sim, &out->world[f]);
  }
  return VS_OK;
}

typedef struct trace_errors {
  double position_m[1024], heading_rad[1024], ball_m[1024];
  int robots, balls;
} trace_errors;

static inline int trace_compare_numbers(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static inline double trace_quantile(double *values, int n, double q) {
  if (!n) return 0;
  qsort(values, (size_t)n, sizeof *values, trace_compare_numbers);
  return values[(int)(q * (n - 1) + 0.5)];
}

// Differences at the end of the second; the ball counts where the trace moved it (a robot met it in either run).
static inline void trace_add_errors(trace_errors *e, const trace *t, const trace_run *a, const trace_run *b) {
  const vs_world *x = &a->world[TRACE_FRAMES - 1], *y = &b->world[TRACE_FRAMES - 1];
  for (int r = 0; r < 6; r++) {
    if (!t->uses_robot[r]) continue;
    vs_pose p = x->robot[r / 3][r % 3].pose, q = y->robot[r / 3][r % 3].pose;
    e->position_m[e->robots] = vs_distance_m(p.x_m, p.y_m, q.x_m, q.y_m);
    e->heading_rad[e->robots++] = fabs(vs_wrap_rad(p.theta_rad - q.theta_rad));
  }
  double moved = fmax(vs_distance_m(x->ball.x_m, x->ball.y_m, t->start.ball.x_m, t->start.ball.y_m),
                      vs_distance_m(y->ball.x_m, y->ball.y_m, t->start.ball.x_m, t->start.ball.y_m));
  if (moved > 0.01) e->ball_m[e->balls++] = vs_distance_m(x->ball.x_m, x->ball.y_m, y->ball.x_m, y->ball.y_m);
}

#endif
