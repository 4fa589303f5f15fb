// Compiles a loop for any machine, for one with AVX2 and for one with AVX-512, and runs the widest
// that fits. Without fused multiplications (-ffp-contract=off) all give the same bits: IEEE 754
// leaves no choice. Kernels must be always_inline, so that each copy is built of its own
// instructions.
#pragma once

#include <vector>

namespace stereovox {

enum class VectorTarget { portable, avx2, avx512 };

#if defined(__x86_64__) && defined(__GNUC__)
inline VectorTarget best_target() {
  static const VectorTarget best = [] {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw"))
      return VectorTarget::avx512;
    return __builtin_cpu_supports("avx2") ? VectorTarget::avx2 : VectorTarget::portable;
  }();
  return best;
}

template <class Kernel, class... Arguments>
[[gnu::target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512"), gnu::noinline]] void
run_with_avx512(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}
template <class Kernel, class... Arguments>
[[gnu::target("avx2"), gnu::noinline]] void run_with_avx2(const Kernel& kernel,
                                                          Arguments&... arguments) {
  kernel(arguments...);
}
#else
inline VectorTarget best_target() { return VectorTarget::portable; }

template <class Kernel, class... Arguments>
void run_with_avx512(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}
template <class Kernel, class... Arguments>
void run_with_avx2(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}
#endif

template <class Kernel, class... Arguments>
[[gnu::noinline]] void run_portable(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}

// All that this machine has: those up to the best.
inline std::vector<VectorTarget> targets_here() {
  std::vector<VectorTarget> targets = {VectorTarget::portable};
  for (const VectorTarget wider : {VectorTarget::avx2, VectorTarget::avx512})
    if (wider <= best_target()) targets.push_back(wider);
  return targets;
}

// `target` must be one that the machine has.
template <class Kernel, class... Arguments>
void run_on(VectorTarget target, const Kernel& kernel, Arguments&... arguments) {
  if (target == VectorTarget::avx512)
    run_with_avx512(kernel, arguments...);
  else if (target == VectorTarget::avx2)
    run_with_avx2(kernel, arguments...);
  else
    run_portable(kernel, arguments...);
}

template <class Kernel, class... Arguments>
void on_best_target(const Kernel& kernel, Arguments&... arguments) {
  run_on(best_target(), kernel, arguments...);
}

}  // namespace stereovox
