#include "value_scale.h"

#include <math.h>

vs_value_scale vs_value_scale_make(bool on) { return (vs_value_scale){.on = on, .mean = 0.0, .deviation = 1.0}; }

float vs_value_in_reward(const vs_value_scale *scale, float value) {
  return (float)(value * scale->deviation + scale->mean);
}

static float in_deviations(const vs_value_scale *scale, float reward_units) {
  return (float)((reward_units - scale->mean) / scale->deviation);
}

void vs_value_scale_update(vs_value_scale *scale, double count, double sum, double squares) {
  if (!scale->on) return;
  static const double keep = 0.9; // of an update: the scale follows the returns over about ten batches
  scale->weight = keep * scale->weight + count;
  scale->sum = keep * scale->sum + sum;
  scale->squares = keep * scale->squares + squares;
  scale->mean = scale->sum / scale->weight;
  scale->deviation = fmax(sqrt(fmax(scale->squares / scale->weight - scale->mean * scale->mean, 0.0)), 1e-3);
}

void vs_value_scale_fit(const vs_value_scale *from, const vs_value_scale *to, const vs_net *net, float *parameters) {
  int last = net->shape.width[net->shape.layers - 1];
  float *weight = parameters + net->head_weight[VS_CRITIC], *bias = parameters + net->head_bias[VS_CRITIC];
  double ratio = from->deviation / to->deviation;
  for (int i = 0; i < last; i++) weight[i] = (float)(weight[i] * ratio);
  *bias = (float)((from->deviation * *bias + from->mean - to->mean) / to->deviation);
}

vs_status vs_value_scale_follow(vs_value_scale *scale, const vs_group *group, const vs_value_batch *batch,
                                const vs_net *net, float *parameters, vs_error *err) {
  double sums[3] = {batch->rows, 0.0, 0.0};
  for (int i = 0; i < batch->rows; i++) {
    sums[1] += batch->target[i];
    sums[2] += (double)batch->target[i] * batch->target[i];
  }
  if (group) {
    vs_status s = group->sum_doubles(group->self, sums, 3, err);
    if (s != VS_OK) return s;
  }
  const vs_value_scale before = *scale;
  vs_value_scale_update(scale, sums[0], sums[1], sums[2]);
  vs_value_scale_fit(&before, scale, net, parameters);
  for (int i = 0; i < batch->rows; i++) {
    batch->target[i] = in_deviations(scale, batch->target[i]);
    batch->old_value[i] = in_deviations(scale, batch->value[i]);
  }
  return VS_OK;
}
