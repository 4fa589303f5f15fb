#include "stereovox/stereo/window_kernels.h"

#include "stereovox/stereo/bytes_portable.h"
#include "stereovox/stereo/window_kernels_impl.h"

namespace stereovox {

const WindowKernels& portable_window_kernels() {
  static constexpr WindowKernels kernels = make_window_kernels<BytesPortable>();
  return kernels;
}

const WindowKernels& fastest_window_kernels() {
  const WindowKernels* const kernels = avx2_window_kernels();
  return kernels != nullptr ? *kernels : portable_window_kernels();
}

}  // namespace stereovox
