// Compiled with -mavx2 where the compiler knows it; entered only on a machine that has it.
#include "stereovox/stereo/row_kernels.h"

#ifdef __AVX2__
#include "stereovox/stereo/row_kernels_impl.h"
#endif

namespace stereovox {

const RowKernels* avx2_row_kernels() {
#ifdef __AVX2__
  return __builtin_cpu_supports("avx2") ? &kRowKernels : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
