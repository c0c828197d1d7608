#include "kernels.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

// The sanitizers' start-up does not get on with functions chosen at load time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CLONES
#endif
#define INLINE static inline __attribute__((always_inline))

// tanh(x) = 1 - 2/(e^(2x) + 1), with e^(2x) = 2^k e^r, |r| <= ln2/2, and the Taylor series of e^r to r^6 (relative
// error 1.2e-7). Beyond |x| = 9 the result rounds to +-1.
INLINE float tanh_one(float x) {
  float clipped = x < -9.0f ? -9.0f : x;
  clipped = clipped > 9.0f ? 9.0f : clipped;
  float t = clipped * 2.885390081777927f; // 2/ln 2
  float k = rintf(t);
  float r = (t - k) * 0.6931471805599453f;
  float series = 1.0f / 120 + r * (1.0f / 720);
  series = 1.0f + r * (1.0f + r * (0.5f + r * (1.0f / 6 + r * (1.0f / 24 + r * series))));
  int32_t bits = (int32_t)((uint32_t)((int32_t)k + 127) << 23);
  float power;
  memcpy(&power, &bits, sizeof power);
  float y = 1.0f - 2.0f / (series * power + 1.0f);
  return x != x ? x : y; // NaN stays NaN
}

CLONES void vs_kernel_bias_tanh(float *restrict y, size_t rows, size_t columns, const float *restrict bias) {
  for (size_t row = 0; row < rows; row++) {
    float *restrict line = y + row * columns;
    for (size_t i = 0; i < columns; i++) line[i] = tanh_one(line[i] + bias[i]);
  }
}

CLONES void vs_kernel_tanh_backward(float *restrict d, const float *restrict y, size_t count) {
  for (size_t i = 0; i < count; i++) d[i] *= 1.0f - y[i] * y[i];
}

INLINE float dot(const float *restrict a, const float *restrict b, size_t n) {
  float sum = 0.0f;
#pragma omp simd reduction(+ : sum)
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

CLONES void vs_kernel_dot(const float *restrict x, size_t stride, size_t rows, size_t width,
                          const float *restrict weight, float bias, float *restrict out, size_t out_stride) {
  for (size_t row = 0; row < rows; row++) out[row * out_stride] = bias + dot(x + row * stride, weight, width);
}

CLONES void vs_kernel_head_backward(const float *restrict x, float *restrict d, size_t stride, size_t rows,
                                    size_t width, const float *restrict weight, const float *restrict d_out,
                                    size_t outputs, float *restrict d_weight, float *restrict d_bias) {
  for (size_t row = 0; row < rows; row++) {
    const float *restrict xr = x + row * stride;
    float *restrict dr = d + row * stride;
    for (size_t i = 0; i < width; i++) dr[i] = 0.0f;
    for (size_t o = 0; o < outputs; o++) {
      float g = d_out[row * outputs + o];
      const float *restrict w = weight + o * width;
      float *restrict dw = d_weight + o * width;
      d_bias[o] += g;
      for (size_t i = 0; i < width; i++) dr[i] += g * w[i];
      for (size_t i = 0; i < width; i++) dw[i] += g * xr[i];
    }
    for (size_t i = 0; i < width; i++) dr[i] *= 1.0f - xr[i] * xr[i];
  }
}

CLONES void vs_kernel_column_sums(const float *restrict x, size_t rows, size_t columns, float *restrict out) {
  for (size_t row = 0; row < rows; row++) {
    const float *restrict line = x + row * columns;
    for (size_t i = 0; i < columns; i++) out[i] += line[i];
  }
}

CLONES void vs_kernel_to_bf16(const float *restrict x, size_t count, uint16_t *restrict out) {
  for (size_t i = 0; i < count; i++) {
    uint32_t bits;
    memcpy(&bits, &x[i], sizeof bits);
    uint32_t rounded = (bits + 0x7fffu + (bits >> 16 & 1u)) >> 16;
    out[i] = (uint16_t)(x[i] != x[i] ? 0x7fc0u : rounded);
  }
}

CLONES void vs_kernel_add(float *restrict a, const float *restrict b, size_t count) {
  for (size_t i = 0; i < count; i++) a[i] += b[i];
}

CLONES double vs_kernel_square_sum(const float *restrict a, size_t count) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (size_t i = 0; i < count; i++) sum += (double)a[i] * (double)a[i];
  return sum;
}

CLONES void vs_kernel_adam(float *restrict parameter, const float *restrict gradient, float *restrict m,
                           float *restrict v, size_t count, const vs_adam_step *step) {
  float rate = step->rate, beta1 = step->beta1, beta2 = step->beta2, epsilon = step->epsilon, scale = step->scale;
  for (size_t i = 0; i < count; i++) {
    float g = gradient[i] * scale;
    m[i] = beta1 * m[i] + (1.0f - beta1) * g;
    v[i] = beta2 * v[i] + (1.0f - beta2) * g * g;
    parameter[i] -= rate * m[i] / (sqrtf(v[i]) + epsilon);
  }
}
