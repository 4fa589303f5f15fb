// Compiled for AVX-512 where the compiler knows it; entered only on a machine that has it.
#include "stereovox/stereo/row_kernels.h"

#ifdef __AVX512BW__
#include "stereovox/stereo/row_kernels_impl.h"
#endif

namespace stereovox {

const RowKernels* avx512_row_kernels() {
#ifdef __AVX512BW__
  return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                 __builtin_cpu_supports("avx512dq")
             ? &kRowKernels
             : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
