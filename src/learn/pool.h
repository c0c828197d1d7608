// Threads that share out numbered pieces of work. The pieces are the same whatever the number of threads, so results
// are too.
#ifndef VSSS_LEARN_POOL_H
#define VSSS_LEARN_POOL_H

#include "vsss/status.h"

typedef struct vs_pool vs_pool;

vs_status vs_pool_new(int threads, vs_pool **out, vs_error *err); // the caller counts as one of them
void vs_pool_free(vs_pool *pool);

// Calls work(context, piece) for every piece in [0, pieces), in any order, and returns when all are done.
void vs_pool_run(vs_pool *pool, int pieces, void (*work)(void *context, int piece), void *context);

#endif
