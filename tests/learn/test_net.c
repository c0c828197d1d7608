// Tests src/learn/net.c
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "learn/kernels.h"
#include "learn/net.h"

enum { ROWS = 7, INPUTS = 6 };
static const vs_net_shape small = {INPUTS, 3, {5, 4, 3}, 2, true};

typedef struct fixture {
  vs_net net;
  vs_blas blas;
  vs_net_work work;
  float *parameters, x[ROWS * INPUTS], d_raw[ROWS * 4], d_value[ROWS];
} fixture;

static void set_up_with(fixture *f, const vs_blas *blas) {
  f->blas = *blas;
  assert_ok(vs_net_init(&f->net, &small, err));
  assert_ok(vs_net_work_init(&f->work, &f->net, ROWS, true, NULL, err));
  f->parameters = malloc(f->net.size * sizeof *f->parameters);
  vs_rng rng = vs_rng_make(2, 0);
  for (size_t i = 0; i < f->net.size; i++) f->parameters[i] = (float)vs_rng_range(&rng, -0.8, 0.8);
  for (int i = 0; i < ROWS * INPUTS; i++) f->x[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (int i = 0; i < ROWS * 4; i++) f->d_raw[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (int i = 0; i < ROWS; i++) f->d_value[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
}

static void set_up(fixture *f) {
  vs_blas blas;
  assert_ok(vs_blas_open(&blas, VS_BLAS_ANY, err));
  set_up_with(f, &blas);
}

// Those of the libraries that are installed; returns how many.
static int libraries(vs_blas blas[2]) {
  int count = 0;
  for (int which = VS_BLAS_ONEDNN; which <= VS_BLAS_OPENBLAS; which++) {
    vs_error missing = {0};
    if (vs_blas_open(&blas[count], (vs_blas_library)which, &missing) == VS_OK)
      count++;
    else
      print_message("note: 1 check not run: %s\n", missing.text);
  }
  assert_true(count > 0);
  return count;
}

static void tear_down(fixture *f) {
  vs_net_work_free(&f->work);
  free(f->parameters);
}

// The same network in double, one value after the other.
static void plain(const vs_net *net, const float *p, const float *x, double raw[4], double *value) {
  const vs_net_shape *s = &net->shape;
  for (int n = 0; n < net->nets; n++) {
    double in[16], out[16];
    for (int i = 0; i < s->inputs; i++) in[i] = x[i];
    for (int l = 0; l < s->layers; l++) {
      int before = l ? s->width[l - 1] : s->inputs, stride = l ? s->width[l] : net->nets * s->width[0];
      for (int j = 0; j < s->width[l]; j++) {
        out[j] = p[net->bias[l] + (size_t)(n * s->width[l] + j)];
        for (int i = 0; i < before; i++) out[j] += in[i] * p[net->weight[l][n] + (size_t)(i * stride + j)];
      }
      for (int j = 0; j < s->width[l]; j++) in[j] = tanh(out[j]);
    }
    int last = s->width[s->layers - 1];
    for (int o = 0; o < vs_net_outputs(net, n); o++) {
      double sum = p[net->head_bias[n] + (size_t)o];
      for (int i = 0; i < last; i++) sum += in[i] * p[net->head_weight[n] + (size_t)(o * last + i)];
      if (n == VS_ACTOR) raw[o] = sum;
      if (n == VS_CRITIC) *value = sum;
    }
  }
}

static void the_forward_pass_agrees_with_a_plain_network(void **state) {
  (void)state;
  vs_blas blas[2];
  for (int i = libraries(blas) - 1; i >= 0; i--) {
    fixture f;
    set_up_with(&f, &blas[i]);
    vs_net_forward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work);
    for (int r = 0; r < ROWS; r++) {
      double raw[4], value;
      plain(&f.net, f.parameters, f.x + r * INPUTS, raw, &value);
      for (int o = 0; o < 4; o++) assert_near(f.work.raw[r * 4 + o], raw[o], 2e-6);
      assert_near(f.work.value[r], value, 2e-6);
    }
    tear_down(&f);
  }
}

static void derivatives(const fixture *f, vs_net_work *work) {
  memcpy(work->d_raw, f->d_raw, sizeof f->d_raw);
  memcpy(work->d_value, f->d_value, sizeof f->d_value);
}

// Loss = sum of d_raw * raw + d_value * value, whose derivatives by the outputs are d_raw and d_value.
static double loss(fixture *f) {
  double sum = 0.0;
  for (int r = 0; r < ROWS; r++) {
    double raw[4], value;
    plain(&f->net, f->parameters, f->x + r * INPUTS, raw, &value);
    for (int o = 0; o < 4; o++) sum += f->d_raw[r * 4 + o] * raw[o];
    sum += f->d_value[r] * value;
  }
  return sum;
}

static void check_every_gradient(const vs_blas *blas) {
  fixture f;
  set_up_with(&f, blas);
  float *gradient = malloc(f.net.size * sizeof *gradient);
  for (size_t i = 0; i < f.net.size; i++) gradient[i] = 0.25f; // it is added to what is there
  vs_net_forward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work);
  derivatives(&f, &f.work);
  vs_net_backward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work, gradient);
  for (size_t i = 0; i < f.net.size; i++) {
    float kept = f.parameters[i], up = kept + 1e-3f, down = kept - 1e-3f;
    f.parameters[i] = up;
    double more = loss(&f);
    f.parameters[i] = down;
    double less = loss(&f);
    f.parameters[i] = kept;
    assert_near(gradient[i] - 0.25, (more - less) / ((double)up - down), 5e-5);
  }
  free(gradient);
  tear_down(&f);
}

static void every_gradient_agrees_with_finite_differences(void **state) {
  (void)state;
  vs_blas blas[2];
  for (int i = libraries(blas) - 1; i >= 0; i--) check_every_gradient(&blas[i]);
}

// bfloat16 has 8 bits of mantissa: each factor is off by at most 2^-9 of itself.
static void bfloat16_changes_no_output_and_the_gradient_by_less_than_a_percent(void **state) {
  (void)state;
  fixture f;
  set_up(&f);
  if (!vs_blas_has_bf16(&f.blas)) {
    print_message("note: no bfloat16 here\n");
    tear_down(&f);
    skip();
  }
  uint16_t *bf16 = malloc(f.net.size * sizeof *bf16);
  float *gradient = calloc(2 * f.net.size, sizeof *gradient), *rounded = gradient + f.net.size;
  vs_net_work work;
  assert_ok(vs_net_work_init(&work, &f.net, ROWS, true, bf16, err));
  vs_kernel_to_bf16(f.parameters, f.net.size, bf16);
  vs_net_forward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work);
  vs_net_forward(&f.net, &f.blas, f.parameters, f.x, ROWS, &work);
  assert_memory_equal(work.raw, f.work.raw, ROWS * 4 * sizeof(float));
  assert_memory_equal(work.value, f.work.value, ROWS * sizeof(float));
  derivatives(&f, &f.work);
  vs_net_backward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work, gradient);
  derivatives(&f, &work);
  vs_net_backward(&f.net, &f.blas, f.parameters, f.x, ROWS, &work, rounded);
  double off = 0.0, length = 0.0;
  for (size_t i = 0; i < f.net.size; i++) {
    off += pow((double)rounded[i] - gradient[i], 2.0);
    length += pow(gradient[i], 2.0);
  }
  assert_true(sqrt(off / length) < 0.01);
  assert_true(sqrt(off / length) > 1e-4); // they were not products of floats
  vs_net_work_free(&work);
  free(gradient);
  free(bf16);
  tear_down(&f);
}

static void an_extracted_actor_says_the_same(void **state) {
  (void)state;
  fixture f;
  set_up(&f);
  vs_net actor;
  vs_net_shape shape = small;
  shape.critic = false;
  assert_ok(vs_net_init(&actor, &shape, err));
  assert_true(actor.size < f.net.size);
  float *own = malloc(actor.size * sizeof *own);
  vs_net_work work;
  assert_ok(vs_net_work_init(&work, &actor, ROWS, false, NULL, err));
  vs_net_extract_actor(&f.net, f.parameters, &actor, own);
  vs_net_forward(&actor, &f.blas, own, f.x, ROWS, &work);
  vs_net_forward(&f.net, &f.blas, f.parameters, f.x, ROWS, &f.work);
  for (int i = 0; i < ROWS * 4; i++) assert_near(work.raw[i], f.work.raw[i], 1e-6);
  vs_net_work_free(&work);
  free(own);
  tear_down(&f);
}

// Orthogonal columns of length sqrt 2; alpha = beta = 4 needs 1 + softplus(bias) = 4.
static void a_fresh_network_is_orthogonal_and_starts_at_the_asked_shape(void **state) {
  (void)state;
  const vs_net_shape shape = {20, 2, {8, 8}, 2, true};
  vs_net net;
  assert_ok(vs_net_init(&net, &shape, err));
  float *p = malloc(net.size * sizeof *p);
  vs_rng rng = vs_rng_make(1, 0);
  assert_ok(vs_net_randomise(&net, 4.0, &rng, p, err));
  for (int a = 0; a < 8; a++)
    for (int b = 0; b < 8; b++) {
      double first = 0.0, second = 0.0;
      for (int i = 0; i < 20; i++)
        first += (double)p[net.weight[0][VS_CRITIC] + (size_t)(i * 16 + a)] *
                 p[net.weight[0][VS_CRITIC] + (size_t)(i * 16 + b)];
      for (int i = 0; i < 8; i++)
        second +=
            (double)p[net.weight[1][VS_ACTOR] + (size_t)(i * 8 + a)] * p[net.weight[1][VS_ACTOR] + (size_t)(i * 8 + b)];
      assert_near(first, a == b ? 2.0 : 0.0, 1e-5);
      assert_near(second, a == b ? 2.0 : 0.0, 1e-5);
    }
  for (int i = 0; i < 4; i++) assert_near(1.0 + log1p(exp((double)p[net.head_bias[VS_ACTOR] + (size_t)i])), 4.0, 1e-5);
  free(p);
}

static void shapes_out_of_range_are_refused_with_the_range(void **state) {
  (void)state;
  vs_net net;
  vs_error err = {0};
  const vs_net_shape deep = {4, 5, {2, 2, 2, 2}, 2, true}, wide = {4, 1, {5000}, 2, true};
  assert_int_equal(vs_net_init(&net, &deep, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "1 to 4"));
  assert_int_equal(vs_net_init(&net, &wide, &err), VS_USAGE);
  assert_non_null(strstr(err.text, "1 to 4096"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_forward_pass_agrees_with_a_plain_network),
      cmocka_unit_test(every_gradient_agrees_with_finite_differences),
      cmocka_unit_test(bfloat16_changes_no_output_and_the_gradient_by_less_than_a_percent),
      cmocka_unit_test(an_extracted_actor_says_the_same),
      cmocka_unit_test(a_fresh_network_is_orthogonal_and_starts_at_the_asked_shape),
      cmocka_unit_test(shapes_out_of_range_are_refused_with_the_range),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
