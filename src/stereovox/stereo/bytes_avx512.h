// Sixty-four bytes at a time on x86-64 with AVX-512 (F, BW, VBMI, BITALG: Ice Lake, Zen 4 and
// later). Only for files that are compiled for it; bytes_portable.h gives the same operations
// everywhere.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace stereovox {
namespace {  // each including file keeps its own copy: none may leak into code for other machines

struct BytesAvx512 {
  using V = __m512i;
  static constexpr int kSize = 64;

  static V load(const std::uint8_t* p) { return _mm512_loadu_si512(p); }
  static void store(std::uint8_t* p, V v) { _mm512_storeu_si512(p, v); }
  static V spread(std::uint8_t byte) { return _mm512_set1_epi8(static_cast<char>(byte)); }
  static std::uint8_t first(V v) {
    return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm512_castsi512_si128(v)));
  }

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
  // Bit i says whether byte i is the same.
  static std::uint64_t equal_bits(V a, V b) { return _mm512_cmpeq_epi8_mask(a, b); }

  // Byte i is v[i - 1], and byte 0 the last of `before`.
  static V from_before(V before, V v) {
    return _mm512_permutex2var_epi8(before, _mm512_add_epi8(own_places(), spread(kSize - 1)), v);
  }
  // Byte i is v[i + 1], and the last byte the first of `after`.
  static V from_after(V v, V after) {
    return _mm512_permutex2var_epi8(v, _mm512_add_epi8(own_places(), spread(1)), after);
  }

  // The smallest byte, in every byte.
  static V min_of_all(V v) {
    const __m256i half =
        _mm256_min_epu8(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64(v, 1));
    __m128i m = _mm_min_epu8(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    m = _mm_min_epu8(m, _mm_srli_epi16(m, 8));  // leaves zeros in the upper byte of each pair
    return _mm512_broadcastb_epi8(_mm_minpos_epu16(m));
  }

  // Byte v[i] of `table`, which has 64; no byte of v is larger.
  static V look_up(const std::uint8_t* table, V v) {
    return _mm512_permutexvar_epi8(v, load(table));
  }

  static constexpr bool kShiftsFast = true;
  static constexpr bool kCountsOnesInOneStep = true;
  static V count_ones(V v) { return _mm512_popcnt_epi8(v); }

 private:
  // 0, 1, 2, ...
  static V own_places() {
    alignas(kSize) static constexpr std::uint8_t kPlaces[kSize] = {
        0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21,
        22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43,
        44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63};
    return load(kPlaces);
  }
};

}  // namespace
}  // namespace stereovox
