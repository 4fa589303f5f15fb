// A set of voxels of one block.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "stereovox/occupancy/block_index.h"

namespace stereovox {

// One bit for each of 64 bytes (0 or 1), the first lowest. The product shifts the eight bytes of a
// row so that byte i ends as bit 56 + i.
[[gnu::always_inline]] inline std::uint64_t bits_of_bytes(
    const std::array<std::uint8_t, 64>& bytes) {
  static_assert(std::endian::native == std::endian::little);
  constexpr std::uint64_t kShifts = 0x0102040810204080ULL;
  constexpr int kLastByte = 56;
  std::uint64_t bits = 0;
  for (std::size_t row = 0; row < bytes.size(); row += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes.data() + row, sizeof eight);
    bits |= (eight * kShifts) >> kLastByte << row;
  }
  return bits;
}

struct VoxelMask {
  static constexpr int kBits = 64;
  std::array<std::uint64_t, kVoxelsPerBlock / kBits> words{};

  void set(int position) { words[word_of(position)] |= bit_of(position); }
  void reset(int position) { words[word_of(position)] &= ~bit_of(position); }
  bool contains(int position) const { return (words[word_of(position)] & bit_of(position)) != 0; }
  bool is_empty() const {
    return std::ranges::all_of(words, [](std::uint64_t word) { return word == 0; });
  }
  std::size_t count() const {
    std::size_t count = 0;
    for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }
  VoxelMask& operator|=(const VoxelMask& other) {
    for (std::size_t i = 0; i < words.size(); ++i) words[i] |= other.words[i];
    return *this;
  }

 private:
  static std::size_t word_of(int position) { return static_cast<std::size_t>(position / kBits); }
  static std::uint64_t bit_of(int position) { return std::uint64_t{1} << (position % kBits); }
};

// Calls visit(position) for each voxel of the set, in increasing order.
template <class Visit>
void for_each_in(const VoxelMask& mask, Visit visit) {
  for (std::size_t i = 0; i < mask.words.size(); ++i)
    for (std::uint64_t rest = mask.words[i]; rest != 0; rest &= rest - 1)
      visit(static_cast<int>(i) * VoxelMask::kBits + std::countr_zero(rest));
}

}  // namespace stereovox
