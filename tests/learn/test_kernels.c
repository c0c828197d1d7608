// Tests src/learn/kernels.c
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "learn/kernels.h"
#include "vsss/rng.h"

static void tanh_is_within_3e7_of_the_libm_everywhere(void **state) {
  (void)state;
  enum { N = 40000 };
  float *y = malloc(N * sizeof *y), *bias = malloc(N * sizeof *bias);
  for (int i = 0; i < N; i++) y[i] = 0.5f, bias[i] = (float)(i - N / 2) * 1e-3f;
  vs_kernel_bias_tanh(y, 1, N, bias);
  for (int i = 0; i < N; i++) assert_near(y[i], tanh((double)(0.5f + bias[i])), 3e-7);
  const float extreme[] = {-1e30f, 1e30f, -INFINITY, INFINITY};
  float out[5] = {0, 0, 0, 0, NAN}, zeros[5] = {extreme[0], extreme[1], extreme[2], extreme[3], 0};
  vs_kernel_bias_tanh(out, 1, 5, zeros);
  for (int i = 0; i < 4; i++) assert_near(out[i], i % 2 ? 1.0 : -1.0, 1e-6);
  assert_true(isnan(out[4])); // a broken network shows
  free(bias);
  free(y);
}

// Two rows of three inputs inside rows of four floats, two outputs, worked out by hand:
//   x = (0.5, 0, -0.5), (1, 0.5, 0); weight = (1, 2, 3), (4, 5, 6); d_out = (1, 0), (2, -1)
//   d_out weight: row 0 (1, 2, 3); row 1 (2-4, 4-5, 6-6) = (-2, -1, 0)
//   times 1 - x^2: row 0 (0.75, 2, 2.25); row 1 (0, -0.75, 0)
//   d_weight 0: 1*x0 + 2*x1 = (2.5, 1, -0.5); d_weight 1: -x1 = (-1, -0.5, 0); d_bias (3, -1)
static void the_backward_of_a_head_agrees_with_hand_values(void **state) {
  (void)state;
  const float x[8] = {0.5f, 0, -0.5f, 7, 1, 0.5f, 0, 7}, weight[6] = {1, 2, 3, 4, 5, 6}, d_out[4] = {1, 0, 2, -1};
  float d[8] = {9, 9, 9, 9, 9, 9, 9, 9}, d_weight[6] = {0}, d_bias[2] = {0};
  vs_kernel_head_backward(x, d, 4, 2, 3, weight, d_out, 2, d_weight, d_bias);
  const double expected[8] = {0.75, 2, 2.25, 9, 0, -0.75, 0, 9}, expected_weight[6] = {2.5, 1, -0.5, -1, -0.5, 0};
  for (int i = 0; i < 8; i++) assert_near(d[i], expected[i], 1e-6);
  for (int i = 0; i < 6; i++) assert_near(d_weight[i], expected_weight[i], 1e-6);
  assert_near(d_bias[0], 3.0, 1e-6);
  assert_near(d_bias[1], -1.0, 1e-6);
  float out[4];
  vs_kernel_dot(x, 4, 2, 3, weight, 0.25f, out, 2); // 0.5 - 1.5 + 0.25, 1 + 1 + 0.25
  assert_near(out[0], -0.75, 1e-6);
  assert_near(out[2], 2.25, 1e-6);
}

// Adam, first step from zero moments: m = 0.1 g, v = 0.001 g^2; unbiased both give g and g^2, so the step is
// rate g/(|g| + epsilon). With g = 2 scaled by 0.5 (to 1), rate 0.1, epsilon 1: parameter 3 - 0.1 * 1/(1 + 1) = 2.95.
static void adam_takes_its_first_step_as_the_paper_says(void **state) {
  (void)state;
  float parameter = 3, gradient = 2, m = 0, v = 0;
  double unbias = sqrt(1.0 - 0.999);
  const vs_adam_step step = {(float)(0.1 * unbias / (1.0 - 0.9)), 0.9f, 0.999f, (float)(1.0 * unbias), 0.5f};
  vs_kernel_adam(&parameter, &gradient, &m, &v, 1, &step);
  assert_near(m, 0.1, 1e-7);
  assert_near(v, 0.001, 2e-8);
  assert_near(parameter, 2.95, 1e-6);
}

// bfloat16 keeps the upper 16 bits of a float: 1 = 0x3f800000; its next is 1 + 2^-7, half way there is a tie.
static void rounding_goes_to_the_nearest_and_ties_to_even(void **state) {
  (void)state;
  const float step = 0x1p-7f, x[] = {1.0f,
                                     1.0f + 0.49f * step,
                                     1.0f + 0.5f * step,
                                     1.0f + 0.51f * step,
                                     1.0f + 1.5f * step,
                                     -1.0f - 0.51f * step,
                                     0.0f,
                                     INFINITY,
                                     -INFINITY,
                                     FLT_MAX};
  const uint16_t expected[] = {0x3f80, 0x3f80, 0x3f80, 0x3f81, 0x3f82, 0xbf81, 0, 0x7f80, 0xff80, 0x7f80};
  enum { N = sizeof x / sizeof *x };
  uint16_t out[N];
  vs_kernel_to_bf16(x, N, out);
  for (int i = 0; i < N; i++) assert_int_equal(out[i], expected[i]);
  const uint32_t nans[] = {0x7fffffff, 0xffffffff, 0x7f800001}; // adding to these carries into nonsense
  float broken[3];
  memcpy(broken, nans, sizeof broken);
  vs_kernel_to_bf16(broken, 3, out);
  for (int i = 0; i < 3; i++) assert_true((out[i] & 0x7f80) == 0x7f80 && (out[i] & 0x7f) != 0);
}

static void sums_run_over_rows(void **state) {
  (void)state;
  const float x[6] = {1, 2, 3, 10, 20, 30};
  float sums[3] = {0}, a[3] = {1, 1, 1};
  vs_kernel_column_sums(x, 2, 3, sums);
  vs_kernel_add(a, sums, 3);
  for (int i = 0; i < 3; i++) assert_near(a[i], 11.0 * (i + 1) + 1.0, 1e-6);
  assert_near(vs_kernel_square_sum(x, 3), 14.0, 1e-9);
  float d[2] = {2, 2};
  const float y[2] = {0.5f, -1};
  vs_kernel_tanh_backward(d, y, 2);
  assert_near(d[0], 1.5, 1e-7);
  assert_near(d[1], 0.0, 1e-7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tanh_is_within_3e7_of_the_libm_everywhere),
      cmocka_unit_test(the_backward_of_a_head_agrees_with_hand_values),
      cmocka_unit_test(adam_takes_its_first_step_as_the_paper_says),
      cmocka_unit_test(rounding_goes_to_the_nearest_and_ties_to_even),
      cmocka_unit_test(sums_run_over_rows),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
