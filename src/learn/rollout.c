#include "rollout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "beta.h"
#include "gae.h"
#include "vsss/geom.h"

enum { A = VS_ACTION_SIZE, CHUNK = 128 };

// One piece of inference: up to CHUNK rows of one network.
typedef struct infer_job {
  const vs_net *net;
  const float *parameters;
  const int *row; // in io.observation
  int count;
  int learning; // position of its first row among the learning rows; -1: a frozen self
} infer_job;

struct vs_rollout_scratch {
  int threads;
  vs_net_work *joint, *actor; // [threads]
  float *gathered;            // [threads][CHUNK][inputs]
  int *frozen_row;            // [all rows]: rows of frozen selves, grouped
  infer_job *job;
  int jobs, jobs_max;
  // Of the step being worked on:
  vs_rollout *rollout;
  int t;
  bool keep; // false: values only, of the state after the last step
};

static int all_rows(const vs_rollout *r) { return VS_VECENV_ROWS(r->def.envs); }

static void *zeroed(size_t count, size_t size, bool *failed) {
  void *p = calloc(count ? count : 1, size);
  if (!p) *failed = true;
  return p;
}

static bool allocate_io(vs_rollout *r) {
  bool failed = false;
  size_t rows = (size_t)all_rows(r), envs = (size_t)r->def.envs;
  r->io.observation = zeroed(rows * VS_OBS_SIZE, sizeof(float), &failed);
  r->io.final_observation = zeroed(rows * VS_OBS_SIZE, sizeof(float), &failed);
  r->io.action = zeroed(rows * A, sizeof(float), &failed);
  r->io.reward_terms = zeroed(rows * VS_REWARD_TERMS, sizeof(double), &failed);
  r->io.done = zeroed(envs, 1, &failed);
  r->io.time_limit = zeroed(envs, 1, &failed);
  r->io.score = zeroed(envs * VS_TEAMS, sizeof(int32_t), &failed);
  r->io.episode_s = zeroed(envs, sizeof(float), &failed);
  return !failed;
}

static bool allocate_batch(vs_rollout *r) {
  bool failed = false;
  size_t n = (size_t)r->rows * (size_t)r->def.steps;
  float **const vectors[] = {&r->log_p, &r->advantage, &r->target, &r->reward, &r->truncated_value, &r->old_value};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) *vectors[i] = zeroed(n, sizeof(float), &failed);
  r->x = malloc(n * VS_OBS_SIZE * sizeof(float));
  r->log_u = zeroed(n * A, sizeof(float), &failed);
  r->log_1_u = zeroed(n * A, sizeof(float), &failed);
  r->value = zeroed(n + (size_t)r->rows, sizeof(float), &failed);
  r->end = zeroed(n, 1, &failed);
  r->turn = zeroed((size_t)r->rows, sizeof *r->turn, &failed);
  return r->x && !failed;
}

static vs_status allocate_scratch(vs_rollout *r, vs_error *err) {
  bool failed = false;
  struct vs_rollout_scratch *s = r->scratch = zeroed(1, sizeof *s, &failed);
  if (!s) return vs_fail(err, VS_FAIL, "out of memory");
  s->rollout = r;
  s->threads = vs_pool_threads(r->pool);
  size_t threads = (size_t)s->threads;
  s->joint = zeroed(threads, sizeof *s->joint, &failed);
  s->actor = zeroed(threads, sizeof *s->actor, &failed);
  s->gathered = zeroed(threads * CHUNK * VS_OBS_SIZE, sizeof(float), &failed);
  s->frozen_row = zeroed((size_t)all_rows(r), sizeof(int), &failed);
  // At worst every match meets another frozen self.
  s->jobs_max = all_rows(r) / CHUNK + r->def.envs + 2;
  s->job = zeroed((size_t)s->jobs_max, sizeof *s->job, &failed);
  if (failed) return vs_fail(err, VS_FAIL, "out of memory for %d matches", r->def.envs);
  for (int i = 0; i < s->threads; i++) {
    vs_status status = vs_net_work_init(&s->joint[i], r->net, CHUNK, false, NULL, err);
    if (status == VS_OK) status = vs_net_work_init(&s->actor[i], &r->actor, CHUNK, false, NULL, err);
    if (status != VS_OK) return status;
  }
  return VS_OK;
}

static bool team_learns(const vs_rollout *r, int env, int team) {
  return vs_league_kind(r->league, env) == VS_OPPONENT_SELF || r->league->slot[env].learner == (vs_team)team;
}

static bool list_learning_rows(vs_rollout *r) {
  r->row = malloc((size_t)all_rows(r) * sizeof *r->row);
  if (!r->row) return false;
  for (int row = 0; row < all_rows(r); row++) {
    int env = row / (VS_TEAMS * VS_TEAM_SIZE), team = row / VS_TEAM_SIZE % VS_TEAMS;
    if (team_learns(r, env, team)) r->row[r->rows++] = row;
  }
  return true;
}

vs_status vs_rollout_init(vs_rollout *rollout, const vs_rollout_def *def, const vs_learner *learner,
                          const vs_value_scale *scale, vs_league *league, vs_error *err) {
  *rollout = (vs_rollout){.def = *def,
                          .net = &learner->net,
                          .blas = &learner->blas,
                          .pool = learner->pool,
                          .league = league,
                          .scale = scale};
  vs_symmetry_table_init(&rollout->symmetry);
  vs_net_shape shape = learner->net.shape;
  shape.critic = false;
  vs_status s = vs_net_init(&rollout->actor, &shape, err);
  if (s == VS_OK && (!allocate_io(rollout) || !list_learning_rows(rollout) || !allocate_batch(rollout)))
    s = vs_fail(err, VS_FAIL, "out of memory for %d matches x %d steps: lower envs or steps", def->envs, def->steps);
  if (s == VS_OK) s = allocate_scratch(rollout, err);
  if (s != VS_OK) vs_rollout_free(rollout);
  return s;
}

static void free_scratch(struct vs_rollout_scratch *s) {
  if (!s) return;
  for (int i = 0; i < s->threads; i++) {
    if (s->joint) vs_net_work_free(&s->joint[i]);
    if (s->actor) vs_net_work_free(&s->actor[i]);
  }
  free(s->joint);
  free(s->actor);
  free(s->gathered);
  free(s->frozen_row);
  free(s->job);
  free(s);
}

void vs_rollout_free(vs_rollout *r) {
  free_scratch(r->scratch);
  void *const owned[] = {r->io.observation,
                         r->io.final_observation,
                         r->io.action,
                         r->io.reward_terms,
                         r->io.done,
                         r->io.time_limit,
                         r->io.score,
                         r->io.episode_s,
                         r->row,
                         r->x,
                         r->log_u,
                         r->log_1_u,
                         r->log_p,
                         r->advantage,
                         r->target,
                         r->value,
                         r->reward,
                         r->truncated_value,
                         r->old_value,
                         r->end,
                         r->turn};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
  *r = (vs_rollout){0};
}

// The version that row `row` of all is shown for the time being. Rows change theirs at different decisions.
static int drawn_version(const vs_rollout *r, int row) {
  uint64_t period = ((uint64_t)r->decision + (uint64_t)row) / (uint64_t)r->def.io.augment;
  vs_rng rng = vs_rng_make(vs_seed_mix(r->def.seed ^ UINT64_C(0x53594d4d), period), (uint64_t)row);
  return (int)vs_rng_below(&rng, VS_SYMMETRIES);
}

// What the network sees in place of an observation: its mirror image, and the robot by its other end.
enum { MIRRORED = 1, REVERSED = 2 };

// What the network sees of row `row` of all (observations float[rows][VS_OBS_SIZE]), and how it is turned.
static uint8_t show(const vs_rollout *r, const float *observations, int row, float *x) {
  const float *observation = observations + (size_t)row * VS_OBS_SIZE;
  float other_end[VS_OBS_SIZE];
  uint8_t turn = 0;
  if (r->def.io.reversible && vs_observation_faces_back(observation)) {
    vs_observation_reverse(observation, other_end);
    observation = other_end;
    turn = REVERSED;
  }
  if (!r->def.io.canonical && !r->def.io.augment) {
    memcpy(x, observation, VS_OBS_SIZE * sizeof *x);
    return turn;
  }
  int version = r->def.io.canonical ? vs_symmetry_canonical(observation) : drawn_version(r, row);
  vs_symmetry_apply(&r->symmetry, version, observation, x);
  return vs_symmetry_mirrored(version) ? turn | MIRRORED : turn;
}

// The wheel that the network's output k drives, and which way.
static int wheel_of(uint8_t turn, int k) { return turn == MIRRORED || turn == REVERSED ? 1 - k : k; }
static double way_of(uint8_t turn) { return turn & REVERSED ? -1.0 : 1.0; }

// How a row drives: its gain, and whether it samples or takes the mean.
typedef struct driving {
  double gain;
  bool mean;
} driving;

// Of a frozen self's row in the present episode of its match: in half of the episodes its team has one gain, in the others
// each robot its own.
static driving draw_driving(const vs_rollout *r, int row) {
  const vs_opponent_style *style = &r->def.opponent;
  int env = row / (VS_TEAMS * VS_TEAM_SIZE), robot = row % VS_TEAM_SIZE;
  vs_rng rng =
      vs_rng_make(vs_seed_mix(r->def.seed ^ UINT64_C(0x5354594c), (uint64_t)env), r->league->slot[env].episode);
  driving d = {.gain = r->def.io.action_gain, .mean = vs_rng_uniform(&rng) < style->mean};
  bool alike = vs_rng_below(&rng, 2) == 0;
  double part = vs_rng_uniform(&rng);
  for (int k = 0; k < robot && !alike; k++) part = vs_rng_uniform(&rng);
  if (style->gain_high > 0.0) d.gain = style->gain_low + part * (style->gain_high - style->gain_low);
  return d;
}

// Draws the action of one row: number `decision` of the row's own stream, whoever computes it. Of a frozen self
// (learning false) nothing is kept.
static void sample_row(vs_rollout *r, const float *raw, int row, uint8_t turn, size_t kept, bool learning) {
  vs_rng rng = vs_rng_make(vs_seed_mix(r->def.seed, (uint64_t)r->decision), (uint64_t)row);
  driving drives = {.gain = r->def.io.action_gain};
  if (!learning) drives = draw_driving(r, row);
  double log_p = 0.0;
  for (int k = 0; k < A; k++) {
    double alpha = 1.0 + vs_softplus(raw[k]), beta = 1.0 + vs_softplus(raw[A + k]);
    double u = drives.mean ? alpha / (alpha + beta) : vs_beta_sample(alpha, beta, &rng);
    r->io.action[row * A + wheel_of(turn, k)] =
        (float)(way_of(turn) * vs_clamp(drives.gain * (2.0 * u - 1.0), -1.0, 1.0));
    if (!learning) continue;
    float log_u = (float)log(u), log_1_u = (float)log1p(-u);
    r->log_u[kept * A + (size_t)k] = log_u;
    r->log_1_u[kept * A + (size_t)k] = log_1_u;
    log_p += vs_beta_log_density(alpha, beta, log_u, log_1_u);
  }
  if (learning) r->log_p[kept] = (float)log_p;
}

static void infer_piece(void *context, int piece, int thread) {
  struct vs_rollout_scratch *s = context;
  vs_rollout *r = s->rollout;
  const infer_job *job = &s->job[piece];
  bool learning = job->learning >= 0;
  size_t kept = (size_t)s->t * (size_t)r->rows + (size_t)(learning ? job->learning : 0);
  float *x = learning && s->keep ? r->x + kept * VS_OBS_SIZE : s->gathered + (size_t)thread * CHUNK * VS_OBS_SIZE;
  uint8_t turn[CHUNK];
  for (int i = 0; i < job->count; i++) {
    turn[i] = show(r, r->io.observation, job->row[i], x + (size_t)i * VS_OBS_SIZE);
    if (learning && s->keep) r->turn[job->learning + i] = turn[i];
  }
  vs_net_work *work = learning ? &s->joint[thread] : &s->actor[thread];
  vs_net_forward(job->net, r->blas, job->parameters, x, job->count, work);
  for (int i = 0; i < job->count; i++) {
    size_t at = kept + (size_t)i;
    if (learning) r->value[at] = vs_value_in_reward(r->scale, work->value[i]);
    if (s->keep && !r->watch) sample_row(r, work->raw + i * 2 * A, job->row[i], turn[i], at, learning);
  }
}

static void add_jobs(struct vs_rollout_scratch *s, infer_job job, int rows) {
  for (int from = 0; from < rows; from += CHUNK) {
    infer_job *j = &s->job[s->jobs++];
    *j = job;
    j->row = job.row + from;
    j->count = rows - from < CHUNK ? rows - from : CHUNK;
    if (job.learning >= 0) j->learning = from;
  }
}

// Rows of the frozen selves, grouped by self, so that each group is one network's batch.
static void add_frozen_jobs(vs_rollout *r) {
  struct vs_rollout_scratch *s = r->scratch;
  int used = 0;
  for (int self = 0; self < r->league->selves; self++) {
    if (r->league->self[self].users == 0) continue;
    int from = used;
    for (int env = 0; env < r->def.envs; env++) {
      const vs_league_slot *slot = &r->league->slot[env];
      if (slot->self != self) continue;
      int first = (env * VS_TEAMS + (slot->learner == VS_BLUE)) * VS_TEAM_SIZE;
      for (int k = 0; k < VS_TEAM_SIZE; k++) s->frozen_row[used++] = first + k;
    }
    add_jobs(s, (infer_job){&r->actor, r->league->self[self].parameters, s->frozen_row + from, 0, -1}, used - from);
  }
}

void vs_rollout_begin(vs_rollout *rollout) { rollout->stats = (vs_rollout_stats){0}; }

// The learning rows' jobs of step t.
static void begin_jobs(vs_rollout *r, int t, bool keep, const float *parameters) {
  struct vs_rollout_scratch *s = r->scratch;
  s->t = t;
  s->keep = keep;
  s->jobs = 0;
  add_jobs(s, (infer_job){r->net, parameters, r->row, 0, 0}, r->rows);
}

void vs_rollout_act(vs_rollout *rollout, int t, const float *parameters) {
  struct vs_rollout_scratch *s = rollout->scratch;
  begin_jobs(rollout, t, true, parameters);
  if (!rollout->watch) add_frozen_jobs(rollout);
  vs_pool_run(rollout->pool, s->jobs, infer_piece, s);
  rollout->decision++;
}

// What the last state of a truncated episode was worth to row `row` of all.
static float truncated_value(const vs_rollout *r, int row, const float *parameters) {
  vs_net_work *work = &r->scratch->joint[0];
  float x[VS_OBS_SIZE];
  show(r, r->io.final_observation, row, x);
  vs_net_forward(r->net, r->blas, parameters, x, 1, work);
  return vs_value_in_reward(r->scale, work->value[0]);
}

static void record_row(vs_rollout *r, int t, int i, const float *parameters, const vs_reward_weights *weights) {
  int row = r->row[i], env = row / (VS_TEAMS * VS_TEAM_SIZE);
  size_t at = (size_t)t * (size_t)r->rows + (size_t)i;
  const double *terms = r->io.reward_terms + (size_t)row * VS_REWARD_TERMS;
  double reward = 0.0;
  for (int k = 0; k < VS_REWARD_TERMS; k++) {
    reward += weights->weight[k] * terms[k];
    r->stats.terms[k] += terms[k];
  }
  r->reward[at] = (float)reward;
  r->stats.reward += reward;
  r->end[at] = !r->io.done[env] ? VS_GOES_ON : r->io.time_limit[env] ? VS_TRUNCATED : VS_TERMINATED;
  if (r->end[at] == VS_TRUNCATED) r->truncated_value[at] = truncated_value(r, row, parameters);
}

// What the scripts did in step t, as samples of a Beta distribution. Full speed is moved off the edge of [0, 1], where
// no density is finite.
static void watch_actions(vs_rollout *r, int t) {
  static const double edge = 0.02;
  for (int i = 0; i < r->rows; i++)
    for (int k = 0; k < A; k++) {
      const float *action = r->io.action + r->row[i] * A;
      double u = 0.5 * (way_of(r->turn[i]) * action[wheel_of(r->turn[i], k)] / r->def.io.action_gain + 1.0);
      u = vs_clamp(u, edge, 1.0 - edge);
      size_t at = ((size_t)t * (size_t)r->rows + (size_t)i) * A + (size_t)k;
      r->log_u[at] = (float)log(u);
      r->log_1_u[at] = (float)log1p(-u);
    }
}

void vs_rollout_record(vs_rollout *rollout, int t, const float *parameters, const vs_reward_weights *weights) {
  if (rollout->watch) watch_actions(rollout, t);
  for (int i = 0; i < rollout->rows; i++) record_row(rollout, t, i, parameters, weights);
  rollout->stats.transitions += rollout->rows;
  for (int env = 0; env < rollout->def.envs; env++) {
    if (!rollout->io.done[env]) continue;
    int side = rollout->league->slot[env].learner;
    int goals_for = rollout->io.score[env * VS_TEAMS + side], against = rollout->io.score[env * VS_TEAMS + !side];
    rollout->stats.episodes++;
    rollout->stats.episode_s += rollout->io.episode_s[env];
    rollout->stats.goals_for += goals_for;
    rollout->stats.goals_against += against;
    vs_league_episode_over(rollout->league, env, goals_for, against);
  }
}

void vs_rollout_bootstrap(vs_rollout *rollout, const float *parameters) {
  begin_jobs(rollout, rollout->def.steps, false, parameters);
  vs_pool_run(rollout->pool, rollout->scratch->jobs, infer_piece, rollout->scratch);
}

void vs_rollout_advantages(vs_rollout *rollout) {
  const vs_gae_batch batch = {.steps = rollout->def.steps,
                              .rows = rollout->rows,
                              .gamma = rollout->def.gamma,
                              .lambda = rollout->def.lambda,
                              .reward = rollout->reward,
                              .value = rollout->value,
                              .end = rollout->end,
                              .truncated_value = rollout->truncated_value};
  vs_gae(&batch, rollout->advantage, rollout->target);
}

vs_ppo_batch vs_rollout_batch(const vs_rollout *rollout) {
  return (vs_ppo_batch){.rows = rollout->rows * rollout->def.steps,
                        .x = rollout->x,
                        .log_u = rollout->log_u,
                        .log_1_u = rollout->log_1_u,
                        .old_log_p = rollout->log_p,
                        .advantage = rollout->advantage,
                        .target = rollout->target,
                        .old_value = rollout->old_value};
}
