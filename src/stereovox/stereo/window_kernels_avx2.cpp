// Compiled with -mavx2 where the compiler knows it; entered only on a machine that has it.
#include "stereovox/stereo/window_kernels.h"

#ifdef __AVX2__
#include "stereovox/stereo/bytes_avx2.h"
#include "stereovox/stereo/window_kernels_impl.h"
#endif

namespace stereovox {

const WindowKernels* avx2_window_kernels() {
#ifdef __AVX2__
  static constexpr WindowKernels kernels = make_window_kernels<BytesAvx2>();
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
