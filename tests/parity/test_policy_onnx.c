// Tests src/policy/policy_onnx.c with files of src/learn/onnx_writer.c: ONNX Runtime against a plain C network, and
// every way in which a file can be wrong.
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#if __has_include(<onnxruntime_c_api.h>)
#include <onnxruntime_c_api.h>
#endif

#include "assert_near.h"
#include "learn/export.h"
#include "vsss/learn.h"
#include "vsss/observe.h"
#include "vsss/policy.h"
#include "vsss/rng.h"
#include "vsss/world.h"

enum { OBSERVATIONS = 1000, W0 = 48, W1 = 32, ACTOR_OUTPUTS = 4 };

// A fresh network with large weights, so that tanh and softplus leave their linear part.
static void make_net(vs_net *net, float **parameters) {
  const vs_net_shape shape = {VS_OBS_SIZE, 2, {W0, W1}, VS_ACTION_SIZE, true};
  assert_ok(vs_net_init(net, &shape, err));
  *parameters = malloc(net->size * sizeof **parameters);
  vs_rng rng = vs_rng_make(7, 0);
  for (size_t i = 0; i < net->size; i++) (*parameters)[i] = (float)vs_rng_range(&rng, -0.3, 0.3);
}

// The oracle: the same network in double, one value at a time, straight from the definition in net.h.
static void plain_beta(const vs_net *net, const float *p, const float *x, double alpha[2], double beta[2]) {
  double h0[W0], h1[W1], raw[ACTOR_OUTPUTS];
  for (int j = 0; j < W0; j++) {
    double sum = p[net->bias[0] + (size_t)j];
    for (int i = 0; i < VS_OBS_SIZE; i++) sum += (double)x[i] * p[net->weight[0][VS_ACTOR] + (size_t)(i * 2 * W0 + j)];
    h0[j] = tanh(sum);
  }
  for (int j = 0; j < W1; j++) {
    double sum = p[net->bias[1] + (size_t)j];
    for (int i = 0; i < W0; i++) sum += h0[i] * p[net->weight[1][VS_ACTOR] + (size_t)(i * W1 + j)];
    h1[j] = tanh(sum);
  }
  for (int j = 0; j < ACTOR_OUTPUTS; j++) {
    raw[j] = p[net->head_bias[VS_ACTOR] + (size_t)j];
    for (int i = 0; i < W1; i++) raw[j] += h1[i] * p[net->head_weight[VS_ACTOR] + (size_t)(j * W1 + i)];
  }
  for (int k = 0; k < 2; k++) alpha[k] = 1.0 + log1p(exp(raw[k])), beta[k] = 1.0 + log1p(exp(raw[2 + k]));
}

static void plain_forward(const vs_net *net, const float *p, const float *x, double action[2]) {
  double alpha[2], beta[2];
  plain_beta(net, p, x, alpha, beta);
  for (int k = 0; k < 2; k++) action[k] = 2.0 * alpha[k] / (alpha[k] + beta[k]) - 1.0;
}

static char folder[] = "build/onnx_test_XXXXXX";
static char file[128];

static void write_model_with(const vs_net *net, const float *parameters, vs_policy_io io) {
  const vs_onnx_note note = {"seed", "7"};
  const vs_export_def def = {"test", io, true, &note, 1};
  assert_ok(vs_export_actor(file, net, parameters, &def, err));
}

static void write_model(const vs_net *net, const float *parameters) {
  write_model_with(net, parameters, (vs_policy_io){.action_gain = 1.0});
}

static vs_status open_file(vs_player **player, vs_error *err) {
  char uri[200];
  snprintf(uri, sizeof uri, "onnx:%s", file);
  return vs_player_open(uri, player, err);
}

static void onnx_runtime_agrees_with_plain_c_on_1000_observations(void **state) {
  (void)state;
  vs_net net;
  float *parameters;
  make_net(&net, &parameters);
  write_model(&net, parameters);
  vs_player *player = NULL;
  assert_ok(open_file(&player, err));
  assert_int_equal(vs_player_kind(player), VS_SEES_OBSERVATION);
  float *obs = malloc(OBSERVATIONS * VS_OBS_SIZE * sizeof *obs), *action = malloc(OBSERVATIONS * 2 * sizeof *action);
  vs_rng rng = vs_rng_make(8, 0);
  for (int i = 0; i < OBSERVATIONS * VS_OBS_SIZE; i++) obs[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  assert_ok(vs_player_act(player, obs, OBSERVATIONS, action, err));
  double spread = 0.0;
  for (int i = 0; i < OBSERVATIONS; i++) {
    double expected[2];
    plain_forward(&net, parameters, obs + i * VS_OBS_SIZE, expected);
    for (int k = 0; k < 2; k++) assert_near(action[2 * i + k], expected[k], 1e-5);
    spread = fmax(spread, fabs(expected[0]));
  }
  assert_true(spread > 0.1); // the network says something
  // One row at a time gives the very same bits as all at once.
  for (int i = 0; i < 50; i++) {
    float alone[2];
    assert_ok(vs_player_act(player, obs + i * VS_OBS_SIZE, 1, alone, err));
    assert_memory_equal(alone, action + 2 * i, sizeof alone);
  }
  vs_player_close(player);
  free(action);
  free(obs);
  free(parameters);
}

// A file whose network sees canonical observations and whose output is amplified, against the same in plain C. Every
// tenth observation is of a tie: adversaries and allies at equal distances.
static void a_canonical_amplified_policy_agrees_with_plain_c(void **state) {
  (void)state;
  enum { N = 400 };
  vs_net net;
  float *parameters, *obs = malloc(N * VS_OBS_SIZE * sizeof *obs), action[N * 2];
  vs_symmetry_table table;
  vs_player *player = NULL;
  vs_rng rng = vs_rng_make(9, 0);
  make_net(&net, &parameters);
  write_model_with(&net, parameters, (vs_policy_io){.canonical = true, .action_gain = 1.4});
  assert_ok(open_file(&player, err));
  for (int i = 0; i < N * VS_OBS_SIZE; i++) obs[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (int i = 0; i < N; i += 10) {
    float *newest = obs + (i + 1) * VS_OBS_SIZE - VS_OBS_FRAME;
    newest[VS_OBS_ALLIES_BALL_DISTANCE] = newest[VS_OBS_ALLIES_BALL_DISTANCE + 1];
    newest[VS_OBS_ADVERSARIES_DISTANCE + i / 10 % 3] = newest[VS_OBS_ADVERSARIES_DISTANCE + (i / 10 + 1) % 3];
  }
  assert_ok(vs_player_act(player, obs, N, action, err));
  vs_symmetry_table_init(&table);
  int mirrored = 0, clipped = 0;
  for (int i = 0; i < N; i++) {
    float shown[VS_OBS_SIZE];
    double mean[2];
    int version = vs_symmetry_canonical(obs + i * VS_OBS_SIZE), swap = vs_symmetry_mirrored(version);
    vs_symmetry_apply(&table, version, obs + i * VS_OBS_SIZE, shown);
    plain_forward(&net, parameters, shown, mean);
    for (int k = 0; k < 2; k++) {
      double expected = fmin(fmax(1.4 * mean[k ^ swap], -1.0), 1.0);
      assert_near(action[2 * i + k], expected, 2e-5);
      clipped += fabs(expected) == 1.0;
    }
    mirrored += swap;
  }
  assert_true(mirrored > N / 4 && mirrored < 3 * N / 4);
  assert_true(clipped < N);
  vs_player_close(player);
  free(obs);
  free(parameters);
}

// A file that averages: the mean of the plain network's answers to all 24 versions, each turned back, times the gain.
// What it does in the mirror image of a situation is the mirror image of what it does, to the last digits.
static void an_averaging_policy_agrees_with_plain_c_and_is_symmetric(void **state) {
  (void)state;
  enum { N = 30 };
  vs_net net;
  float *parameters, *obs = malloc(N * VS_OBS_SIZE * sizeof *obs), *turned = malloc(N * VS_OBS_SIZE * sizeof *obs);
  float action[N * 2], turned_action[N * 2];
  vs_symmetry_table table;
  vs_player *player = NULL;
  vs_rng rng = vs_rng_make(10, 0);
  make_net(&net, &parameters);
  write_model_with(&net, parameters, (vs_policy_io){.average = true, .action_gain = 2.0});
  assert_ok(open_file(&player, err));
  for (int i = 0; i < N * VS_OBS_SIZE; i++) obs[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  assert_ok(vs_player_act(player, obs, N, action, err));
  vs_symmetry_table_init(&table);
  double spread = 0;
  for (int i = 0; i < N; i++) {
    double sum[2] = {0};
    for (int v = 0; v < VS_SYMMETRIES; v++) {
      float shown[VS_OBS_SIZE];
      double mean[2];
      vs_symmetry_apply(&table, v, obs + i * VS_OBS_SIZE, shown);
      plain_forward(&net, parameters, shown, mean);
      for (int k = 0; k < 2; k++) sum[k] += mean[k ^ vs_symmetry_mirrored(v)] / VS_SYMMETRIES;
    }
    for (int k = 0; k < 2; k++) assert_near(action[2 * i + k], fmin(fmax(2.0 * sum[k], -1.0), 1.0), 2e-5);
    spread = fmax(spread, fabs(sum[0]));
  }
  assert_true(spread > 0.05);
  for (int i = 0; i < N; i++) vs_symmetry_apply(&table, 12 + i % 12, obs + i * VS_OBS_SIZE, turned + i * VS_OBS_SIZE);
  assert_ok(vs_player_act(player, turned, N, turned_action, err));
  for (int i = 0; i < 2 * N; i++) assert_near(turned_action[i ^ 1], action[i], 1e-5);
  vs_player_close(player);
  free(turned);
  free(obs);
  free(parameters);
}

// A file that sees the robot by the end that faces their goal, against the same in plain C. A robot turned round by 180
// degrees, its wheels told the opposite, does the same, with the average and with the canonical version too.
static void a_reversible_policy_agrees_with_plain_c_whichever_way_the_robot_faces(void **state) {
  (void)state;
  enum { N = 60 };
  vs_net net;
  float *parameters, *obs = malloc(N * VS_OBS_SIZE * sizeof *obs), *turned = malloc(N * VS_OBS_SIZE * sizeof *obs);
  float action[N * 2], turned_action[N * 2];
  vs_rng rng = vs_rng_make(11, 0);
  make_net(&net, &parameters);
  enum { PLAIN, AVERAGE, CANONICAL, KINDS };
  for (int kind = 0; kind < KINDS; kind++) {
    vs_player *player = NULL;
    write_model_with(
        &net, parameters,
        (vs_policy_io){
            .reversible = true, .average = kind == AVERAGE, .canonical = kind == CANONICAL, .action_gain = 1.5});
    assert_ok(open_file(&player, err));
    int backs = 0;
    for (int i = 0; i < N * VS_OBS_SIZE; i++) obs[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
    assert_ok(vs_player_act(player, obs, N, action, err));
    for (int i = 0; i < N; i++) {
      int back = vs_observation_faces_back(obs + i * VS_OBS_SIZE);
      vs_observation_reverse(obs + i * VS_OBS_SIZE, turned + i * VS_OBS_SIZE);
      backs += back;
      if (kind != PLAIN) continue;
      double mean[2];
      plain_forward(&net, parameters, (back ? turned : obs) + i * VS_OBS_SIZE, mean);
      for (int k = 0; k < 2; k++)
        assert_near(action[2 * i + k], fmin(fmax(1.5 * (back ? -mean[1 - k] : mean[k]), -1.0), 1.0), 2e-5);
    }
    assert_in_range(backs, N / 4, 3 * N / 4);
    assert_ok(vs_player_act(player, turned, N, turned_action, err));
    for (int i = 0; i < 2 * N; i++) assert_near(turned_action[i ^ 1], -action[i], 1e-5);
    vs_player_close(player);
  }
  free(turned);
  free(obs);
  free(parameters);
}

#ifdef ORT_API_VERSION
// Runs the model in file[] as another program would, which is how alpha and beta are read: float[rows][2] each.
static void run_elsewhere(float *obs, int64_t rows, float *alpha, float *beta) {
  vs_player *player = NULL;
  assert_ok(open_file(&player, err)); // loads the library
  void *library = dlopen("libonnxruntime.so.1", RTLD_NOW | RTLD_NOLOAD);
  if (!library) library = dlopen("libonnxruntime.so.1.21", RTLD_NOW | RTLD_NOLOAD);
  assert_non_null(library);
  const OrtApiBase *(*base)(void) = (const OrtApiBase *(*)(void))dlsym(library, "OrtGetApiBase");
  const OrtApi *ort = base()->GetApi(20);
  OrtEnv *env;
  OrtSessionOptions *options;
  OrtSession *session;
  OrtMemoryInfo *memory;
  OrtValue *input, *output[2];
  const int64_t in[2] = {rows, VS_OBS_SIZE}, out[2] = {rows, 2};
  const size_t out_bytes = (size_t)rows * 2 * sizeof(float);
  assert_null(ort->CreateEnv(ORT_LOGGING_LEVEL_ERROR, "test", &env));
  assert_null(ort->CreateSessionOptions(&options));
  assert_null(ort->CreateSession(env, file, options, &session));
  assert_null(ort->CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, &memory));
  const ONNXTensorElementDataType type = ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT;
  assert_null(
      ort->CreateTensorWithDataAsOrtValue(memory, obs, (size_t)rows * VS_OBS_SIZE * sizeof *obs, in, 2, type, &input));
  assert_null(ort->CreateTensorWithDataAsOrtValue(memory, alpha, out_bytes, out, 2, type, &output[0]));
  assert_null(ort->CreateTensorWithDataAsOrtValue(memory, beta, out_bytes, out, 2, type, &output[1]));
  const char *const inputs[] = {"observation"}, *const outputs[] = {"alpha", "beta"};
  assert_null(ort->Run(session, NULL, inputs, (const OrtValue *const *)&input, 1, outputs, 2, output));
  for (int i = 0; i < 2; i++) ort->ReleaseValue(output[i]);
  ort->ReleaseValue(input);
  ort->ReleaseMemoryInfo(memory);
  ort->ReleaseSession(session);
  ort->ReleaseSessionOptions(options);
  ort->ReleaseEnv(env);
  dlclose(library);
  vs_player_close(player);
}
#else
static void run_elsewhere(float *obs, int64_t rows, float *alpha, float *beta) {
  (void)obs, (void)rows, (void)alpha, (void)beta;
  fail_msg("built without ONNX Runtime: run 'sudo sh deploy/setup.sh', then make");
}
#endif

// The distributions of a reversible file are those of the wheels as the contract numbers them: seen by the other end, the
// wheels change places and forward becomes back, which is alpha for beta. Averaged, each is the mean over the versions.
static void alpha_and_beta_are_of_the_robots_own_wheels(void **state) {
  (void)state;
  enum { N = 40 };
  vs_net net;
  float *parameters, *obs = malloc(N * VS_OBS_SIZE * sizeof *obs), alpha[N][2], beta[N][2];
  vs_symmetry_table table;
  vs_rng rng = vs_rng_make(12, 0);
  make_net(&net, &parameters);
  vs_symmetry_table_init(&table);
  for (int i = 0; i < N * VS_OBS_SIZE; i++) obs[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (int average = 0; average < 2; average++) {
    write_model_with(&net, parameters, (vs_policy_io){.reversible = true, .average = average != 0, .action_gain = 1.0});
    run_elsewhere(obs, N, &alpha[0][0], &beta[0][0]);
    int versions = average ? VS_SYMMETRIES : 1, backs = 0;
    for (int i = 0; i < N; i++) {
      float end[VS_OBS_SIZE], shown[VS_OBS_SIZE];
      double sum[2][2] = {{0}}, seen[2][2]; // alpha and beta of both wheels
      int back = vs_observation_faces_back(obs + i * VS_OBS_SIZE);
      memcpy(end, obs + i * VS_OBS_SIZE, sizeof end);
      if (back) vs_observation_reverse(obs + i * VS_OBS_SIZE, end);
      backs += back;
      for (int v = 0; v < versions; v++) {
        vs_symmetry_apply(&table, v, end, shown);
        plain_beta(&net, parameters, shown, seen[0], seen[1]);
        for (int k = 0; k < 2; k++)
          for (int which = 0; which < 2; which++)
            sum[which][k] += seen[which][vs_symmetry_mirrored(v) ? 1 - k : k] / versions;
      }
      for (int k = 0; k < 2; k++) {
        assert_near(alpha[i][k], back ? sum[1][1 - k] : sum[0][k], 2e-5);
        assert_near(beta[i][k], back ? sum[0][1 - k] : sum[1][k], 2e-5);
      }
    }
    assert_in_range(backs, N / 4, 3 * N / 4);
  }
  free(obs);
  free(parameters);
}

static void expect_refusal(const char *why) {
  vs_player *player = NULL;
  vs_error err = {0};
  assert_int_equal(open_file(&player, &err), VS_FAIL);
  if (!strstr(err.text, why) || !strstr(err.text, file) || strchr(err.text, '\n'))
    fail_msg("expected one line with the file and '%s': %s", why, err.text);
  assert_null(player);
}

static void read_file(char **data, size_t *size) {
  FILE *f = fopen(file, "rb");
  assert_non_null(f);
  *data = malloc(1 << 22);
  *size = fread(*data, 1, 1 << 22, f);
  fclose(f);
}

static void write_file(const char *data, size_t size) {
  FILE *f = fopen(file, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
}

static void a_truncated_file_is_refused_at_every_length(void **state) {
  (void)state;
  vs_net net;
  float *parameters;
  char *data;
  size_t size;
  make_net(&net, &parameters);
  write_model(&net, parameters);
  read_file(&data, &size);
  for (int part = 0; part < 10; part++) {
    write_file(data, size * (size_t)part / 10);
    expect_refusal("");
  }
  write_file(data, size / 2);
  expect_refusal("truncated");
  free(data);
  free(parameters);
}

static void swap_text(const char *from, const char *to) {
  char *data;
  size_t size;
  read_file(&data, &size);
  size_t n = strlen(from), found = 0;
  for (size_t i = 0; i + n <= size; i++)
    if (memcmp(data + i, from, n) == 0) memcpy(data + i, to, n), found++;
  assert_true(found > 0);
  write_file(data, size);
  free(data);
}

static void a_model_of_another_contract_is_refused(void **state) {
  (void)state;
  vs_net net;
  float *parameters;
  make_net(&net, &parameters);
  write_model(&net, parameters);
  swap_text(vs_contract_hash_hex(), "0123456789abcdef");
  expect_refusal("made for contract 0123456789abcdef");
  write_model(&net, parameters);
  swap_text("contract", "kontract");
  expect_refusal("no 'contract'");
  write_model(&net, parameters);
  swap_text("action", "aktion");
  expect_refusal("no output 'action'");
  write_model(&net, parameters);
  swap_text("observation", "observateon");
  expect_refusal("no input 'observation'");
  free(parameters);
}

static void a_network_of_other_sizes_is_not_written(void **state) {
  (void)state;
  const vs_net_shape shape = {VS_OBS_SIZE - 1, 1, {8}, VS_ACTION_SIZE, false};
  vs_net net;
  assert_ok(vs_net_init(&net, &shape, err));
  float *parameters = calloc(net.size, sizeof *parameters);
  vs_error err = {0};
  const vs_export_def def = {"test", {.action_gain = 1.0}, false, NULL, 0};
  assert_int_equal(vs_export_actor(file, &net, parameters, &def, &err), VS_FAIL);
  assert_non_null(strstr(err.text, "463 -> 4"));
  free(parameters);
}

static void a_missing_file_and_a_wrong_option_are_named(void **state) {
  (void)state;
  unlink(file);
  expect_refusal("No such file");
  vs_player *player = NULL;
  vs_error err = {0};
  assert_int_equal(vs_player_open("onnx:build/untrained.onnx?fast=1", &player, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "fast=1"));
}

static void the_untrained_policy_is_the_same_for_the_same_seed_and_acts(void **state) {
  (void)state;
  char *first, *second;
  size_t first_size, second_size;
  assert_ok(vs_learn_write_untrained(file, 1, err));
  read_file(&first, &first_size);
  assert_ok(vs_learn_write_untrained(file, 1, err));
  read_file(&second, &second_size);
  assert_int_equal(first_size, second_size);
  assert_memory_equal(first, second, first_size);
  vs_player *player = NULL;
  assert_ok(open_file(&player, err));
  float obs[3][VS_OBS_SIZE] = {{0}}, action[3][2] = {{9, 9}, {9, 9}, {9, 9}};
  assert_ok(vs_player_act(player, obs[0], 3, action[0], err));
  // No input, no preference: alpha = beta up to the rounding of the head's bias.
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) assert_near(action[i][k], 0.0, 1e-6);
  vs_player_close(player);
  free(first);
  free(second);
}

static int set_up(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  snprintf(file, sizeof file, "%s/model.onnx", folder);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  unlink(file);
  return rmdir(folder);
}

int main(void) {
  // A build without ONNX Runtime has nothing to test but its message.
  vs_player *player = NULL;
  vs_error err = {0};
  vs_player_open("onnx:build/none.onnx", &player, &err);
  if (strstr(err.text, "no ONNX Runtime")) {
    printf("note: this build has no ONNX Runtime\n");
    return 0;
  }
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(onnx_runtime_agrees_with_plain_c_on_1000_observations),
      cmocka_unit_test(a_canonical_amplified_policy_agrees_with_plain_c),
      cmocka_unit_test(a_reversible_policy_agrees_with_plain_c_whichever_way_the_robot_faces),
      cmocka_unit_test(alpha_and_beta_are_of_the_robots_own_wheels),
      cmocka_unit_test(an_averaging_policy_agrees_with_plain_c_and_is_symmetric),
      cmocka_unit_test(a_truncated_file_is_refused_at_every_length),
      cmocka_unit_test(a_model_of_another_contract_is_refused),
      cmocka_unit_test(a_network_of_other_sizes_is_not_written),
      cmocka_unit_test(a_missing_file_and_a_wrong_option_are_named),
      cmocka_unit_test(the_untrained_policy_is_the_same_for_the_same_seed_and_acts),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
