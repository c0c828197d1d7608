#include "export.h"

#include <stdio.h>
#include <stdlib.h>

#include "vsss/contract.h"
#include "vsss/learn.h"

vs_status vs_export_actor(const char *path, const vs_net *net, const float *parameters, const vs_export_def *def,
                          vs_error *err) {
  const vs_net_shape *s = &net->shape;
  const int last = s->width[s->layers - 1], outputs = vs_net_outputs(net, VS_ACTOR);
  // The head is stored [outputs][width]; the writer wants [width][outputs].
  float *head = malloc((size_t)last * (size_t)outputs * sizeof *head);
  if (!head) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  for (int o = 0; o < outputs; o++)
    for (int i = 0; i < last; i++)
      head[i * outputs + o] = parameters[net->head_weight[VS_ACTOR] + (size_t)(o * last + i)];
  vs_onnx_layer layer[VS_NET_MAX_LAYERS + 1];
  for (int l = 0; l < s->layers; l++)
    layer[l] = (vs_onnx_layer){.in = l ? s->width[l - 1] : s->inputs,
                               .out = s->width[l],
                               .stride = l ? s->width[l] : net->nets * s->width[0],
                               .weight = parameters + net->weight[l][VS_ACTOR],
                               .bias = parameters + net->bias[l]};
  layer[s->layers] = (vs_onnx_layer){last, outputs, outputs, head, parameters + net->head_bias[VS_ACTOR]};
  const vs_onnx_policy policy = {def->name, s->layers + 1, layer, def->io, def->with_spread, def->notes, def->note};
  vs_status status = vs_onnx_write(path, &policy, err);
  free(head);
  return status;
}

vs_status vs_learn_write_untrained(const char *path, uint64_t seed, vs_error *err) {
  const vs_net_shape shape = {VS_OBS_SIZE, 2, {256, 256}, VS_ACTION_SIZE, false};
  vs_net net;
  vs_status s = vs_net_init(&net, &shape, err);
  if (s != VS_OK) return s;
  float *parameters = malloc(net.size * sizeof *parameters);
  if (!parameters) return vs_fail(err, VS_FAIL, "%s: out of memory", path);
  vs_rng rng = vs_rng_make(seed, 0);
  s = vs_net_randomise(&net, 4.0, &rng, parameters, err);
  char number[32];
  snprintf(number, sizeof number, "%llu", (unsigned long long)seed);
  const vs_onnx_note notes[] = {{"seed", number}, {"transitions", "0"}, {"command", "make"}};
  const vs_export_def def = {"untrained", {.action_gain = 1.0}, true, notes, 3};
  if (s == VS_OK) s = vs_export_actor(path, &net, parameters, &def, err);
  free(parameters);
  return s;
}
