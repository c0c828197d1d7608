// The networks: a policy ("actor") and a value ("critic") perceptron with tanh layers of the same sizes, no shared
// weights. Their first layers read the same input and lie side by side in one matrix, so that one multiplication does
// both.
//
// Parameters are one flat float array; vs_net says where each part lies. A frozen opponent is a net without critic.
#ifndef VSSS_LEARN_NET_H
#define VSSS_LEARN_NET_H

#include <stdbool.h>
#include <stddef.h>

#include "blas.h"
#include "vsss/rng.h"

#define VS_NET_MAX_LAYERS 4
enum { VS_ACTOR = 0, VS_CRITIC = 1, VS_NETS = 2 };

typedef struct vs_net_shape {
  int inputs;
  int layers;                   // hidden ones, 1 to VS_NET_MAX_LAYERS
  int width[VS_NET_MAX_LAYERS]; // of each network
  int actions;                  // the actor has 2 * actions outputs: alpha's then beta's raw values
  bool critic;                  // false: the actor alone
} vs_net_shape;

// Offsets in floats. N: 2 with a critic, else 1. Weights of layer 0: [inputs][N * width[0]], the actor's columns first;
// of layer l > 0: [width[l-1]][width[l]] per network; biases [N * width[l]]; heads [outputs][width[last]], biases
// [outputs].
typedef struct vs_net {
  vs_net_shape shape;
  int nets;
  size_t weight[VS_NET_MAX_LAYERS][VS_NETS], bias[VS_NET_MAX_LAYERS];
  size_t head_weight[VS_NETS], head_bias[VS_NETS];
  size_t size; // all parameters
} vs_net;

vs_status vs_net_init(vs_net *net, const vs_net_shape *shape, vs_error *err);
// Of the head: 2 * actions, or 1. Inline, for the module of libtorch.
static inline int vs_net_outputs(const vs_net *net, int which) {
  return which == VS_ACTOR ? 2 * net->shape.actions : 1;
}

// Orthogonal weights of gain sqrt 2 (heads: 0.01 and 1; Saxe et al. 2014), zero biases but the actor's last, which
// makes alpha = beta = initial_concentration (> 1) where the weights say nothing.
vs_status vs_net_randomise(const vs_net *net, double initial_concentration, vs_rng *rng, float *parameters,
                           vs_error *err);

// The actor's part of parameters of `net` as parameters of `actor` (made with the same shape, critic = false).
void vs_net_extract_actor(const vs_net *net, const float *parameters, const vs_net *actor, float *out);

// Room for the activations of up to `rows` rows; one per thread. With `bf16` the backward pass multiplies bfloat16 numbers
// (8 bits of mantissa), added up in float. The forward pass never does: what the robots see would be rounded to steps of
// 3 mm, and four of four trial runs earned less with it.
typedef struct vs_net_work {
  int rows;
  const uint16_t *bf16; // borrowed: the parameters rounded to bfloat16 by the owner; NULL: products of floats
  uint16_t *bf16_x, *bf16_hidden[VS_NET_MAX_LAYERS], *bf16_gradient[VS_NET_MAX_LAYERS]; // of backward with bf16
  float *hidden[VS_NET_MAX_LAYERS];                                                     // [rows][N * width]
  float *gradient[VS_NET_MAX_LAYERS]; // the same; NULL where made without backward
  float *raw, *value;                 // [rows][2 * actions], [rows]: the outputs; values are zeros without a critic
  float *d_raw, *d_value;             // the same: a loss's derivatives by them; NULL where made without backward
  void *block;                        // owns all of the above but bf16
} vs_net_work;

vs_status vs_net_work_init(vs_net_work *work, const vs_net *net, int rows, bool backward, const uint16_t *bf16,
                           vs_error *err);
void vs_net_work_free(vs_net_work *work);

// x float[rows][inputs] -> work->raw, work->value. rows <= work->rows.
void vs_net_forward(const vs_net *net, const vs_blas *blas, const float *parameters, const float *x, int rows,
                    vs_net_work *work);

// After vs_net_forward on the same x, and work->d_raw and work->d_value filled in by the caller: the gradient of that loss
// is added to gradient[net->size].
void vs_net_backward(const vs_net *net, const vs_blas *blas, const float *parameters, const float *x, int rows,
                     vs_net_work *work, float *gradient);

#endif
