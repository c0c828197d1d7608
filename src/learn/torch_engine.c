#include "torch_engine.h"

#include <dlfcn.h>

#include "vsss/paths.h"

vs_status vs_torch_engine_open(vs_gradient_engine *out, vs_error *err) {
  void *module;
  vs_status s = vs_module_load("torch", "libtorch-dev", &module, err);
  if (s != VS_OK) return s;
  vs_status (*open)(vs_gradient_engine *, vs_error *) =
      (vs_status(*)(vs_gradient_engine *, vs_error *))dlsym(module, "vs_torch_gradient_engine");
  if (!open) return vs_fail(err, VS_FAIL, "build/lib/vsss_torch.so is of another version: run make again");
  return open(out, err);
}
