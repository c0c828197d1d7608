#include "blas.h"

#include <dlfcn.h>
#include <stdlib.h>

// Values of CBLAS (netlib's cblas.h).
enum { ROW_MAJOR = 101, PLAIN = 111, TRANSPOSED = 112 };

// OpenBLAS chooses its kernels by the processor's model when it loads, and takes an old family for a model it does not
// know: a processor with AVX-512 is told so, unless the user chose.
static void choose_kernels(void) {
  setenv("OPENBLAS_NUM_THREADS", "1", 0); // our threads share out the work, its own would only wait
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
#endif
}

vs_status vs_blas_open(vs_blas *out, vs_error *err) {
  choose_kernels();
  void *library = dlopen("libopenblas.so.0", RTLD_NOW | RTLD_LOCAL);
  if (!library) return vs_fail(err, VS_FAIL, "training needs OpenBLAS: apt install libopenblas0 (%.200s)", dlerror());
  out->sgemm = (void (*)(int, int, int, int, int, int, float, const float *, int, const float *, int, float, float *,
                         int))dlsym(library, "cblas_sgemm");
  const char *(*name)(void) = (const char *(*)(void))dlsym(library, "openblas_get_corename");
  void (*set_threads)(int) = (void (*)(int))dlsym(library, "openblas_set_num_threads");
  if (!out->sgemm || !name || !set_threads)
    return vs_fail(err, VS_FAIL, "libopenblas.so.0 has no cblas_sgemm: apt install libopenblas0");
  set_threads(1);
  out->kernels = name();
  return VS_OK;
}

void vs_blas_multiply(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k, const float *a,
                      int lda, const float *b, int ldb, bool accumulate, float *c, int ldc) {
  blas->sgemm(ROW_MAJOR, transpose_a ? TRANSPOSED : PLAIN, transpose_b ? TRANSPOSED : PLAIN, m, n, k, 1.0f, a, lda, b,
              ldb, accumulate ? 1.0f : 0.0f, c, ldc);
}
