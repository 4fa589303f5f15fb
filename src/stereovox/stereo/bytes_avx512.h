// Sixty-four bytes at a time on x86-64 with AVX-512 (F, BW, VL, VBMI, BITALG: Ice Lake, Zen 4
// and later). Only for files that are compiled for it; bytes_portable.h gives the same operations
// everywhere.
#pragma once

#include <immintrin.h>

#include <cstdint>

#include "stereovox/stereo/bytes_avx2.h"

namespace stereovox {
namespace {  // each including file keeps its own copy: none may leak into code for other machines

struct BytesAvx512 {
  using V = __m512i;
  static constexpr int kSize = 64;

  static V load(const std::uint8_t* p) { return _mm512_loadu_si512(p); }
  static void store(std::uint8_t* p, V v) { _mm512_storeu_si512(p, v); }
  static V spread(std::uint8_t byte) { return _mm512_set1_epi8(static_cast<char>(byte)); }

  static V add(V a, V b) { return _mm512_add_epi8(a, b); }
  static V add_saturated(V a, V b) { return _mm512_adds_epu8(a, b); }
  static V subtract_saturated(V a, V b) { return _mm512_subs_epu8(a, b); }
  static V subtract(V a, V b) { return _mm512_sub_epi8(a, b); }
  // (a + b + 1) / 2
  static V mean(V a, V b) { return _mm512_avg_epu8(a, b); }
  static V min(V a, V b) { return _mm512_min_epu8(a, b); }
  static V either(V a, V b) { return _mm512_or_si512(a, b); }
  static V both(V a, V b) { return _mm512_and_si512(a, b); }
  static V differ(V a, V b) { return _mm512_xor_si512(a, b); }

  // 255 where a >= b.
  static V is_at_least(V a, V b) { return _mm512_movm_epi8(_mm512_cmpge_epu8_mask(a, b)); }

  // Byte v[i] of `table`, which has 64; no byte of v is larger.
  static V look_up(const std::uint8_t* table, V v) {
    return _mm512_permutexvar_epi8(v, load(table));
  }

  static constexpr bool kCountsOnesInOneStep = true;
  static V count_ones(V v) { return _mm512_popcnt_epi8(v); }
};

// Thirty-two bytes at a time, which these machines shift across a vector in one step.
struct BytesAvx512Half : BytesAvx2 {
  static V from_before(V before, V v) {
    return _mm256_permutex2var_epi8(before, add(own_places(), spread(kSize - 1)), v);
  }
  static V from_after(V v, V after) {
    return _mm256_permutex2var_epi8(v, add(own_places(), spread(1)), after);
  }

 private:
  // 0, 1, 2, ...
  static V own_places() {
    alignas(kSize) static constexpr std::uint8_t kPlaces[kSize] = {
        0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15,
        16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31};
    return load(kPlaces);
  }
};

}  // namespace
}  // namespace stereovox
