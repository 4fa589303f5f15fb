// Sixteen bytes at a time in the vector types of g++ and clang, which they turn into what the
// machine has (SSE2, NEON, plain code). The operations are those of bytes_avx2.h.
#pragma once

#include <cstdint>
#include <cstring>

namespace stereovox {

struct BytesPortable {
  using V = std::uint8_t __attribute__((vector_size(16)));
  static constexpr int kSize = 16;

  static V load(const std::uint8_t* p) {
    V v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
  static void store(std::uint8_t* p, V v) { std::memcpy(p, &v, sizeof v); }
  static V spread(std::uint8_t byte) { return V{} + byte; }
  static std::uint8_t first(V v) { return v[0]; }

  static V add(V a, V b) { return a + b; }
  static V add_saturated(V a, V b) {
    const V sum = a + b;
    return sum | V(sum < a);
  }
  static V subtract_saturated(V a, V b) { return a - min(a, b); }
  static V subtract(V a, V b) { return a - b; }
  // (a + b + 1) / 2
  static V mean(V a, V b) { return (a | b) - ((a ^ b) >> 1); }
  static V min(V a, V b) { return a < b ? a : b; }
  static V either(V a, V b) { return a | b; }
  static V both(V a, V b) { return a & b; }
  static V differ(V a, V b) { return a ^ b; }

  static V is_at_least(V a, V b) { return V(a >= b); }
  static std::uint64_t equal_bits(V a, V b) {
    const V is_equal = V(a == b);
    std::uint64_t bits = 0;
    for (int i = 0; i < kSize; ++i) bits |= (is_equal[i] & 1ULL) << i;
    return bits;
  }

  static V from_before(V before, V v) {
    return __builtin_shufflevector(before, v, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27,
                                   28, 29, 30);
  }
  static V from_after(V v, V after) {
    return __builtin_shufflevector(v, after, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
  }

  static V min_of_all(V v) {
    v = min(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
    v = min(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
    v = min(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
    return min(v,
               __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  }

  // Byte v[i] of `table`, which has 64; no byte of v is larger.
  static V look_up(const std::uint8_t* table, V v) {
    for (int i = 0; i < kSize; ++i) v[i] = table[v[i]];
    return v;
  }

  static constexpr bool kCountsOnesInOneStep = false;
  static V count_ones(V v) {
    v = v - ((v >> 1) & 0x55);
    v = (v & 0x33) + ((v >> 2) & 0x33);
    return (v + (v >> 4)) & 0x0f;
  }
};

}  // namespace stereovox
