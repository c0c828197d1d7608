// Tests src/learn/blas.c
#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "assert_near.h"
#include "learn/blas.h"
#include "learn/kernels.h"
#include "vsss/rng.h"

enum { M = 37, N = 21, K = 53, PAD = 3 }; // no multiples of a vector's width; rows lie further apart than they are long

// One product against sums in double.
static void check(const vs_blas *blas, bool transpose_a, bool transpose_b, bool accumulate) {
  enum { A_MAX = (M > K ? M : K) + PAD, B_MAX = (K > N ? K : N) + PAD };
  static float a[A_MAX * A_MAX], b[B_MAX * B_MAX], c[M * (N + PAD)], before[M * (N + PAD)];
  vs_rng rng = vs_rng_make(3, 0);
  for (size_t i = 0; i < sizeof a / sizeof *a; i++) a[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (size_t i = 0; i < sizeof b / sizeof *b; i++) b[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  for (size_t i = 0; i < sizeof c / sizeof *c; i++) before[i] = c[i] = (float)vs_rng_range(&rng, -1.0, 1.0);
  int lda = (transpose_a ? M : K) + PAD, ldb = (transpose_b ? K : N) + PAD, ldc = N + PAD;
  vs_blas_multiply(blas, transpose_a, transpose_b, M, N, K, a, lda, b, ldb, accumulate, c, ldc);
  for (int i = 0; i < M; i++)
    for (int j = 0; j < ldc; j++) {
      double sum = accumulate || j >= N ? before[i * ldc + j] : 0.0;
      for (int k = 0; k < K && j < N; k++)
        sum +=
            (double)(transpose_a ? a[k * lda + i] : a[i * lda + k]) * (transpose_b ? b[j * ldb + k] : b[k * ldb + j]);
      assert_near(c[i * ldc + j], sum, 1e-5);
    }
}

static void check_all(const vs_blas *blas) {
  for (int kind = 0; kind < 8; kind++) check(blas, kind & 1, kind & 2, kind & 4);
}

static bool open_or_note(vs_blas *blas, vs_blas_library which) {
  vs_error missing = {0};
  if (vs_blas_open(blas, which, &missing) == VS_OK) return true;
  assert_non_null(strstr(missing.text, "apt install"));
  print_message("note: 1 check not run: %s\n", missing.text);
  return false;
}

static void both_libraries_multiply_and_add_to_what_was_there(void **state) {
  (void)state;
  vs_blas blas;
  if (open_or_note(&blas, VS_BLAS_ONEDNN)) {
    assert_string_equal(blas.name, "oneDNN");
    check_all(&blas);
  }
  if (open_or_note(&blas, VS_BLAS_OPENBLAS)) {
    assert_string_equal(blas.name, "OpenBLAS");
    check_all(&blas);
  }
  assert_ok(vs_blas_open(&blas, VS_BLAS_ANY, err));
  check_all(&blas);
}

// Products of whole numbers below 256, which bfloat16 holds exactly, and their sums, which float does.
static void products_of_bfloat16_numbers_are_added_up_in_float(void **state) {
  (void)state;
  vs_blas blas;
  assert_ok(vs_blas_open(&blas, VS_BLAS_ANY, err));
  if (!vs_blas_has_bf16(&blas)) {
    print_message("note: no bfloat16 here\n");
    skip();
  }
  static uint16_t a[M * K], b[K * N];
  static float fa[M * K], fb[K * N], c[M * N];
  for (int i = 0; i < M * K; i++) fa[i] = (float)(i * 7 % 201 - 100);
  for (int i = 0; i < K * N; i++) fb[i] = (float)(i * 11 % 199 - 99);
  vs_kernel_to_bf16(fa, M * K, a);
  vs_kernel_to_bf16(fb, K * N, b);
  for (int kind = 0; kind < 8; kind++) {
    bool ta = kind & 1, tb = kind & 2, add = kind & 4;
    for (int i = 0; i < M * N; i++) c[i] = 3.0f;
    vs_blas_multiply_bf16(&blas, ta, tb, M, N, K, a, ta ? M : K, b, tb ? K : N, add, c, N);
    for (int i = 0; i < M; i++)
      for (int j = 0; j < N; j++) {
        double sum = add ? 3.0 : 0.0;
        for (int k = 0; k < K; k++)
          sum += (double)(ta ? fa[k * M + i] : fa[i * K + k]) * (tb ? fb[j * K + k] : fb[k * N + j]);
        assert_near(c[i * N + j], sum, 0.0);
      }
  }
}

static int threads_of_this_process(void) {
  int count = 0;
  DIR *tasks = opendir("/proc/self/task");
  assert_non_null(tasks);
  while (readdir(tasks)) count++;
  closedir(tasks);
  return count;
}

// A product large enough for several threads, of which OpenMP is told to take three.
static void onednn_starts_no_threads_and_leaves_openmp_as_it_was(void **state) {
  (void)state;
  enum { SIDE = 512 };
  vs_blas blas;
  if (!open_or_note(&blas, VS_BLAS_ONEDNN)) skip();
  float *square = calloc(3 * SIDE * SIDE, sizeof *square), *other = square + SIDE * SIDE, *out = other + SIDE * SIDE;
  blas.set_threads(3);
  int before = threads_of_this_process();
  vs_blas_multiply(&blas, false, false, SIDE, SIDE, SIDE, square, SIDE, other, SIDE, false, out, SIDE);
  assert_int_equal(threads_of_this_process(), before);
  assert_int_equal(blas.max_threads(), 3);
  free(square);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(both_libraries_multiply_and_add_to_what_was_there),
                                     cmocka_unit_test(products_of_bfloat16_numbers_are_added_up_in_float),
                                     cmocka_unit_test(onednn_starts_no_threads_and_leaves_openmp_as_it_was)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
