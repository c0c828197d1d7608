// The planar drive's model, loaded once for a test program, as the group set-up and tear-down of cmocka.
#ifndef VSSS_TESTS_PLANAR_MODEL_H
#define VSSS_TESTS_PLANAR_MODEL_H

#include "assert_near.h"
#include "vsss/sim.h"

static vs_model *model;

static inline int load_model(void **state) {
  (void)state;
  vs_error err;
  vs_model_def def = vs_model_def_default(VS_DRIVE_PLANAR);
  if (vs_model_load(&def, &model, &err) == VS_OK) return 0;
  print_error("%s\n", err.text);
  return -1;
}

static inline int free_model(void **state) {
  (void)state;
  vs_model_free(model);
  return 0;
}

#endif
