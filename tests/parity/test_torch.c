// Tests src/learn/gradient_torch.cpp against src/learn/net.c, src/learn/ppo.c and an exported ONNX file: libtorch as the
// oracle of all three, at the sizes that are trained.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assert_near.h"
#include "learn/beta.h"
#include "learn/export.h"
#include "learn/learner.h"
#include "learn/torch_engine.h"
#include "vsss/policy.h"

enum { OBSERVATIONS = 1000, ROWS = 600 };
static vs_gradient_engine torch;

static void random_floats(float *out, size_t count, double low, double high, uint64_t seed) {
  vs_rng rng = vs_rng_make(seed, 0);
  for (size_t i = 0; i < count; i++) out[i] = (float)vs_rng_range(&rng, low, high);
}

// 464-256-256 as trained, but with a last layer that says something.
static void make_net(vs_net *net, float **parameters) {
  const vs_net_shape shape = {VS_OBS_SIZE, 2, {256, 256}, VS_ACTION_SIZE, true};
  assert_ok(vs_net_init(net, &shape, err));
  *parameters = malloc(net->size * sizeof **parameters);
  vs_rng rng = vs_rng_make(1, 0);
  assert_ok(vs_net_randomise(net, 4.0, &rng, *parameters, err));
  random_floats(*parameters + net->head_weight[VS_ACTOR], 256 * 4, -0.3, 0.3, 2);
}

static void onnx_runtime_agrees_with_torch_on_1000_observations(void **state) {
  (void)state;
  vs_net net;
  float *parameters;
  make_net(&net, &parameters);
  char file[64], uri[80];
  snprintf(file, sizeof file, "build/torch_test_%d.onnx", (int)getpid());
  snprintf(uri, sizeof uri, "onnx:%s", file);
  assert_ok(
      vs_export_actor(file, &net, parameters, &(vs_export_def){"test", {.action_gain = 1.0}, true, NULL, 0}, err));
  vs_player *player = NULL;
  vs_error err = {0};
  vs_status opened = vs_player_open(uri, &player, &err);
  unlink(file);
  if (opened != VS_OK && strstr(err.text, "no ONNX Runtime")) {
    printf("note: this build has no ONNX Runtime\n");
    free(parameters);
    skip();
  }
  assert_int_equal(opened, VS_OK);
  static float x[OBSERVATIONS * VS_OBS_SIZE], raw[OBSERVATIONS * 4], value[OBSERVATIONS], action[OBSERVATIONS * 2];
  random_floats(x, OBSERVATIONS * VS_OBS_SIZE, -1.0, 1.0, 3);
  assert_ok(torch.forward(torch.self, &net, parameters, x, OBSERVATIONS, raw, value, err));
  assert_ok(vs_player_act(player, x, OBSERVATIONS, action, err));
  double largest = 0.0;
  for (int i = 0; i < OBSERVATIONS; i++)
    for (int k = 0; k < 2; k++) {
      double alpha = 1.0 + vs_softplus(raw[4 * i + k]), beta = 1.0 + vs_softplus(raw[4 * i + 2 + k]);
      assert_near(action[2 * i + k], (alpha - beta) / (alpha + beta), 1e-5);
      largest = fmax(largest, fabs(action[2 * i + k]));
    }
  assert_true(largest > 0.3);
  vs_player_close(player);
  free(parameters);
}

static void our_networks_agree_with_torch_on_1000_observations(void **state) {
  (void)state;
  vs_net net;
  float *parameters;
  vs_blas blas;
  vs_net_work work;
  make_net(&net, &parameters);
  assert_ok(vs_blas_open(&blas, VS_BLAS_ANY, err));
  assert_ok(vs_net_work_init(&work, &net, OBSERVATIONS, false, NULL, err));
  static float x[OBSERVATIONS * VS_OBS_SIZE], raw[OBSERVATIONS * 4], value[OBSERVATIONS];
  random_floats(x, OBSERVATIONS * VS_OBS_SIZE, -1.0, 1.0, 4);
  assert_ok(torch.forward(torch.self, &net, parameters, x, OBSERVATIONS, raw, value, err));
  vs_net_forward(&net, &blas, parameters, x, OBSERVATIONS, &work);
  for (int i = 0; i < OBSERVATIONS * 4; i++) assert_near(work.raw[i], raw[i], 2e-5);
  for (int i = 0; i < OBSERVATIONS; i++) assert_near(work.value[i], value[i], 2e-5);
  vs_net_work_free(&work);
  free(parameters);
}

typedef struct batch_data {
  float x[ROWS * VS_OBS_SIZE], log_u[ROWS * 2], log_1_u[ROWS * 2], old_log_p[ROWS], advantage[ROWS], target[ROWS],
      old_value[ROWS];
} batch_data;

// Old log-probabilities near the present ones, so that ratios fall on both sides of the clip.
static vs_ppo_batch make_batch(batch_data *d) {
  random_floats(d->x, ROWS * VS_OBS_SIZE, -1.0, 1.0, 5);
  random_floats(d->old_log_p, ROWS, 0.0, 1.5, 6);
  random_floats(d->advantage, ROWS, -2.0, 2.0, 7);
  random_floats(d->target, ROWS, -1.0, 1.0, 8);
  random_floats(d->old_value, ROWS, -1.0, 1.0, 9);
  vs_rng rng = vs_rng_make(10, 0);
  for (int i = 0; i < ROWS * 2; i++) {
    double u = vs_rng_range(&rng, 0.2, 0.8);
    d->log_u[i] = (float)log(u), d->log_1_u[i] = (float)log1p(-u);
  }
  return (vs_ppo_batch){ROWS, d->x, d->log_u, d->log_1_u, d->old_log_p, d->advantage, d->target, d->old_value};
}

static void check_gradient(bool clip_value, bool imitate) {
  static batch_data data;
  const vs_ppo_batch batch = make_batch(&data);
  vs_learner_def def = {.shape = {VS_OBS_SIZE, 2, {256, 256}, VS_ACTION_SIZE, true},
                        .ppo = {.clip = 0.2, .clip_value = clip_value, .entropy = 0.01, .value_weight = 0.5},
                        .learning_rate = 1e-3,
                        .initial_concentration = 4.0,
                        .epochs = 1,
                        .minibatch = ROWS,
                        .microbatches = 3};
  def.ppo.imitate = imitate;
  vs_learner learner;
  vs_pool *pool;
  assert_ok(vs_pool_new(2, &pool, err));
  assert_ok(vs_learner_init(&learner, &def, pool, 1, err));
  int rows[ROWS];
  for (int i = 0; i < ROWS; i++) rows[i] = i;
  vs_ppo_stats own = {0}, theirs = {0};
  assert_ok(vs_learner_gradient(&learner, &batch, &(vs_minibatch){rows, ROWS, ROWS, 0.0, 1.0}, &own, err));
  float *gradient = malloc(learner.net.size * sizeof *gradient);
  assert_ok(
      torch.gradient(torch.self, &learner.net, &def.ppo, learner.parameters, &batch, ROWS, gradient, &theirs, err));
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < learner.net.size; i++) {
    largest = fmax(largest, fabs((double)gradient[i]));
    worst = fmax(worst, fabs((double)gradient[i] - learner.gradient[i]));
  }
  if (worst > 1e-5 * fmax(1.0, largest)) fail_msg("gradients differ by %g, the largest is %g", worst, largest);
  assert_true(largest > 1e-3);
  assert_near(own.policy_loss / ROWS, theirs.policy_loss / ROWS, 1e-5);
  assert_near(own.value_loss / ROWS, theirs.value_loss / ROWS, 1e-5);
  assert_near(own.entropy / ROWS, theirs.entropy / ROWS, 1e-5);
  if (!imitate) {
    assert_near(own.kl / ROWS, theirs.kl / ROWS, 1e-5);
    assert_true(own.clipped > 0.2 * ROWS && own.clipped < 0.98 * ROWS);
    assert_near(own.clipped, theirs.clipped, 2.0);
  }
  free(gradient);
  vs_learner_free(&learner);
  vs_pool_free(pool);
}

static void the_gradient_of_the_ppo_loss_agrees_with_torch(void **state) {
  (void)state;
  check_gradient(false, false);
  check_gradient(true, false);
}

static void the_gradient_of_imitation_agrees_with_torch(void **state) {
  (void)state;
  check_gradient(false, true);
}

int main(void) {
  vs_error err = {0};
  if (vs_torch_engine_open(&torch, &err) != VS_OK) {
    if (!strstr(err.text, "libtorch-dev")) {
      printf("%s\n", err.text);
      return 1;
    }
    printf("note: this build has no libtorch\n");
    return 0;
  }
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(onnx_runtime_agrees_with_torch_on_1000_observations),
      cmocka_unit_test(our_networks_agree_with_torch_on_1000_observations),
      cmocka_unit_test(the_gradient_of_the_ppo_loss_agrees_with_torch),
      cmocka_unit_test(the_gradient_of_imitation_agrees_with_torch),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
