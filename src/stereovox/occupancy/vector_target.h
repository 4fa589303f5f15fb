// Compiles a loop twice, for any machine and for one with AVX2, and runs the one that fits. Without
// fused multiplications (-ffp-contract=off) both give the same bits: IEEE 754 leaves no choice.
// Kernels must be always_inline, so that each copy is built of its own instructions.
#pragma once

namespace stereovox {

#if defined(__x86_64__) && defined(__GNUC__)
inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}

template <class Kernel, class... Arguments>
[[gnu::target("avx2"), gnu::noinline]] void run_with_avx2(const Kernel& kernel,
                                                          Arguments&... arguments) {
  kernel(arguments...);
}
#else
inline bool has_avx2() { return false; }

template <class Kernel, class... Arguments>
void run_with_avx2(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}
#endif

template <class Kernel, class... Arguments>
[[gnu::noinline]] void run_portable(const Kernel& kernel, Arguments&... arguments) {
  kernel(arguments...);
}

template <class Kernel, class... Arguments>
void on_best_target(const Kernel& kernel, Arguments&... arguments) {
  if (has_avx2())
    run_with_avx2(kernel, arguments...);
  else
    run_portable(kernel, arguments...);
}

}  // namespace stereovox
