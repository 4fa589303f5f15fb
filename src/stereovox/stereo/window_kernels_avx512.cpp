// Compiled for AVX-512 where the compiler knows it; entered only on a machine that has it. Numbers
// of candidates that do not fill its vectors are left to those of AVX2.
#include "stereovox/stereo/window_kernels.h"

#ifdef __AVX512BITALG__
#include "stereovox/stereo/bytes_avx512.h"
#include "stereovox/stereo/window_kernels_impl.h"
#endif

namespace stereovox {

const WindowKernels* avx512_window_kernels() {
#ifdef __AVX512BITALG__
  static constexpr WindowKernels kernels = make_window_kernels<BytesAvx2, BytesAvx512>();
  return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vbmi") &&
                 __builtin_cpu_supports("avx512bitalg") && __builtin_cpu_supports("avx512vl")
             ? &kernels
             : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
