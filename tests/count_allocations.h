// Counts what the whole process allocates, by standing in front of the C library's allocator. Include it in one file
// of a program. A sanitizer owns the allocator: COUNTS_ALLOCATIONS is then 0 and nothing is counted.
#ifndef VSSS_TESTS_COUNT_ALLOCATIONS_H
#define VSSS_TESTS_COUNT_ALLOCATIONS_H

#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define COUNTS_ALLOCATIONS 0
#else
#define COUNTS_ALLOCATIONS 1
#endif

#if COUNTS_ALLOCATIONS
static atomic_long allocations_counted;
static inline long allocations_so_far(void) { return atomic_load(&allocations_counted); }

// The C library's own names of its allocator.
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t n, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size) {
  atomic_fetch_add(&allocations_counted, 1);
  return __libc_malloc(size);
}

void *calloc(size_t n, size_t size) {
  atomic_fetch_add(&allocations_counted, 1);
  return __libc_calloc(n, size);
}

void *realloc(void *block, size_t size) {
  atomic_fetch_add(&allocations_counted, 1);
  return __libc_realloc(block, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
  atomic_fetch_add(&allocations_counted, 1);
  return __libc_memalign(alignment, size);
}

int posix_memalign(void **out, size_t alignment, size_t size) {
  atomic_fetch_add(&allocations_counted, 1);
  *out = __libc_memalign(alignment, size);
  return *out ? 0 : ENOMEM;
}
#else
static inline long allocations_so_far(void) { return 0; }
#endif

#endif
