// The gradient of a minibatch by libtorch's automatic differentiation, written from the definitions in net.h and ppo.h
// and sharing nothing with our kernels but the layout of the parameters.
#include <torch/torch.h>

extern "C" {
#include "learner.h"
}

namespace {

using torch::Tensor;
using namespace torch::indexing;

// A view of the flat parameters.
Tensor view(const Tensor &flat, size_t offset, int64_t rows, int64_t columns) {
  return flat.narrow(0, static_cast<int64_t>(offset), rows * columns).view({rows, columns});
}

// Output of one of the two networks.
Tensor forward(const vs_net &net, const Tensor &flat, int which, Tensor x) {
  const vs_net_shape &s = net.shape;
  for (int l = 0; l < s.layers; l++) {
    int64_t width = s.width[l];
    Tensor weight;
    if (l == 0)
      weight = view(flat, net.weight[0][0], s.inputs, net.nets * width).narrow(1, which * width, width);
    else
      weight = view(flat, net.weight[l][which], s.width[l - 1], width);
    Tensor bias = flat.narrow(0, static_cast<int64_t>(net.bias[l]) + which * width, width);
    x = torch::tanh(torch::matmul(x, weight) + bias);
  }
  int64_t outputs = vs_net_outputs(&net, which), last = s.width[s.layers - 1];
  Tensor bias = flat.narrow(0, static_cast<int64_t>(net.head_bias[which]), outputs);
  return torch::matmul(x, view(flat, net.head_weight[which], outputs, last).t()) + bias;
}

Tensor rows_of(const float *data, int64_t rows, int64_t columns) {
  return torch::from_blob(const_cast<float *>(data),
                          columns ? std::vector<int64_t>{rows, columns} : std::vector<int64_t>{rows});
}

struct Loss {
  Tensor policy, value, entropy, kl, clipped; // sums over rows
};

Loss loss_of(const vs_ppo_def &def, const vs_ppo_batch &b, const Tensor &raw, const Tensor &value) {
  const int64_t actions = VS_ACTION_SIZE, n = b.rows;
  Tensor shape = 1 + torch::nn::functional::softplus(raw);
  Tensor alpha = shape.narrow(1, 0, actions), beta = shape.narrow(1, actions, actions), total = alpha + beta;
  Tensor log_norm = torch::lgamma(alpha) + torch::lgamma(beta) - torch::lgamma(total);
  Tensor log_p =
      ((alpha - 1) * rows_of(b.log_u, n, actions) + (beta - 1) * rows_of(b.log_1_u, n, actions) - log_norm).sum(1);
  Tensor entropy = (log_norm - (alpha - 1) * torch::digamma(alpha) - (beta - 1) * torch::digamma(beta) +
                    (total - 2) * torch::digamma(total))
                       .sum();
  Tensor advantage = rows_of(b.advantage, n, 0), log_ratio = log_p - rows_of(b.old_log_p, n, 0);
  Tensor ratio = log_ratio.exp(), limited = ratio.clamp(1 - def.clip, 1 + def.clip);
  Tensor policy = def.imitate ? -log_p.sum() : -torch::min(ratio * advantage, limited * advantage).sum();
  Tensor target = rows_of(b.target, n, 0), old = rows_of(b.old_value, n, 0);
  Tensor squares = (value - target).square();
  if (def.clip_value) squares = torch::max(squares, (old + (value - old).clamp(-def.clip, def.clip) - target).square());
  return {policy, 0.5 * squares.sum(), entropy, (ratio - 1 - log_ratio).sum(), (ratio != limited).sum()};
}

vs_status gradient(void *, const vs_net *net, const vs_ppo_def *def, const float *parameters, const vs_ppo_batch *batch,
                   double total_rows, float *out, vs_ppo_stats *stats, vs_error *err) {
  try {
    auto size = static_cast<int64_t>(net->size);
    Tensor flat = torch::from_blob(const_cast<float *>(parameters), {size}).clone().requires_grad_(true);
    Tensor x = rows_of(batch->x, batch->rows, net->shape.inputs);
    Tensor raw = forward(*net, flat, VS_ACTOR, x), value = forward(*net, flat, VS_CRITIC, x).squeeze(1);
    Loss loss = loss_of(*def, *batch, raw, value);
    Tensor total = (loss.policy - def->entropy * loss.entropy + def->value_weight * loss.value) / total_rows;
    total.backward();
    torch::from_blob(out, {size}).copy_(flat.grad());
    stats->rows += batch->rows;
    stats->policy_loss += loss.policy.item<double>();
    stats->value_loss += loss.value.item<double>();
    stats->entropy += loss.entropy.item<double>();
    stats->kl += loss.kl.item<double>();
    stats->clipped += loss.clipped.item<double>();
    return VS_OK;
  } catch (const std::exception &e) {
    return vs_fail(err, VS_FAIL, "libtorch: %.400s", e.what());
  }
}

vs_status outputs(void *, const vs_net *net, const float *parameters, const float *x, int rows, float *raw,
                  float *value, vs_error *err) {
  try {
    torch::NoGradGuard no_gradient;
    Tensor flat = torch::from_blob(const_cast<float *>(parameters), {static_cast<int64_t>(net->size)});
    Tensor in = rows_of(x, rows, net->shape.inputs);
    rows_of(raw, rows, vs_net_outputs(net, VS_ACTOR)).copy_(forward(*net, flat, VS_ACTOR, in));
    if (net->shape.critic) rows_of(value, rows, 1).copy_(forward(*net, flat, VS_CRITIC, in));
    return VS_OK;
  } catch (const std::exception &e) {
    return vs_fail(err, VS_FAIL, "libtorch: %.400s", e.what());
  }
}

} // namespace

extern "C" vs_status vs_torch_gradient_engine(vs_gradient_engine *out, vs_error *err) {
  try {
    *out = vs_gradient_engine{nullptr, gradient, outputs, nullptr};
    return VS_OK;
  } catch (const std::exception &e) {
    return vs_fail(err, VS_FAIL, "libtorch: %.400s", e.what());
  }
}
