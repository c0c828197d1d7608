#include "learner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"
#include "vsss/signals.h"

// BLOCK: the fastest of 128 to 1070 rows at the paper's sizes (make bench N=learn): what a product leaves is mostly still
// in the second-level cache when the next step reads it.
enum { A = VS_ACTION_SIZE, BLOCK = 192 };

// What one microbatch needs: a block of its rows gathered, activations, its part of the gradient.
struct vs_learner_part {
  int capacity; // rows of a block
  float *x, *log_u, *log_1_u, *old_log_p, *advantage, *target, *old_value;
  float *block; // owns the arrays above
  vs_net_work work;
  float *gradient; // [net.size]
  vs_ppo_stats stats;
};

static vs_status part_init(struct vs_learner_part *part, const vs_net *net, const uint16_t *bf16, int rows,
                           vs_error *err) {
  size_t n = (size_t)rows, inputs = (size_t)net->shape.inputs;
  part->capacity = rows;
  part->block = aligned_alloc(64, (n * (inputs + 2 * A + 4) + 15) / 16 * 16 * sizeof(float));
  part->gradient = aligned_alloc(64, (net->size + 15) / 16 * 16 * sizeof(float));
  if (!part->block || !part->gradient) return vs_fail(err, VS_FAIL, "out of memory for a minibatch of %d rows", rows);
  float *at = part->block;
  part->x = at, at += n * inputs;
  part->log_u = at, at += n * A;
  part->log_1_u = at, at += n * A;
  part->old_log_p = at, at += n;
  part->advantage = at, at += n;
  part->target = at, at += n;
  part->old_value = at;
  return vs_net_work_init(&part->work, net, rows, true, bf16, err);
}

static void part_free(struct vs_learner_part *part) {
  vs_net_work_free(&part->work);
  free(part->gradient);
  free(part->block);
}

vs_status vs_learner_init(vs_learner *learner, const vs_learner_def *def, vs_pool *pool, uint64_t seed, vs_error *err) {
  *learner = (vs_learner){.def = *def, .pool = pool};
  vs_status s = vs_blas_open(&learner->blas, VS_BLAS_ANY, err);
  bool can_bf16 = s == VS_OK && vs_blas_has_bf16(&learner->blas);
  if (s == VS_OK && def->precision == VS_PRECISION_BF16 && !can_bf16)
    s = vs_fail(err, VS_FAIL,
                "precision = bf16 needs oneDNN (apt install libdnnl-dev) and a processor with AVX512-BF16: --set "
                "precision=fp32");
  if (s == VS_OK) s = vs_net_init(&learner->net, &def->shape, err);
  if (s != VS_OK) return s;
  size_t size = (learner->net.size + 15) / 16 * 16;
  learner->parameters = aligned_alloc(64, 3 * size * sizeof(float));
  learner->gradient = aligned_alloc(64, size * sizeof(float));
  learner->part = calloc((size_t)def->microbatches, sizeof *learner->part);
  bool bf16 = can_bf16 && def->precision != VS_PRECISION_FP32;
  if (bf16) learner->bf16 = aligned_alloc(64, (size + 31) / 32 * 32 * sizeof(uint16_t));
  if (!learner->parameters || !learner->gradient || !learner->part || (bf16 && !learner->bf16))
    s = vs_fail(err, VS_FAIL, "out of memory for %zu parameters", size);
  int rows = (def->minibatch + def->microbatches - 1) / def->microbatches;
  int block = def->block ? def->block : BLOCK;
  if (rows > block) rows = block;
  for (int i = 0; s == VS_OK && i < def->microbatches; i++)
    s = part_init(&learner->part[i], &learner->net, learner->bf16, rows, err);
  if (s == VS_OK) {
    memset(learner->parameters, 0, 3 * size * sizeof(float));
    learner->m = learner->parameters + size;
    learner->v = learner->m + size;
    vs_rng rng = vs_rng_make(seed, 0);
    s = vs_net_randomise(&learner->net, def->initial_concentration, &rng, learner->parameters, err);
  }
  if (s != VS_OK) vs_learner_free(learner);
  return s;
}

void vs_learner_free(vs_learner *learner) {
  for (int i = 0; learner->part && i < learner->def.microbatches; i++) part_free(&learner->part[i]);
  free(learner->part);
  free(learner->order);
  free(learner->gradient);
  free(learner->bf16);
  free(learner->parameters);
  *learner = (vs_learner){0};
}

// A minibatch being worked on.
typedef struct job {
  vs_learner *learner;
  const vs_ppo_batch *batch;
  const vs_minibatch *minibatch;
} job;

// Rows from .. from + count of the minibatch.
static void gather(const job *j, struct vs_learner_part *part, int from, int count) {
  const vs_ppo_batch *b = j->batch;
  const vs_minibatch *minibatch = j->minibatch;
  size_t inputs = (size_t)j->learner->net.shape.inputs;
  for (int i = 0; i < count; i++) {
    size_t r = (size_t)minibatch->row[from + i], to = (size_t)i;
    memcpy(part->x + to * inputs, b->x + r * inputs, inputs * sizeof *b->x);
    for (size_t k = 0; k < A; k++) {
      part->log_u[to * A + k] = b->log_u[r * A + k];
      part->log_1_u[to * A + k] = b->log_1_u[r * A + k];
    }
    part->old_log_p[i] = b->old_log_p[r];
    part->advantage[i] = (float)((b->advantage[r] - minibatch->advantage_mean) * minibatch->advantage_scale);
    part->target[i] = b->target[r];
    part->old_value[i] = b->old_value[r];
  }
}

static vs_ppo_batch gathered(const struct vs_learner_part *part, int count) {
  return (vs_ppo_batch){count,           part->x,         part->log_u,  part->log_1_u,
                        part->old_log_p, part->advantage, part->target, part->old_value};
}

static void gradient_microbatch(void *context, int index, int thread) {
  (void)thread;
  const job *j = context;
  vs_learner *l = j->learner;
  struct vs_learner_part *part = &l->part[index];
  int from = (int)((long long)j->minibatch->rows * index / l->def.microbatches);
  int to = (int)((long long)j->minibatch->rows * (index + 1) / l->def.microbatches);
  const vs_ppo_outputs outputs = {part->work.raw, part->work.value, part->work.d_raw, part->work.d_value};
  part->stats = (vs_ppo_stats){0};
  memset(part->gradient, 0, l->net.size * sizeof(float));
  for (int at = from; at < to; at += part->capacity) {
    int count = to - at < part->capacity ? to - at : part->capacity;
    gather(j, part, at, count);
    const vs_ppo_batch batch = gathered(part, count);
    vs_net_forward(&l->net, &l->blas, l->parameters, part->x, count, &part->work);
    vs_ppo_loss(&l->def.ppo, &batch, &outputs, j->minibatch->total_rows, &part->stats);
    vs_net_backward(&l->net, &l->blas, l->parameters, part->x, count, &part->work, part->gradient);
  }
}

// Parameters are shared out in ranges for what is done to each alone.
enum { RANGES = 8 };

static void range_of(const vs_learner *l, int range, size_t *from, size_t *count) {
  *from = l->net.size * (size_t)range / RANGES;
  *count = l->net.size * (size_t)(range + 1) / RANGES - *from;
}

static void sum_range(void *context, int range, int thread) {
  (void)thread;
  vs_learner *l = context;
  size_t from, count;
  range_of(l, range, &from, &count);
  memcpy(l->gradient + from, l->part[0].gradient + from, count * sizeof(float));
  for (int i = 1; i < l->def.microbatches; i++) vs_kernel_add(l->gradient + from, l->part[i].gradient + from, count);
}

// The backward pass multiplies by the weights of the second layer and up.
static void round_range(void *context, int range, int thread) {
  (void)thread;
  vs_learner *l = context;
  size_t first = l->net.shape.layers > 1 ? l->net.weight[1][0] : l->net.size, all = l->net.size - first;
  size_t from = first + all * (size_t)range / RANGES, to = first + all * (size_t)(range + 1) / RANGES;
  vs_kernel_to_bf16(l->parameters + from, to - from, l->bf16 + from);
}

static void add_stats(vs_ppo_stats *sum, const vs_ppo_stats *part) {
  sum->rows += part->rows;
  sum->policy_loss += part->policy_loss;
  sum->value_loss += part->value_loss;
  sum->entropy += part->entropy;
  sum->kl += part->kl;
  sum->clipped += part->clipped;
}

// The same by another library, in parts as large as its workspace holds.
static vs_status engine_gradient(const job *j, vs_ppo_stats *stats, vs_error *err) {
  vs_learner *l = j->learner;
  memset(l->gradient, 0, l->net.size * sizeof(float));
  vs_status s = VS_OK;
  const int rows = j->minibatch->rows, capacity = l->part[0].capacity;
  for (int from = 0; s == VS_OK && from < rows; from += capacity) {
    int count = rows - from < capacity ? rows - from : capacity;
    gather(j, &l->part[0], from, count);
    const vs_ppo_batch batch = gathered(&l->part[0], count);
    vs_signals_hold(); // its products may be oneDNN's
    s = l->engine->gradient(l->engine->self, &l->net, &l->def.ppo, l->parameters, &batch, j->minibatch->total_rows,
                            l->part[0].gradient, stats, err);
    vs_signals_release();
    vs_kernel_add(l->gradient, l->part[0].gradient, l->net.size);
  }
  return s;
}

vs_status vs_learner_gradient(vs_learner *learner, const vs_ppo_batch *batch, const vs_minibatch *minibatch,
                              vs_ppo_stats *stats, vs_error *err) {
  job j = {learner, batch, minibatch};
  if (learner->engine) {
    vs_status s = engine_gradient(&j, stats, err);
    if (s != VS_OK) return s;
  } else {
    if (learner->bf16) vs_pool_run(learner->pool, RANGES, round_range, learner);
    vs_pool_run(learner->pool, learner->def.microbatches, gradient_microbatch, &j);
    for (int i = 0; i < learner->def.microbatches; i++) add_stats(stats, &learner->part[i].stats);
    vs_pool_run(learner->pool, RANGES, sum_range, learner);
  }
  const vs_group *g = learner->group;
  return g ? g->sum_floats(g->self, learner->gradient, learner->net.size, err) : VS_OK;
}

typedef struct step_job {
  vs_learner *learner;
  double squares[RANGES];
  vs_adam_step step;
} step_job;

static void norm_range(void *context, int range, int thread) {
  (void)thread;
  step_job *j = context;
  size_t from, count;
  range_of(j->learner, range, &from, &count);
  j->squares[range] = vs_kernel_square_sum(j->learner->gradient + from, count);
}

static void adam_range(void *context, int range, int thread) {
  (void)thread;
  step_job *j = context;
  vs_learner *l = j->learner;
  size_t from, count;
  range_of(l, range, &from, &count);
  vs_kernel_adam(l->parameters + from, l->gradient + from, l->m + from, l->v + from, count, &j->step);
}

double vs_learner_step(vs_learner *learner) {
  const vs_learner_def *def = &learner->def;
  step_job j = {.learner = learner};
  vs_pool_run(learner->pool, RANGES, norm_range, &j);
  double norm = 0.0;
  for (int i = 0; i < RANGES; i++) norm += j.squares[i];
  norm = sqrt(norm);
  learner->steps++;
  double t = (double)learner->steps, unbias = sqrt(1.0 - pow(def->adam_beta2, t));
  j.step = (vs_adam_step){.rate = (float)(def->learning_rate * unbias / (1.0 - pow(def->adam_beta1, t))),
                          .beta1 = (float)def->adam_beta1,
                          .beta2 = (float)def->adam_beta2,
                          .epsilon = (float)(def->adam_epsilon * unbias),
                          .scale = norm > def->max_gradient_norm ? (float)(def->max_gradient_norm / norm) : 1.0f};
  vs_pool_run(learner->pool, RANGES, adam_range, &j);
  return norm;
}

// Mean and 1/deviation of the advantages of a minibatch, over all ranks.
static vs_status normalise(const vs_learner *l, const vs_ppo_batch *batch, vs_minibatch *minibatch, vs_error *err) {
  double sums[3] = {minibatch->rows, 0.0, 0.0};
  for (int i = 0; i < minibatch->rows; i++) {
    double a = batch->advantage[minibatch->row[i]];
    sums[1] += a;
    sums[2] += a * a;
  }
  if (l->group) {
    vs_status s = l->group->sum_doubles(l->group->self, sums, 3, err);
    if (s != VS_OK) return s;
  }
  double mean = sums[1] / sums[0];
  minibatch->total_rows = sums[0];
  minibatch->advantage_mean = mean;
  minibatch->advantage_scale = 1.0 / (sqrt(fmax(0.0, sums[2] / sums[0] - mean * mean)) + 1e-8);
  return VS_OK;
}

// A permutation of the rows of all ranks, the same on every rank; each keeps its own rows of every minibatch.
static vs_status shuffle(vs_learner *l, size_t all, vs_rng *rng, vs_error *err) {
  if (l->order_size < all) {
    free(l->order);
    l->order = malloc(all * sizeof *l->order);
    l->order_size = l->order ? all : 0;
    if (!l->order) return vs_fail(err, VS_FAIL, "out of memory for a batch of %zu rows", all);
  }
  for (size_t i = 0; i < all; i++) l->order[i] = (int)i;
  vs_rng_shuffle(rng, l->order, (int)all);
  return VS_OK;
}

// Moves this rank's rows of order[0..count) to the front and makes them indices into its batch; returns how many.
static int own_rows(const vs_learner *l, int *order, int count, int rows_per_rank) {
  if (!l->group) return count;
  int own = 0;
  for (int i = 0; i < count; i++)
    if (order[i] / rows_per_rank == l->group->rank) order[own++] = order[i] % rows_per_rank;
  return own;
}

static vs_status epoch(vs_learner *l, const vs_ppo_batch *batch, vs_rng *rng, vs_learner_stats *stats, vs_error *err) {
  int all = batch->rows * (l->group ? l->group->size : 1), minibatches = 0;
  vs_status s = shuffle(l, (size_t)all, rng, err);
  for (int from = 0; s == VS_OK && from < all; from += l->def.minibatch) {
    int count = all - from < l->def.minibatch ? all - from : l->def.minibatch;
    vs_minibatch minibatch = {l->order + from, own_rows(l, l->order + from, count, batch->rows), 0.0, 0.0, 1.0};
    s = normalise(l, batch, &minibatch, err);
    if (s == VS_OK) s = vs_learner_gradient(l, batch, &minibatch, &stats->last, err);
    if (s == VS_OK) stats->gradient_norm += vs_learner_step(l);
    minibatches++;
  }
  if (!isfinite(stats->gradient_norm))
    return vs_fail(err, VS_FAIL, "the gradient is not finite: lower learning_rate (now %g)", l->def.learning_rate);
  stats->gradient_norm /= minibatches;
  return s;
}

static double explained_variance(const vs_ppo_batch *batch) {
  double sums[4] = {0};
  for (int i = 0; i < batch->rows; i++) {
    double target = batch->target[i], miss = target - batch->old_value[i];
    sums[0] += target, sums[1] += target * target, sums[2] += miss, sums[3] += miss * miss;
  }
  double n = batch->rows, variance = sums[1] / n - sums[0] / n * sums[0] / n;
  return variance > 0.0 ? 1.0 - (sums[3] / n - sums[2] / n * sums[2] / n) / variance : 0.0;
}

vs_status vs_learner_update(vs_learner *learner, const vs_ppo_batch *batch, uint64_t seed, vs_learner_stats *stats,
                            vs_error *err) {
  vs_rng rng = vs_rng_make(seed, 1);
  vs_status s = VS_OK;
  for (int e = 0; s == VS_OK && e < learner->def.epochs; e++) {
    *stats = (vs_learner_stats){0};
    s = epoch(learner, batch, &rng, stats, err);
  }
  stats->explained_variance = explained_variance(batch);
  return s;
}
