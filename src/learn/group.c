#include "group.h"

#include <dlfcn.h>
#include <stdlib.h>

#include "vsss/paths.h"

// Ranks that the launcher started, as it tells its children (Open MPI; the PMI of MPICH and Slurm).
static int launched_ranks(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char *text = getenv(names[i]);
    if (text) return atoi(text);
  }
  return 1;
}

vs_status vs_group_open(vs_group **out, vs_error *err) {
  *out = NULL;
  if (launched_ranks() < 2) return VS_OK;
  void *module;
  vs_status s = vs_module_load("mpi", "libopenmpi-dev", &module, err);
  if (s != VS_OK) return s;
  vs_status (*open)(vs_group *, vs_error *) = (vs_status(*)(vs_group *, vs_error *))dlsym(module, "vs_mpi_group");
  if (!open) return vs_fail(err, VS_FAIL, "build/lib/vsss_mpi.so is of another version: run make again");
  vs_group *group = calloc(1, sizeof *group);
  if (!group) return vs_fail(err, VS_FAIL, "out of memory");
  s = open(group, err);
  if (s != VS_OK)
    free(group);
  else
    *out = group;
  return s;
}

void vs_group_close(vs_group *group, bool failed) {
  if (!group) return;
  group->close(group->self, failed);
  free(group);
}

int vs_group_rank(const vs_group *group) { return group ? group->rank : 0; }

int vs_group_size(const vs_group *group) { return group ? group->size : 1; }

vs_status vs_group_any(vs_group *group, bool *flag, vs_error *err) {
  if (!group) return VS_OK;
  double sum = *flag;
  vs_status s = group->sum_doubles(group->self, &sum, 1, err);
  *flag = sum > 0.0;
  return s;
}
