#include "onnx_writer.h"

#include <stdio.h>

#include "vsss/contract.h"
#include "wire.h"

// Numbers of onnx.proto (ONNX IR version 8, operator set 13: Split without sizes, Softplus, Gemm).
enum { IR_VERSION = 8, OPSET = 13, TYPE_FLOAT = 1, ATTRIBUTE_INT = 2 };
enum { MODEL_IR = 1, MODEL_PRODUCER = 2, MODEL_GRAPH = 7, MODEL_OPSET = 8, MODEL_META = 14 };
enum { GRAPH_NODE = 1, GRAPH_NAME = 2, GRAPH_TENSOR = 5, GRAPH_INPUT = 11, GRAPH_OUTPUT = 12 };
enum { NODE_INPUT = 1, NODE_OUTPUT = 2, NODE_NAME = 3, NODE_OP = 4, NODE_ATTRIBUTE = 5 };

static void node(vs_bytes *graph, const char *op, const char *const *inputs, const char *const *outputs,
                 const char *int_attribute, int attribute_value) {
  vs_bytes n = {0};
  for (; *inputs; inputs++) vs_wire_text(&n, NODE_INPUT, *inputs);
  vs_wire_text(&n, NODE_NAME, *outputs);
  for (; *outputs; outputs++) vs_wire_text(&n, NODE_OUTPUT, *outputs);
  vs_wire_text(&n, NODE_OP, op);
  if (int_attribute) {
    vs_bytes attribute = {0};
    vs_wire_text(&attribute, 1, int_attribute);
    vs_wire_int(&attribute, 3, attribute_value);
    vs_wire_int(&attribute, 20, ATTRIBUTE_INT);
    vs_wire_message(&n, NODE_ATTRIBUTE, &attribute);
  }
  vs_wire_message(graph, GRAPH_NODE, &n);
}

// rows x columns of a float array with `stride` floats from row to row; rows 0: a vector.
static void tensor(vs_bytes *graph, const char *name, const float *data, int rows, int columns, int stride) {
  vs_bytes t = {0}, raw = {0};
  if (rows > 0) vs_wire_int(&t, 1, rows);
  vs_wire_int(&t, 1, columns);
  vs_wire_int(&t, 2, TYPE_FLOAT);
  vs_wire_text(&t, 8, name);
  for (int r = 0; r < (rows > 0 ? rows : 1); r++)
    vs_bytes_append(&raw, data + (size_t)r * (size_t)stride, (size_t)columns * sizeof *data);
  vs_wire_message(&t, 9, &raw);
  vs_wire_message(graph, GRAPH_TENSOR, &t);
}

// A float[N][columns] input or output of the graph.
static void port(vs_bytes *graph, int field, const char *name, int columns) {
  vs_bytes rows = {0}, width = {0}, shape = {0}, type_tensor = {0}, type = {0}, info = {0};
  vs_wire_text(&rows, 2, "N");
  vs_wire_int(&width, 1, columns);
  vs_wire_message(&shape, 1, &rows);
  vs_wire_message(&shape, 1, &width);
  vs_wire_int(&type_tensor, 1, TYPE_FLOAT);
  vs_wire_message(&type_tensor, 2, &shape);
  vs_wire_message(&type, 1, &type_tensor);
  vs_wire_text(&info, 1, name);
  vs_wire_message(&info, 2, &type);
  vs_wire_message(graph, field, &info);
}

static void layer_nodes(vs_bytes *graph, const vs_onnx_layer *l, int index, bool last) {
  char in[32], weight[32], bias[32], sum[32], out[32];
  snprintf(in, sizeof in, "hidden%d", index);
  snprintf(weight, sizeof weight, "weight%d", index);
  snprintf(bias, sizeof bias, "bias%d", index);
  snprintf(sum, sizeof sum, "sum%d", index);
  snprintf(out, sizeof out, "hidden%d", index + 1);
  const char *from = index == 0 ? "observation" : in;
  node(graph, "Gemm", (const char *[]){from, weight, bias, NULL}, (const char *[]){last ? "raw" : sum, NULL}, NULL, 0);
  if (!last) node(graph, "Tanh", (const char *[]){sum, NULL}, (const char *[]){out, NULL}, NULL, 0);
  tensor(graph, weight, l->weight, l->in, l->out, l->stride);
  tensor(graph, bias, l->bias, 0, l->out, l->out);
}

// raw[N][4] -> alpha, beta[N][2] -> action[N][2] = (alpha - beta)/(alpha + beta).
static void beta_head(vs_bytes *graph) {
  static const float one = 1.0f;
  tensor(graph, "one", &one, 0, 1, 1);
  node(graph, "Softplus", (const char *[]){"raw", NULL}, (const char *[]){"positive", NULL}, NULL, 0);
  node(graph, "Add", (const char *[]){"positive", "one", NULL}, (const char *[]){"shape", NULL}, NULL, 0);
  node(graph, "Split", (const char *[]){"shape", NULL}, (const char *[]){"alpha", "beta", NULL}, "axis", 1);
  node(graph, "Sub", (const char *[]){"alpha", "beta", NULL}, (const char *[]){"difference", NULL}, NULL, 0);
  node(graph, "Add", (const char *[]){"alpha", "beta", NULL}, (const char *[]){"total", NULL}, NULL, 0);
  node(graph, "Div", (const char *[]){"difference", "total", NULL}, (const char *[]){"action", NULL}, NULL, 0);
}

static void note(vs_bytes *model, const char *key, const char *value) {
  vs_bytes entry = {0};
  vs_wire_text(&entry, 1, key);
  vs_wire_text(&entry, 2, value);
  vs_wire_message(model, MODEL_META, &entry);
}

vs_status vs_onnx_write(const char *path, const vs_onnx_policy *policy, vs_error *err) {
  const vs_onnx_layer *first = &policy->layer[0], *last = &policy->layer[policy->layers - 1];
  if (first->in != VS_OBS_SIZE || last->out != 2 * VS_ACTION_SIZE)
    return vs_fail(err, VS_FAIL, "%s: network is %d -> %d, the contract wants %d -> %d", path, first->in, last->out,
                   VS_OBS_SIZE, 2 * VS_ACTION_SIZE);
  vs_bytes model = {0}, graph = {0}, opset = {0};
  for (int i = 0; i < policy->layers; i++) layer_nodes(&graph, &policy->layer[i], i, i + 1 == policy->layers);
  beta_head(&graph);
  vs_wire_text(&graph, GRAPH_NAME, policy->name);
  port(&graph, GRAPH_INPUT, "observation", VS_OBS_SIZE);
  port(&graph, GRAPH_OUTPUT, "action", VS_ACTION_SIZE);
  if (policy->with_spread) {
    port(&graph, GRAPH_OUTPUT, "alpha", VS_ACTION_SIZE);
    port(&graph, GRAPH_OUTPUT, "beta", VS_ACTION_SIZE);
  }
  vs_wire_int(&model, MODEL_IR, IR_VERSION);
  vs_wire_text(&model, MODEL_PRODUCER, "vsss");
  vs_wire_message(&model, MODEL_GRAPH, &graph);
  vs_wire_int(&opset, 2, OPSET);
  vs_wire_message(&model, MODEL_OPSET, &opset);
  note(&model, "contract", vs_contract_hash_hex());
  note(&model, "layout", vs_contract_text());
  for (int i = 0; i < policy->notes; i++) note(&model, policy->note[i].key, policy->note[i].value);
  vs_status s = model.failed ? vs_fail(err, VS_FAIL, "%s: out of memory", path)
                             : vs_file_replace(path, model.data, model.size, err);
  vs_bytes_free(&model);
  return s;
}
