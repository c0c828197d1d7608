// The environments: simulated seconds a second with referee, observations and rewards at 10 Hz decisions, 3 against 3,
// with random actions and with all robots driving at the ball; beside them a bare mj_step loop of the same model through
// the states of random play, in the same run.
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "count_allocations.h"
#include "vsss/clock.h"
#include "vsss/vecenv.h"

enum { RUNS = 7, ENVS = 16, STEPS = 60, RECORDED = 400, RESETS = 400 };
#define DECISION_S (1.0 / VS_DECISION_HZ)

static void die(const vs_error *err) {
  fprintf(stderr, "bench_env: %s\n", err->text);
  exit(err->status);
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *value, int n) {
  qsort(value, (size_t)n, sizeof *value, by_value);
  return value[n / 2];
}

static double wall_s(void) { return (double)vs_clock_monotonic_us() * 1e-6; }

// Processor time of this process: what one core does, whatever else runs on it.
static double cpu_s(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// A vecenv with both teams external, and the arrays it writes.
typedef struct arena {
  vs_vecenv *vec;
  vs_vecenv_buffers buffers;
  vs_rng rng;
} arena;

static void open_arena(arena *a, const vs_model *model, int threads) {
  vs_error err = {0};
  vs_vecenv_def def = {.env = vs_env_def_default(model), .envs = ENVS, .threads = threads, .seed = 1};
  def.env.referee = vs_referee_def_training();
  def.env.shuffle_adversaries = true;
  size_t rows = VS_VECENV_ROWS(ENVS);
  a->buffers = (vs_vecenv_buffers){.observation = calloc(rows * VS_OBS_SIZE, sizeof(float)),
                                   .action = calloc(rows * VS_ACTION_SIZE, sizeof(float)),
                                   .reward_terms = calloc(rows * VS_REWARD_TERMS, sizeof(double)),
                                   .done = calloc(ENVS, 1),
                                   .time_limit = calloc(ENVS, 1),
                                   .score = calloc((size_t)ENVS * VS_TEAMS, sizeof(int32_t)),
                                   .episode_s = calloc(ENVS, sizeof(float))};
  a->rng = vs_rng_make(2, 0);
  if (vs_vecenv_new(&def, &a->vec, &err) != VS_OK) die(&err);
  if (vs_vecenv_reset(a->vec, &a->buffers, &err) != VS_OK) die(&err);
}

static void close_arena(arena *a) {
  vs_vecenv_free(a->vec);
  free(a->buffers.observation);
  free(a->buffers.action);
  free(a->buffers.reward_terms);
  free(a->buffers.done);
  free(a->buffers.time_limit);
  free(a->buffers.score);
  free(a->buffers.episode_s);
}

typedef struct speed {
  double wall, core; // simulated seconds per second of the wall clock, of processor time
} speed;

// Every robot drives at the ball, as policies in training do: the scrum costs far more than random driving.
static void chase(const float *newest, float *action) {
  const float *heading = newest + VS_OBS_OWN_HEADING, *ball = newest + VS_OBS_ANGLES; // sin, cos
  float ahead = ball[1] * heading[1] + ball[0] * heading[0], aside = ball[0] * heading[1] - ball[1] * heading[0];
  action[0] += 0.8f * (ahead - aside);
  action[1] += 0.8f * (ahead + aside);
}

static speed play(arena *a, bool scrum) {
  vs_error err = {0};
  double wall_start = wall_s(), cpu_start = cpu_s(), noise = scrum ? 0.3 : 1.0;
  for (int i = 0; i < STEPS; i++) {
    for (int k = 0; k < VS_VECENV_ROWS(ENVS) * VS_ACTION_SIZE; k++)
      a->buffers.action[k] = (float)vs_rng_range(&a->rng, -noise, noise);
    for (int row = 0; scrum && row < VS_VECENV_ROWS(ENVS); row++)
      chase(a->buffers.observation + (size_t)row * VS_OBS_SIZE + VS_OBS_SIZE - VS_OBS_FRAME,
            a->buffers.action + (size_t)row * VS_ACTION_SIZE);
    if (vs_vecenv_step(a->vec, &a->buffers, &err) != VS_OK) die(&err);
  }
  double played_s = ENVS * STEPS * DECISION_S;
  return (speed){played_s / (wall_s() - wall_start), played_s / (cpu_s() - cpu_start)};
}

// States at decisions of a match with random actions.
typedef struct recording {
  const mjModel *mj;
  mjData *data;
  double *state[RECORDED]; // qpos, qvel, qacc_warmstart, ctrl, qfrc_applied
} recording;

static double *state_part(const mjModel *mj, mjData *d, int part, int *size) {
  double *const array[] = {d->qpos, d->qvel, d->qacc_warmstart, d->ctrl, d->qfrc_applied};
  const int sizes[] = {mj->nq, mj->nv, mj->nv, mj->nu, mj->nv};
  *size = part < 5 ? sizes[part] : 0;
  return part < 5 ? array[part] : NULL;
}

static void copy_state(const mjModel *mj, mjData *d, double *kept, bool save) {
  int size;
  double *live;
  for (int part = 0; (live = state_part(mj, d, part, &size)) != NULL; kept += size, part++) {
    if (save)
      memcpy(kept, live, (size_t)size * sizeof *kept);
    else
      memcpy(live, kept, (size_t)size * sizeof *kept);
  }
}

static void record(recording *r, const vs_model *model) {
  vs_error err = {0};
  vs_env_def def = vs_env_def_default(model);
  def.referee = vs_referee_def_training();
  vs_env *env = NULL;
  if (vs_env_new(&def, &env, &err) != VS_OK) die(&err);
  r->mj = vs_model_mjmodel(model);
  r->data = mj_makeData(r->mj);
  vs_rng rng = vs_rng_make(3, 0);
  for (int i = 0; i < RECORDED; i++) {
    if (vs_env_over(env) && vs_env_reset(env, (uint64_t)i, &err) != VS_OK) die(&err);
    for (int t = 0; t < VS_TEAMS; t++) {
      float action[VS_TEAM_SIZE * VS_ACTION_SIZE];
      for (int k = 0; k < VS_TEAM_SIZE * VS_ACTION_SIZE; k++) action[k] = (float)vs_rng_range(&rng, -1, 1);
      if (vs_env_set_action(env, (vs_team)t, action, &err) != VS_OK) die(&err);
    }
    vs_env_result result;
    if (vs_env_step(env, &result, &err) != VS_OK) die(&err);
    r->state[i] = malloc((size_t)(r->mj->nq + 3 * r->mj->nv + r->mj->nu) * sizeof(double));
    copy_state(r->mj, vs_sim_mjdata(vs_env_sim(env)), r->state[i], true);
  }
  vs_env_free(env);
}

static void forget(recording *r) {
  for (int i = 0; i < RECORDED; i++) free(r->state[i]);
  mj_deleteData(r->data);
}

// Simulated seconds per second of processor time of mj_step alone: one decision's steps from each recorded state, controls held.
static double step_barely(const recording *r, int steps) {
  double start = cpu_s();
  for (int i = 0; i < RECORDED; i++) {
    copy_state(r->mj, r->data, r->state[i], false);
    for (int k = 0; k < steps; k++) mj_step(r->mj, r->data);
  }
  return RECORDED * steps * r->mj->opt.timestep / (cpu_s() - start);
}

static double reset_us(const vs_model *model) {
  vs_error err = {0};
  vs_env_def def = vs_env_def_default(model);
  def.referee = vs_referee_def_training();
  vs_env *env = NULL;
  if (vs_env_new(&def, &env, &err) != VS_OK) die(&err);
  double start = cpu_s();
  for (int i = 0; i < RESETS; i++)
    if (vs_env_reset(env, (uint64_t)i, &err) != VS_OK) die(&err);
  double spent_s = cpu_s() - start;
  vs_env_free(env);
  return spent_s / RESETS * 1e6;
}

static void bench_drive(vs_drive drive) {
  vs_error err = {0};
  vs_model *model = NULL;
  vs_model_def def = vs_model_def_default(drive);
  if (vs_model_load(&def, &model, &err) != VS_OK) die(&err);
  int steps = vs_model_substeps(model) * VS_CAMERA_HZ / VS_DECISION_HZ;
  arena one, two;
  recording bare;
  open_arena(&one, model, 1);
  open_arena(&two, model, 2);
  record(&bare, model);
  double single[RUNS], core[RUNS], doubled[RUNS], scaling[RUNS], stepped[RUNS], overhead[RUNS], resets[RUNS],
      scrum[RUNS];
  long allocated = 0;
  play(&one, false); // warm
  for (int i = 0; i < RUNS; i++) {
    long before = allocations_so_far();
    speed on_one = play(&one, false), on_two = play(&two, false);
    allocated += allocations_so_far() - before;
    stepped[i] = step_barely(&bare, steps);
    single[i] = on_one.wall;
    core[i] = on_one.core;
    doubled[i] = on_two.wall;
    scaling[i] = on_two.wall / on_one.wall;
    overhead[i] = stepped[i] / on_one.core;
    resets[i] = reset_us(model);
    scrum[i] = play(&one, true).core;
  }
  const char *name = vs_drive_name(drive);
  printf("bench env_%s_physics_step %.3f ms\n", name, 1000 * vs_model_step_s(model));
  printf("bench env_%s_per_core %.1f simulated_s/cpu_s\n", name, median(core, RUNS));
  printf("bench env_%s_scrum_per_core %.1f simulated_s/cpu_s\n", name, median(scrum, RUNS));
  printf("bench env_%s_1_thread %.1f simulated_s/s\n", name, median(single, RUNS));
  printf("bench env_%s_2_threads %.1f simulated_s/s\n", name, median(doubled, RUNS));
  printf("bench env_%s_scaling %.2f x\n", name, median(scaling, RUNS));
  printf("bench env_%s_bare_mj_step %.1f simulated_s/cpu_s\n", name, median(stepped, RUNS));
  printf("bench env_%s_overhead %.3f x\n", name, median(overhead, RUNS));
  printf("bench env_%s_reset %.1f us\n", name, median(resets, RUNS));
  printf("bench env_%s_allocations %.3f per_step\n", name, (double)allocated / (2.0 * RUNS * STEPS));
  fflush(stdout);
  forget(&bare);
  close_arena(&one);
  close_arena(&two);
  vs_model_free(model);
}

int main(void) {
  bench_drive(VS_DRIVE_PLANAR);
  bench_drive(VS_DRIVE_CONTACT);
  return 0;
}
