#include "stereovox/stereo/row_kernels.h"

#include "stereovox/stereo/row_kernels_impl.h"

namespace stereovox {

const RowKernels& portable_row_kernels() { return kRowKernels; }

const RowKernels& fastest_row_kernels() {
  const RowKernels* const avx2 = avx2_row_kernels();
  return avx2 != nullptr ? *avx2 : portable_row_kernels();
}

}  // namespace stereovox
