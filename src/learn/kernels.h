// The inner loops of the learner that BLAS does not have, written so that the compiler vectorises them, each compiled
// for three generations of x86 processors and chosen when the program starts.
#ifndef VSSS_LEARN_KERNELS_H
#define VSSS_LEARN_KERNELS_H

#include <stddef.h>
#include <stdint.h>

// All matrices are row-major floats; stride: floats from one row to the next.

// y = tanh(y + bias), in place. Absolute error of tanh below 3e-7.
void vs_kernel_bias_tanh(float *y, size_t rows, size_t columns, const float *bias);

// d = d * (1 - y^2), the derivative of tanh where y = tanh(x).
void vs_kernel_tanh_backward(float *d, const float *y, size_t count);

// out[row] = x[row] . weight + bias, for one output of width inputs.
void vs_kernel_dot(const float *x, size_t stride, size_t rows, size_t width, const float *weight, float bias,
                   float *out, size_t out_stride);

// Backward of one group of outputs (weight [outputs][width]) in one pass over the rows: d = (d_out weight)(1 - x^2),
// d_weight += d_out^T x, d_bias += sum of d_out.
void vs_kernel_head_backward(const float *x, float *d, size_t stride, size_t rows, size_t width, const float *weight,
                             const float *d_out, size_t outputs, float *d_weight, float *d_bias);

// out[column] += sum over rows.
void vs_kernel_column_sums(const float *x, size_t rows, size_t columns, float *out);

// x rounded to the nearest bfloat16 (the upper half of a float), ties to even; NaN stays NaN.
void vs_kernel_to_bf16(const float *x, size_t count, uint16_t *out);

// a += b.
void vs_kernel_add(float *a, const float *b, size_t count);
double vs_kernel_square_sum(const float *a, size_t count);

// One step of Adam (Kingma and Ba 2015) on gradients scaled by `scale` (gradient clipping). rate: the learning rate
// times sqrt(1 - beta2^t)/(1 - beta1^t); epsilon: times sqrt(1 - beta2^t).
typedef struct vs_adam_step {
  float rate, beta1, beta2, epsilon, scale;
} vs_adam_step;
void vs_kernel_adam(float *parameter, const float *gradient, float *m, float *v, size_t count,
                    const vs_adam_step *step);

#endif
