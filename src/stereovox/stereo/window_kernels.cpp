#include "stereovox/stereo/window_kernels.h"

#include "stereovox/stereo/bytes_portable.h"
#include "stereovox/stereo/window_kernels_impl.h"

namespace stereovox {

const WindowKernels& portable_window_kernels() {
  static constexpr WindowKernels kernels = make_window_kernels<BytesPortable>();
  return kernels;
}

const WindowKernels& fastest_window_kernels() {
  for (const WindowKernels* const kernels : {avx512_window_kernels(), avx2_window_kernels()})
    if (kernels != nullptr) return *kernels;
  return portable_window_kernels();
}

}  // namespace stereovox
