// Threads that share out numbered pieces of work. The pieces are the same whatever the number of threads, so results
// are too. The threads that the pool starts take no signals (vsss/signals.h).
#ifndef VSSS_POOL_H
#define VSSS_POOL_H

#include "vsss/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vs_pool vs_pool;

vs_status vs_pool_new(int threads, vs_pool **out, vs_error *err); // the caller of vs_pool_run counts as one of them
void vs_pool_free(vs_pool *pool);

// Work on one piece; thread in [0, threads) tells whose scratch memory may be used.
typedef void (*vs_pool_work)(void *context, int piece, int thread);

// Calls work for every piece in [0, pieces), in any order, and returns when all are done.
void vs_pool_run(vs_pool *pool, int pieces, vs_pool_work work, void *context);
int vs_pool_threads(const vs_pool *pool);

#ifdef __cplusplus
}
#endif
#endif
