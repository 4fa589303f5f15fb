// Compiled for AVX-512 where the compiler knows it; entered only on a machine that has it.
#include "stereovox/stereo/census_kernels.h"

#ifdef __AVX512BITALG__
#include "stereovox/stereo/bytes_avx512.h"
#include "stereovox/stereo/census_kernels_impl.h"
#endif

namespace stereovox {

const CensusKernels* avx512_census_kernels() {
#ifdef __AVX512BITALG__
  static constexpr CensusKernels kernels = make_census_kernels<BytesAvx512Half, BytesAvx512>();
  return __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vbmi") &&
                 __builtin_cpu_supports("avx512bitalg") && __builtin_cpu_supports("avx512vl")
             ? &kernels
             : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace stereovox
