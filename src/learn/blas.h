// Matrix products by OpenBLAS, opened when a learner starts, so that other commands do not pay for it.
#ifndef VSSS_LEARN_BLAS_H
#define VSSS_LEARN_BLAS_H

#include <stdbool.h>

#include "vsss/status.h"

// Row-major float C[m][n] = A B (+ C where accumulate), with A [m][k] (or [k][m] transposed) and B [k][n] (or [n][k]
// transposed); lda, ldb, ldc: floats from one stored row to the next. One thread; callable from many.
typedef struct vs_blas {
  void (*sgemm)(int order, int trans_a, int trans_b, int m, int n, int k, float alpha, const float *a, int lda,
                const float *b, int ldb, float beta, float *c, int ldc);
  const char *kernels; // the processor family whose kernels run, as OpenBLAS names it
} vs_blas;

// VS_FAIL names the Debian package. The library stays open for good.
vs_status vs_blas_open(vs_blas *out, vs_error *err);

void vs_blas_multiply(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k, const float *a,
                      int lda, const float *b, int ldb, bool accumulate, float *c, int ldc);

#endif
