#include "blas.h"

#include <dlfcn.h>
#include <math.h>
#include <stddef.h>

#include "vsss/signals.h"

// Values of CBLAS (netlib's cblas.h).
enum { ROW_MAJOR = 101, PLAIN = 111, TRANSPOSED = 112 };

// A function of a library as a pointer of any type: POSIX's way round ISO C, which knows no cast from void *.
static bool find(void *library, const char *name, void *function) {
  *(void **)function = dlsym(library, name);
  return *(void **)function != NULL;
}

static bool processor_has_bf16(void) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx512bf16");
#else
  return false;
#endif
}

// Whether a bfloat16 product comes out: (1 2; 3 4)(5; 6) = (17; 39). oneDNN 2.6 refuses where its user limits it to less
// than the processor has (ONEDNN_MAX_CPU_ISA).
static bool bf16_works(const vs_blas *blas) {
  const uint16_t a[4] = {0x3f80, 0x4000, 0x4040, 0x4080}, b[2] = {0x40a0, 0x40c0};
  float c[2] = {0};
  vs_blas_multiply_bf16(blas, false, false, 2, 1, 2, a, 2, b, 1, false, c, 1);
  return c[0] == 17.0f && c[1] == 39.0f;
}

static vs_status open_onednn(vs_blas *out, vs_error *err) {
  void *library = dlopen("libdnnl.so", RTLD_NOW | RTLD_LOCAL); // the link that libdnnl-dev sets, whatever the version
  if (!library) return vs_fail(err, VS_FAIL, "training needs oneDNN: apt install libdnnl-dev (%.200s)", dlerror());
  *out = (vs_blas){.name = "oneDNN"};
  if (!find(library, "dnnl_sgemm", (void *)&out->dnnl_sgemm) ||
      !find(library, "omp_get_max_threads", (void *)&out->max_threads) ||
      !find(library, "omp_set_num_threads", (void *)&out->set_threads))
    return vs_fail(err, VS_FAIL, "libdnnl.so has no dnnl_sgemm over OpenMP: apt install libdnnl-dev");
  // Exported by both releases' libraries, though their headers keep it back: where it is missing, floats have to do.
  if (processor_has_bf16() && find(library, "dnnl_gemm_bf16bf16f32", (void *)&out->dnnl_bf16) && !bf16_works(out))
    out->dnnl_bf16 = NULL;
  return VS_OK;
}

static vs_status open_openblas(vs_blas *out, vs_error *err) {
  void *library = dlopen("libopenblas.so.0", RTLD_NOW | RTLD_LOCAL);
  if (!library) return vs_fail(err, VS_FAIL, "training needs OpenBLAS: apt install libopenblas0 (%.200s)", dlerror());
  *out = (vs_blas){.name = "OpenBLAS"};
  void (*set_threads)(int);
  if (!find(library, "cblas_sgemm", (void *)&out->cblas_sgemm) ||
      !find(library, "openblas_set_num_threads", (void *)&set_threads))
    return vs_fail(err, VS_FAIL, "libopenblas.so.0 has no cblas_sgemm: apt install libopenblas0");
  set_threads(1);
  return VS_OK;
}

vs_status vs_blas_open(vs_blas *out, vs_blas_library which, vs_error *err) {
  if (which == VS_BLAS_ONEDNN) return open_onednn(out, err);
  if (which == VS_BLAS_OPENBLAS) return open_openblas(out, err);
#if defined(__x86_64__)
  return open_onednn(out, NULL) == VS_OK ? VS_OK : open_openblas(out, err);
#else
  return open_openblas(out, NULL) == VS_OK ? VS_OK : open_onednn(out, err);
#endif
}

// oneDNN works on the calling thread alone from here on, and no signal disturbs it; returns how many threads OpenMP gave
// it, for whoever else uses OpenMP on this thread (libtorch).
static int begin_product(const vs_blas *blas) {
  vs_signals_hold();
  int threads = blas->max_threads();
  blas->set_threads(1);
  return threads;
}

static void end_product(const vs_blas *blas, int threads) {
  blas->set_threads(threads);
  vs_signals_release();
}

// A product that failed (out of memory) must not pass for one: what is learnt from it is then not finite.
static void spoil(int m, int n, float *c, int ldc) {
  for (int i = 0; i < m; i++)
    for (int j = 0; j < n; j++) c[(size_t)i * (size_t)ldc + (size_t)j] = NAN;
}

void vs_blas_multiply(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k, const float *a,
                      int lda, const float *b, int ldb, bool accumulate, float *c, int ldc) {
  float beta = accumulate ? 1.0f : 0.0f;
  if (blas->cblas_sgemm) {
    blas->cblas_sgemm(ROW_MAJOR, transpose_a ? TRANSPOSED : PLAIN, transpose_b ? TRANSPOSED : PLAIN, m, n, k, 1.0f, a,
                      lda, b, ldb, beta, c, ldc);
    return;
  }
  int threads = begin_product(blas);
  if (blas->dnnl_sgemm(transpose_a ? 'T' : 'N', transpose_b ? 'T' : 'N', m, n, k, 1.0f, a, lda, b, ldb, beta, c, ldc))
    spoil(m, n, c, ldc);
  end_product(blas, threads);
}

bool vs_blas_has_bf16(const vs_blas *blas) { return blas->dnnl_bf16 != NULL; }

void vs_blas_multiply_bf16(const vs_blas *blas, bool transpose_a, bool transpose_b, int m, int n, int k,
                           const uint16_t *a, int lda, const uint16_t *b, int ldb, bool accumulate, float *c, int ldc) {
  int threads = begin_product(blas);
  if (blas->dnnl_bf16(transpose_a ? 'T' : 'N', transpose_b ? 'T' : 'N', m, n, k, 1.0f, a, lda, b, ldb,
                      accumulate ? 1.0f : 0.0f, c, ldc))
    spoil(m, n, c, ldc);
  end_product(blas, threads);
}
