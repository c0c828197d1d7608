// The group over MPI: build/lib/vsss_mpi.so, loaded under mpirun only.
#include <dlfcn.h>
#include <limits.h>
#include <mpi.h>

#include "group.h"

vs_status vs_mpi_group(vs_group *out, vs_error *err);

static vs_status check(int code, const char *doing, vs_error *err) {
  if (code == MPI_SUCCESS) return VS_OK;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  return vs_fail(err, VS_FAIL, "MPI, %s: %.300s", doing, text);
}

static vs_status sum_floats(void *self, float *values, size_t count, vs_error *err) {
  (void)self;
  if (count > INT_MAX) return vs_fail(err, VS_FAIL, "MPI: %zu values are too many for one sum", count);
  return check(MPI_Allreduce(MPI_IN_PLACE, values, (int)count, MPI_FLOAT, MPI_SUM, MPI_COMM_WORLD), "sum", err);
}

static vs_status sum_doubles(void *self, double *values, size_t count, vs_error *err) {
  (void)self;
  return check(MPI_Allreduce(MPI_IN_PLACE, values, (int)count, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD), "sum", err);
}

static vs_status broadcast(void *self, void *data, size_t size, vs_error *err) {
  (void)self;
  for (size_t from = 0; from < size; from += 1u << 30) { // the count is an int
    size_t part = size - from < 1u << 30 ? size - from : 1u << 30;
    int code = MPI_Bcast((char *)data + from, (int)part, MPI_BYTE, 0, MPI_COMM_WORLD);
    if (code != MPI_SUCCESS) return check(code, "broadcast", err);
  }
  return VS_OK;
}

static void close_group(void *self, bool failed) {
  (void)self;
  if (failed)
    MPI_Abort(MPI_COMM_WORLD, VS_FAIL);
  else
    MPI_Finalize();
}

vs_status vs_mpi_group(vs_group *out, vs_error *err) {
  // Open MPI's own plugins look for its symbols in the global scope, where a module's libraries are not.
  dlopen("libmpi.so.40", RTLD_NOW | RTLD_GLOBAL);
  int have = 0;
  vs_status s = check(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &have), "start", err);
  if (s != VS_OK) return s;
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  *out = (vs_group){.sum_floats = sum_floats, .sum_doubles = sum_doubles, .broadcast = broadcast, .close = close_group};
  MPI_Comm_rank(MPI_COMM_WORLD, &out->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &out->size);
  return VS_OK;
}
