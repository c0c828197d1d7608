#include "net.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"

vs_status vs_net_init(vs_net *net, const vs_net_shape *shape, vs_error *err) {
  if (shape->layers < 1 || shape->layers > VS_NET_MAX_LAYERS)
    return vs_fail(err, VS_USAGE, "%d hidden layers: allowed are 1 to %d", shape->layers, VS_NET_MAX_LAYERS);
  *net = (vs_net){.shape = *shape, .nets = shape->critic ? 2 : 1};
  size_t at = 0;
  for (int l = 0; l < shape->layers; l++) {
    if (shape->width[l] < 1 || shape->width[l] > 4096)
      return vs_fail(err, VS_USAGE, "hidden layer of %d units: allowed are 1 to 4096", shape->width[l]);
    size_t width = (size_t)shape->width[l], inputs = (size_t)(l ? shape->width[l - 1] : shape->inputs);
    for (int n = 0; n < net->nets; n++) {
      // Layer 0: one matrix of N * width columns.
      net->weight[l][n] = l == 0 ? at + (size_t)n * width : at;
      if (l > 0) at += inputs * width;
    }
    if (l == 0) at += inputs * width * (size_t)net->nets;
    net->bias[l] = at;
    at += width * (size_t)net->nets;
  }
  size_t last = (size_t)shape->width[shape->layers - 1];
  for (int n = 0; n < net->nets; n++) {
    net->head_weight[n] = at;
    at += last * (size_t)vs_net_outputs(net, n);
    net->head_bias[n] = at;
    at += (size_t)vs_net_outputs(net, n);
  }
  net->size = at;
  return VS_OK;
}

// Columns (where there are at least as many rows) or rows of m made orthonormal by Gram-Schmidt, in double, from normal
// random numbers. m: count vectors of `length` doubles, count <= length.
static void orthonormal(double *m, int count, int length, vs_rng *rng) {
  for (int i = 0; i < count; i++) {
    double *v = m + (size_t)i * (size_t)length;
    for (int k = 0; k < length; k++) v[k] = vs_rng_normal(rng);
    for (int j = 0; j < i; j++) {
      const double *u = m + (size_t)j * (size_t)length;
      double along = 0.0;
      for (int k = 0; k < length; k++) along += u[k] * v[k];
      for (int k = 0; k < length; k++) v[k] -= along * u[k];
    }
    double norm = 0.0;
    for (int k = 0; k < length; k++) norm += v[k] * v[k];
    for (int k = 0; k < length; k++) v[k] /= sqrt(norm);
  }
}

// A matrix [inputs][outputs] stored with the two strides.
static void randomise(float *weight, int inputs, int outputs, size_t in_stride, size_t out_stride, double gain,
                      double *scratch, vs_rng *rng) {
  bool by_output = outputs <= inputs;
  int count = by_output ? outputs : inputs, length = by_output ? inputs : outputs;
  orthonormal(scratch, count, length, rng);
  for (int i = 0; i < count; i++)
    for (int k = 0; k < length; k++) {
      size_t in = (size_t)(by_output ? k : i), out = (size_t)(by_output ? i : k);
      weight[in * in_stride + out * out_stride] = (float)(gain * scratch[(size_t)i * (size_t)length + (size_t)k]);
    }
}

vs_status vs_net_randomise(const vs_net *net, double initial_concentration, vs_rng *rng, float *parameters,
                           vs_error *err) {
  const vs_net_shape *s = &net->shape;
  double *scratch = malloc(net->size * sizeof *scratch);
  if (!scratch) return vs_fail(err, VS_FAIL, "out of memory for %zu parameters", net->size);
  memset(parameters, 0, net->size * sizeof *parameters);
  for (int n = 0; n < net->nets; n++) {
    for (int l = 0; l < s->layers; l++) {
      size_t stride = (size_t)s->width[l] * (l == 0 ? (size_t)net->nets : 1);
      randomise(parameters + net->weight[l][n], l ? s->width[l - 1] : s->inputs, s->width[l], stride, 1, sqrt(2.0),
                scratch, rng);
    }
    int last = s->width[s->layers - 1];
    randomise(parameters + net->head_weight[n], last, vs_net_outputs(net, n), 1, (size_t)last,
              n == VS_ACTOR ? 0.01 : 1.0, scratch, rng);
  }
  free(scratch);
  // 1 + softplus(b) = initial_concentration.
  float *bias = parameters + net->head_bias[VS_ACTOR];
  for (int i = 0; i < 2 * s->actions; i++) bias[i] = (float)log(expm1(initial_concentration - 1.0));
  return VS_OK;
}

void vs_net_extract_actor(const vs_net *net, const float *parameters, const vs_net *actor, float *out) {
  const vs_net_shape *s = &net->shape;
  size_t first = (size_t)s->width[0];
  for (size_t i = 0; i < (size_t)s->inputs; i++)
    memcpy(out + actor->weight[0][0] + i * first, parameters + net->weight[0][VS_ACTOR] + i * first * (size_t)net->nets,
           first * sizeof *out);
  for (int l = 0; l < s->layers; l++) {
    size_t width = (size_t)s->width[l];
    memcpy(out + actor->bias[l], parameters + net->bias[l], width * sizeof *out);
    if (l > 0)
      memcpy(out + actor->weight[l][0], parameters + net->weight[l][VS_ACTOR],
             (size_t)s->width[l - 1] * width * sizeof *out);
  }
  size_t head = (size_t)s->width[s->layers - 1] * 2 * (size_t)s->actions;
  memcpy(out + actor->head_weight[0], parameters + net->head_weight[VS_ACTOR], head * sizeof *out);
  memcpy(out + actor->head_bias[0], parameters + net->head_bias[VS_ACTOR], 2 * (size_t)s->actions * sizeof *out);
}

// Hands out parts of one block, each beginning on a cache line; with base NULL it only counts.
typedef struct arena {
  unsigned char *base;
  size_t used; // bytes
} arena;

static void *room(arena *a, size_t count, size_t size) {
  void *out = a->base ? a->base + a->used : NULL;
  a->used += (count * size + 63) / 64 * 64;
  return out;
}

static void lay_out(vs_net_work *work, const vs_net *net, bool backward, arena *a) {
  const vs_net_shape *s = &net->shape;
  size_t rows = (size_t)work->rows;
  for (int l = 0; l < s->layers; l++) {
    size_t size = rows * (size_t)(net->nets * s->width[l]);
    work->hidden[l] = room(a, size, sizeof(float));
    if (backward) work->gradient[l] = room(a, size, sizeof(float));
    if (!work->bf16) continue;
    work->bf16_hidden[l] = room(a, size, sizeof(uint16_t));
    work->bf16_gradient[l] = room(a, size, sizeof(uint16_t));
  }
  if (work->bf16) work->bf16_x = room(a, rows * (size_t)s->inputs, sizeof(uint16_t));
  work->raw = room(a, rows * 2 * (size_t)s->actions, sizeof(float));
  work->value = room(a, rows, sizeof(float));
  if (!backward) return;
  work->d_raw = room(a, rows * 2 * (size_t)s->actions, sizeof(float));
  work->d_value = room(a, rows, sizeof(float));
}

vs_status vs_net_work_init(vs_net_work *work, const vs_net *net, int rows, bool backward, const uint16_t *bf16,
                           vs_error *err) {
  *work = (vs_net_work){.rows = rows, .bf16 = bf16};
  arena a = {0};
  lay_out(work, net, backward, &a);
  work->block = aligned_alloc(64, a.used);
  if (!work->block) return vs_fail(err, VS_FAIL, "out of memory for the activations of %d rows", rows);
  memset(work->block, 0, a.used);
  a = (arena){.base = work->block};
  lay_out(work, net, backward, &a);
  return VS_OK;
}

void vs_net_work_free(vs_net_work *work) {
  free(work->block);
  *work = (vs_net_work){0};
}

void vs_net_forward(const vs_net *net, const vs_blas *blas, const float *parameters, const float *x, int rows,
                    vs_net_work *work) {
  const vs_net_shape *s = &net->shape;
  const int nets = net->nets, top = s->layers - 1;
  for (int l = 0; l <= top; l++) {
    int width = s->width[l], all = nets * width;
    if (l == 0)
      vs_blas_multiply(blas, false, false, rows, all, s->inputs, x, s->inputs, parameters + net->weight[0][0], all,
                       false, work->hidden[0], all);
    else
      for (int n = 0; n < nets; n++) {
        int before = s->width[l - 1];
        vs_blas_multiply(blas, false, false, rows, width, before, work->hidden[l - 1] + n * before, nets * before,
                         parameters + net->weight[l][n], width, false, work->hidden[l] + n * width, all);
      }
    vs_kernel_bias_tanh(work->hidden[l], (size_t)rows, (size_t)all, parameters + net->bias[l]);
  }
  const int last = s->width[top], outputs = 2 * s->actions;
  const float *hidden = work->hidden[top];
  for (int o = 0; o < outputs; o++)
    vs_kernel_dot(hidden, (size_t)(nets * last), (size_t)rows, (size_t)last,
                  parameters + net->head_weight[VS_ACTOR] + o * last, parameters[net->head_bias[VS_ACTOR] + (size_t)o],
                  work->raw + o, (size_t)outputs);
  if (s->critic)
    vs_kernel_dot(hidden + last, (size_t)(nets * last), (size_t)rows, (size_t)last,
                  parameters + net->head_weight[VS_CRITIC], parameters[net->head_bias[VS_CRITIC]], work->value, 1);
}

// Gradients of the heads, and of the sums before the last hidden layer's tanh.
static void backward_heads(const vs_net *net, const float *parameters, int rows, vs_net_work *work, float *gradient) {
  const int top = net->shape.layers - 1, last = net->shape.width[top];
  for (int n = 0; n < net->nets; n++) {
    size_t outputs = (size_t)vs_net_outputs(net, n);
    vs_kernel_head_backward(work->hidden[top] + n * last, work->gradient[top] + n * last, (size_t)(net->nets * last),
                            (size_t)rows, (size_t)last, parameters + net->head_weight[n],
                            n == VS_ACTOR ? work->d_raw : work->d_value, outputs, gradient + net->head_weight[n],
                            gradient + net->head_bias[n]);
  }
}

// A matrix, or a part of one, in the one form or the other.
typedef struct operand {
  const float *full;
  const uint16_t *bf16; // NULL: full counts
} operand;

static operand part_of(const float *full, const uint16_t *bf16, size_t offset) {
  return bf16 ? (operand){NULL, bf16 + offset} : (operand){full + offset, NULL};
}

static void multiply(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k, operand a, int lda,
                     operand b, int ldb, bool accumulate, float *c, int ldc) {
  if (a.bf16)
    vs_blas_multiply_bf16(blas, transpose_a, transpose_b, m, n, k, a.bf16, lda, b.bf16, ldb, accumulate, c, ldc);
  else
    vs_blas_multiply(blas, transpose_a, transpose_b, m, n, k, a.full, lda, b.full, ldb, accumulate, c, ldc);
}

// The backward pass's operands into bfloat16.
static void round_inputs(const vs_net *net, const float *x, int rows, vs_net_work *work) {
  const vs_net_shape *s = &net->shape;
  vs_kernel_to_bf16(x, (size_t)rows * (size_t)s->inputs, work->bf16_x);
  for (int l = 0; l < s->layers - 1; l++)
    vs_kernel_to_bf16(work->hidden[l], (size_t)rows * (size_t)(net->nets * s->width[l]), work->bf16_hidden[l]);
}

void vs_net_backward(const vs_net *net, const vs_blas *blas, const float *parameters, const float *x, int rows,
                     vs_net_work *work, float *gradient) {
  const vs_net_shape *s = &net->shape;
  const int nets = net->nets;
  backward_heads(net, parameters, rows, work, gradient);
  if (work->bf16) round_inputs(net, x, rows, work);
  for (int l = s->layers - 1; l >= 0; l--) {
    const int width = s->width[l], all = nets * width;
    vs_kernel_column_sums(work->gradient[l], (size_t)rows, (size_t)all, gradient + net->bias[l]);
    if (work->bf16) vs_kernel_to_bf16(work->gradient[l], (size_t)rows * (size_t)all, work->bf16_gradient[l]);
    if (l == 0) {
      multiply(blas, true, false, s->inputs, all, rows, part_of(x, work->bf16_x, 0), s->inputs,
               part_of(work->gradient[0], work->bf16_gradient[0], 0), all, true, gradient + net->weight[0][0], all);
      continue;
    }
    const int before = s->width[l - 1], all_before = nets * before;
    for (int n = 0; n < nets; n++) {
      const operand above = part_of(work->gradient[l], work->bf16_gradient[l], (size_t)(n * width));
      multiply(blas, true, false, before, width, rows,
               part_of(work->hidden[l - 1], work->bf16_hidden[l - 1], (size_t)(n * before)), all_before, above, all,
               true, gradient + net->weight[l][n], width);
      multiply(blas, false, true, rows, before, width, above, all, part_of(parameters, work->bf16, net->weight[l][n]),
               width, false, work->gradient[l - 1] + n * before, all_before);
    }
    vs_kernel_tanh_backward(work->gradient[l - 1], work->hidden[l - 1], (size_t)rows * (size_t)all_before);
  }
}
