// The simulator's speed and accuracy: simulated seconds per second of both drives, how much of it is MuJoCo's own step
// loop, a reset, and how far each drive at each physics step is from the contact drive at a 1 ms step after one second
// of the recorded commands of tests/data/drive_traces.txt. The default steps (sim_model.c) were chosen by that table.
#include <mujoco/mujoco.h>

#include "sim/traces.h"
#include "vsss/clock.h"
#include "vsss/field.h"
#include "vsss/rng.h"

enum { RUNS = 15, FRAMES = 300, FINE_CONTACT = 34 };

static double seconds(void) { return 1e-6 * (double)vs_clock_monotonic_us(); }

static void give_up(const vs_error *err) {
  fprintf(stderr, "%s\n", err->text);
  exit(1);
}

static void open_sim(vs_drive drive, int substeps, vs_model **model, vs_sim **sim) {
  vs_error err = {0};
  vs_model_def def = vs_model_def_default(drive);
  def.substeps_per_frame = substeps;
  if (vs_model_load(&def, model, &err) != VS_OK || vs_sim_new(*model, sim, &err) != VS_OK) give_up(&err);
}

static double median(double *values, int n) { return trace_quantile(values, n, 0.5); }

// Random commands at 10 Hz, the hardest play for the solver: wheels slip and robots crash all the time.
static void random_commands(vs_rng *rng, vs_wheels command[VS_TEAMS][VS_TEAM_MOST]) {
  for (int i = 0; i < VS_TEAMS * VS_TEAM_SIZE; i++) {
    double left = vs_rng_range(rng, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
    double right = vs_rng_range(rng, -VS_WHEEL_LIMIT_RADPS, VS_WHEEL_LIMIT_RADPS);
    command[i / VS_TEAM_SIZE][i % VS_TEAM_SIZE] = (vs_wheels){left, right};
  }
}

// What the drive gave MuJoCo in each step, to repeat the same motion by bare mj_step calls.
typedef struct tape {
  double *input;
  int size;
} tape;

static double play(vs_sim *sim, uint64_t seed) {
  vs_error err = {0};
  vs_rng rng = vs_rng_make(seed, 0);
  vs_wheels command[VS_TEAMS][VS_TEAM_MOST];
  vs_sim_reset(sim, NULL);
  double start = seconds();
  for (int f = 0; f < FRAMES; f++) {
    if (f % 3 == 0) random_commands(&rng, command);
    if (vs_sim_frame(sim, command, &err) != VS_OK) give_up(&err);
  }
  return seconds() - start;
}

// The applied forces change every step, the frame's function gives no hook: record them through MuJoCo's callback.
static tape recording;
static int recorded;
static void record_step(const mjModel *m, mjData *d) {
  memcpy(recording.input + (size_t)recorded * recording.size, d->ctrl, sizeof(double) * m->nu);
  memcpy(recording.input + (size_t)recorded * recording.size + m->nu, d->qfrc_applied, sizeof(double) * m->nv);
  recorded++;
}

static double bare_loop(vs_model *model, vs_sim *sim, uint64_t seed) {
  const mjModel *m = vs_model_mjmodel(model);
  mjData *d = vs_sim_mjdata(sim);
  int steps = FRAMES * vs_model_substeps(model);
  recording.size = m->nu + m->nv;
  recording.input = malloc(sizeof(double) * (size_t)steps * recording.size);
  recorded = 0;
  mjcb_control = record_step;
  play(sim, seed);
  mjcb_control = NULL;
  vs_sim_reset(sim, NULL);
  double start = seconds();
  for (int i = 0; i < steps; i++) {
    memcpy(d->ctrl, recording.input + (size_t)i * recording.size, sizeof(double) * m->nu);
    memcpy(d->qfrc_applied, recording.input + (size_t)i * recording.size + m->nu, sizeof(double) * m->nv);
    mj_step(m, d);
  }
  double took = seconds() - start;
  free(recording.input);
  return took;
}

static void speed(vs_drive drive) {
  vs_model *model;
  vs_sim *sim;
  open_sim(drive, 0, &model, &sim);
  double ours[RUNS], bare[RUNS], ratio[RUNS], reset[RUNS], place[RUNS];
  vs_world world;
  vs_sim_world(sim, &world);
  for (int r = 0; r < RUNS; r++) {
    ours[r] = play(sim, (uint64_t)r);
    bare[r] = bare_loop(model, sim, (uint64_t)r);
    ratio[r] = ours[r] / bare[r];
    double start = seconds();
    for (int i = 0; i < 1000; i++) vs_sim_reset(sim, NULL);
    double middle = seconds();
    for (int i = 0; i < 1000; i++) vs_sim_place(sim, &world);
    reset[r] = middle - start; // of 1000, in s: one, in ms; times 1000: us
    place[r] = seconds() - middle;
  }
  const char *name = vs_drive_name(drive);
  printf("bench sim_%s_step %.3f ms\n", name, 1e3 * vs_model_step_s(model));
  printf("bench sim_%s_speed %.0f sim_s/s\n", name, FRAMES / 30.0 / median(ours, RUNS));
  printf("bench sim_%s_bare_mj_step_speed %.0f sim_s/s\n", name, FRAMES / 30.0 / median(bare, RUNS));
  printf("bench sim_%s_overhead %.3f ratio\n", name, median(ratio, RUNS));
  printf("bench sim_%s_reset %.2f us\n", name, 1e3 * median(reset, RUNS));
  printf("bench sim_%s_place %.2f us\n", name, 1e3 * median(place, RUNS));
  vs_sim_free(sim);
  vs_model_free(model);
}

static trace traces[TRACE_MOST];
static trace_run fine[TRACE_MOST], usual[TRACE_MOST];

static void play_all(vs_drive drive, int substeps, int count, trace_run *out) {
  vs_model *model;
  vs_sim *sim;
  vs_error err = {0};
  open_sim(drive, substeps, &model, &sim);
  for (int i = 0; i < count; i++) {
    if (trace_play(sim, &traces[i], &out[i], &err) != VS_OK) give_up(&err);
  }
  vs_sim_free(sim);
  vs_model_free(model);
}

static void print_errors(const char *name, trace_errors *e) {
  printf("bench sim_agree_%s_position %.1f mm\n", name, 1e3 * trace_quantile(e->position_m, e->robots, 0.5));
  printf("bench sim_agree_%s_heading %.1f deg\n", name, 180 / VS_PI * trace_quantile(e->heading_rad, e->robots, 0.5));
  if (e->balls) printf("bench sim_agree_%s_ball %.1f mm\n", name, 1e3 * trace_quantile(e->ball_m, e->balls, 0.5));
}

// One row of the table by which the steps were chosen.
static void step_row(vs_drive drive, int substeps, int count) {
  static trace_run runs[TRACE_MOST];
  static trace_errors all;
  char name[48];
  memset(&all, 0, sizeof all);
  play_all(drive, substeps, count, runs);
  for (int i = 0; i < count; i++) {
    if (traces[i].kind < TRACE_MELEE) trace_add_errors(&all, &traces[i], &fine[i], &runs[i]);
  }
  snprintf(name, sizeof name, "%s_%.1fms_to_contact_1ms", vs_drive_name(drive), 1e3 / 30 / substeps);
  print_errors(name, &all);
}

static void agreement(void) {
  static trace_errors kind[TRACE_KINDS], all;
  static trace_run planar[TRACE_MOST];
  vs_error err = {0};
  int count = traces_load(traces, &err);
  if (count < 0) give_up(&err);
  play_all(VS_DRIVE_CONTACT, 0, count, usual);
  play_all(VS_DRIVE_PLANAR, 0, count, planar);
  for (int i = 0; i < count; i++) {
    trace_add_errors(&kind[traces[i].kind], &traces[i], &usual[i], &planar[i]);
    if (traces[i].kind < TRACE_MELEE) trace_add_errors(&all, &traces[i], &usual[i], &planar[i]);
  }
  for (int k = 0; k < TRACE_KINDS; k++) print_errors(trace_kind_name[k], &kind[k]);
  print_errors("planar_to_contact", &all);
  play_all(VS_DRIVE_CONTACT, FINE_CONTACT, count, fine);
  for (int substeps = 4; substeps <= 8; substeps++) step_row(VS_DRIVE_CONTACT, substeps, count);
  for (int substeps = 3; substeps <= 8; substeps++) step_row(VS_DRIVE_PLANAR, substeps, count);
}

int main(void) {
  speed(VS_DRIVE_CONTACT);
  speed(VS_DRIVE_PLANAR);
  agreement();
  return 0;
}
