#include "onnx_writer.h"

#include <stdio.h>

#include "vsss/contract.h"
#include "vsss/file.h"
#include "vsss/observe.h"
#include "wire.h"

// Numbers of onnx.proto (ONNX IR version 8, operator set 13: Split without sizes, Softplus, Gemm).
enum { IR_VERSION = 8, OPSET = 13, TYPE_FLOAT = 1, TYPE_INT32 = 6, TYPE_INT64 = 7, ATTRIBUTE_INT = 2 };
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

// rows x columns of an array of 4-byte numbers with `stride` of them from row to row; rows 0: a vector.
static void tensor_of(vs_bytes *graph, int type, const char *name, const void *data, int rows, int columns,
                      int stride) {
  vs_bytes t = {0}, raw = {0};
  if (rows > 0) vs_wire_int(&t, 1, rows);
  vs_wire_int(&t, 1, columns);
  vs_wire_int(&t, 2, type);
  vs_wire_text(&t, 8, name);
  for (int r = 0; r < (rows > 0 ? rows : 1); r++)
    vs_bytes_append(&raw, (const char *)data + (size_t)r * (size_t)stride * sizeof(float),
                    (size_t)columns * sizeof(float));
  vs_wire_message(&t, 9, &raw);
  vs_wire_message(graph, GRAPH_TENSOR, &t);
}

static void tensor(vs_bytes *graph, const char *name, const float *data, int rows, int columns, int stride) {
  tensor_of(graph, TYPE_FLOAT, name, data, rows, columns, stride);
}

static void scalar(vs_bytes *graph, const char *name, const float *value) {
  vs_bytes t = {0};
  vs_wire_int(&t, 2, TYPE_FLOAT);
  vs_wire_text(&t, 8, name);
  vs_wire_bytes(&t, 9, value, sizeof *value);
  vs_wire_message(graph, GRAPH_TENSOR, &t);
}

// The target of a Reshape.
static void shape(vs_bytes *graph, const char *name, const int64_t sizes[2]) {
  vs_bytes t = {0};
  vs_wire_int(&t, 1, 2);
  vs_wire_int(&t, 2, TYPE_INT64);
  vs_wire_text(&t, 8, name);
  vs_wire_bytes(&t, 9, sizes, 2 * sizeof *sizes);
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

// What vs_symmetry_canonical asks of the newest frame, as five differences that are above 0 where it is so: y < 0, the
// first ally farther from the ball, adversary 0 farther than 1, 0 than 2, 1 than 2.
enum { QUESTIONS = 5, ANSWERS = 1 << QUESTIONS };

static void fill_questions(float (*matrix)[QUESTIONS]) {
  float(*frame)[QUESTIONS] = matrix + VS_OBS_SIZE - VS_OBS_FRAME, (*d)[QUESTIONS] = frame + VS_OBS_ADVERSARIES_DISTANCE;
  frame[VS_OBS_BALL_XY + 1][0] = -1;
  frame[VS_OBS_ALLIES_BALL_DISTANCE][1] = d[0][2] = d[0][3] = d[1][4] = 1;
  frame[VS_OBS_ALLIES_BALL_DISTANCE + 1][1] = d[1][2] = d[2][3] = d[2][4] = -1;
}

// The version for each set of answers (bit k: question k).
static int version_of(int answers) {
  int farther01 = answers >> 2 & 1, farther02 = answers >> 3 & 1, farther12 = answers >> 4 & 1;
  int first = !farther01 && !farther02 ? 0 : !farther12 ? 1 : 2;
  int swapped = first == 0 ? farther12 : first == 1 ? farther02 : farther01;
  return ((answers & 1) * 2 + (answers >> 1 & 1)) * 6 + 2 * first + swapped;
}

// observation[N][464] -> seen[N][464], the robot by the end that faces their goal, and turned_round[N][1],
// whether that is its back (vs_observation_reverse).
static void other_end_nodes(vs_bytes *graph) {
  static const int32_t cosine = VS_OBS_SIZE - VS_OBS_FRAME + VS_OBS_OWN_HEADING + 1;
  int32_t place[VS_OBS_SIZE];
  float sign[VS_OBS_SIZE], less[VS_OBS_SIZE] = {0}, more[VS_OBS_SIZE] = {0};
  for (int i = 0; i < VS_OBS_SIZE; i++) {
    int k = i % VS_OBS_FRAME;
    bool action = k == VS_OBS_OWN_ACTION || k == VS_OBS_OWN_ACTION + 1;
    place[i] = !action ? i : k == VS_OBS_OWN_ACTION ? i + 1 : i - 1;
    sign[i] = action || k == VS_OBS_OWN_HEADING || k == VS_OBS_OWN_HEADING + 1 ? -1.0f : 1.0f;
    if (k == VS_OBS_OWN_HEADING + 2) less[i] = -1, more[i] = 1;
  }
  tensor_of(graph, TYPE_INT32, "heading_cosine", &cosine, 0, 1, 1);
  tensor_of(graph, TYPE_INT32, "end_place", place, 0, VS_OBS_SIZE, 0);
  tensor(graph, "end_sign", sign, 0, VS_OBS_SIZE, 0);
  tensor(graph, "half_turn_less", less, 0, VS_OBS_SIZE, 0);
  tensor(graph, "half_turn_more", more, 0, VS_OBS_SIZE, 0);
  node(graph, "Gather", (const char *[]){"observation", "heading_cosine", NULL}, (const char *[]){"facing", NULL},
       "axis", 1);
  node(graph, "Less", (const char *[]){"facing", "zero", NULL}, (const char *[]){"turned_round", NULL}, NULL, 0);
  node(graph, "Gather", (const char *[]){"observation", "end_place", NULL}, (const char *[]){"end_moved", NULL}, "axis",
       1);
  node(graph, "Mul", (const char *[]){"end_moved", "end_sign", NULL}, (const char *[]){"end_signed", NULL}, NULL, 0);
  node(graph, "Greater", (const char *[]){"observation", "zero", NULL}, (const char *[]){"above", NULL}, NULL, 0);
  node(graph, "Where", (const char *[]){"above", "half_turn_less", "half_turn_more", NULL},
       (const char *[]){"half_turn", NULL}, NULL, 0);
  node(graph, "Add", (const char *[]){"end_signed", "half_turn", NULL}, (const char *[]){"other_end", NULL}, NULL, 0);
  node(graph, "Where", (const char *[]){"turned_round", "other_end", "observation", NULL},
       (const char *[]){"seen", NULL}, NULL, 0);
}

// The other end's wheels are exchanged and turn the other way: 2 u - 1 becomes its negative, alpha and beta change places.
static void own_end_nodes(vs_bytes *graph) {
  static const int32_t exchanged[2] = {1, 0};
  tensor_of(graph, TYPE_INT32, "wheels_exchanged", exchanged, 0, 2, 2);
  static const char *const from[3] = {"seen_mean", "seen_beta", "seen_alpha"}, // of which the other end's is made
      *const own[3] = {"seen_mean", "seen_alpha", "seen_beta"}, *const to[3] = {"mean", "alpha", "beta"};
  for (int i = 0; i < 3; i++) {
    char other[32], way[32];
    snprintf(other, sizeof other, "%s_exchanged", to[i]);
    snprintf(way, sizeof way, "%s_reversed", to[i]);
    node(graph, "Gather", (const char *[]){from[i], "wheels_exchanged", NULL}, (const char *[]){other, NULL}, "axis",
         1);
    if (i == 0) node(graph, "Neg", (const char *[]){other, NULL}, (const char *[]){way, NULL}, NULL, 0);
    node(graph, "Where", (const char *[]){"turned_round", i == 0 ? way : other, own[i], NULL},
         (const char *[]){to[i], NULL}, NULL, 0);
  }
}

// input[N][464] -> canonical[N][464] and, of its version, wheel_order[N][4], which undoes a mirror image in the
// network's outputs.
static void canonical_nodes(vs_bytes *graph, const char *input) {
  static const float bits[QUESTIONS] = {1, 2, 4, 8, 16};
  static const int32_t order[2][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}};
  float question[VS_OBS_SIZE][QUESTIONS] = {{0}}, sign[ANSWERS][VS_OBS_SIZE];
  int32_t index[ANSWERS][VS_OBS_SIZE], wheels[ANSWERS][4];
  vs_symmetry_table table;
  vs_symmetry_table_init(&table);
  fill_questions(question);
  for (int a = 0; a < ANSWERS; a++) {
    int version = version_of(a);
    for (int i = 0; i < VS_OBS_SIZE; i++) {
      int k = i % VS_OBS_FRAME;
      index[a][i] = i - k + table.index[version][k];
      sign[a][i] = table.sign[version][k];
    }
    for (int i = 0; i < 4; i++) wheels[a][i] = order[vs_symmetry_mirrored(version)][i];
  }
  tensor(graph, "question", &question[0][0], VS_OBS_SIZE, QUESTIONS, QUESTIONS);
  tensor(graph, "bits", bits, 0, QUESTIONS, QUESTIONS);
  tensor_of(graph, TYPE_INT32, "indices", index, ANSWERS, VS_OBS_SIZE, VS_OBS_SIZE);
  tensor(graph, "signs", &sign[0][0], ANSWERS, VS_OBS_SIZE, VS_OBS_SIZE);
  tensor_of(graph, TYPE_INT32, "wheel_orders", wheels, ANSWERS, 4, 4);
  node(graph, "MatMul", (const char *[]){input, "question", NULL}, (const char *[]){"doubt", NULL}, NULL, 0);
  node(graph, "Greater", (const char *[]){"doubt", "zero", NULL}, (const char *[]){"truth", NULL}, NULL, 0);
  node(graph, "Cast", (const char *[]){"truth", NULL}, (const char *[]){"answer", NULL}, "to", TYPE_FLOAT);
  node(graph, "MatMul", (const char *[]){"answer", "bits", NULL}, (const char *[]){"answers", NULL}, NULL, 0);
  node(graph, "Cast", (const char *[]){"answers", NULL}, (const char *[]){"version", NULL}, "to", TYPE_INT32);
  node(graph, "Gather", (const char *[]){"indices", "version", NULL}, (const char *[]){"index", NULL}, "axis", 0);
  node(graph, "Gather", (const char *[]){"signs", "version", NULL}, (const char *[]){"sign", NULL}, "axis", 0);
  node(graph, "Gather", (const char *[]){"wheel_orders", "version", NULL}, (const char *[]){"wheel_order", NULL},
       "axis", 0);
  node(graph, "GatherElements", (const char *[]){input, "index", NULL}, (const char *[]){"moved", NULL}, "axis", 1);
  node(graph, "Mul", (const char *[]){"moved", "sign", NULL}, (const char *[]){"canonical", NULL}, NULL, 0);
}

// input[N][464] -> versions[24 N][464], all symmetric versions of each row one after the other.
static void version_nodes(vs_bytes *graph, const char *input) {
  static const int64_t row_shape[2] = {-1, VS_OBS_SIZE};
  float sign[VS_SYMMETRIES * VS_OBS_SIZE];
  int32_t index[VS_SYMMETRIES * VS_OBS_SIZE];
  vs_symmetry_table table;
  vs_symmetry_table_init(&table);
  for (int i = 0; i < VS_SYMMETRIES * VS_OBS_SIZE; i++) {
    int version = i / VS_OBS_SIZE, k = i % VS_OBS_FRAME, frame = i % VS_OBS_SIZE - k;
    index[i] = frame + table.index[version][k];
    sign[i] = table.sign[version][k];
  }
  tensor_of(graph, TYPE_INT32, "indices", index, 0, VS_SYMMETRIES * VS_OBS_SIZE, 0);
  tensor(graph, "signs", sign, 0, VS_SYMMETRIES * VS_OBS_SIZE, 0);
  shape(graph, "row_shape", row_shape);
  node(graph, "Gather", (const char *[]){input, "indices", NULL}, (const char *[]){"moved", NULL}, "axis", 1);
  node(graph, "Mul", (const char *[]){"moved", "signs", NULL}, (const char *[]){"turned", NULL}, NULL, 0);
  node(graph, "Reshape", (const char *[]){"turned", "row_shape", NULL}, (const char *[]){"versions", NULL}, NULL, 0);
}

// Of each observation's 24 answers ([24 N][2], left and right as each version saw them) the mean, [N][2].
static void mean_nodes(vs_bytes *graph, const char *answers, const char *flat, const char *mean) {
  node(graph, "Reshape", (const char *[]){answers, "answer_shape", NULL}, (const char *[]){flat, NULL}, NULL, 0);
  node(graph, "MatMul", (const char *[]){flat, "averaging", NULL}, (const char *[]){mean, NULL}, NULL, 0);
}

static void averaging_tensors(vs_bytes *graph) {
  static const int64_t answer_shape[2] = {-1, VS_SYMMETRIES * VS_ACTION_SIZE};
  float averaging[VS_SYMMETRIES][VS_ACTION_SIZE][VS_ACTION_SIZE] = {{{0}}};
  for (int v = 0; v < VS_SYMMETRIES; v++)
    for (int k = 0; k < VS_ACTION_SIZE; k++)
      averaging[v][k][vs_symmetry_mirrored(v) ? 1 - k : k] = 1.0f / VS_SYMMETRIES;
  shape(graph, "answer_shape", answer_shape);
  tensor(graph, "averaging", &averaging[0][0][0], VS_SYMMETRIES * VS_ACTION_SIZE, VS_ACTION_SIZE, VS_ACTION_SIZE);
}

static void layer_nodes(vs_bytes *graph, const vs_onnx_layer *l, int index, bool last, const char *input) {
  char in[32], weight[32], bias[32], sum[32], out[32];
  snprintf(in, sizeof in, "hidden%d", index);
  snprintf(weight, sizeof weight, "weight%d", index);
  snprintf(bias, sizeof bias, "bias%d", index);
  snprintf(sum, sizeof sum, "sum%d", index);
  snprintf(out, sizeof out, "hidden%d", index + 1);
  const char *from = index == 0 ? input : in;
  node(graph, "Gemm", (const char *[]){from, weight, bias, NULL}, (const char *[]){last ? "head" : sum, NULL}, NULL, 0);
  if (!last) node(graph, "Tanh", (const char *[]){sum, NULL}, (const char *[]){out, NULL}, NULL, 0);
  tensor(graph, weight, l->weight, l->in, l->out, l->stride);
  tensor(graph, bias, l->bias, 0, l->out, l->out);
}

// head[][4] -> alpha, beta[][2] -> their mean (alpha - beta)/(alpha + beta), over the versions where there are some ->
// action[N][2] = gain times that, clipped.
static void beta_head(vs_bytes *graph, const vs_policy_io *io) {
  static const float one = 1.0f, limits[2] = {-1.0f, 1.0f};
  const float gain = (float)io->action_gain;
  const bool average = io->average;
  // Of the network's one answer, or the mean of its answers; then of the robot's own end.
  const char *mean = io->reversible ? "seen_mean" : "mean", *alpha_mean = io->reversible ? "seen_alpha" : "alpha",
             *beta_mean = io->reversible ? "seen_beta" : "beta";
  const char *alpha = average ? "alphas" : alpha_mean, *beta = average ? "betas" : beta_mean;
  tensor(graph, "one", &one, 0, 1, 1);
  if (io->canonical)
    node(graph, "GatherElements", (const char *[]){"head", "wheel_order", NULL}, (const char *[]){"raw", NULL}, "axis",
         1);
  node(graph, "Softplus", (const char *[]){io->canonical ? "raw" : "head", NULL}, (const char *[]){"positive", NULL},
       NULL, 0);
  node(graph, "Add", (const char *[]){"positive", "one", NULL}, (const char *[]){"shape", NULL}, NULL, 0);
  node(graph, "Split", (const char *[]){"shape", NULL}, (const char *[]){alpha, beta, NULL}, "axis", 1);
  node(graph, "Sub", (const char *[]){alpha, beta, NULL}, (const char *[]){"difference", NULL}, NULL, 0);
  node(graph, "Add", (const char *[]){alpha, beta, NULL}, (const char *[]){"total", NULL}, NULL, 0);
  node(graph, "Div", (const char *[]){"difference", "total", NULL}, (const char *[]){average ? "means" : mean, NULL},
       NULL, 0);
  if (average) {
    averaging_tensors(graph);
    mean_nodes(graph, "means", "means_flat", mean);
    mean_nodes(graph, alpha, "alphas_flat", alpha_mean);
    mean_nodes(graph, beta, "betas_flat", beta_mean);
  }
  if (io->reversible) own_end_nodes(graph);
  tensor(graph, "gain", &gain, 0, 1, 1);
  scalar(graph, "lowest", &limits[0]);
  scalar(graph, "highest", &limits[1]);
  node(graph, "Mul", (const char *[]){"mean", "gain", NULL}, (const char *[]){"amplified", NULL}, NULL, 0);
  node(graph, "Clip", (const char *[]){"amplified", "lowest", "highest", NULL}, (const char *[]){"action", NULL}, NULL,
       0);
}

static void note(vs_bytes *model, const char *key, const char *value) {
  vs_bytes entry = {0};
  vs_wire_text(&entry, 1, key);
  vs_wire_text(&entry, 2, value);
  vs_wire_message(model, MODEL_META, &entry);
}

vs_status vs_onnx_write(const char *path, const vs_onnx_policy *policy, vs_error *err) {
  const vs_onnx_layer *first = &policy->layer[0], *last = &policy->layer[policy->layers - 1];
  if (policy->io.canonical && policy->io.average)
    return vs_fail(err, VS_USAGE, "%s: the canonical version and the average over all exclude each other", path);
  if (first->in != VS_OBS_SIZE || last->out != 2 * VS_ACTION_SIZE)
    return vs_fail(err, VS_FAIL, "%s: network is %d -> %d, the contract wants %d -> %d", path, first->in, last->out,
                   VS_OBS_SIZE, 2 * VS_ACTION_SIZE);
  vs_bytes model = {0}, graph = {0}, opset = {0};
  const vs_policy_io *io = &policy->io;
  const char *input = "observation";
  const float zero = 0.0f;
  if (io->reversible || io->canonical) tensor(&graph, "zero", &zero, 0, 1, 1);
  if (io->reversible) other_end_nodes(&graph), input = "seen";
  if (io->canonical) canonical_nodes(&graph, input), input = "canonical";
  if (io->average) version_nodes(&graph, input), input = "versions";
  for (int i = 0; i < policy->layers; i++) layer_nodes(&graph, &policy->layer[i], i, i + 1 == policy->layers, input);
  beta_head(&graph, io);
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
