// Thirty-two bytes at a time on x86-64 with AVX2. Only for files that are compiled with -mavx2;
// bytes_portable.h gives the same operations everywhere.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace stereovox {
namespace {  // each including file keeps its own copy: none may leak into code for other machines

struct BytesAvx2 {
  using V = __m256i;
  static constexpr int kSize = 32;

  static V load(const std::uint8_t* p) {
    return _mm256_loadu_si256(reinterpret_cast<const V*>(p));  // NOLINT: how AVX2 is written
  }
  static void store(std::uint8_t* p, V v) { _mm256_storeu_si256(reinterpret_cast<V*>(p), v); }
  static V spread(std::uint8_t byte) { return _mm256_set1_epi8(static_cast<char>(byte)); }
  static std::uint8_t first(V v) {
    return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm256_castsi256_si128(v)));
  }

  static V add(V a, V b) { return _mm256_add_epi8(a, b); }
  static V add_saturated(V a, V b) { return _mm256_adds_epu8(a, b); }
  static V subtract_saturated(V a, V b) { return _mm256_subs_epu8(a, b); }
  static V subtract(V a, V b) { return _mm256_sub_epi8(a, b); }
  // (a + b + 1) / 2
  static V mean(V a, V b) { return _mm256_avg_epu8(a, b); }
  static V min(V a, V b) { return _mm256_min_epu8(a, b); }
  static V either(V a, V b) { return _mm256_or_si256(a, b); }
  static V both(V a, V b) { return _mm256_and_si256(a, b); }
  static V differ(V a, V b) { return _mm256_xor_si256(a, b); }

  // 255 where a >= b.
  static V is_at_least(V a, V b) { return _mm256_cmpeq_epi8(_mm256_max_epu8(a, b), a); }
  // Bit i says whether byte i is the same.
  static std::uint64_t equal_bits(V a, V b) {
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(a, b)));
  }

  // Byte i is v[i - 1], and byte 0 the last of `before`.
  static V from_before(V before, V v) {
    return _mm256_alignr_epi8(v, _mm256_permute2x128_si256(before, v, 0x21), 15);
  }
  // Byte i is v[i + 1], and the last byte the first of `after`.
  static V from_after(V v, V after) {
    return _mm256_alignr_epi8(_mm256_permute2x128_si256(v, after, 0x21), v, 1);
  }

  // The smallest byte, in every byte.
  static V min_of_all(V v) {
    __m128i m = _mm_min_epu8(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    m = _mm_min_epu8(m, _mm_srli_epi16(m, 8));  // leaves zeros in the upper byte of each pair
    return _mm256_broadcastb_epi8(_mm_minpos_epu16(m));
  }

  // Byte v[i] of `table`, which has 64; no byte of v is larger.
  static V look_up(const std::uint8_t* table, V v) {
    constexpr int kPart = 16, kBitsOfPart = 4;
    V found = _mm256_setzero_si256();
    for (int part = 0; part < 4; ++part) {
      const V part_of_table = _mm256_broadcastsi128_si256(
          _mm_loadu_si128(reinterpret_cast<const __m128i*>(table + part * kPart)));  // NOLINT
      const V is_here =
          _mm256_cmpeq_epi8(_mm256_and_si256(_mm256_srli_epi16(v, kBitsOfPart), spread(3)),
                            spread(static_cast<std::uint8_t>(part)));
      found = either(found, both(is_here, _mm256_shuffle_epi8(part_of_table, v)));
    }
    return found;
  }

  static constexpr bool kCountsOnesInOneStep = false;
  static V count_ones(V v) {
    const V ones_of_nibble = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4,  //
                                              0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    const V nibble = _mm256_set1_epi8(15);
    const V low = _mm256_and_si256(v, nibble);
    const V high = _mm256_and_si256(_mm256_srli_epi16(v, 4), nibble);
    return _mm256_add_epi8(_mm256_shuffle_epi8(ones_of_nibble, low),
                           _mm256_shuffle_epi8(ones_of_nibble, high));
  }
};

}  // namespace
}  // namespace stereovox
