#include "stereovox/stereo/row_kernels.h"

#include "stereovox/stereo/row_kernels_impl.h"

namespace stereovox {

const RowKernels& portable_row_kernels() { return kRowKernels; }

const RowKernels& fastest_row_kernels() {
  for (const RowKernels* const kernels : {avx512_row_kernels(), avx2_row_kernels()})
    if (kernels != nullptr) return *kernels;
  return portable_row_kernels();
}

}  // namespace stereovox
