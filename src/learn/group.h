// Ranks that train together (mpirun): what the learner needs of MPI, as a table, so that MPI is loaded only under
// mpirun and the tests can stand in for it. Every rank calls the functions in the same order.
#ifndef VSSS_LEARN_GROUP_H
#define VSSS_LEARN_GROUP_H

#include <stddef.h>

#include "vsss/learn.h"

struct vs_group {
  int rank, size;
  void *self;
  vs_status (*sum_floats)(void *self, float *values, size_t count, vs_error *err); // in place, over all ranks
  vs_status (*sum_doubles)(void *self, double *values, size_t count, vs_error *err);
  vs_status (*broadcast)(void *self, void *data, size_t size, vs_error *err); // from rank 0
  void (*close)(void *self, bool failed);                                     // failed: ends all ranks at once
};

#endif
