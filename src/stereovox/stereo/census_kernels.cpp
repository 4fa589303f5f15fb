#include "stereovox/stereo/census_kernels.h"

#include "stereovox/stereo/bytes_portable.h"
#include "stereovox/stereo/census_kernels_impl.h"

namespace stereovox {

const CensusKernels& portable_census_kernels() {
  static constexpr CensusKernels kernels = make_census_kernels<BytesPortable>();
  return kernels;
}

const CensusKernels& fastest_census_kernels() {
  const CensusKernels* const avx2 = avx2_census_kernels();
  return avx2 != nullptr ? *avx2 : portable_census_kernels();
}

}  // namespace stereovox
