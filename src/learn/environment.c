// The one place of training that sets variables of the process's environment, for programs that ask for it.
#include <stdlib.h>

#include "vsss/learn.h"

// OpenBLAS chooses its kernels by the processor's model when it loads, and takes an old family for a model it does not
// know: a processor with AVX-512 is told so.
static void choose_kernels(void) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
#endif
}

void vs_learn_environment(void) {
  setenv("OPENBLAS_NUM_THREADS", "1", 0); // our threads share out the work, its own would only wait
  choose_kernels();
  // Plain transports (memory, TCP): on a machine without its hardware, Debian's build may pick one for InfiniBand or
  // Omni-Path that writes to the terminal and never ends.
  setenv("OMPI_MCA_pml", "ob1", 0);
}
