#include "stereovox/stereo/census_kernels.h"

#include "stereovox/stereo/bytes_portable.h"
#include "stereovox/stereo/census_kernels_impl.h"

namespace stereovox {

const CensusKernels& portable_census_kernels() {
  static constexpr CensusKernels kernels = make_census_kernels<BytesPortable>();
  return kernels;
}

const CensusKernels& fastest_census_kernels() {
  for (const CensusKernels* const kernels : {avx512_census_kernels(), avx2_census_kernels()})
    if (kernels != nullptr) return *kernels;
  return portable_census_kernels();
}

}  // namespace stereovox
