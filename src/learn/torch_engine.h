// Gradients by libtorch (build/lib/vsss_torch.so), the oracle of our kernels and --learner torch.
#ifndef VSSS_LEARN_TORCH_ENGINE_H
#define VSSS_LEARN_TORCH_ENGINE_H

#include "learner.h"

vs_status vs_torch_engine_open(vs_gradient_engine *out, vs_error *err);

#endif
