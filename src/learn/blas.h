// Matrix products of the learner by a library opened when it starts, so that other commands do not pay for it: oneDNN,
// whose products of the learner's sizes run at 9/10 of the processor's peak (OpenBLAS: 7/10), or OpenBLAS.
#ifndef VSSS_LEARN_BLAS_H
#define VSSS_LEARN_BLAS_H

#include <stdbool.h>
#include <stdint.h>

#include "vsss/status.h"

typedef enum vs_blas_library { VS_BLAS_ANY, VS_BLAS_ONEDNN, VS_BLAS_OPENBLAS } vs_blas_library;

// Row-major float C[m][n] = A B (+ C where accumulate), with A [m][k] (or [k][m] transposed) and B [k][n] (or [n][k]
// transposed); lda, ldb, ldc: floats from one stored row to the next. One thread; callable from many. Where the library
// fails, C is NaN.
typedef struct vs_blas {
  const char *name; // of the library
  // The functions of the library, the others NULL.
  int (*dnnl_sgemm)(char trans_a, char trans_b, int64_t m, int64_t n, int64_t k, float alpha, const float *a,
                    int64_t lda, const float *b, int64_t ldb, float beta, float *c, int64_t ldc);
  int (*dnnl_bf16)(char trans_a, char trans_b, int64_t m, int64_t n, int64_t k, float alpha, const uint16_t *a,
                   int64_t lda, const uint16_t *b, int64_t ldb, float beta, float *c, int64_t ldc);
  void (*cblas_sgemm)(int order, int trans_a, int trans_b, int m, int n, int k, float alpha, const float *a, int lda,
                      const float *b, int ldb, float beta, float *c, int ldc);
  // The OpenMP that shares out oneDNN's products.
  int (*max_threads)(void);
  void (*set_threads)(int);
} vs_blas;

// VS_BLAS_ANY: oneDNN on x86-64 (elsewhere it has no kernels of its own, and OpenBLAS comes first), else the other.
// VS_FAIL names the Debian package. The library stays open for good.
vs_status vs_blas_open(vs_blas *out, vs_blas_library which, vs_error *err);

void vs_blas_multiply(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k, const float *a,
                      int lda, const float *b, int ldb, bool accumulate, float *c, int ldc);

// The same with A and B of bfloat16 numbers (the upper halves of floats), added up in float: three to four times as fast
// on processors with AMX. vs_blas_has_bf16: the library and the processor can.
bool vs_blas_has_bf16(const vs_blas *blas);
void vs_blas_multiply_bf16(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k,
                           const uint16_t *a, int lda, const uint16_t *b, int ldb, bool accumulate, float *c, int ldc);

#endif
