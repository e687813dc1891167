#include <maximin/deep/runtime.hpp>

#include <cstdlib>

#include <torch/torch.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

// OpenBLAS has threads of its own, which torch::set_num_threads does not know. Null where another BLAS is linked.
extern "C" __attribute__((weak)) void openblas_set_num_threads(int);

namespace maximin::deep {

void prepare_runtime() {
  torch::set_num_threads(1);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace maximin::deep
