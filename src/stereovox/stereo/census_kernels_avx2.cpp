// Compiled with -mavx2 where the compiler knows it; entered only on a machine that has it.
#include "stereovox/stereo/census_kernels.h"

#ifdef __AVX2__
#include "stereovox/stereo/bytes_avx2.h"
#include "stereovox/stereo/census_kernels_impl.h"
#endif

namespace stereovox {

const CensusKernels* avx2_census_kernels() {
#ifdef __AVX2__
  static constexpr CensusKernels kernels = make_census_kernels<BytesAvx2>();
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
